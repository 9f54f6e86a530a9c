"""One link or joint at a time: where a link can be pulled, which joints bring it to a pose, how a neck looks at a place."""

from __future__ import annotations

from math import atan2
from typing import TYPE_CHECKING

import numpy as np

from .inverse_kinematics import Reach
from .placements import Placement, placement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .descriptions import Description, Frame, Joint
    from .things import Machine

_solvers: dict[tuple[int, str, str], tuple[Description, Reach]] = {}


def solver_of(description: Description, base: str, tip: str) -> Reach:
    """The solver for a chain, made once. Errors: `DescriptionError`, when ``tip`` is not below ``base``."""
    key = (id(description), base, tip)
    found = _solvers.get(key)
    if found is None:
        found = _solvers[key] = (description, Reach(description, base, tip))
    return found[1]


def reach(machine: Machine, base: str, tip: str, goal: Placement) -> dict[str, float] | None:
    """Positions of the joints between two links that bring ``tip`` to a place in the world; ``None`` when there are none.

    Errors: `DescriptionError`.
    """
    solver = solver_of(machine.description, base, tip)
    wanted = machine.link(base).inverse() @ goal
    answer = solver.solve(wanted.position, wanted.rotation)
    return None if answer is None else dict(zip(solver.joints, map(float, answer), strict=True))


def pan_and_tilt(machine: Machine, pan: Joint, tilt: Joint, place: Sequence[float]) -> tuple[float, float]:
    """Positions of the two joints of a neck, with which the head looks at a place in the world."""
    target = placement(place)
    x, y, _ = ((machine.link(pan.parent) @ at(pan.frame)).inverse() @ target).position
    turn = atan2(y, x)
    ahead = machine.copy()
    if pan.name in machine.skeleton.joint_numbers:
        ahead.bend({pan.name: turn})
    x, _, z = ((ahead.link(tilt.parent) @ at(tilt.frame)).inverse() @ target).position
    return turn, atan2(-z, x)


def pull(machine: Machine, link: str, goal: Placement) -> None:
    """Bring a link as near to a place in the world as the joint above it allows, whatever its limits; the root takes all with it."""
    joint = machine.description.joint_above.get(link)
    world = machine.world
    if joint is None:
        world.put(machine.name, goal)
    elif joint.moves:
        local = (machine.link(joint.parent) @ at(joint.frame)).inverse() @ goal
        axis = np.array(joint.axis)
        if joint.kind == "prismatic":
            value = float(axis @ local.position)
        else:
            value = 2 * atan2(float(axis @ local.rotation[1:]), float(local.rotation[0]))
        world.bend(machine.name, {joint.name: value})


def at(frame: Frame) -> Placement:
    """The placement of a frame of a description."""
    return placement(frame.position, frame.rotation)
