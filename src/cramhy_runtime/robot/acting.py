"""What the robot does: each function performs an action designator, in the plan that calls it or in one of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from cramhy_runtime.cpl.failures.python_exceptions import for_python
from cramhy_runtime.designators import Location, Object
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.packages import keyword, sym
from cramhy_runtime.process_modules import ReferenceFailure, perform

from .designators import Detecting, Going, Looking, MovingTorso, PickingUp, Placing
from .failures import failures
from .libraries import lisp
from .outcomes import astray, in_hand, in_room, name_of, not_parked, told
from .poses import Place, pose_of
from .worlds import text

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
    """Take an object that was detected. Returns its designator as it is known now; the robot holds it then.

    arm: ``"left"`` or ``"right"``; grasp: ``"left-side"``, ``"top"`` and so on; by default rules choose. park: bring the arms afterwards to
    where they can carry something. Failures: `ManipulationPoseUnreachable`, also when no grasp of such a thing is known;
    `GripperClosedCompletely`, when the fingers missed it, or it slipped out of the hand.
    """
    action = PickingUp(object=_detected(thing), arm=_name(arm), grasp=_name(grasp))
    try:
        perform(action)
    except ReferenceFailure as problem:
        ways = "".join([f" with the {arm} arm" if arm else "", f" by the grasp {grasp}" if grasp else ""])
        description = f"No way to take the {text(thing['type'])}{ways} is known."
        raise failures.ManipulationPoseUnreachable(description=description) from problem
    if park:
        _park()
    if not in_hand(thing):
        raise failures.GripperClosedCompletely(description=f"{name_of(thing)} slipped out of the hand.")
    return lisp("CRAM-DESIGNATORS", "current_desig")(thing)


@_acting
def place(thing: Object, target: Place, arm: str | None = None, park: bool = True) -> None:
    """Put down an object that is held, so that it stands at ``target``, and look whether it does when the world has come to rest.

    How near it must be: `outcomes.BESIDE`, 5 cm, and so on. Failures: `ManipulationPoseUnreachable`, also when the robot does not hold it;
    `ManipulationGoalNotReached`, when it was put down and is elsewhere now, or has fallen over.
    """
    pose = in_room(target)
    if not in_hand(_detected(thing)):
        description = f"{name_of(thing)} cannot be put down: the robot does not hold it."
        raise failures.ManipulationPoseUnreachable(description=description)
    try:
        perform(Placing(object=thing, target=Location(pose=pose), arm=_name(arm)))
    except ReferenceFailure as problem:
        description = f"No way to put {name_of(thing)} at {told(pose)}{f' with the {arm} arm' if arm else ''} is known."
        raise failures.ManipulationPoseUnreachable(description=description) from problem
    if park:
        _park()
    if elsewhere := astray(thing, pose):
        description = f"{name_of(thing)} was to stand at {told(pose)}, and it {elsewhere}."
        raise failures.ManipulationGoalNotReached(description=description)


@_acting
def park(arm: str | None = None) -> None:
    """Bring an arm, by default all, to where it is out of the way and can carry something.

    Failures: `ManipulationGoalNotReached`, when an arm is elsewhere then.
    """
    _park(arm)
    if unparked := not_parked(None if arm is None else _name(arm)):
        raise failures.ManipulationGoalNotReached(description=unparked)


def _park(arm: str | None = None) -> None:
    """Park without looking: in the middle of a plan an arm that is not quite there does no harm."""
    arguments = () if arm is None else (sym(":ARM"), list_from([_name(arm)]))
    lisp("CRAM-MOBILE-PICK-PLACE-PLANS", "park_arms")(*arguments)


@_acting
def lift(height: float) -> None:
    """Raise or lower the torso. Failures: `TorsoGoalNotReached`, beyond its limits; then it is at the limit."""
    perform(MovingTorso(joint_angle=height))
