"""``ros-load``: how a user of ROS loads a system (roslisp.md section 12); and ``require``."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.conditions import error, types
from cramhy_runtime.lisp_core.data import Cons, list_from, truth
from cramhy_runtime.lisp_core.dynamic import binding
from ..evaluation.environment import MODULES, provide
from ..packages.face_definition import define_face
from .program_files import load
from cramhy_runtime.lisp_core.packages import near_names, string_designator, sym
from cramhy_runtime.ros import definition_files
from cramhy_runtime.ros.search_folders import crawling_once
from . import systems

NOT_FOUND = "rospack find ~A returned 1 with stderr '[rospack] Error: package '~A' not found'"


def load_system(package, system=None, force=None):
    """``(ros-load:load-system "ros_package" :system)``: load a system of a ROS package; returns T.

    Without ``system`` the name of the package is the name of the system. A package that does not exist is an error, also when the system
    is found without it (roslisp.md section 12).
    """
    name = string_designator(package)
    wanted = string_designator(package if system is None else system).lower()
    with crawling_once(), binding(sym("ROS-LOAD-MANIFEST::*CURRENT-ROS-PACKAGE*"), name):
        if system is not None:
            check_package(name, wanted)
        systems.load_system(wanted, truth(force))
    return True


def check_package(name, system):
    """An error if there is no ROS package ``name``. cramhy's own systems are packages, too, and so are folders with a system in them.

    Of a ``system`` that is not there whoever looks for it tells, if the package is there.
    """
    file = systems.find_asd(system)
    system_name = name.lower().replace("_", "-")
    if systems.is_provided(name.lower()) or systems.is_provided(system_name) or f"{system_name}.asd" in systems.libraries():
        return
    if file is not None and name in [folder.name for folder in file.parents]:
        return
    if systems.find_package_folder(name) is not None or definition_files.package_folder(name) is not None:
        return
    packages = dict(definition_files.packages())
    if name not in packages:
        _not_found(name, system, next((other for other, folder in packages.items() if file is not None and folder in file.parents), None))


def _not_found(name, system, home):
    """Signal that there is no package ``name``; ``home``: that of the ``system``, or ``None``."""
    known = {
        *definition_files.known_packages(),
        *(other.replace("-", "_") for other in systems.built_in),
        *dict(definition_files.packages()),
    }
    near = near_names(name, known)
    hint = f"No package {name} is below {definition_files.where_searched()}."
    if home or near:
        hint = f"The system {system} is in the package {home}." if home else f"Did you mean {' or '.join(near)}?"
    error(types.SimpleError(NOT_FOUND, name, name), hint=hint)


def ros_package_path(package):
    """The folder of a ROS package, as a string."""
    folder = systems.find_package_folder(string_designator(package))
    if folder is None:
        return error(NOT_FOUND, package, package)
    return str(folder) + "/"


def rospack(command="", *arguments):
    """``(ros-load:rospack "find" "package")``: the lines that this command of the shell prints, as a list. Only ``find`` is there."""
    if command != "find" or len(arguments) != 1:
        return error('(ros-load:rospack "find" package) is all that rospack does from within a program; the shell\'s command does more.')
    return list_from([ros_package_path(arguments[0]).rstrip("/")])


def asdf_paths_to_add(package):
    """The folders ``asdf`` below a ROS package in which systems used to lie: a list of one, or of none."""
    folder = ros_package_path(package) + "asdf/"
    return list_from([folder] if os.path.isdir(folder) else [])


def asdf_ros_search(system):
    """The file that defines ``system``, as a string, or nil."""
    found = systems.find_asd(string_designator(system).lower())
    return None if found is None else str(found)


def load_manifest(*_):
    """What loaded the systems of a package before `load_system` was there."""
    return error("Load manifest deprecated!")


def ros_home():
    """Where ROS keeps its logs: ``$ROS_HOME``, or ``.ros`` in the user's home."""
    return os.environ.get("ROS_HOME") or os.path.join(os.path.expanduser("~"), ".ros")


def require(module, pathnames=None):
    """``require``: load the module of that name unless ``*modules*`` says that it is there; the names of what was loaded.

    pathnames: the file or files of it; without, it is the system of that name. ASDF itself and SBCL's own modules always are there.
    """
    name = string_designator(module)
    before = list(MODULES.value or ())
    if name in before or name.lower() in ("asdf", "uiop") or name.lower().startswith("sb-"):
        return None
    if pathnames is None:
        systems.load_system(name.lower())
        provide(name)
    for path in pathnames if isinstance(pathnames, Cons) else [pathnames] if pathnames is not None else ():
        load(path)
    return list_from([each for each in MODULES.value or () if each not in before])


def define_faces():
    """Make the package ROS-LOAD-MANIFEST (ROS-LOAD)."""
    define_face(
        "ROS-LOAD-MANIFEST",
        nicknames=["ROS-LOAD"],
        use=["COMMON-LISP"],
        functions={
            "load-system": load_system,
            "ros-package-path": ros_package_path,
            "ros-home": ros_home,
            "rospack": rospack,
            "asdf-paths-to-add": asdf_paths_to_add,
            "asdf-ros-search": asdf_ros_search,
            "load-manifest": load_manifest,
        },
        variables={"*CURRENT-ROS-PACKAGE*": None},
        export="asdf-ros-pkg-search",
    )
    define_face("COMMON-LISP", functions={"require": require})
