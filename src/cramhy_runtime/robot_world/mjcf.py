"""MJCF, the XML in which MuJoCo describes robots and scenes: reading it into a `Description`, as a URDF file is read.

MuJoCo itself reads the file, with its defaults, includes and meshes. Each body becomes a link. A joint that is not at the origin of its
body, or not the only one, gets a link of its own that has no shape. A capsule becomes a cylinder with two spheres, an ellipsoid the box
around it. What floats (a free joint) is a robot whose root is that body. Shapes that touch nothing (``contype`` and ``conaffinity`` 0) are
for the eye, and passed over. Source: https://mujoco.readthedocs.io/en/stable/XMLreference.html.

Law: whatever the text is, it gives a `Description`, or a `DescriptionError` with file, and with line and element where MuJoCo tells them.
"""

from __future__ import annotations

import re
from math import inf, prod
from pathlib import Path

import numpy as np

from .descriptions import Description, DescriptionError, Frame, Joint, Link, Shape
from .mesh_files import Mesh
from .mujoco_parts import mujoco
from .xml_elements import Element, parsed, read_bytes

MOST_PARTS = 5_000
"""Bodies, geoms and sites, each copy that <replicate> and the like make counted; MuJoCo needs ten seconds for 2,000 bodies that fall."""
MOST_INCLUDED = 100
_REPEATING = {"replicate", "composite", "flexcomp"}
_WHERE = re.compile(r"Element '(?P<element>[^']*)'(?:, line (?P<line>\d+))?|[Ll]ine (?P<other>\d+)")
_PLANE, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{kind}")) for kind in "PLANE SPHERE CAPSULE ELLIPSOID CYLINDER BOX MESH".split()
)
_SLIDE, _HINGE = int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)
_COUPLING = int(mujoco.mjtEq.mjEQ_JOINT)
_ROOT = "world"


def read_file(path: str | Path) -> Description:
    """The description in an MJCF file. Errors: `DescriptionError`; OSError, when it cannot be read."""
    _check_size(parsed(read_bytes(path), str(path)), str(path), Path(path).parent)
    return _read(lambda: mujoco.MjModel.from_xml_path(str(path)), str(path))


def read_text(text: str | bytes, file: str = "") -> Description:
    """The description in the text of an MJCF file, which cannot name other files. Errors: `DescriptionError`."""
    words = text.decode("utf-8", "replace") if isinstance(text, bytes) else text
    _check_size(parsed(text.lstrip(), file), file)
    return _read(lambda: mujoco.MjModel.from_xml_string(words), file)


def _check_size(root: Element, file: str, folder: Path | None = None) -> None:
    """Refuse what MuJoCo would take minutes to read, with no way to interrupt it. ``folder``: where included files are looked for."""
    left, waiting, included = MOST_PARTS, [(root, 1, file)], 0
    while waiting:
        element, times, place = waiting.pop()
        if element.name in _REPEATING:
            times *= max(1, _product(element.attributes.get("count", "1")))
        elif element.name in ("body", "geom", "site", "flexcomp"):
            left -= times
        if left < 0 or times > MOST_PARTS:
            reason = f"it makes more than {MOST_PARTS} bodies and geoms, which MuJoCo needs too long to read."
            raise DescriptionError(reason, place, element.line, element.name)
        if element.name == "include" and folder is not None:
            path, included = folder / element.attributes.get("file", ""), included + 1
            if included > MOST_INCLUDED:
                raise DescriptionError(f"more than {MOST_INCLUDED} files are included.", place, element.line, element.name)
            if path.is_file():  # of others MuJoCo tells that they are missing
                waiting.append((parsed(read_bytes(path), str(path)), times, str(path)))
        waiting += [(inner, times, place) for inner in element.inside]


def _product(count: str) -> int:
    numbers = [float(word) for word in count.split() if word.replace(".", "", 1).isdigit()]
    return int(min(prod(numbers), 1e9))


def _read(load, file: str) -> Description:  # noqa: ANN001
    try:
        model = load()
    except ValueError as problem:
        raise _told(str(problem), file) from None
    return _Reading(model, file).description()


def _told(problem: str, file: str) -> DescriptionError:
    found = _WHERE.search(problem)
    line = int((found["line"] or found["other"] or 0) if found else 0)
    reason = " ".join(problem.split()).removeprefix("XML Error: ").removeprefix("Error: ")
    return DescriptionError(f"MuJoCo says: {reason}", file, line, (found["element"] or "") if found else "")


class _Reading:
    """Reads one model."""

    def __init__(self, model: mujoco.MjModel, file: str) -> None:
        self.model, self.file = model, file
        self.links: dict[str, Link] = {}
        self.joints: dict[str, Joint] = {}
        self.names: dict[int, str] = {}

    def description(self) -> Description:
        model = self.model
        below = [body for body in range(1, model.nbody) if model.body_parentid[body] == 0]
        stands = any(int(model.geom_type[geom]) != _PLANE for geom in self._geoms(0))
        if len(below) == 1 and not stands:
            self.put_link(below[0], self._name(below[0]))
            first = 2
        else:
            self.put_link(0, _ROOT)
            first = 1
        for body in range(first, model.nbody):  # MuJoCo numbers parents before their children
            self.body(body)
        name = bytes(model.names[: model.names.index(b"\0")]).decode()
        return Description(name, self.links, self.joints, self.file)

    def _name(self, body: int) -> str:
        return self.model.body(body).name or f"body {body}"

    def _geoms(self, body: int) -> range:
        first = int(self.model.body_geomadr[body])
        return range(first, first + int(self.model.body_geomnum[body])) if first >= 0 else range(0)

    def put_link(self, body: int, name: str) -> None:
        solid = [geom for geom in self._geoms(body) if self.model.geom_contype[geom] or self.model.geom_conaffinity[geom]]
        shapes = tuple(shape for geom in solid for shape in self.shapes(geom))
        self.names[body] = name
        self.links[name] = Link(name, shapes, float(self.model.body_mass[body]))

    def body(self, body: int) -> None:
        model, name = self.model, self._name(body)
        parent = self.names[int(model.body_parentid[body])]
        frame = _frame(model.body_pos[body], model.body_quat[body])
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        for number in range(first, first + count):
            joint = model.joint(number)
            if int(model.jnt_type[number]) not in (_SLIDE, _HINGE):
                raise DescriptionError(
                    f"the joint {joint.name or number} of the body {name} is a ball or floats; only hinges and slides are known here.",
                    self.file,
                    element="joint",
                )
            place = model.jnt_pos[number]
            last = number == first + count - 1 and not place.any()
            child = name if last else f"{name} {joint.name or number}"
            if not last:
                self.links[child] = Link(child)
            self.put_joint(self.joint(number, parent, child, _moved(frame, place)))
            parent, frame = child, Frame(tuple(map(float, -place)))
            if last:
                frame = None
        if frame is not None:
            self.put_joint(Joint(f"{name} fixed", "fixed", parent, name, frame))
        self.put_link(body, name)

    def put_joint(self, joint: Joint) -> None:
        self.joints[joint.name] = joint

    def joint(self, number: int, parent: str, child: str, frame: Frame) -> Joint:
        model = self.model
        slides, limited = int(model.jnt_type[number]) == _SLIDE, bool(model.jnt_limited[number])
        kind = "prismatic" if slides else "revolute" if limited else "continuous"
        lower, upper = map(float, model.jnt_range[number]) if limited else (-inf, inf)
        effort = float(model.jnt_actfrcrange[number, 1]) if model.jnt_actfrclimited[number] else inf
        name = model.joint(number).name or f"joint {number}"
        axis = tuple(map(float, model.jnt_axis[number]))
        return Joint(name, kind, parent, child, frame, axis, lower, upper, inf, effort, self._leader(number))

    def _leader(self, number: int) -> str:
        """The name of the joint that this one follows one to one, by an equality."""
        model = self.model
        for equality in range(model.neq):
            if (
                model.eq_type[equality] == mujoco.mjtEq.mjEQ_JOINT
                and model.eq_obj1id[equality] == number
                and model.eq_obj2id[equality] >= 0
            ):
                return model.joint(int(model.eq_obj2id[equality])).name
        return ""

    def shapes(self, geom: int) -> list[Shape]:
        model = self.model
        kind, frame = int(model.geom_type[geom]), _frame(model.geom_pos[geom], model.geom_quat[geom])
        one, two, three = map(float, model.geom_size[geom])
        if kind in (_BOX, _ELLIPSOID):
            return [Shape("box", (2 * one, 2 * two, 2 * three), frame)]
        if kind == _CYLINDER:
            return [Shape("cylinder", (one, 2 * two), frame)]
        if kind == _SPHERE:
            return [Shape("sphere", (one,), frame)]
        if kind == _CAPSULE:
            ends = [Shape("sphere", (one,), _moved(frame, np.array([0.0, 0.0, end]))) for end in (-two, two)]
            return [Shape("cylinder", (one, 2 * two), frame), *ends]
        if kind == _PLANE:
            return [Shape("plane", (), frame)]
        if kind == _MESH:
            return [Shape("mesh", (1.0, 1.0, 1.0), frame, body=self._mesh(int(model.geom_dataid[geom])))]
        raise DescriptionError(
            f"the geom {model.geom(geom).name or geom} is a height field or the like, which is not known here.", self.file
        )

    def _mesh(self, number: int) -> Mesh:
        model = self.model
        points, faces = int(model.mesh_vertadr[number]), int(model.mesh_faceadr[number])
        return Mesh(
            np.array(model.mesh_vert[points : points + model.mesh_vertnum[number]], float),
            np.array(model.mesh_face[faces : faces + model.mesh_facenum[number]], int),
        )


def _frame(position: np.ndarray, rotation: np.ndarray) -> Frame:
    return Frame(tuple(map(float, position)), tuple(map(float, rotation)))


def _moved(frame: Frame, place: np.ndarray) -> Frame:
    """``frame``, at a place that is given in it."""
    turned = np.zeros(3)
    mujoco.mju_rotVecQuat(turned, place, np.array(frame.rotation))
    return Frame(tuple(map(float, np.array(frame.position) + turned)), frame.rotation)
