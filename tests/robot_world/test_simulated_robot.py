"""The motions of a robot in a world: each happens whole, or leaves the world as it was and says why."""

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime.robot_world.descriptions import Frame, Shape, turned
from cramhy_runtime.robot_world.placements import placement
from cramhy_runtime.robot_world.simulated_robot import (
    ArmParts,
    BeyondLimits,
    Blocked,
    NothingGripped,
    OutOfReach,
    RobotParts,
    SimulatedRobot,
)

BOTTLE = (Shape("cylinder", (0.0357, 0.1814), Frame((0.0, 0.0, -0.01))),)
COUNTER = placement((-1.8547, -0.381, 0.0), turned(0, 0, -np.pi / 2))
JOINTS = "shoulder_pan shoulder_lift upper_arm_roll elbow_flex forearm_roll wrist_flex wrist_roll".split()
CARRYING = {
    "left": (1.9653, -0.265, 1.3837, -2.1225, 16.9965, -0.0735, 0.0),
    "right": (-1.7126, -0.2567, -1.4634, -2.1222, 1.7663, -0.0794, 0.0511),
}


def arm(side, machine):
    hand = tuple(link for link in machine.skeleton.links if link.startswith(f"{side}_gripper"))
    fingers = tuple(f"{side}_gripper_{finger}_finger_joint" for finger in "lr")
    return ArmParts(
        tuple(f"{side}_{name}_joint" for name in JOINTS),
        "torso_lift_link",
        f"{side}_wrist_roll_link",
        placement((0.2, 0, 0)),
        fingers,
        hand,
        0.548,
        5.0,
    )


@pytest.fixture
def robot(world):
    machine = world.machine("pr2")
    arms = {"left": arm("l", machine), "right": arm("r", machine)}
    cameras = ("head_mount_kinect_rgb_optical_frame", "narrow_stereo_optical_frame")
    made = SimulatedRobot(world, "pr2", RobotParts("torso_lift_joint", "head_pan_joint", "head_tilt_joint", cameras, arms))
    for side, positions in CARRYING.items():
        made.move_joints(side, positions)
    made.move_torso(0.3)
    world.add_item("bottle", BOTTLE, placement((-2.0, -0.9, 0.86)))
    world.simulate(10)
    return made


def test_a_base_that_would_touch_something_stays_where_it_is(robot):
    robot.drive(COUNTER)
    with pytest.raises(Blocked, match="kitchen") as caught:
        robot.drive(placement((-0.8, 2.0, 0.0)))
    assert [thing.name for thing in caught.value.things] == ["kitchen"]
    assert robot.machine.placement.near(COUNTER, 0, 1e-6)


@pytest.mark.parametrize(("height", "reached"), [(0.5, 0.33), (-0.1, 0.0)])
def test_the_torso_goes_as_far_as_it_can(robot, height, reached):
    with pytest.raises(BeyondLimits, match="torso_lift_joint"):
        robot.move_torso(height)
    assert robot.machine.joint("torso_lift_joint") == pytest.approx(reached)


@pytest.mark.parametrize("place", [(-2.0, -0.9, 0.8), (-1.5, -1.2, 0.3), (-1.8, -1.4, 1.6), (-0.5, -1.0, 1.2)])
def test_the_head_looks_where_it_shall(robot, place):
    robot.drive(COUNTER)
    robot.look_at(np.array(place))
    tilt = robot.machine.link("head_tilt_link")
    ahead = (tilt.inverse() @ placement(place)).position
    assert ahead[0] > 0
    assert np.abs(ahead[1:]).max() < 1e-6


def test_the_neck_goes_as_far_as_it_can(robot):
    robot.drive(COUNTER)
    with pytest.raises(BeyondLimits, match="head_tilt_joint"):
        robot.look_at(np.array([-1.85, -0.5, 0.0]))
    assert robot.machine.joint("head_tilt_joint") == pytest.approx(1.396, abs=1e-3)
    robot.look_forward()
    assert robot.machine.joint("head_pan_joint") == 0.0


def test_the_robot_sees_what_is_before_it(robot):
    robot.drive(COUNTER)
    robot.look_at(robot.world.item("bottle").placement.position)
    assert robot.camera() == "head_mount_kinect_rgb_optical_frame"
    assert robot.sees("bottle")
    robot.look_at(np.array([-1.0, -3.0, 1.0]))
    assert not robot.sees("bottle")


def grasp_from_the_left(robot):
    """The tool before, at, and above the bottle: the gripper points along y of the world, from the robot's right."""
    at = robot.machine.placement.inverse() @ robot.world.item("bottle").placement
    turn = placement((0, 0, 0), turned(0, 0, -np.pi / 2)).rotation
    return [
        placement(at.position + offset, (placement((0, 0, 0), at.rotation) @ placement((0, 0, 0), turn)).rotation)
        for offset in ((-0.15, 0, 0), (0, 0, 0), (0, 0, 0.15))
    ]


def test_a_bottle_is_gripped_lifted_and_carried(robot):
    robot.drive(COUNTER)
    before, at, above = grasp_from_the_left(robot)
    robot.set_gripper("right", 0.1)
    robot.move_tools({"right": before})
    robot.move_tools({"right": at})
    assert [thing.name for thing in robot.grip("right")] == ["bottle"]
    robot.world.attach("pr2", "bottle", "r_wrist_roll_link")
    height = robot.world.item("bottle").placement.position[2]
    robot.move_tools({"right": above})
    assert robot.world.item("bottle").placement.position[2] == pytest.approx(height + 0.15, abs=1e-3)
    robot.move_joints("right", CARRYING["right"])
    robot.drive(placement((0.0, 1.0, 0.0)))
    assert robot.world.item("bottle").placement.position[1] > 0.0
    assert robot.collisions() == []


def test_closing_on_air_grips_nothing(robot):
    robot.open_gripper("left")
    assert robot.machine.joint("l_gripper_l_finger_joint") == pytest.approx(0.548)
    with pytest.raises(NothingGripped):
        robot.grip("left")
    assert robot.machine.joint("l_gripper_l_finger_joint") == 0.0


def test_what_no_height_of_the_torso_reaches_moves_nothing(robot):
    before = robot.machine.joints.copy()
    with pytest.raises(OutOfReach, match="left arm was found at 8 heights"):
        robot.move_tools({"left": placement((3.0, 0.0, 1.0))})
    assert (robot.machine.joints == before).all()


def test_the_torso_helps_the_arm(robot):
    robot.move_torso(0.0)
    robot.move_tools({"right": placement((0.6, -0.3, 1.55))})
    assert robot.machine.joint("torso_lift_joint") > 0.0
    tool = robot.machine.placement.inverse() @ robot.machine.link("r_wrist_roll_link") @ placement((0.2, 0, 0))
    assert tool.near(placement((0.6, -0.3, 1.55)), 1e-3, 1e-3)


def test_a_wrong_number_of_joints_is_refused(robot):
    with pytest.raises(ValueError, match="argument"):
        robot.move_joints("left", (0.0,))
