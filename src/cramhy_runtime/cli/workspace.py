"""The commands for packages and workspaces: ``catkin_create_pkg``, ``catkin_make``, ``roscd``, ``rospack``, ``rosls``, ``rosversion``.

Packages are found where `systems` finds them; those that are part of cramhy are the folders of their message definitions. What has
nothing to do here (catkin_make) says so in one line and succeeds. Source: roslisp.md 14.2.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

from cramhy_runtime import storage

VERSIONS = {"turtlesim": "0.10.2", "roslisp": "1.9.25"}


def _fail(text, status=1):
    print(text, file=sys.stderr)
    return status


def catkin_create_pkg(arguments):
    """``catkin_create_pkg NAME [DEPENDENCY ...]``: a folder with a manifest, in the current one."""
    from cramhy_runtime.ros import new_packages

    names = [argument for argument in arguments if not argument.startswith("-")]
    if not names:
        return _fail("usage: catkin_create_pkg NAME [DEPENDENCY ...]", 2)
    name, *dependencies = names
    if not re.fullmatch(r"[a-z][a-z0-9_-]*", name):
        return _fail(
            f"catkin_create_pkg: '{name}' is not a name for a package: a lower-case letter, then such letters, digits, _ and - only."
        )
    folder = Path.cwd() / name
    for file in ("package.xml", "CMakeLists.txt"):
        if os.path.lexists(folder / file):
            return _fail(f"catkin_create_pkg: {folder} has a {file} already.")
    with storage.Tree() as made:
        for sub in ("", "src", f"include/{name}"):
            made.folder(folder / sub)
        made.write(folder / "CMakeLists.txt", new_packages.cmake_lists(name, dependencies))
        made.write(folder / "package.xml", new_packages.manifest(name, dependencies))  # with it, it is a package
    print(
        f"Created file {name}/package.xml\nCreated file {name}/CMakeLists.txt\nCreated folder {name}/include/{name}\n"
        f"Created folder {name}/src\nSuccessfully created files in {folder}. Please adjust the values in package.xml."
    )
    return 0


def catkin_make(arguments):
    """``catkin_make``: there is nothing to build."""
    (Path.cwd() / "devel").mkdir(exist_ok=True)
    print("Nothing to build: cramhy compiles Lisp when it loads it.")


def folder_of(package):
    """The folder of a package, or ``None``: the user's first, then those of cramhy."""
    from cramhy_runtime.languages.commonlisp.systems import systems
    from cramhy_runtime.ros import definition_files

    return systems.find_package_folder(package) or definition_files.package_folder(package) or definition_files.own_folder(package)


def packages():
    """The folders of all packages by name."""
    from cramhy_runtime.ros import definition_files, search_folders

    with search_folders.crawling_once():
        found = {package: folder_of(package) for package in {*definition_files.known_packages(), *definition_files.own_packages()}}
        for name, folder in definition_files.packages():
            found.setdefault(name, folder)
    return {name: folder for name, folder in sorted(found.items()) if folder is not None}


def roscd(arguments):
    """``roscd [PACKAGE[/FOLDER]]``: print where the shell shall go."""
    if len(arguments) > 1 or arguments and arguments[0].startswith("-"):
        return _fail("usage: roscd package")
    if not arguments:
        if os.environ.get("ROS_WORKSPACE"):
            print(os.environ["ROS_WORKSPACE"])
            return 0
        here = Path.cwd()
        for folder in [here, *here.parents]:
            if os.path.isdir(folder / "devel"):
                print(folder / "devel")
                return 0
        return _fail("roscd: no workspace here: there is no folder 'devel' (run catkin_make in the workspace first).")
    return _print_place("roscd", arguments[0])


def _print_place(tool, place, show=print):
    package, _, below = place.partition("/")
    found = folder_of(package)
    if found is None:
        return _fail(f"{tool}: No such package/stack '{package}'")
    place = os.path.join(found, below) if below else str(found)
    if not os.path.exists(place):
        return _fail(f"{tool}: No such file or folder: {place}")
    show(place)
    return 0


def rosls(arguments):
    """``rosls [PACKAGE[/FOLDER]]``: list the files of a package; without a word, all packages."""
    if not arguments:
        print("\n".join(packages()))
        return 0

    def show(place):
        print("\n".join(sorted(name for name in os.listdir(place) if not name.startswith(".")) if os.path.isdir(place) else [place]))

    return _print_place("rosls", arguments[0], show)


def rospack(arguments):
    """``rospack find PACKAGE | list | list-names | depends PACKAGE | depends1 PACKAGE | profile``."""
    command, names = (arguments or [""])[0], arguments[1:]
    if command in ("list", "list-names"):
        for name, folder in packages().items():
            print(name if command == "list-names" else f"{name} {folder}")
        return 0
    if command == "profile":
        print("Packages are looked for when they are needed, so there is nothing to crawl.")
        return 0
    if command not in ("find", "depends", "depends1"):
        return _fail("usage: rospack find PACKAGE | list | list-names | depends PACKAGE | depends1 PACKAGE | profile", 2)
    if len(names) != 1:
        return _fail(f"[rospack] Error: {command} takes the name of one package")
    folder = folder_of(names[0])
    if folder is None:
        return _fail(f"[rospack] Error: package '{names[0]}' not found")
    if command == "find":
        print(folder)
    else:
        print("".join(f"{name}\n" for name in _dependencies(names[0], deep=command == "depends")), end="")
    return 0


_DEPENDENCY = re.compile(r"<(?:depend|build_depend|build_export_depend|exec_depend|run_depend)>\s*([\w-]+)\s*</")


def _dependencies(package, deep):
    """The packages that a package names in its manifest; ``deep``: and those that these name."""
    found, waiting = [], [package]
    while waiting:
        folder = folder_of(waiting.pop(0))
        manifest = folder and folder / "package.xml"
        for name in _DEPENDENCY.findall(manifest.read_text(encoding="utf-8", errors="replace")) if manifest and manifest.is_file() else ():
            if name not in found:
                found.append(name)
                if deep:
                    waiting.append(name)
    return found


def rosversion(arguments):
    """``rosversion PACKAGE`` or ``rosversion -d``, which prints the name of the distribution."""
    if arguments in (["-d"], ["--distro"]):
        from cramhy_runtime.ros.parameter_tree import DISTRIBUTION

        print(DISTRIBUTION)
        return 0
    if len(arguments) != 1 or arguments[0].startswith("-"):
        return _fail("Usage: rosversion PACKAGE, or rosversion -d for the name of the distribution", 2)
    name = arguments[0]
    if name == "cramhy":
        from cramhy_runtime import __version__

        version = __version__
    else:
        version = VERSIONS.get(name) or _version_in_manifest(name)
    if version is None:
        return _fail(f"Cannot locate [{name}]")
    print(version)
    return 0


def _version_in_manifest(package):
    manifest = folder_of(package)
    manifest = manifest and manifest / "package.xml"
    found = manifest and manifest.is_file() and re.search(r"<version>\s*([^\s<]+)", manifest.read_text(encoding="utf-8", errors="replace"))
    return found.group(1) if found else None
