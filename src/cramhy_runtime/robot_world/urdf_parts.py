"""What a URDF file says beside what moves: materials, what is to be seen of the links, and by how much a joint follows another.

Worlds need none of it. CL-URDF has it for programs that ask. Source: https://wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .descriptions import Shape
from .urdf import Reading
from .xml_elements import Element, parsed


@dataclass(frozen=True, slots=True)
class Material:
    """A colour or a picture of a surface. color: red, green, blue and alpha, 0 to 1; empty where the file tells none."""

    name: str
    color: tuple[float, ...] = ()
    texture: str = ""


@dataclass(slots=True)
class Parts:
    """What was read.

    materials: those of the whole robot. visuals: (link, shape, material or ``None``). mimics: (joint, other joint, multiplier, offset).
    """

    materials: list[Material] = field(default_factory=list)
    visuals: list[tuple[str, Shape, Material | None]] = field(default_factory=list)
    mimics: list[tuple[str, str, float, float]] = field(default_factory=list)


def read_text(text: str | bytes, file: str = "") -> Parts:
    """What a text says of materials, visuals and mimics. Errors: `DescriptionError`."""
    reading, root, parts = Reading(file), parsed(text, file), Parts()
    known: dict[str, Material] = {}
    for element in root.all("material"):
        known[reading.name(element)] = _material(reading, element, {})
    for link in root.all("link"):
        for visual in link.all("visual"):
            material = visual.first("material")
            parts.visuals.append((reading.name(link), reading.shape(visual), material and _material(reading, material, known)))
    for joint in root.all("joint"):
        mimic = joint.first("mimic")
        if mimic is not None:
            numbers = (reading.number(mimic, name, default=default) for name, default in (("multiplier", 1.0), ("offset", 0.0)))
            times, plus = numbers
            parts.mimics.append((reading.name(joint), reading.text(mimic, "joint"), times, plus))
    parts.materials = list(known.values())
    return parts


def _material(reading: Reading, element: Element, known: dict[str, Material]) -> Material:
    """The material of an element; one that only names another is that one."""
    name, color, texture = element.attributes.get("name", "").strip(), element.first("color"), element.first("texture")
    if color is None and texture is None and name in known:
        return known[name]
    return Material(
        name,
        reading.numbers(color, "rgba", 4) if color is not None else (),
        reading.text(texture, "filename") if texture is not None else "",
    )
