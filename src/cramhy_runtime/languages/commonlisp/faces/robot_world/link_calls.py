"""The functions of the Lisp package ROBOT-WORLD about single links and joints: pulling a link somewhere, reaching, looking."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.data import Cons, boolean, lisp_list, list_from
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.robot_world import reaching
from cramhy_runtime.robot_world.descriptions import DescriptionError
from cramhy_runtime.robot_world.placements import of_pose

if TYPE_CHECKING:
    from cramhy_runtime.robot_world.things import Machine
    from cramhy_runtime.transforms.poses import Pose
    from cramhy_runtime.transforms.vectors import Vector3

LISP_NAMES = """
pull-link pan-and-tilt reach-with joint-limits set-fixed
"""


def pull_link(machine: Machine, link: str, pose: Pose) -> bool | None:
    """Bring a link as near to a pose as the joint above it allows, its limits apart; the root takes the whole machine with it.

    Nil when there is no such link.
    """
    if str(link) not in machine.skeleton.links:
        return None
    reaching.pull(machine, str(link), of_pose(pose))
    return True


def pan_and_tilt(machine: Machine, pan_link: str, tilt_link: str, place: Vector3) -> Cons:
    """A list of the positions of the joints above two links of the neck, with which the head looks at a place in the world."""
    above = machine.description.joint_above
    for link in (pan_link, tilt_link):
        if str(link) not in above:
            return error("~S has no link ~A that a joint moves.", machine.name, link)
    found = reaching.pan_and_tilt(machine, above[str(pan_link)], above[str(tilt_link)], (float(place.x), float(place.y), float(place.z)))
    return lisp_list(*map(float, found))


def reach_with(machine: Machine, base: str, tip: str, pose: Pose) -> Cons | None:
    """A list of (joint . position) that brings the link ``tip`` to a pose in the world, moved by the joints behind the link ``base``.

    Nil when no posture does.
    """
    try:
        found = reaching.reach(machine, str(base), str(tip), of_pose(pose))
    except DescriptionError as problem:
        return error("~a", str(problem))
    return list_from(Cons(name, float(value)) for name, value in found.items()) if found else None


def joint_limits(machine: Machine, joint: str) -> Cons | None:
    """A list of the lower and the upper limit of a joint, each nil where there is none; nil when there is no such joint."""
    found = machine.description.joints.get(str(joint))
    if found is None:
        return None
    return lisp_list(*(float(limit) if abs(limit) < float("inf") else None for limit in (found.lower, found.upper)))


def set_fixed(machine: Machine, fixed: Any) -> bool | None:
    """Say whether a machine is furniture, which touches neither the floor nor other furniture."""
    machine.fixed = fixed is not None
    return boolean(machine.fixed)
