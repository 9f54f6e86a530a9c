"""MJCF files: they load as URDF files do, and what is wrong in them is told with file, line and element."""

from math import pi

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime.robot_world import description_files, mjcf, urdf
from cramhy_runtime.robot_world.descriptions import DescriptionError
from cramhy_runtime.robot_world.mujoco_parts import mujoco
from cramhy_runtime.robot_world.placements import placement
from cramhy_runtime.robot_world.skeleton import Skeleton
from cramhy_runtime.robot_world.world import World

CRANE = """<mujoco model="crane">
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="foot" pos="1 0 0">
      <freejoint/>
      <geom type="box" size="0.2 0.2 0.05" pos="0 0 0.05"/>
      <body name="mast" pos="0 0 0.1">
        <joint name="turn" axis="0 0 1"/>
        <geom type="cylinder" size="0.05 0.5" pos="0 0 0.5"/>
        <body name="boom" pos="0 0 1" euler="0 0 90">
          <joint name="raise" axis="0 1 0" range="-60 0" limited="true" pos="0.1 0 0" actuatorfrcrange="-50 50"/>
          <joint name="reach" type="slide" axis="1 0 0" range="0 0.4" limited="true"/>
          <geom type="capsule" fromto="0 0 0 1 0 0" size="0.03"/>
          <body name="hook" pos="1 0 0"><geom type="sphere" size="0.04"/><geom type="ellipsoid" size="0.1 0.2 0.3" contype="0" conaffinity="0"/></body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def test_bodies_are_links_and_joints_have_their_limits():
    crane = description_files.read_text(CRANE, "crane.xml")
    assert (crane.name, crane.root) == ("crane", "foot")
    assert [name for name in crane.links if " " not in name] == ["foot", "mast", "boom", "hook"]
    assert [shape.kind for shape in crane.links["boom"].shapes] == ["cylinder", "sphere", "sphere"]
    assert [shape.kind for shape in crane.links["hook"].shapes] == ["sphere"]
    assert crane.links["foot"].shapes[0].size == (0.4, 0.4, 0.1)
    joints = crane.joints
    assert [joints[name].kind for name in ("turn", "raise", "reach")] == ["continuous", "revolute", "prismatic"]
    assert (joints["raise"].lower, joints["raise"].upper) == pytest.approx((-pi / 3, 0.0))
    assert (joints["reach"].upper, joints["raise"].effort) == (0.4, 50.0)


def test_links_are_where_mujoco_has_them():
    crane, draw = mjcf.read_text(CRANE), np.random.default_rng(5)
    skeleton, model = Skeleton(crane), mujoco.MjModel.from_xml_string(CRANE)
    data = mujoco.MjData(model)
    for _ in range(20):
        values = {"turn": draw.uniform(-3, 3), "raise": draw.uniform(-1, 0), "reach": draw.uniform(0, 0.4)}
        data.qpos[:] = [1, 0, 0, 1, 0, 0, 0, *values.values()]
        mujoco.mj_kinematics(model, data)
        places, turns = skeleton.placed(placement((1, 0, 0)), skeleton.positions(values))
        for link in ("mast", "boom", "hook"):
            number = skeleton.links[link]
            assert places[number] == pytest.approx(data.body(link).xpos, abs=1e-9)
            assert abs(float(turns[number] @ data.body(link).xquat)) == pytest.approx(1, abs=1e-9)


def test_a_scene_with_furniture_has_the_world_as_its_root():
    room = mjcf.read_text('<mujoco><worldbody><geom type="box" size="1 1 1"/><body name="a"/><body name="b"/></worldbody></mujoco>')
    assert (room.root, list(room.links)) == ("world", ["world", "a", "b"])


def test_a_model_stands_in_a_world_and_is_touched():
    world = World()
    world.add_machine("crane", mjcf.read_text(CRANE), placement((1, 0, 0)))
    world.add_item("ball", mjcf.read_text(CRANE).links["hook"].shapes, placement((1, 0, 0.12)))
    assert [thing.name for thing in world.touching("ball")] == ["crane"]


def test_what_was_written_as_urdf_is_the_same_robot():
    crane = mjcf.read_text(CRANE)
    again = urdf.read_text(urdf.text_of(crane))
    assert (list(again.links), list(again.joints)) == (list(crane.links), list(crane.joints))


@pytest.mark.parametrize(
    ("text", "line", "element"),
    [
        ("<mujoco>\n<worldbody>\n<geom type='bax'/>\n</worldbody></mujoco>", 3, "geom"),
        ("<mujoco>\n<worldbody>\n<body><joint axis='1 0'/></body></worldbody></mujoco>", 3, "joint"),
        ("<mujoco>\n<worldbody><body></worldbody></mujoco>", 0, ""),
        ("<mujoco><worldbody><body name='b'><joint name='j' type='ball'/><geom size='1'/></body><body/></worldbody></mujoco>", 0, "joint"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text, line, element):
    with pytest.raises(DescriptionError) as caught:
        description_files.read_text(text, "robot.xml")
    problem = caught.value
    assert (problem.file, problem.line or line, problem.element or element) == (
        "robot.xml",
        line or problem.line,
        element or problem.element,
    )
    assert str(problem).startswith("robot.xml")


def test_a_file_is_read_by_what_is_in_it(tmp_path):
    for name, text, root in (("crane.urdf", CRANE, "foot"), ("arm.xml", '<robot name="arm"><link name="base"/></robot>', "base")):
        (tmp_path / name).write_text(text)
        assert description_files.read_file(tmp_path / name).root == root


def test_a_file_that_is_not_there_is_an_os_error(tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        mjcf.read_file(tmp_path / "nowhere.xml")
