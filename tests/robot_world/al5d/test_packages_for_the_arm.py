"""Packages with the habits of the course's run to their end on the arm: ours, and the course's own where a checkout is given.

The course's repositories are not ours to ship. ``CRAMHY_FOREIGN`` names the folder in which they are cloned.
"""

from __future__ import annotations

import os
import re
from math import pi
from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.session.session import Session

pytestmark = pytest.mark.soak

HERE = Path(__file__).parent
FOREIGN = Path(os.environ.get("CRAMHY_FOREIGN", HERE / "nowhere"))
BRICK = """(roslisp:call-service "/lynxmotion_al5d/spawn_brick" 'lynxmotion_al5d_description-srv:SpawnBrick :color "red"
             :pose (roslisp:make-msg "lynxmotion_al5d_description/Pose" (x position) {} (y position) {} (yaw orientation) {}))"""
WATCHED = """(defvar cl-user::*brick* nil)
(roslisp:subscribe "/lynxmotion_al5d/brick1/pose" "lynxmotion_al5d_description/Pose" (lambda (message) (setf cl-user::*brick* message)))"""
PLACE = """(progn (sleep 0.5) (roslisp:with-fields ((x (x position)) (y (y position)) (yaw (yaw orientation))) cl-user::*brick*
             (list (round x 0.001) (round y 0.001) (round yaw (/ pi 180)))))"""


@pytest.fixture
def session(monkeypatch):
    """A function that begins a session which finds the packages of a folder: it gives the value of the last form of a text, printed."""
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

    def begin(*folders):
        monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join(map(str, folders)))
        made = Session(time="virtual")
        return lambda text: prin1_to_string(made.evaluate_text(text)[0])

    yield begin
    kernel.stop()


def near(place, x, y, degrees):
    """Whether a place, printed, is so many millimetres and degrees, either way round, within what the exercise allows."""
    at = [int(number) for number in re.findall(r"-?\d+", place)]
    turn = abs((at[2] - degrees + 90) % 180 - 90)
    return abs(at[0] - x) <= 5 and abs(at[1] - y) <= 5 and turn <= 6


def test_a_package_with_the_habits_of_the_course_runs_to_its_end(session):
    ask = session(HERE / "packages")
    ask('(ros-load:load-system "cram_brick_exercise" :cram-brick-exercise) (in-package :bex) (roslisp-utilities:startup-ros)')
    assert ask("(list (num-subscribers *pub*) (progn (sleep 1.1) (length (msg-slot-value (value *image*) :data))))") == "(1 921600)"
    ask("(perform-with-arm (desig:an action (type touring)))")
    assert ask('(round (joint "Joint1") 0.001)') == str(round(1000 * 0.5071))
    ask(f"{BRICK.format(0, 0.15, '(/ pi 4)')} {WATCHED}")
    ask("""(defvar start-pose (make-pose (make-3d-vector 0 0.15 0) (euler->quaternion :az (/ pi 4))))
           (defvar end-pose (make-pose (make-3d-vector 0.06 0.18 0) (euler->quaternion :az (* 3 (/ pi 4)))))
           (perform-with-arm (desig:an action (type carrying) (from start-pose) (to end-pose)))""")
    assert near(ask(PLACE), 60, 180, 135)


def readme(package):
    """The forms that the README of a package lets its readers type."""
    text = (package / "README.md").read_text(encoding="utf-8")
    (forms,) = re.findall(r"^```lisp\n(.*?)^```", text, re.M | re.S)
    return forms


TUTORIALS = FOREIGN / "coro_examples" / "module11"


@pytest.mark.skipif(not TUTORIALS.is_dir(), reason="CRAMHY_FOREIGN names no folder with coro_examples")
def test_the_readme_of_cram_lynxmotion_al5d_tutorials_typed_to_its_end(session):
    ask = session(TUTORIALS)
    before, after = readme(TUTORIALS / "cram_lynxmotion_al5d_tutorials").split("(defparameter *pick-and-place")
    ask(before)
    ask(f"{BRICK.format(0, 0.15, pi / 4)} {WATCHED}")
    ask("(defparameter *pick-and-place" + after)
    assert near(ask(PLACE), 60, 180, 135)
