"""Fetching and delivering with what the robot knows: places to stand at, ways to hold, and what to try when one of them fails."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, cos, degrees, dist, pi, sin
from typing import Any

from cramhy_runtime.designators import Object
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.prolog import V, findall, names
from cramhy_runtime.robot_world.placements import of_pose
from cramhy_runtime.tf.stamped import PoseStamped
from cramhy_runtime.transforms.poses import Pose

from .acting import _acting, _park, detect, go, look, pick_up, place
from .failures import failures
from .libraries import lisp
from .outcomes import astray, in_hand, in_room, name_of, told
from .poses import Place, at
from .worlds import World, text

DISTANCES = (0.65, 0.55, 0.75)
"""How far from a thing the robot stands to reach it, in metres, the best first."""
DIRECTIONS = 16
AGAIN = 2
"""How often an object that is astray is fetched again."""
PUSHED = 0.4
"""How far from its target an object is worth fetching again, metres; one that fell to the floor is not."""
SUITABLE = {"left": ("left-side", "back", "top"), "right": ("right-side", "back", "top")}
"""The sides of a thing, as the robot sees it, from which an arm takes it with ease."""


def standing_places(target: Place) -> Iterator[PoseStamped]:
    """Poses from which the robot may reach ``target``, turned towards it, at which it touches nothing. The nearest come first.

    They lie on circles around the target; those straight ahead, to its left, right and behind it go before those between.
    """
    pose, world = in_room(target), World()
    x, y, _ = world.place()
    tx, ty = pose.origin.x, pose.origin.y
    here = atan2(y - ty, x - tx)

    def detour(number: int) -> tuple[bool, float]:
        turn = (2 * pi * number / DIRECTIONS - here + pi) % (2 * pi) - pi
        return number % (DIRECTIONS // 4) != 0, round(abs(turn), 6)

    directions = [2 * pi * number / DIRECTIONS for number in sorted(range(DIRECTIONS), key=detour)]
    for distance in DISTANCES:
        for direction in directions:
            stand = at(tx + distance * cos(direction), ty + distance * sin(direction), yaw=degrees(direction) + 180.0)
            if _free(world, stand):
                yield stand


def _free(world: World, stand: PoseStamped) -> bool:
    """Whether the robot touches nothing there but what it holds. It is put there and back, and nobody sees it."""
    core, robot = world.core, world.robot
    before = robot.placement
    with core.trial():
        core.put(robot.name, of_pose(stand))
        try:
            return all(thing.name in robot.holds for thing in core.touching(robot.name))
        finally:
            core.put(robot.name, before)


def ways_to_hold(thing: Object) -> list[tuple[str, str]]:
    """Pairs of an arm that is free and a grasp that suit an object that was detected, the arm on its side first."""
    robot, objects = names("CRAM-ROBOT-INTERFACES"), names("CRAM-OBJECT-INTERFACES")
    busy = World().held().values()
    arms = [arm for arm in map(text, findall(V.arm, robot.robot(V.robot), robot.arm(V.robot, V.arm))) if arm not in busy]
    grasps = [text(grasp) for grasp in findall(V.grasp, objects.object_type_grasp(thing["type"], V.grasp))]
    left_first = lisp("CRAM-OBJECT-INTERFACES", "get_object_pose")(thing).origin.y > 0
    arms.sort(key=lambda arm: (arm == "left") != left_first)
    return [(arm, grasp) for arm in arms for grasp in grasps if grasp in SUITABLE.get(arm, grasps)]


def _line(failure: BaseException) -> str:
    return " ".join(str(failure).split())


@_acting
def fetch(kind: str, near: Place) -> Any:
    """Find the object of a type that is nearest to a place, and take it. Returns its designator; the robot holds it then.

    From each of the `standing_places` each of the `ways_to_hold` is tried. Failures: `ObjectNowhereToBeFound`, when it was seen from
    nowhere, `ObjectUnfetchable`, when it was seen and could not be taken.
    """
    near = in_room(near)
    seen, stands, holds, last = None, 0, 0, ""
    for stand in standing_places(near):
        stands += 1
        thing = _seen_from(stand, kind, near)
        tried: set[tuple[str, str]] = set()
        while thing is not None:
            seen = thing
            way = next((way for way in ways_to_hold(seen) if way not in tried), None)
            if way is None:
                break
            tried.add(way)
            holds += 1
            try:
                return pick_up(seen, *way)
            except failures.ManipulationLowLevelFailure as failure:
                last = f" At last: {_line(failure)}"
                if in_hand(seen):
                    return lisp("CRAM-DESIGNATORS", "current_desig")(seen)
                _park()
                thing = _seen_from(None, kind, near)  # the hand may have moved it
    if seen is None:
        raise failures.ObjectNowhereToBeFound(description=f"No {kind} was seen from {stands} places near {told(near)}.")
    how = f"in {holds} ways.{last}" if holds else "since no grasp of it is known for an arm that is free."
    raise failures.ObjectUnfetchable(object=seen, description=f"The {kind} could not be taken from {stands} places {how}")


def _seen_from(stand: PoseStamped | None, kind: str, near: PoseStamped) -> Any:
    """The object of that type that is nearest to a place, as it is seen from a pose, or from here; ``None`` when it is not seen."""
    wanted = Object(type=keyword(kind.upper().replace("_", "-")))
    try:
        if stand is not None:
            go(stand)
        look(near)
        visible = list(lisp("CRAM-PR2-PROJECTION", "visible_items")(wanted) or ())
        visible.sort(key=lambda item: _distance(item.placement.pose(), near))
        return detect(Object(type=wanted["type"], name=visible[0].name) if visible else wanted)
    except (failures.NavigationLowLevelFailure, failures.PtuLowLevelFailure, failures.PerceptionLowLevelFailure):
        return None


def _distance(one: Pose, other: Pose) -> float:
    return dist(*((pose.origin.x, pose.origin.y, pose.origin.z) for pose in (one, other)))


@_acting
def deliver(thing: Object, target: Place) -> None:
    """Put an object that is held down at ``target``, from the first of the `standing_places` from which it works.

    The robot looks whether it stands there, as `place` does. Failures: `ObjectUndeliverable`; its text says whether the robot still holds
    the object, and else where it lies.
    """
    name, target = name_of(thing), in_room(target)
    stands, last = 0, None
    if not in_hand(thing):
        raise failures.ObjectUndeliverable(object=thing, description=f"{name} cannot be delivered: the robot does not hold it.")
    for stand in standing_places(target):
        stands += 1
        try:
            go(stand)
            place(thing, target)
            return
        except (failures.NavigationLowLevelFailure, failures.ManipulationLowLevelFailure) as failure:
            last = failure
            _park()
        if not in_hand(thing):
            raise failures.ObjectUndeliverable(object=thing, description=_lost(thing, target, last))
    why = f" At last: {_line(last)}" if last else ""
    description = f"Nothing could be put at {told(target)} from {stands} places; the robot still holds {name}.{why}"
    raise failures.ObjectUndeliverable(object=thing, description=description)


def _lost(thing: Object, target: PoseStamped, failure: Any) -> str:
    """What has become of an object that was to be put at ``target``, and that no hand holds after a failure."""
    if isinstance(failure, failures.ManipulationGoalNotReached):  # `place` has looked
        return _line(failure)
    where = astray(thing, target) or "stands there all the same"
    return f"{name_of(thing)} was to stand at {told(target)}. It slipped out of the hand, and it {where}. {_line(failure)}"


@_acting
def transport(kind: str, near: Place, target: Place) -> Any:
    """Fetch the object of a type that is nearest to a place, and deliver it to ``target``. Returns its designator; it stands there then.

    An object that fell over or was pushed, and lies within `PUSHED` of its target, is fetched again, `AGAIN` times.

    Failures: `ObjectNowhereToBeFound`, `ObjectUnfetchable`, `ObjectUndeliverable`.
    """
    near, target = in_room(near), in_room(target)
    thing = fetch(kind, near)
    for left in reversed(range(AGAIN + 1)):
        try:
            deliver(thing, target)
            return lisp("CRAM-DESIGNATORS", "current_desig")(thing)
        except failures.ObjectUndeliverable as failure:
            if in_hand(thing) or not left or _distance(World().pose(name_of(thing)), target) > PUSHED:
                raise
            first = failure
        try:
            thing = fetch(kind, World().pose(name_of(thing)))
        except (failures.ObjectNowhereToBeFound, failures.ObjectUnfetchable) as failure:
            raise failures.ObjectUndeliverable(
                object=thing, description=f"{first} It could not be fetched again: {_line(failure)}"
            ) from failure
