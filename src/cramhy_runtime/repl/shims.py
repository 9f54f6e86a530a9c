"""The ROS commands of the slides, for machines without ROS.

``cramhy ros-shims`` prints shell functions (``eval "$(cramhy ros-shims)"``), ``cramhy ros-shims --install FOLDER`` writes them as
programs. What has nothing to do here (roscore, catkin_make) says so in one line and succeeds. A real ROS on the PATH is left
alone.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

TOOLS = ("catkin_create_pkg", "catkin_make", "roscore", "rosrun", "roslaunch", "rosservice", "rostopic", "rosnode", "rosparam", "rosmsg",
         "rossrv", "rospack")


def run(folder=None):
    """Print the shell functions, or install programs in ``folder``."""
    real = [tool for tool in TOOLS if (found := shutil.which(tool)) and not _is_ours(found)]
    tools = [tool for tool in TOOLS if tool not in real]
    if real:
        print(f"cramhy: a ROS is installed here, so {', '.join(real)} stay as they are.", file=sys.stderr)
    if folder is None:
        for tool in tools:
            print(f'{tool}() {{ cramhy ros {tool} "$@"; }}')
        print('roslisp_repl() { command roslisp_repl --commands "$@"; }')
        if shutil.which("roscd") is None:
            print('roscd() { local to; to="$(cramhy ros roscd "$@")" && cd "$to"; }')
        return 0
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for tool in tools:
        program = target / tool
        program.write_text(f'#!/bin/sh\n# {_MARK}\nexec "{sys.executable}" -m cramhy_runtime.cli ros {tool} "$@"\n')
        program.chmod(0o755)
    print(f"Wrote {', '.join(tools)} into {target}. roscd changes the shell's folder, so it must be a shell function: "
          'eval "$(cramhy ros-shims)"')
    return 0


_MARK = "made by cramhy ros-shims"


def _is_ours(path):
    try:
        return _MARK in Path(path).read_text(errors="ignore")[:200]
    except OSError:
        return False


def tool(name, arguments):
    """Do what the command ``name`` does; the exit status."""
    function = globals().get(f"_{name}")
    if function is None:
        print(f"cramhy: there is no command {name} here; there are {', '.join(TOOLS)} and roscd.", file=sys.stderr)
        return 2
    return function(arguments) or 0


def _catkin_create_pkg(arguments):
    names = [argument for argument in arguments if not argument.startswith("-")]
    if not names:
        print("usage: catkin_create_pkg NAME [DEPENDENCY ...]", file=sys.stderr)
        return 2
    name, *dependencies = names
    if not re.fullmatch(r"[a-z][a-z0-9_-]*", name):
        print(f"catkin_create_pkg: '{name}' is no name for a package: lower-case letters, digits and _ only.", file=sys.stderr)
        return 1
    folder = Path.cwd() / name
    if (folder / "package.xml").exists():
        print(f"catkin_create_pkg: {folder} has a package.xml already.", file=sys.stderr)
        return 1
    for sub in ("", "src", f"include/{name}"):
        (folder / sub).mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(_manifest(name, dependencies))
    (folder / "CMakeLists.txt").write_text(_cmake(name, dependencies))
    print(f"Created file {name}/package.xml\nCreated file {name}/CMakeLists.txt\nCreated folder {name}/include/{name}\n"
          f"Created folder {name}/src\nSuccessfully created files in {folder}. Please adjust the values in package.xml.")
    return 0


def _manifest(name, dependencies):
    lines = ['<?xml version="1.0"?>', '<package format="2">', f"  <name>{name}</name>", "  <version>0.0.0</version>",
             f"  <description>The {name} package</description>", '  <maintainer email="user@example.org">user</maintainer>',
             "  <license>unknown</license>", "  <buildtool_depend>catkin</buildtool_depend>"]
    for kind in ("build_depend", "build_export_depend", "exec_depend"):
        lines += [f"  <{kind}>{dependency}</{kind}>" for dependency in dependencies]
    return "\n".join([*lines, "</package>", ""])


def _cmake(name, dependencies):
    components = " ".join(dependencies)
    return (f"cmake_minimum_required(VERSION 3.0.2)\nproject({name})\n"
            f"find_package(catkin REQUIRED COMPONENTS {components})\ncatkin_package()\n")


def _catkin_make(arguments):
    (Path.cwd() / "devel").mkdir(exist_ok=True)
    print("Nothing to build: cramhy compiles Lisp when it loads it.")


def _roscore(arguments):
    print("No master is needed: the ROS graph lives in the process of roslisp_repl.")


def _roscd(arguments):
    from cramhy_runtime.lisp.systems import systems

    if not arguments:
        here = Path.cwd()
        for folder in [here, *here.parents]:
            if (folder / "devel").is_dir():
                print(folder / "devel")
                return 0
        print("roscd: no workspace here: there is no folder 'devel' (run catkin_make in the workspace first).", file=sys.stderr)
        return 1
    package, _, below = arguments[0].partition("/")
    found = systems.find_package_folder(package)
    if found is None:
        print(f"roscd: No such package/stack '{package}'", file=sys.stderr)
        return 1
    print(os.path.join(found, below) if below else found)
    return 0


def _rosrun(arguments):
    if len(arguments) < 2:
        print("Usage: rosrun PACKAGE EXECUTABLE [ARGS]")
        return 0
    package, executable = arguments[:2]
    if package != "turtlesim":
        print(f"[rospack] Error: package '{package}' not found", file=sys.stderr)
        return 2
    notes = {"turtlesim_node": 'The simulator lives in the process of roslisp_repl: it starts with (start-ros-node "name").',
             "turtle_teleop_key": "The arrow keys live in the process of roslisp_repl: (turtlesim:press :up), also :down :left :right."}
    if executable not in notes:
        print(f"[rosrun] Couldn't find executable named {executable} below the package turtlesim", file=sys.stderr)
        return 3
    print(notes[executable])
    return 0


_roslaunch = _rosrun


def _graph_command(name):
    def run_there(arguments):
        from .commands import send

        answer = send([name, *arguments])
        if answer is None:
            print(f"ERROR: no REPL serves ROS commands. Start it with: roslisp_repl --commands (or type {name} ... at its prompt).",
                  file=sys.stderr)
            return 1
        text, status = answer
        print(text, end="", file=sys.stderr if status else sys.stdout)
        return status

    return run_there


_rosservice, _rostopic, _rosnode = map(_graph_command, ("rosservice", "rostopic", "rosnode"))
_rosparam, _rosmsg, _rossrv = map(_graph_command, ("rosparam", "rosmsg", "rossrv"))


def _rospack(arguments):
    if len(arguments) == 2 and arguments[0] == "find":
        return _roscd(arguments[1:])
    print("usage: rospack find PACKAGE", file=sys.stderr)
    return 2
