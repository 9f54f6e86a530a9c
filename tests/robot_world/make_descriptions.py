"""Makes the URDF files of the product from the figures in ``../shared/robots``.

    python tests/robot_world/make_descriptions.py

Run it again when the figures change; ``test_descriptions.py`` tells when the files are behind.
"""

import json
from math import inf, pi
from pathlib import Path

from cramhy_runtime.robot_world import urdf
from cramhy_runtime.robot_world.descriptions import Description, Frame, Joint, Link, Shape, turned

FIGURES = Path(__file__).parents[3] / "shared" / "robots"
DATA = Path(urdf.__file__).parent / "data"
ALONG = {"x": (0.0, pi / 2, 0.0), "y": (pi / 2, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}


def described(name: str, figures: dict, changes: dict = {}) -> Description:  # noqa: B006  never changed
    """The description in a file of figures. changes: frames of joints that stand elsewhere with us."""
    links = {link["name"]: Link(link["name"], tuple(shapes(link))) for link in figures["links"]}
    joints = {}
    for joint in figures["joints"]:
        place = changes.get(joint["name"], joint)
        frame = Frame(tuple(map(float, place.get("xyz", (0, 0, 0)))), turned(*place.get("rpy", (0, 0, 0))))
        limits = {"lower": joint.get("lower", -inf), "upper": joint.get("upper", inf)}
        joints[joint["name"]] = Joint(
            joint["name"], joint["type"], joint["parent"], joint["child"], frame, tuple(joint.get("axis", (1.0, 0.0, 0.0))), **limits,
            velocity=joint.get("velocity", inf), mimic=joint.get("mimic", ""),
        )  # fmt: skip
    return Description(name, links, joints)


def shapes(link: dict):
    for x, y, z, *size in link.get("boxes", ()):
        yield Shape("box", tuple(size), Frame((x, y, z)))
    for shape in link.get("shapes", ()):
        place = tuple(shape["xyz"])
        if shape["type"] == "box":
            yield Shape("box", tuple(shape["size"]), Frame(place))
        else:
            yield Shape("cylinder", (shape["radius"], shape["length"]), Frame(place, turned(*ALONG[shape.get("axis", "z")])))


def read(name: str) -> dict:
    return json.loads((FIGURES / f"{name}.json").read_text())


TAPERED = (
    {"type": "box", "size": [0.0739, 0.0544, 0.0551], "xyz": [0.028, 0.0184, 0.0]},
    {"type": "box", "size": [0.0301, 0.0411, 0.0435], "xyz": [0.0801, 0.0157, 0.0]},
)
"""A left finger of the PR2 as two boxes: the bounds of what pr2_description's ``l_finger.stl`` has before and behind x = 0.065 m, where two
boxes have the least volume (0.275 of 0.312 l). The figures of pr2.json have one box about the whole of it, which is 0.0551 m high at its end."""

FINGERS = {f"{arm}_gripper_{side}_finger_link": sign for arm in "lr" for side, sign in (("l", 1), ("r", -1))}
"""Where pr2.urdf departs from pr2.json: at these links alone. The right finger of a hand mirrors the left one."""

WHY = "Fingers: two boxes each, the bounds of the mesh l_finger.stl of pr2_description before and behind x = 0.065 m."
"""The comment in the file."""


def with_tapered_fingers(figures: dict) -> dict:
    """The figures of a PR2 whose fingers are narrower at their ends, as the real ones are."""

    def link(told):
        sign = FINGERS.get(told["name"])
        shapes = [{**shape, "xyz": [x, sign * y, z]} for shape in TAPERED for x, y, z in [shape["xyz"]]] if sign else None
        return {**told, "shapes": shapes} if shapes else told

    return {**figures, "links": list(map(link, figures["links"]))}


def with_kinect(figures: dict) -> dict:
    """The figures of a PR2 that has a Kinect on its head, as the one in Bremen does."""
    joints = figures["optional_kinect_joints"]["joints"]
    links = [{"name": joint["child"]} for joint in joints]
    return {**figures, "links": figures["links"] + links, "joints": figures["joints"] + joints}


ROUND = frozenset("bottle buttermilk cup bowl plate red-metal-plate blue-metal-plate pot mug".split())
"""The types of objects that are cylinders; all others are boxes."""


def objects(figures: dict) -> dict[str, dict]:
    """Type of object -> shape, size and middle. Of types that several packages have, the last counts, as when they are loaded in turn."""
    found = {}
    for files in figures["mesh_sets"].values():
        for name, entry in files.items():
            entry = entry[-1] if isinstance(entry, list) else entry
            x, y, z = entry["size"]
            shape = {"shape": "cylinder", "size": [round((x + y) / 4, 4), z]} if name in ROUND else {"shape": "box", "size": [x, y, z]}
            found[name.split()[0]] = {**shape, "middle": entry["center"]}
    for name, size in (("cereal-box", [0.058, 0.193, 0.277]), ("sugar-box", [0.055, 0.094, 0.207])):
        found[name] = {"shape": "box", "size": size, "middle": [0.0, 0.0, 0.0]}
    return dict(sorted(found.items()))


def written(models: dict[str, dict]) -> str:
    """JSON with a line for each model."""
    lines = ",\n".join(f" {json.dumps(name)}: {json.dumps(model)}" for name, model in models.items())
    return f"{{\n{lines}\n}}\n"


def commented(text: str, comment: str) -> str:
    """A file of URDF with a comment behind its first tag."""
    head, tag, rest = text.partition('">\n')
    return f"{head}{tag}  <!-- {comment} -->\n{rest}"


def made() -> dict[str, str]:
    """The text of each file."""
    kitchen = read("kitchen")
    table = {"table_area_main_joint": {"xyz": (-1.4, -1.18, 0.0), "rpy": (0.0, 0.0, pi)}}  # under the tutorials' bottle
    return {
        "objects.json": written(objects(read("objects"))),
        "pr2.urdf": commented(urdf.text_of(described("pr2", with_tapered_fingers(with_kinect(read("pr2"))))), WHY),
        "kitchen.urdf": urdf.text_of(described("iai_kitchen", kitchen, table)),
    }


if __name__ == "__main__":
    for file, text in made().items():
        (DATA / file).write_text(text)
        print(DATA / file)
