"""Meshes: files of the three formats, their addresses, and how they stand in a world."""

import struct

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime import kernel  # noqa: E402
from cramhy_runtime.robot_world import meshes  # noqa: E402
from cramhy_runtime.robot_world.descriptions import Shape  # noqa: E402
from cramhy_runtime.robot_world.mesh_files import MeshError, read_mesh  # noqa: E402
from cramhy_runtime.robot_world.placements import placement  # noqa: E402
from cramhy_runtime.robot_world.world import World, WorldError  # noqa: E402

CORNERS = [(x, y, z) for x in (-0.05, 0.05) for y in (-0.1, 0.1) for z in (0, 0.3)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [(a, b, c) for a, *rest in FACES for b, c in zip(rest, rest[1:], strict=False)]
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset><unit name="centimeter" meter="0.01"/><up_axis>{up}</up_axis></asset>
 <library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="24">{points}</float_array>
   <technique_common><accessor source="#pa" count="8" stride="3"/></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="6"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#p" offset="1"/>
   <vcount>4 4 4 4 4 4</vcount><p>{corners}</p></polylist>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s"><node><scale>10 10 10</scale><node><instance_geometry url="#g"/></node></node></visual_scene>
 </library_visual_scenes></COLLADA>"""


def stl_text():
    facets = "".join(
        f"facet normal 0 0 0 outer loop {''.join('vertex {} {} {} '.format(*CORNERS[corner]) for corner in triangle)}endloop endfacet\n"
        for triangle in TRIANGLES
    )
    return f"solid box\n{facets}endsolid box\n".encode()


def stl_bytes():
    facets = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(part for corner in triangle for part in CORNERS[corner]), 0) for triangle in TRIANGLES
    )
    return b"solid but binary".ljust(80) + struct.pack("<I", len(TRIANGLES)) + facets


def obj():
    lines = ["# a box", *(f"v {x} {y} {z}" for x, y, z in CORNERS), "vn 0 0 1", *("f " + " ".join(f"{c + 1}//1" for c in f) for f in FACES)]
    return "\n".join(lines).encode()


def dae(up="Z_UP"):
    order = {"Z_UP": lambda x, y, z: (x, y, z), "Y_UP": lambda x, y, z: (x, z, -y)}[up]
    points = " ".join(str(part * 10) for corner in CORNERS for part in order(*corner))
    return COLLADA.format(up=up, points=points, corners=" ".join(f"{c} 0" for face in FACES for c in face)).encode()


@pytest.mark.parametrize(
    ("name", "data"),
    [("a.stl", stl_text()), ("b.STL", stl_bytes()), ("c.obj", obj()), ("d.dae", dae()), ("e.dae", dae("Y_UP"))],
    ids=["text STL", "binary STL", "OBJ", "Collada", "Collada, y up"],
)
def test_the_same_box_is_read_from_each_format(tmp_path, name, data):
    (tmp_path / name).write_bytes(data)
    mesh = read_mesh(tmp_path / name)
    lowest, highest = mesh.box
    assert np.allclose(lowest, (-0.05, -0.1, 0), atol=1e-6) and np.allclose(highest, (0.05, 0.1, 0.3), atol=1e-6)
    assert mesh.points.shape == (8, 3) and mesh.triangles.shape == (12, 3)


@pytest.mark.parametrize(
    ("name", "data", "reason"),
    [
        ("a.stl", b"hello", "neither begins with solid"),
        ("a.stl", b"solid x vertex 1 2", "no STL that can be read"),
        ("a.stl", stl_bytes()[:-1], "neither|four points"),
        ("a.obj", b"v 1 2 z", "line 1"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "not in one plane"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 9", "a point that is not there"),
        ("a.obj", b"v 0 0 inf\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3", "no finite number"),
        ("a.dae", b"<COLLADA>", "no DAE that can be read: a.dae, line 1"),
        ("a.dae", b"<COLLADA/>", "no geometry"),
        ("a.dae", dae().replace(b"#g", b"#h"), "it names #h"),
        ("a.dae", b'<!DOCTYPE a [<!ENTITY x "y">]><COLLADA/>', "entities"),
        ("a.ply", b"ply", r"meshes are read from \.stl, \.obj, \.dae"),
    ],
)
def test_a_broken_file_says_what_is_wrong(tmp_path, name, data, reason):
    (tmp_path / name).write_bytes(data)
    with pytest.raises(MeshError, match=reason) as problem:
        read_mesh(tmp_path / name)
    assert name in str(problem.value)


def test_a_changed_file_is_read_again(tmp_path):
    import os

    path = tmp_path / "a.obj"
    path.write_bytes(obj())
    assert read_mesh(path) is read_mesh(path)
    path.write_bytes(obj().replace(b"0.3", b"0.6"))
    os.utime(path, ns=(1, 1))
    assert read_mesh(path).box[1][2] == pytest.approx(0.6)


def test_addresses(tmp_path, monkeypatch):
    package = tmp_path / "my_meshes"
    (package / "resource").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_meshes</name></package>")
    (package / "resource" / "box.stl").write_bytes(stl_text())
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    assert meshes.path_of("package://my_meshes/resource/*.*") == package / "resource" / "*.*"
    assert meshes.path_of("package://no_such_package/x.stl") is None
    assert len(meshes.mesh_at("package://my_meshes/resource/box.stl").points) == 8
    with pytest.raises(MeshError, match="the ROS package no_such_package is not found"):
        meshes.mesh_at("package://no_such_package/x.stl")


@pytest.fixture
def empty():
    kernel.start(clock="virtual")
    yield World()
    kernel.stop()


def test_meshes_cones_and_clouds_of_points_fall_and_lie(empty, tmp_path):
    (tmp_path / "box.stl").write_bytes(stl_text())
    empty.add_item("box", (meshes.mesh_shape(str(tmp_path / "box.stl")),), placement((0, 0, 0.5)))
    empty.add_item("twice", (meshes.mesh_shape(str(tmp_path / "box.stl"), 2.0),), placement((1, 0, 0.5)))
    empty.add_item("cone", (meshes.cone_shape(0.1, 0.2),), placement((0, 1, 0.5)))
    empty.add_item("points", (meshes.points_shape([(0, 0, 0), (0.2, 0, 0), (0, 0.2, 0), (0.1, 0.1, 0.1)]),), placement((1, 1, 0.3)))
    empty.simulate(5)
    heights = [float(empty.item(name).placement.position[2]) for name in ("box", "twice", "cone", "points")]
    assert heights == pytest.approx([0, 0, 0.1, 0], abs=2e-3)
    low, high = empty.bounds("twice")
    assert high - low == pytest.approx([0.2, 0.4, 0.6], abs=2e-3)
    assert empty.stable("box")


def test_a_plane_is_the_floor_where_there_is_one(empty):
    empty.add_item("ground", (Shape("plane", ()),), placement((0, 0, -1.0)), mass=0)
    empty.add_item("ball", (Shape("sphere", (0.1,)),), placement((0, 0, 0)))
    empty.simulate(5)
    assert empty.item("ball").placement.position[2] == pytest.approx(-0.9, abs=2e-3)
    assert [thing.name for thing in empty.touching("ball")] == ["ground"]


def test_a_mesh_that_cannot_be_read_is_told_when_it_is_added(empty):
    with pytest.raises(WorldError, match="the ROS package nowhere is not found"):
        empty.add_item("x", (Shape("mesh", (1.0, 1.0, 1.0), mesh="package://nowhere/x.stl"),))
    assert not empty.things


def test_what_is_in_a_wall_stays_there_and_is_told_of(empty):
    empty.add_item("wall", (Shape("box", (1.0, 1.0, 8.0)),), placement((0, 0, 0)), mass=0)
    empty.add_item("in it", (Shape("box", (0.1, 0.1, 0.1)),), placement((0, 0, 1.0)))
    empty.add_item("free", (Shape("sphere", (0.1,)),), placement((2, 0, 1.0)))
    empty.simulate(3)
    assert [(item.name, other.name) for item, other in empty.stuck] == [("in it", "wall")]
    assert empty.item("in it").placement.position[2] == 1.0
    assert empty.item("free").placement.position[2] == pytest.approx(0.1, abs=2e-3)
