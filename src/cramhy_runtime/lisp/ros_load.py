"""``ros-load`` and ``asdf``: how a user loads a system (roslisp.md section 12)."""

from __future__ import annotations

import os

from . import systems
from .conditions import error
from .data import Cons, list_from, truth
from .dynamic import binding
from .faces import define_face
from .environment import MODULES, provide
from .loader import folder_of_load
from .packages import string_designator, sym
from .program_files import load


def load_system(package, system=None, force=None):
    """``(ros-load:load-system "ros_package" :system)``: load a system of a ROS package; returns T.

    Without ``system`` the name of the package is the name of the system.
    """
    name = string_designator(package)
    wanted = string_designator(package if system is None else system).lower()
    with binding(sym("ROS-LOAD-MANIFEST::*CURRENT-ROS-PACKAGE*"), name):
        systems.load_system(wanted, truth(force))
    return True


def ros_package_path(package):
    """The folder of a ROS package, as a string."""
    folder = systems.find_package_folder(string_designator(package))
    if folder is None:
        return error("rospack find ~A returned 1 with stderr '[rospack] Error: package '~A' not found'", package, package)
    return str(folder) + "/"


def ros_home():
    return os.environ.get("ROS_HOME") or os.path.join(os.path.expanduser("~"), ".ros")


def asdf_load_system(system, *, force=None, verbose=None):
    """``asdf:load-system``"""
    systems.load_system(string_designator(system), truth(force))
    return True


def find_system(name, error_p=True):
    known = string_designator(name).lower()
    if known in systems.built_in:
        return True
    if not truth(error_p) and systems.find_asd(known) is None:
        return None
    return systems.find_system(known)


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


def _defsystem(form, environment):
    quote = sym("QUOTE")
    return Cons(sym("CRAMHY::DEFINE-SYSTEM-HERE"), Cons(Cons(quote, Cons(form, None)), None))


def define_system_here(form):
    """A ``defsystem`` evaluated outside an ``.asd`` file: its folder is that of the file being loaded."""
    return systems.define_system(form, folder_of_load()).name


def define_faces():
    """Make the packages ROS-LOAD-MANIFEST (ROS-LOAD) and ASDF."""
    define_face("ROS-LOAD-MANIFEST", nicknames=["ROS-LOAD"], functions={"load-system": load_system, "ros-package-path": ros_package_path,
                                                                        "ros-home": ros_home},
                variables={"*CURRENT-ROS-PACKAGE*": None})
    define_face("ASDF", functions={"load-system": asdf_load_system, "find-system": find_system, "defsystem": define_system_here})
    define_face("CRAMHY", functions={"define-system-here": define_system_here})
    define_face("COMMON-LISP", functions={"require": require})
    sym("ASDF::DEFSYSTEM").macro = _defsystem

