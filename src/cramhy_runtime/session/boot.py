"""Starting: the packages of all rooms, and what a session begins with.

`boot` makes the packages of every room and lets Python import Lisp systems. What wants Lisp calls it first: the command line,
the pytest plugin, and the Hy module ``cramhy``. A prompt that waits for its first line needs Common Lisp only, a third less: it has
`begin`, and `boot` follows when the line is there.
"""

from __future__ import annotations

import functools
import gc
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.kernel.signatures import Backend, BackendName, Clock, ClockName


SYSTEMS = """cram-language cram-utilities cram-prolog cram-designators cram-process-modules cram-language-designator-support
cram-executive cram-projection cram-execution-trace cram-occasions-events cl-transforms
cl-transforms-stamped cl-tf cl-tf2 actionlib actionlib-lisp roslisp roslisp-utilities turtlesim asdf uiop trivial-features
sb-introspect sb-posix sb-thread roslisp-utils roslisp-msg-protocol ros-load-manifest asdf-package-system"""
"""The systems of CRAM, ROS and ASDF that need no loading, because they are here. Those of messages are made on demand (ros/messages.py)."""

TF_PACKAGES = ("CL-TRANSFORMS-STAMPED", "TF-TYPES", "CL-TF", "TF", "CL-TF2")
"""The packages of the room ``tf`` with their nicknames."""


when_booted: list[Callable[[], object]] = []
"""Functions that are called when `boot` has made all packages."""


@functools.cache
def begin():
    """Make the packages of Common Lisp; with no kernel active, start one in virtual time. Calling it again does nothing."""
    from cramhy_runtime import kernel
    from cramhy_runtime.languages.commonlisp import package
    from cramhy_runtime.lisp_core import packages
    from cramhy_runtime.languages.commonlisp.evaluation import evaluator
    from cramhy_runtime.languages.commonlisp.systems import importer
    from cramhy_runtime.languages.commonlisp.tools import advice
    from . import time_setting

    kernel.allow_deep_recursion()
    if kernel.active() is None:
        kernel.start(time_setting.decide())
    with packages.our_own:
        package.fill()
    importer.install()
    kernel.install_reporter(advice.LispReporter())
    evaluator.PACKAGE.value = packages.COMMON_LISP_USER


@functools.cache
def boot():
    """Make the packages of all rooms; with no kernel active, start one in virtual time. Calling it again does nothing."""
    from cramhy_runtime import kernel

    begin()
    collecting = gc.isenabled()
    gc.disable()  # what is made now is kept
    try:
        with kernel.shield():  # Ctrl-C at the prompt shall not leave half of the packages
            _complete()
    finally:
        if collecting:
            gc.enable()
    for function in when_booted:
        function()


def _complete():
    from cramhy_runtime.kernel import images
    from cramhy_runtime.lisp_core import packages
    from cramhy_runtime.languages.commonlisp.systems import asdf, ros_load, systems, unit_tests
    from cramhy_runtime.languages.commonlisp.extension_packages import come_late
    from cramhy_runtime.languages.commonlisp.uiop import texts
    from cramhy_runtime.languages.commonlisp.faces.all_faces import FACES
    from cramhy_runtime.languages.commonlisp.packages.face_definition import define_face
    from . import time_setting

    with packages.our_own:
        for face in FACES:
            face.define()
        systems.provide_system(SYSTEMS)
        packages.on_demand.update({**systems.LIBRARY_PACKAGES, **systems.WITH_CFFI})
        packages.on_demand.update(dict.fromkeys(TF_PACKAGES, define_tf))
        packages.on_demand["ROBOT-WORLD"] = define_robot_world
        packages.on_demand.update(dict.fromkeys(("ACTIONLIB-LISP", "ACTIONLIB"), define_actionlib))
        ros_load.define_faces()
        asdf.define_faces()
        texts.define_faces()
        come_late("UIOP")
        define_face(
            "CRAMHY", functions={"within-limit": unit_tests.within_limit, "time": time_setting.time, "define-costmaps": define_costmaps}
        )
    images.keep_core()


def booted():
    """Whether `boot` was called in this process."""
    return bool(boot.cache_info().currsize)


def define_actionlib():
    """Make the packages of the room ``actionlib``."""
    from cramhy_runtime.languages.commonlisp.faces.actionlib import package

    package.define_faces()


def define_robot_world():
    """Make the package ROBOT-WORLD, which needs the extra ``robot``."""
    from cramhy_runtime.languages.commonlisp.faces.robot_world import package

    package.define_faces()


def define_costmaps():
    """Name what Python computes for the library ``cram-location-costmap``. It takes numpy, so it is done when that is loaded."""
    from cramhy_runtime.lisp_core.conditions import error

    try:
        from cramhy_runtime.languages.commonlisp.faces.costmaps import package
    except ImportError as problem:
        return error("~a", str(problem))
    return package.define()


def define_tf():
    """Make the packages of the room ``tf``: the turtle's course has no frames."""
    from cramhy_runtime.languages.commonlisp.faces.tf import package

    package.define_faces(TF_PACKAGES)


def fresh_start(
    clock: ClockName | Clock | None = None,
    backend: BackendName | Backend = "auto",
    seed: int | None = None,
    time_limit: float | None = None,
    turtlesim: bool = True,
    whole: bool = True,
    **options: Any,
) -> None:
    """Start a kernel with an image: nothing runs, the random numbers begin anew, the simulator waits for the first node.

    clock: "virtual", "wall", or a clock; ``None``: as CRAMHY_TIME says, or virtual. whole: whether the packages of all rooms are made now;
    else the caller calls `boot` before anything is read or evaluated. options: more of `kernel.start`.
    """
    from cramhy_runtime import kernel
    from . import time_setting

    kernel.start(clock=clock or time_setting.decide(), backend=backend, seed=seed, time_limit=time_limit, **options)
    boot() if whole else begin()
    from cramhy_runtime.languages.commonlisp.numbers.random_state import seed_random
    from cramhy_runtime.robot_world.al5d.demand import start_when_asked_for
    from cramhy_runtime.turtlesim.node import start_with_first_node

    seed_random(seed)
    if turtlesim:
        start_with_first_node()
        start_when_asked_for()
