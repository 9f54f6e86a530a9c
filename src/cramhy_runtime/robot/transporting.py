"""Fetching and delivering with what the robot knows: places to stand at, ways to hold, and what to try when one of them fails."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, cos, degrees, pi, sin
from typing import Any

from cramhy_runtime.designators import Object
from cramhy_runtime.prolog import V, findall, names
from cramhy_runtime.robot_world.placements import of_pose
from cramhy_runtime.tf.stamped import PoseStamped

from .acting import _acting, detect, go, look, park, pick_up, place
from .failures import failures
from .libraries import lisp
from .poses import Place, at, pose_of
from .worlds import World, text

DISTANCES = (0.65, 0.55, 0.75)
"""How far from a thing the robot stands to reach it, in metres, the best first."""
DIRECTIONS = 16
SUITABLE = {"left": ("left-side", "back", "top"), "right": ("right-side", "back", "top")}
"""The sides of a thing, as the robot sees it, from which an arm takes it with ease."""


def standing_places(target: Place) -> Iterator[PoseStamped]:
    """Poses from which the robot may reach ``target``, turned towards it, at which it touches nothing. The nearest come first.

    They lie on circles around the target; those straight ahead, to its left, right and behind it go before those between.
    """
    pose, world = pose_of(target), World()
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
    """Pairs of an arm and a grasp that suit an object that was detected, the arm on its side first."""
    robot, objects = names("CRAM-ROBOT-INTERFACES"), names("CRAM-OBJECT-INTERFACES")
    arms = [text(arm) for arm in findall(V.arm, robot.robot(V.robot), robot.arm(V.robot, V.arm))]
    grasps = [text(grasp) for grasp in findall(V.grasp, objects.object_type_grasp(thing["type"], V.grasp))]
    left_first = lisp("CRAM-OBJECT-INTERFACES", "get_object_pose")(thing).origin.y > 0
    arms.sort(key=lambda arm: (arm == "left") != left_first)
    return [(arm, grasp) for arm in arms for grasp in grasps if grasp in SUITABLE.get(arm, grasps)]


@_acting
def fetch(kind: str, near: Place) -> Any:
    """Find an object of a type near a place, and take it. Returns its designator.

    From each of the `standing_places` each of the `ways_to_hold` is tried. Failures: `ObjectNowhereToBeFound`, when it was seen from
    nowhere, `ObjectUnfetchable`, when it was seen and could not be taken.
    """
    seen, stands, holds = None, 0, 0
    for stand in standing_places(near):
        stands += 1
        try:
            go(stand)
            look(near)
            seen = detect(kind)
        except (failures.NavigationLowLevelFailure, failures.PtuLowLevelFailure, failures.PerceptionLowLevelFailure):
            continue
        for arm, grasp in ways_to_hold(seen):
            holds += 1
            try:
                return pick_up(seen, arm, grasp)
            except failures.ManipulationLowLevelFailure:
                park()
    if seen is None:
        raise failures.ObjectNowhereToBeFound(description=f"No {kind} was seen from {stands} places near {_told(near)}.")
    raise failures.ObjectUnfetchable(object=seen, description=f"The {kind} could not be taken from {stands} places in {holds} ways.")


@_acting
def deliver(thing: Object, target: Place) -> None:
    """Put an object that is held down at ``target``, from the first of the `standing_places` from which it works.

    Failures: `ObjectUndeliverable`; the robot still holds it.
    """
    stands = 0
    for stand in standing_places(target):
        stands += 1
        try:
            go(stand)
            place(thing, target)
            World().settle()
            return
        except (failures.NavigationLowLevelFailure, failures.ManipulationLowLevelFailure):
            park()
    raise failures.ObjectUndeliverable(object=thing, description=f"Nothing could be put at {_told(target)} from {stands} places.")


@_acting
def transport(kind: str, near: Place, target: Place) -> Any:
    """Fetch an object of a type from near a place, and deliver it to ``target``. Returns its designator; failures as those two."""
    thing = fetch(kind, near)
    deliver(thing, target)
    return thing


def _told(spot: Place) -> str:
    origin = pose_of(spot).origin
    return f"({origin.x:g}, {origin.y:g}, {origin.z:g})"
