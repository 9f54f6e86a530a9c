"""Fixtures: the PR2 and the kitchen in a world; of the packages for mobile manipulation: forms in, printed values out, a robot of tin that obeys."""

from __future__ import annotations

from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import COMMON_LISP, ensure_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

KITCHEN_WORLD = """
(dolist (system '(:cram-pr2-description :cram-bullet-reasoning-utilities :cl-urdf)) (asdf:load-system system))
(setf cram-tf:*fixed-frame* "map")
(defparameter *pr2* 'cram-pr2-description:pr2)
(defparameter *world* (setf btr:*current-bullet-world* (robot-world:make-world)))
(btr:add-object *world* :static-plane :floor '((0 0 0) (0 0 0 1)) :normal '(0 0 1) :constant 0)
(btr:add-object *world* :urdf :kitchen '((0 0 0) (0 0 0 1)) :urdf (robot-world:description-text :kitchen) :collision-group :static-filter)
(btr:add-object *world* :urdf *pr2* '((0 0 0) (0 0 0 1)) :urdf (robot-world:description-text :pr2))
(prolog:prolog '(and (btr:bullet-world ?w)
                     (assert (btr:object ?w :mesh mug-1 ((-2 -0.9 0.86) (0 0 0 1)) :mesh :mug :mass 0.2 :color (1 0 0)))))
(btr:simulate *world* 100)
(defparameter *pristine* (btr:copy-world *world*))
(defparameter *meshes* (copy-tree btr:*mesh-files*))
(defun named (name) (btr:object *world* name))
(defun robot () (named *pr2*))
(defun mug () (named 'mug-1))
(defun z-of (name) (/ (fround (* 100 (cl-transforms:z (cl-transforms:origin (btr:pose (named name)))))) 100))
(defun all (goal name) (loop for answer in (cut:force-ll (prolog:prolog goal)) collect (cdr (assoc name answer))))
(defun proves (goal) (and (prolog:prolog goal) t))
(defun near (a b) (< (abs (- a b)) 0.01))
"""
AS_IT_WAS = """
(setf *world* (setf btr:*current-bullet-world* (btr:copy-world *pristine*)))
(setf cram-tf:*fixed-frame* "map")
(setf btr:*mesh-files* (copy-tree *meshes*))
"""

TIN_ROBOT = Path(__file__).parent / "tin_robot.lisp"


@pytest.fixture
def lisp(session):
    """A function: the printed values of the last form of a text, in a package of its own; a condition is ``CLASS: its text``. White space is one blank."""
    session.package = ensure_package("ROBOT-TESTS", use=[COMMON_LISP])

    def values(text):
        text = f'(handler-case (progn {text}) (serious-condition (c) (format nil "~A: ~A" (type-of c) c)))'
        return " ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text, "<test>"))

    return values


@pytest.fixture(scope="module")
def session_with_kitchen():
    """A session with the kitchen, the PR2 at its origin, and a mug on the table."""
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    made = Session(time="virtual", turtlesim=False)
    made.evaluate_text(KITCHEN_WORLD)
    yield made
    kernel.stop()


@pytest.fixture
def ask(session_with_kitchen):
    """A function: the printed value of the last form of a text, or the text of its error.

    Each test begins with a copy of the same world, and with the same luck: costmaps draw places.
    """
    session_with_kitchen.evaluate_text(AS_IT_WAS)
    session_with_kitchen.evaluate_text("(setf *random-state* (sb-ext:seed-random-state 0))")

    def asked(form):
        try:
            return prin1_to_string(session_with_kitchen.evaluate_text(form)[-1])
        except Condition as problem:
            return problem.report()

    return asked


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
