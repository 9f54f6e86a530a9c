"""What the robot does: each function performs an action designator, in the plan that calls it or in one of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from cramhy_runtime.cpl.failures.python_exceptions import for_python
from cramhy_runtime.designators import Location, Object
from cramhy_runtime.ground.data import list_from
from cramhy_runtime.ground.packages import keyword, sym
from cramhy_runtime.process_modules import perform

from .designators import Detecting, Going, Looking, MovingTorso, PickingUp, Placing
from .libraries import lisp
from .poses import Place, pose_of

P = ParamSpec("P")
T = TypeVar("T")


@for_python
def run(plan: Callable[[], T]) -> T:
    """Run ``plan()`` as a plan of the robot in the current world, and return its result. Its failure is raised here.

    Inside a plan of the robot it is only called. It may stand as a decorator over the plan: the name is then the result.
    """
    if lisp("CRAMHY-ROBOT", "simulated_p")():
        return plan()
    result: T = lisp("CRAMHY-ROBOT", "simulate")(plan)
    return result


def _acting(function: Callable[P, T]) -> Callable[P, T]:
    """``function``, a plan of its own when no plan of the robot calls it."""

    @wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> T:
        return run(lambda: function(*arguments, **keywords))

    return call


def _name(word: str | None) -> Any:
    return None if word is None else keyword(word.upper().replace("_", "-"))


def _detected(thing: Object) -> Object:
    if not isinstance(thing, Object):
        raise TypeError(f"An object that was detected is expected, as robot.detect returns it, not {thing!r}.")
    return thing


@_acting
def go(place: Place) -> None:
    """Drive to a pose on the floor. Failures: `NavigationPoseUnreachable`, when the robot would touch something there."""
    perform(Going(target=Location(pose=pose_of(place))))


@_acting
def look(place: Place) -> None:
    """Look at a place. Failures: `PtuGoalNotReached`, when the neck does not turn so far."""
    perform(Looking(target=Location(pose=pose_of(place))))


@_acting
def detect(thing: str | Object) -> Any:
    """Look for an object of a type, or one that a designator describes; returns its designator, with name, type and pose.

    Failures: `PerceptionObjectNotFound`.
    """
    wanted = Object(type=_name(thing)) if isinstance(thing, str) else thing
    return perform(Detecting(object=wanted))


@_acting
def pick_up(thing: Object, arm: str | None = None, grasp: str | None = None, park: bool = True) -> Any:  # noqa: A002
    """Take an object that was detected. Returns its designator as it is known now.

    arm: ``"left"`` or ``"right"``; grasp: ``"left-side"``, ``"top"`` and so on; by default rules choose. park: bring the arms afterwards to
    where they can carry something. Failures: `ManipulationPoseUnreachable`, `GripperClosedCompletely`.
    """
    perform(PickingUp(object=_detected(thing), arm=_name(arm), grasp=_name(grasp)))
    if park:
        _park()
    return lisp("CRAM-DESIGNATORS", "current_desig")(thing)


@_acting
def place(thing: Object, target: Place, arm: str | None = None, park: bool = True) -> None:
    """Put down an object that is held, so that it stands at ``target``. Failures: `ManipulationPoseUnreachable`."""
    perform(Placing(object=_detected(thing), target=Location(pose=pose_of(target)), arm=_name(arm)))
    if park:
        _park()


@_acting
def park(arm: str | None = None) -> None:
    """Bring an arm, by default all, to where it is out of the way and can carry something."""
    _park(arm)


def _park(arm: str | None = None) -> None:
    arguments = () if arm is None else (sym(":ARM"), list_from([_name(arm)]))
    lisp("CRAM-MOBILE-PICK-PLACE-PLANS", "park_arms")(*arguments)


@_acting
def lift(height: float) -> None:
    """Raise or lower the torso. Failures: `TorsoGoalNotReached`, beyond its limits; then it is at the limit."""
    perform(MovingTorso(joint_angle=height))
