"""URDF, the XML in which ROS describes robots: reading it, and writing it.

Of a link the collision shapes are read (its visual ones where it has no others) and its mass, of a joint all that moves it. Other elements
(transmissions, sensors, Gazebo's) do not matter here and are passed over. Source: https://wiki.ros.org/urdf/XML.

Law: whatever the text is, it gives a `Description`, or a `DescriptionError` with file, line and element. A description that was written is
read as it was.
"""

from __future__ import annotations

from math import asin, atan2, copysign, inf, isfinite, pi
from pathlib import Path
from xml.sax.saxutils import quoteattr

from .descriptions import UNTURNED, Description, DescriptionError, Four, Frame, Joint, Link, Shape, Three, turned
from .xml_elements import Element, parsed, read_bytes

_KINDS = {"fixed", "revolute", "continuous", "prismatic"}


def read_file(path: str | Path) -> Description:
    """The description in a URDF file. Errors: `DescriptionError`; OSError, when it cannot be read."""
    return read_text(read_bytes(path), str(path))


def read_text(text: str | bytes, file: str = "") -> Description:
    """The description in the text of a URDF file; ``file`` is its name in errors. Errors: `DescriptionError`."""
    return Reading(file).description(parsed(text, file))


class Reading:
    """Reads the elements of one file."""

    def __init__(self, file: str) -> None:
        self.file = file

    def wrong(self, element: Element, reason: str) -> DescriptionError:
        return DescriptionError(reason, self.file, element.line, element.name)

    def description(self, root: Element) -> Description:
        if root.name != "robot":
            macros = "A file with xacro's macros has a name that ends in .xacro, and is expanded."
            raise self.wrong(root, f"a URDF file has <robot> around all. {macros}")
        links: dict[str, Link] = {}
        for element in root.all("link"):
            self.put(links, element, self.link(element))
        joints: dict[str, Joint] = {}
        for element in root.all("joint"):
            self.put(joints, element, self.joint(element, links))
        if not links:
            raise self.wrong(root, "the robot has no <link>.")
        try:
            return Description(root.attributes.get("name", ""), links, joints, self.file)
        except DescriptionError as problem:
            raise self.wrong(root, problem.reason) from None

    def put(self, found: dict, element: Element, thing: Link | Joint) -> None:
        if thing.name in found:
            raise self.wrong(element, f"there are two of the name {thing.name}.")
        found[thing.name] = thing

    def link(self, element: Element) -> Link:
        shapes = element.all("collision") or element.all("visual")
        mass = (inertial := element.first("inertial")) and inertial.first("mass")
        return Link(
            self.name(element),
            tuple(self.shape(each) for each in shapes),
            self.number(mass, "value", least=0.0) if mass is not None else 0.0,
        )

    def shape(self, element: Element) -> Shape:
        geometry = element.first("geometry")
        inner = geometry.inside[0] if geometry and geometry.inside else None
        if inner is None:
            raise self.wrong(geometry or element, "<geometry> with <box>, <cylinder>, <sphere> or <mesh> in it is missing.")
        frame = self.frame(element)
        if inner.name == "box":
            return Shape("box", self.numbers(inner, "size", 3, least=0.0), frame)
        if inner.name in ("cylinder", "capsule"):
            return Shape("cylinder", (self.number(inner, "radius", least=0.0), self.number(inner, "length", least=0.0)), frame)
        if inner.name == "sphere":
            return Shape("sphere", (self.number(inner, "radius", least=0.0),), frame)
        if inner.name == "mesh":
            scale = self.numbers(inner, "scale", 3) if "scale" in inner.attributes else (1.0, 1.0, 1.0)
            return Shape("mesh", scale, frame, self.text(inner, "filename"))
        raise self.wrong(inner, f"<{inner.name}> is no shape; there are <box>, <cylinder>, <sphere> and <mesh>.")

    def joint(self, element: Element, links: dict[str, Link]) -> Joint:
        name, kind = self.name(element), self.text(element, "type")
        if kind not in _KINDS:
            known = ", ".join(sorted(_KINDS))
            raise self.wrong(element, f"a joint of type {kind} is not known here; there are {known}.")
        ends = []
        for role in ("parent", "child"):
            end = element.first(role)
            if end is None:
                raise self.wrong(element, f"the joint {name} has no <{role}>.")
            ends.append(self.text(end, "link"))
            if ends[-1] not in links:
                raise self.wrong(end, f"there is no link {ends[-1]}.")
        axis = (1.0, 0.0, 0.0) if (given := element.first("axis")) is None else self.axis(given)
        limit = element.first("limit")
        if limit is None and kind in ("revolute", "prismatic"):
            raise self.wrong(element, f"the {kind} joint {name} has no <limit>; only a continuous one may turn without end.")
        bounds = {key: self.number(limit, key, default=default) for key, default in _limits(kind).items()} if limit is not None else {}
        if bounds and kind in ("revolute", "prismatic") and bounds["lower"] > bounds["upper"]:
            raise self.wrong(limit or element, f"the lower limit {bounds['lower']} is above the upper one, {bounds['upper']}.")
        mimic = element.first("mimic")
        return Joint(name, kind, *ends, self.frame(element), axis, mimic=self.text(mimic, "joint") if mimic else "", **bounds)

    def axis(self, element: Element) -> Three:
        x, y, z = self.numbers(element, "xyz", 3)
        length = (x * x + y * y + z * z) ** 0.5
        if not length:
            raise self.wrong(element, "an axis of length 0 points nowhere.")
        return (x / length, y / length, z / length)

    def frame(self, element: Element) -> Frame:
        origin = element.first("origin")
        if origin is None:
            return Frame()
        position = self.numbers(origin, "xyz", 3) if "xyz" in origin.attributes else (0.0, 0.0, 0.0)
        angles = self.numbers(origin, "rpy", 3) if "rpy" in origin.attributes else (0.0, 0.0, 0.0)
        return Frame(position, turned(*angles))

    def text(self, element: Element, attribute: str) -> str:
        value = element.attributes.get(attribute, "").strip()
        if not value:
            raise self.wrong(element, f'the attribute {attribute}="..." is missing.')
        return value

    def name(self, element: Element) -> str:
        return self.text(element, "name")

    def number(self, element: Element, attribute: str, *, least: float = -inf, default: float | None = None) -> float:
        if default is not None and attribute not in element.attributes:
            return default
        return self.numbers(element, attribute, 1, least=least)[0]

    def numbers(self, element: Element, attribute: str, count: int, *, least: float = -inf) -> tuple:
        words = self.text(element, attribute).split()
        try:
            values = tuple(float(word) for word in words)
        except ValueError:
            values = ()
        if len(values) != count or not all(map(isfinite, values)):
            wanted = "a number" if count == 1 else f"{count} numbers"
            raise self.wrong(element, f'{attribute}="{" ".join(words)[:60]}" should be {wanted}.')
        if min(values) < least:
            raise self.wrong(element, f'{attribute}="{" ".join(words)}" should not be below {least:g}.')
        return values


def _limits(kind: str) -> dict[str, float]:
    """The attributes of <limit>, with what holds where they are not given: 0 for bounds, as in the original's reader."""
    bounds = {"lower": 0.0, "upper": 0.0} if kind in ("revolute", "prismatic") else {}
    return {**bounds, "velocity": inf, "effort": inf}


# ------------------------------------------------------------------------------------------------------------------ writing


def text_of(description: Description) -> str:
    """The URDF text of a description."""
    lines = ['<?xml version="1.0"?>', f"<robot name={quoteattr(description.name)}>"]
    for link in description.links.values():
        inside = [line for shape in link.shapes for line in _shape_lines(shape)]
        if link.mass:
            inside.append(f'    <inertial><mass value="{link.mass!r}"/></inertial>')
        lines += [f"  <link name={quoteattr(link.name)}>", *inside, "  </link>"] if inside else [f"  <link name={quoteattr(link.name)}/>"]
    for joint in description.joints.values():
        lines += [f'  <joint name={quoteattr(joint.name)} type="{joint.kind}">', *_joint_lines(joint), "  </joint>"]
    return "\n".join([*lines, "</robot>", ""])


def _shape_lines(shape: Shape) -> list[str]:
    if shape.kind == "box":
        geometry = f'<box size="{_written(shape.size)}"/>'
    elif shape.kind == "cylinder":
        geometry = f'<cylinder radius="{shape.size[0]!r}" length="{shape.size[1]!r}"/>'
    elif shape.kind == "sphere":
        geometry = f'<sphere radius="{shape.size[0]!r}"/>'
    else:
        geometry = f'<mesh filename={quoteattr(shape.mesh)} scale="{_written(shape.size)}"/>'
    return [f"    <collision>{_origin(shape.frame)}<geometry>{geometry}</geometry></collision>"]


def _joint_lines(joint: Joint) -> list[str]:
    lines = [f"    <parent link={quoteattr(joint.parent)}/><child link={quoteattr(joint.child)}/>"]
    if origin := _origin(joint.frame):
        lines.append(f"    {origin}")
    if joint.moves:
        lines.append(f'    <axis xyz="{_written(joint.axis)}"/>')
        limits = {"lower": joint.lower, "upper": joint.upper, "effort": joint.effort, "velocity": joint.velocity}
        given = " ".join(f'{name}="{value!r}"' for name, value in limits.items() if isfinite(value))
        if given:
            lines.append(f"    <limit {given}/>")
    if joint.mimic:
        lines.append(f"    <mimic joint={quoteattr(joint.mimic)}/>")
    return lines


def _written(values: tuple[float, ...]) -> str:
    return " ".join(map(repr, values))


def _origin(frame: Frame) -> str:
    if frame == Frame():
        return ""
    turns = "" if frame.rotation == UNTURNED else f' rpy="{_written(tuple(round(angle, 12) for angle in angles(frame.rotation)))}"'
    return f'<origin xyz="{_written(frame.position)}"{turns}/>'


def angles(rotation: Four) -> Three:
    """Roll, pitch and yaw of a quaternion, the inverse of `turned`."""
    w, x, y, z = rotation
    sine = 2 * (w * y - z * x)
    if abs(sine) > 1 - 1e-12:  # straight up or down: roll and yaw turn about the same axis
        return (2 * atan2(x, w), copysign(pi / 2, sine), 0.0)
    return (atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), asin(sine), atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
