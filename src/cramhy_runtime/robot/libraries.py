"""The libraries of CRAM in Lisp that the robot stands on, loaded into the current image when they are first wanted."""

from __future__ import annotations

from typing import Any

from cramhy_runtime.ground.packages import find_package
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.languages.commonlisp.python import python_face
from cramhy_runtime.languages.commonlisp.systems import loader, systems
from cramhy_runtime.session import boot

SYSTEMS = ("cram-mobile-pick-place-plans", "cram-knowrob-pick-place", "cram-pr2-projection", "cram-bullet-reasoning-utilities")
PLANS = """
(defpackage :cramhy-robot (:use :common-lisp))
(in-package :cramhy-robot)
(defun simulate (plan) (pr2-proj:with-simulated-robot (funcall plan)))
(defun simulated-p () (and cram-projection:*projection-environment* t))
(defun objects-held () (mapcar #'first (btr-belief::held-objects)))
(defun arm-that-holds (name) (second (assoc name (btr-belief::held-objects))))
"""
_loaded: list[str] = per_image([])
"""The systems that describe the robot of this image."""


def load(description: str | None = None) -> None:
    """Load the libraries, once in an image.

    description: the system that describes the robot; by default the PR2's. Errors: ImportError, when MuJoCo is missing; ValueError, when
    the image has another robot already.
    """
    from cramhy_runtime.robot_world import mujoco_parts  # noqa: F401  what is missing is told before Lisp is asked

    boot()
    if description is not None and description not in _loaded:
        if find_package("CRAM-PR2-PROJECTION") is not None and _loaded:
            raise ValueError(f"This image has a robot already; describe that of {description} in an image of its own: with Image(): ...")
        systems.load_system(description.replace("_", "-"))
        _loaded.append(description)
    if find_package("CRAMHY-ROBOT") is None:
        for system in SYSTEMS:
            systems.load_system(system)
        loader.load_text(PLANS, "<robot>")
        _loaded.append("cram-pr2-projection")


def lisp(package: str, name: str) -> Any:
    """What a Lisp package has under the Python name ``name``: a function, a class, the value of a variable."""
    load()
    found = find_package(package)
    assert found is not None, package
    return python_face.find(found, name)
