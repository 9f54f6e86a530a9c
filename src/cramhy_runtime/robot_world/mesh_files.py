"""Reading files of meshes: STL, Wavefront OBJ and Collada.

A mesh is points and triangles; colours, textures and normals do not matter here. A Collada file is a small world of its own: what is read
is its scene, each geometry where the nodes put it, in metres and with z up.

Law: whatever is in the file, it gives a `Mesh` of at least four points that are not in one plane, or a `MeshError` that names the file.
Sources: https://www.fabbers.com/tech/STL_Format, http://paulbourke.net/dataformats/obj, Collada 1.4.1 (Khronos).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .descriptions import DescriptionError
from .xml_elements import Element, parsed, read_bytes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

MOST_TRIANGLES = 1_000_000
_FLAT = 1e-6  # metres


class MeshError(ValueError):
    """A file of a mesh cannot be read. file: its path. reason: a sentence."""

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(f"{file}: {reason}")
        self.file, self.reason = file, reason


@dataclass(frozen=True, eq=False)
class Mesh:
    """points: n x 3, metres. triangles: m x 3 numbers of points; none, when only the points are known."""

    points: np.ndarray
    triangles: np.ndarray

    def scaled(self, scale: tuple[float, ...]) -> Mesh:
        """The mesh, so many times as large along x, y and z."""
        return Mesh(self.points * np.array(scale, float), self.triangles)

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest corner of the box around it."""
        return self.points.min(axis=0), self.points.max(axis=0)


def read_mesh(path: Path) -> Mesh:
    """The mesh in a file. It is read again when the file has changed. Errors: `MeshError`."""
    try:
        changed = path.stat().st_mtime_ns
    except OSError as problem:
        raise MeshError(str(path), f"it cannot be read: {problem.strerror or problem}.") from None
    return _read(path, changed)


@functools.lru_cache(maxsize=256)
def _read(path: Path, changed: int) -> Mesh:
    read = _READERS.get(path.suffix.lower())
    if read is None:
        raise MeshError(str(path), f"meshes are read from {', '.join(_READERS)}; {path.suffix or 'a file without ending'} is none of them.")
    try:
        points, triangles = read(path)
    except MeshError:
        raise
    except (OSError, ValueError, IndexError, DescriptionError) as problem:
        raise MeshError(str(path), f"it is no {path.suffix[1:].upper()} that can be read: {problem}") from None
    return solid_mesh(points, triangles, str(path))


def solid_mesh(points: np.ndarray, triangles: np.ndarray, name: str) -> Mesh:
    """A mesh of these points, each of them once. Errors: `MeshError`, when it has no volume; ``name`` stands in the message."""
    points = np.asarray(points, float).reshape(-1, 3)
    triangles = np.asarray(triangles, int).reshape(-1, 3)
    if len(triangles) > MOST_TRIANGLES:
        raise MeshError(name, f"it has {len(triangles)} triangles; {MOST_TRIANGLES} are the most.")
    if not np.isfinite(points).all():
        raise MeshError(name, "a coordinate is no finite number.")
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise MeshError(name, f"a triangle names a point that is not there; there are {len(points)}.")
    places, where = np.unique(points.round(9), axis=0, return_inverse=True)
    if len(places) < 4 or np.linalg.svd(places - places.mean(axis=0), compute_uv=False)[2] / len(places) ** 0.5 < _FLAT:
        raise MeshError(name, f"a mesh needs four points that are not in one plane; it has {len(places)} points.")
    return Mesh(places, where.reshape(-1)[triangles])


# ---------------------------------------------------------------------------------------------------------------- STL, OBJ


def _stl(path: Path) -> tuple[np.ndarray, np.ndarray]:
    data = read_bytes(path)
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and len(data) == 84 + 50 * count:  # a binary file may begin with the word solid, too
        facets = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]), offset=84)
        points = facets["corners"].reshape(-1, 3)
    elif data.lstrip()[:5] == b"solid":
        words = data.decode("ascii", "replace").split()
        corners = [words[at + 1 : at + 4] for at, word in enumerate(words) if word == "vertex"]
        points = np.array(corners, float).reshape(-1, 3)
    else:
        raise MeshError(str(path), f"it is no STL: it neither begins with solid, nor has the length of {count} triangles.")
    if len(points) % 3:
        raise MeshError(str(path), "it ends within a triangle.")
    return points, np.arange(len(points)).reshape(-1, 3)


def _obj(path: Path) -> tuple[np.ndarray, list]:
    points, triangles = [], []
    for number, line in enumerate(read_bytes(path).decode("utf-8", "replace").splitlines(), 1):
        word, *rest = line.split("#")[0].split() or [""]
        try:
            if word == "v":
                points.append([float(each) for each in rest[:3]])
            elif word == "f":
                corners = [int(each.split("/")[0]) for each in rest]
                corners = [corner - 1 if corner > 0 else len(points) + corner for corner in corners]
                triangles += _fan(corners)
        except ValueError:
            raise MeshError(str(path), f"line {number}: {line.strip()[:60]!r} is neither a point nor a face.") from None
    return np.array(points, float), triangles


def _fan(corners: list[int]) -> list[list[int]]:
    """The triangles of a polygon."""
    return [[corners[0], one, other] for one, other in zip(corners[1:], corners[2:], strict=False)]


# ----------------------------------------------------------------------------------------------------------------- Collada


def _dae(path: Path) -> tuple[np.ndarray, np.ndarray]:
    return _Collada(parsed(read_bytes(path), path.name), str(path)).scene()


class _Collada:
    """Reads one Collada document."""

    def __init__(self, root: Element, file: str) -> None:
        self.root, self.file = root, file
        self.named = {each.attributes["id"]: each for each in root.everywhere() if "id" in each.attributes}

    def scene(self) -> tuple[np.ndarray, np.ndarray]:
        """The points and triangles of all geometries in the scene."""
        asset = self.root.first("asset")
        unit = asset.first("unit") if asset else None
        up = asset.first("up_axis") if asset else None
        turn = np.diag([*[float(unit.attributes.get("meter", 1.0)) if unit else 1.0] * 3, 1.0])
        axis = up.text.strip() if up else "Y_UP"
        if axis == "Y_UP":
            turn = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]]) @ turn
        elif axis == "X_UP":
            turn = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]]) @ turn
        scenes = [scene for library in self.root.all("library_visual_scenes") for scene in library.all("visual_scene")]
        nodes = [node for scene in scenes[:1] for node in scene.all("node")]
        parts = [part for node in nodes for part in self.node(node, turn, 0)]
        if not parts:  # a file without a scene: its geometries, where they are
            parts = [part for each in self.root.everywhere() if each.name == "geometry" for part in self.geometry(each, turn)]
        if not parts:
            raise MeshError(self.file, "there is no geometry with triangles in it.")
        starts = np.cumsum([0, *(len(points) for points, _ in parts)])
        return (
            np.concatenate([points for points, _ in parts]),
            np.concatenate([triangles + start for (_, triangles), start in zip(parts, starts, strict=False)]),
        )

    def node(self, node: Element, turn: np.ndarray, depth: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The parts below a node; ``turn``: where the node around it is."""
        if depth > 100:
            raise MeshError(self.file, "its nodes contain each other.")
        for each in node.inside:
            if each.name in _TURNS:
                turn = turn @ _TURNS[each.name](self.numbers(each))
        for each in node.inside:
            if each.name == "node":
                yield from self.node(each, turn, depth + 1)
            elif each.name == "instance_node":
                yield from self.node(self.find(each.attributes.get("url", "")), turn, depth + 1)
            elif each.name == "instance_geometry":
                yield from self.geometry(self.find(each.attributes.get("url", "")), turn)

    def geometry(self, geometry: Element, turn: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The parts of a geometry."""
        mesh = geometry.first("mesh")
        for part in mesh.inside if mesh else ():
            if part.name in ("triangles", "polylist", "polygons", "trifans", "tristrips"):
                yield self.part(part, turn)

    def part(self, part: Element, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        inputs = part.all("input")
        step = 1 + max((int(each.attributes.get("offset", 0)) for each in inputs), default=0)
        source = next((each for each in inputs if each.attributes.get("semantic") == "VERTEX"), None)
        if source is None:
            raise MeshError(self.file, f"<{part.name}> has no <input> of its points.")
        points = self.points(source)
        points = points @ turn[:3, :3].T + turn[:3, 3]
        corners = [self.numbers(each).astype(int)[int(source.attributes.get("offset", 0)) :: step] for each in part.all("p")]
        if part.name == "triangles":
            return points, np.concatenate([np.zeros(0, int), *corners]).reshape(-1, 3)
        if part.name == "polylist":
            counts = self.numbers(part.first("vcount")).astype(int) if part.first("vcount") else np.zeros(0, int)
            corners = np.split(np.concatenate(corners), np.cumsum(counts)[:-1]) if len(counts) and corners else []
        if part.name == "tristrips":
            return points, np.array([strip[at : at + 3] for strip in corners for at in range(len(strip) - 2)], int).reshape(-1, 3)
        return points, np.array([fan for polygon in corners for fan in _fan(list(polygon))], int).reshape(-1, 3)

    def points(self, source: Element) -> np.ndarray:
        """The points that an <input> means."""
        found = self.find(source.attributes.get("source", ""))
        if found.name == "vertices":
            position = next((each for each in found.all("input") if each.attributes.get("semantic") == "POSITION"), None)
            found = self.find(position.attributes.get("source", "") if position else "")
        array = found.first("float_array")
        if array is None:
            raise MeshError(self.file, f"<{found.name}> has no <float_array>.")
        accessor = next((each for each in found.everywhere() if each.name == "accessor"), None)
        stride = int(accessor.attributes.get("stride", 3)) if accessor else 3
        numbers = self.numbers(array)
        return numbers[: len(numbers) // stride * stride].reshape(-1, stride)[:, :3]

    def find(self, address: str) -> Element:
        found = self.named.get(address.removeprefix("#"))
        if found is None:
            raise MeshError(self.file, f"it names {address or 'nothing'}, and there is no such element in it.")
        return found

    def numbers(self, element: Element) -> np.ndarray:
        return np.array(element.text.split(), float)


def _matrix(numbers: np.ndarray) -> np.ndarray:
    return numbers.reshape(4, 4)


def _translation(numbers: np.ndarray) -> np.ndarray:
    made = np.eye(4)
    made[:3, 3] = numbers
    return made


def _scaling(numbers: np.ndarray) -> np.ndarray:
    return np.diag([*numbers, 1.0])


def _rotation(numbers: np.ndarray) -> np.ndarray:
    """A turn about an axis x y z by so many degrees."""
    axis, angle = numbers[:3] / (np.linalg.norm(numbers[:3]) or 1.0), radians(numbers[3])
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    made = np.eye(4)
    made[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return made


_TURNS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "matrix": _matrix,
    "translate": _translation,
    "scale": _scaling,
    "rotate": _rotation,
}
_READERS: dict[str, Callable[[Path], tuple]] = {".stl": _stl, ".obj": _obj, ".dae": _dae}
