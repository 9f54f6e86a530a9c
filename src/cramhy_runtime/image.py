"""The image: all rooms together, as a Lisp image has all packages loaded.

`boot` makes the packages of every room and lets Python import Lisp systems. What wants Lisp calls it first: the command line,
the pytest plugin, and the Hy module ``cramhy``.
"""

from __future__ import annotations

import importlib

ROOMS = ("transforms", "prolog", "cpl", "ros", "turtlesim", "designators", "episodes", "occasions", "process_modules",
         "projection")
"""The rooms with a ``package.py``, in the order of their floors."""

SYSTEMS = """cram-language cram-utilities cram-prolog cram-designators cram-process-modules cram-language-designator-support
cram-executive cram-projection cram-execution-trace cram-occasions-events cl-transforms
cl-transforms-stamped cl-tf cl-tf2 actionlib actionlib-lisp roslisp roslisp-utilities turtlesim asdf uiop trivial-features"""
"""The systems of CRAM, ROS and ASDF that need no loading, because they are here. Those of messages are made on demand (ros/messages.py)."""

TF_PACKAGES = ("CL-TRANSFORMS-STAMPED", "TF-TYPES", "CL-TF", "TF", "CL-TF2")
"""The packages of the room ``tf`` with their nicknames."""

_booted = False


def boot():
    """Make the packages; with no kernel active, start one in virtual time. Calling it again does nothing."""
    global _booted
    if _booted:
        return
    _booted = True
    from cramhy_runtime import kernel
    from cramhy_runtime.lisp import package, packages
    from cramhy_runtime.lisp.evaluation import evaluator, places_in_source
    from cramhy_runtime.lisp.systems import asdf, importer, ros_load, systems, uiop, unit_tests
    from cramhy_runtime.lisp.faces import define_face
    from cramhy_runtime.lisp.packages import COMMON_LISP_USER
    from cramhy_runtime.lisp.tools import advice

    kernel.allow_deep_recursion()
    if kernel.active() is None:
        kernel.start()
    package.fill()
    for room in ROOMS:
        importlib.import_module(f"cramhy_runtime.{room}.package")
    for room in ("prolog", "ros"):
        importlib.import_module(f"cramhy_runtime.{room}.macro_support")
    systems.provide_system(SYSTEMS)
    packages.on_demand.update(systems.LIBRARY_PACKAGES)
    packages.on_demand.update(dict.fromkeys(("CRAMHY-TESTING", "TESTING-USER"), define_testing))
    packages.on_demand.update(dict.fromkeys(TF_PACKAGES, define_tf))
    packages.on_demand.update(dict.fromkeys(("ACTIONLIB-LISP", "ACTIONLIB"), define_actionlib))
    ros_load.define_faces()
    asdf.define_faces()
    uiop.define_faces()
    define_face("CRAMHY", functions={"within-limit": unit_tests.within_limit})
    importer.install()
    kernel.describe_frame = places_in_source.describe_frame
    kernel.unhandled = advice.tell_unhandled
    evaluator.PACKAGE.value = COMMON_LISP_USER


def define_testing():
    """Make the packages of the room ``testing``, which most sessions never name."""
    from cramhy_runtime.testing import package

    package.define_faces()


def define_actionlib():
    """Make the packages of the room ``actionlib``."""
    from cramhy_runtime.actionlib import package

    package.define_faces()


def define_tf():
    """Make the packages of the room ``tf``: the turtle's course has no frames."""
    from cramhy_runtime.tf import package

    package.define_faces(TF_PACKAGES)


def fresh_start(clock="virtual", backend="threads", seed=None, time_limit=None, turtlesim=True, **options):
    """Start a kernel with an image: nothing runs, the random numbers begin anew, the simulator waits for the first node.

    options: more of `kernel.start`.
    """
    from cramhy_runtime import kernel

    kernel.start(clock=clock, backend=backend, seed=seed, time_limit=time_limit, **options)
    boot()
    from cramhy_runtime.lisp.numbers.random_state import seed_random
    from cramhy_runtime.turtlesim.node import start_with_first_node

    seed_random(seed)
    if turtlesim:
        start_with_first_node()
