"""The libraries of CRAM in Lisp that the robot stands on, loaded into the current image when a world of the robot begins.

An image has one robot: the first whose description was loaded, by `load` or by Lisp.
"""

from __future__ import annotations

import os
from typing import Any

from cramhy_runtime.lisp_core.packages import find_package, named_package, near_names
from cramhy_runtime.languages.commonlisp.python import python_face
from cramhy_runtime.languages.commonlisp.systems import loader, system_definitions, systems
from cramhy_runtime.prolog import V, findall, names
from cramhy_runtime.ros import search_folders
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


def load(description: str | None = None) -> None:
    """Load the libraries, once in an image.

    description: the system that describes the robot; by default the one that the image has, else the PR2. Errors: ImportError, when MuJoCo
    is missing; ValueError, when there is no such system, when it describes no robot, or when the image has another robot already.
    """
    from cramhy_runtime.robot_world import mujoco_parts  # noqa: F401  what is missing is told before Lisp is asked

    boot()
    if description is not None:
        _load_description(description)
    if find_package("CRAMHY-ROBOT") is None:
        for system in SYSTEMS:
            systems.load_system(system)
        loader.load_text(PLANS, "<robot>")


def robots() -> list[str]:
    """The names of the robots that are described in this image, in Lisp's spelling; the first one is in its worlds."""
    if find_package("CRAM-ROBOT-INTERFACES") is None:
        return []
    return [robot.name for robot in findall(V.robot, names("CRAM-ROBOT-INTERFACES").robot(V.robot))]


def _load_description(description: str) -> None:
    if not isinstance(description, str):
        raise TypeError(f'A robot is named by the system that describes it, such as "cram_pr2_description", not {description!r}.')
    system = description.lower().replace("_", "-")
    if system in systems.loaded and robots():
        return
    if not (systems.is_provided(system) or system in system_definitions.systems or systems.find_asd(system)):
        raise ValueError(_unknown(description, system))
    if robots():
        raise ValueError(
            f"This image has the robot {robots()[0]} already; describe that of {description} in an image of its own: with Image(): ..."
        )
    systems.load_system(system)
    if not robots():
        raise ValueError(
            f"The system {system} ({_place(system)}) was loaded, and it describes no robot: it has no fact (robot NAME).\n{_known_robots()}"
        )


def _unknown(description: str, system: str) -> str:
    folders = ", ".join(map(str, [*systems.central_registry(), *search_folders.search_folders()]))
    known = _descriptions()
    near = [each for each in known if system in each] or near_names(system, known, 1)
    hint = f" Did you mean {' or '.join(each.replace('-', '_') for each in near)}?" if near else ""
    return (
        f"There is no description of a robot called {description!r}: no file {system}.asd is below {folders}.{hint}\n"
        f"{_known_robots()} ROS_PACKAGE_PATH names further folders in which descriptions are."
    )


def _descriptions() -> list[str]:
    return sorted(each for each in systems.known_systems() if each.endswith("-description"))


def _known_robots() -> str:
    return f"Descriptions that were found: {', '.join(f'{each} ({_place(each)})' for each in _descriptions())}."


def _place(system: str) -> str:
    path = systems.find_asd(system)
    return "part of cramhy" if path is None or systems.LIBRARIES in path.parents else os.fspath(path.parent)


def lisp(package: str, name: str) -> Any:
    """What a Lisp package has under the Python name ``name``: a function, a class, the value of a variable.

    Errors: RuntimeError, before there is a robot: no question chooses one.
    """
    boot()
    if find_package("CRAMHY-ROBOT") is None:
        if not robots():
            raise RuntimeError(
                "There is no robot yet. Begin with robot.world(), which has the PR2, or name another description of a robot."
            )
        load()
    found = find_package(package)
    assert found is not None, package
    return python_face.find(found, name)


def failure_class(name: str) -> Any:
    """The class of CRAM's failures that has this name in Python; no robot is chosen by that."""
    boot()
    return python_face.find(named_package("CRAM-COMMON-FAILURES"), name)
