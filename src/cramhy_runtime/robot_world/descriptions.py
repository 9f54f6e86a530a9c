"""Descriptions of what has links and joints: robots, and furniture with doors and drawers.

A `Description` is the tree that a URDF file tells of (``urdf.py``): links with the shapes that may be hit, joints that move one link
against another. Lengths are metres, angles radians, quaternions (w, x, y, z) as MuJoCo has them; a place is given in the frame of the link
around it.

Law: a description is a tree with one root; each joint has the limits of the file, and ``inf`` where there are none.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import cos, hypot, inf, sin
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from .mesh_files import Mesh

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
Kind = Literal["fixed", "revolute", "continuous", "prismatic"]

UNTURNED: Four = (1.0, 0.0, 0.0, 0.0)


class DescriptionError(ValueError):
    """A description that is no tree, or a file that is none. ``file``, ``line`` and ``element`` tell where, as far as they are known."""

    def __init__(self, reason: str, file: str = "", line: int = 0, element: str = "") -> None:
        where = f"{file or 'the description'}{f', line {line}' if line else ''}{f', in <{element}>' if element else ''}"
        super().__init__(f"{where}: {reason}")
        self.reason, self.file, self.line, self.element = reason, file, line, element


@dataclass(frozen=True, slots=True)
class Frame:
    """Where something is in the frame around it, and how it is turned."""

    position: Three = (0.0, 0.0, 0.0)
    rotation: Four = UNTURNED


@dataclass(frozen=True, slots=True)
class Shape:
    """What a link, or an object, is made of.

    kind: ``"box"``, ``"cylinder"`` (along z), ``"sphere"``, ``"mesh"`` or ``"plane"`` (across z, without end). size: of a box its three
    lengths, of a cylinder radius and length, of a sphere its radius, of a mesh its scale along x, y and z, of a plane nothing. mesh: the
    file or ``package://`` address of a mesh. body: the mesh itself, where it is known.
    """

    kind: Literal["box", "cylinder", "sphere", "mesh", "plane"]
    size: tuple[float, ...]
    frame: Frame = Frame()
    mesh: str = ""
    body: Mesh | None = None


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid part, with the shapes that count in collisions and for the eye. mass: kilograms, 0 where the file tells none."""

    name: str
    shapes: tuple[Shape, ...] = ()
    mass: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """How ``child`` moves against ``parent``: ``frame`` is where the child is when the joint is at 0, ``axis`` is in the child's frame."""

    name: str
    kind: Kind
    parent: str
    child: str
    frame: Frame = Frame()
    axis: Three = (1.0, 0.0, 0.0)
    lower: float = -inf
    upper: float = inf
    velocity: float = inf
    effort: float = inf
    mimic: str = ""

    @property
    def moves(self) -> bool:
        return self.kind != "fixed"

    def clamped(self, value: float) -> float:
        """``value``, as near as the limits allow."""
        return min(max(value, self.lower), self.upper)

    def placed(self, value: float = 0.0) -> Frame:
        """Where the child is in the frame of the parent when the joint is at ``value``, in rad or m."""
        position, rotation = self.frame.position, self.frame.rotation
        length = hypot(*self.axis)
        if not self.moves or not value or not length:
            return self.frame
        x, y, z = (part / length for part in self.axis)
        if self.kind == "prismatic":
            moved = multiplied(multiplied(rotation, (0.0, x * value, y * value, z * value)), inverse(rotation))[1:]
            return Frame(tuple(here + by for here, by in zip(position, moved, strict=True)), rotation)  # type: ignore[arg-type]  # three
        half = sin(value / 2)
        return Frame(position, multiplied(rotation, (cos(value / 2), x * half, y * half, z * half)))


@dataclass(frozen=True, eq=False)
class Description:
    """Links and joints, as a tree.

    name: what the file calls the robot. links, joints: by their names, in the order of the file. Errors: `DescriptionError`, when they are
    no tree.
    """

    name: str
    links: dict[str, Link]
    joints: dict[str, Joint]
    file: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        above: dict[str, Joint] = {}
        for joint in self.joints.values():
            for link in (joint.parent, joint.child):
                if link not in self.links:
                    raise DescriptionError(f"the joint {joint.name} names the link {link}, and there is none of that name.", self.file)
            if joint.child in above:
                raise DescriptionError(f"{above[joint.child].name} and {joint.name} both lead to the link {joint.child}.", self.file)
            above[joint.child] = joint
        roots = [name for name in self.links if name not in above]
        if len(roots) != 1:
            raise DescriptionError(
                f"it has {len(roots)} roots ({', '.join(roots[:5])}); a robot has one link that no joint leads to."
                if roots
                else "it has no root.",
                self.file,
            )
        if len(self.order) != len(self.links):
            lost = next(name for name in self.links if name not in self.order)
            raise DescriptionError(f"the link {lost} hangs in a circle of joints.", self.file)

    @cached_property
    def joint_above(self) -> dict[str, Joint]:
        """The joint that leads to each link but the root."""
        return {joint.child: joint for joint in self.joints.values()}

    @cached_property
    def joints_below(self) -> dict[str, list[Joint]]:
        """The joints that begin at each link."""
        found: dict[str, list[Joint]] = {name: [] for name in self.links}
        for joint in self.joints.values():
            found[joint.parent].append(joint)
        return found

    @cached_property
    def root(self) -> str:
        """The name of the link that no joint leads to."""
        return next(name for name in self.links if name not in self.joint_above)

    @cached_property
    def order(self) -> dict[str, int]:
        """The links from the root on, each behind its parent, with their numbers."""
        found, waiting = {}, [self.root]
        while waiting:
            link = waiting.pop()
            found[link] = len(found)
            waiting += [joint.child for joint in reversed(self.joints_below[link])]
        return found

    @cached_property
    def moving_joints(self) -> dict[str, Joint]:
        """The joints that have a position, in the order of the file."""
        return {name: joint for name, joint in self.joints.items() if joint.moves}

    def chain(self, root: str, tip: str) -> list[Joint]:
        """The joints from the link ``root`` down to the link ``tip``. Errors: `DescriptionError`, when ``tip`` is not below ``root``."""
        joints, link = [], tip
        while link != root:
            joint = self.joint_above.get(link)
            if joint is None:
                raise DescriptionError(f"the link {tip} does not hang below {root}.", self.file)
            joints.append(joint)
            link = joint.parent
        return joints[::-1]

    def below(self, link: str) -> list[str]:
        """``link`` and all links that move with it."""
        found, waiting = [], [link]
        while waiting:
            name = waiting.pop()
            found.append(name)
            waiting += [joint.child for joint in reversed(self.joints_below[name])]
        return found


def multiplied(first: Four, second: Four) -> Four:
    """The product of two quaternions (w, x, y, z)."""
    a, b, c, d = first
    e, f, g, h = second
    return (a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e)


def inverse(rotation: Four) -> Four:
    """The quaternion (w, x, y, z) of unit length that turns back."""
    w, x, y, z = rotation
    return (w, -x, -y, -z)


def turned(roll: float, pitch: float, yaw: float) -> Four:
    """The quaternion of URDF's ``rpy``: turns about the fixed axes x, y and z, in this order."""
    cr, sr, cp, sp, cy, sy = cos(roll / 2), sin(roll / 2), cos(pitch / 2), sin(pitch / 2), cos(yaw / 2), sin(yaw / 2)
    return (cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy)
