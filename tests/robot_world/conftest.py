"""Fixtures: the PR2 and the kitchen in a world; of the packages for mobile manipulation: forms in, printed values out, a robot of tin that obeys."""

from __future__ import annotations

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ground.packages import COMMON_LISP, ensure_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

TIN_ROBOT = Path(__file__).parent / "tin_robot.lisp"


@pytest.fixture
def lisp(session):
    """A function: the printed values of the last form of a text, in a package of its own; a condition is ``CLASS: its text``. White space is one blank."""
    session.package = ensure_package("ROBOT-TESTS", use=[COMMON_LISP])

    def values(text):
        text = f'(handler-case (progn {text}) (serious-condition (c) (format nil "~A: ~A" (type-of c) c)))'
        return " ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text, "<test>"))

    return values


@pytest.fixture
def robot(lisp):
    """The same in the package of a robot of tin, which has no past. See ``tin_robot.lisp``."""
    lisp(f'(or (find-package :tin-robot) (load "{TIN_ROBOT.as_posix()}"))')
    lisp("(setf *package* (find-package :tin-robot))")
    lisp("(forget)")
    return lisp


@pytest.fixture(scope="session")
def pr2():
    return _skeleton("pr2")


@pytest.fixture(scope="session")
def kitchen():
    return _skeleton("kitchen")


def _skeleton(name):
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    from cramhy_runtime.robot_world import models, skeleton

    return skeleton.skeleton_of(models.described(name))


@pytest.fixture
def world(pr2, kitchen):
    from cramhy_runtime.robot_world.world import World

    kernel.start(clock="virtual")
    made = World()
    made.add_machine("kitchen", kitchen)
    made.add_machine("pr2", pr2)
    yield made
    kernel.stop()
