"""A physical world: time is the kernel's, motions take it, fingers hold by friction, what nothing holds falls."""

import numpy as np
import pytest

from cramhy_runtime import cpl, kernel

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from test_simulated_robot import CARRYING, arm

from cramhy_runtime.robot_world import models
from cramhy_runtime.robot_world.descriptions import Shape, turned
from cramhy_runtime.robot_world.physical import arm_ways
from cramhy_runtime.robot_world.physical.contacts import contact_shapes
from cramhy_runtime.robot_world.physical.robot import NotReached, NoWay, PhysicalRobot, Slipped
from cramhy_runtime.robot_world.physical.trajectory import Trajectory
from cramhy_runtime.robot_world.physical.world import PhysicalWorld
from cramhy_runtime.robot_world.placements import placement
from cramhy_runtime.robot_world.simulated_robot import BeyondLimits, Blocked, NothingGripped, OutOfReach, RobotParts
from cramhy_runtime.robot_world.world import World

CUBE = (Shape("box", (0.06, 0.06, 0.06)),)
WRIST = "l_wrist_roll_link"


@pytest.fixture
def empty():
    kernel.start(clock="virtual")
    yield PhysicalWorld()
    kernel.stop()


@pytest.fixture
def robot(empty, pr2):
    """The PR2 with its arms parked, before a block on which a bottle stands."""
    empty.add_machine("pr2", pr2)
    empty.add_item("block", (Shape("box", (0.4, 0.8, 0.8)),), placement((0.85, 0.3, 0.4)), mass=0)
    empty.add_item("bottle", models.object_shapes("bottle"), placement((0.75, 0.25, 0.91)), types=("bottle",))
    machine = empty.machine("pr2")
    made = PhysicalRobot(
        empty,
        "pr2",
        RobotParts("torso_lift_joint", "head_pan_joint", "head_tilt_joint", ("narrow_stereo_optical_frame",), {"left": arm("l", machine)}),
    )
    for side, positions in CARRYING.items():
        empty.bend("pr2", dict(zip(arm(side[0], machine).joints, positions, strict=True)))
    empty.bend("pr2", {"torso_lift_joint": 0.25})
    empty.simulate(3)
    return made


def height(world, name="bottle"):
    return float(world.item(name).placement.position[2])


def take(robot, newtons=60.0):
    """Take the bottle from behind; the things that were gripped."""
    grasp = placement(robot.world.item("bottle").placement.position).moved(x=0.02, z=0.005)
    robot.open_gripper("left")
    robot.move_tools({"left": grasp.moved(x=-0.15)})
    robot.move_tools({"left": grasp}, lenient=True)
    gripped = robot.grip("left", newtons)
    robot.world.attach("pr2", "bottle", WRIST)
    return grasp, gripped


# ------------------------------------------------------------------------------------------------------------------------ time


def test_what_is_let_go_falls_as_the_clock_goes(empty):
    empty.add_item("cube", CUBE, placement((0, 0, 3)))
    kernel.sleep(0.49)
    assert height(empty, "cube") == pytest.approx(3 - 9.81 * 0.48**2 / 2, abs=0.05)
    kernel.sleep(3)
    assert height(empty, "cube") == pytest.approx(0.03, abs=1e-3)


def test_others_run_while_it_falls_and_a_world_at_rest_has_no_timer(empty):
    empty.add_item("cube", CUBE, placement((0, 0, 3)))
    seen = []

    def watch():
        while True:
            seen.append(round(height(empty, "cube"), 2))
            kernel.sleep(0.1)

    kernel.spawn(watch)
    took = empty.simulate(10)
    assert 0.7 < took < 2 and len(seen) == pytest.approx(10 * took, abs=2) and seen[:4] == sorted(seen[:4], reverse=True)
    assert empty._timer is None and empty.at_rest


def test_without_a_kernel_a_fall_is_computed_at_once():
    kernel.stop()
    world = PhysicalWorld()
    world.add_item("cube", CUBE, placement((0, 0, 1)))
    assert 0.4 < world.simulate(5) < 1.5
    assert height(world, "cube") == pytest.approx(0.03, abs=1e-3)


def test_the_same_calls_give_the_same_world():
    def run():
        kernel.start(clock="virtual", seed=1)
        world = PhysicalWorld()
        for number in range(4):
            world.add_item(number, CUBE, placement((0.01 * number, 0.02 * number, 0.1 + 0.1 * number)))
        world.simulate(4)
        kernel.stop()
        return np.concatenate([np.concatenate(item.placement) for item in world.items()])

    assert np.array_equal(run(), run())


def test_what_was_put_inside_of_something_is_lifted_out_and_what_cannot_be_is_told(empty, kitchen):
    empty.add_machine("kitchen", kitchen, fixed=True)
    empty.add_item("bottle", models.object_shapes("bottle"), placement((1.45, 0.6, 0.86)), types=("bottle",))
    empty.simulate(3)
    assert height(empty) == pytest.approx(0.95, abs=0.01)


def test_a_bowl_is_hollow(empty):
    empty.add_item("bowl", models.object_shapes("bowl"), placement((0, 0, 0.04)), types=("bowl",))
    empty.add_item("ball", (Shape("sphere", (0.02,)),), placement((0, 0, 0.15)))
    empty.simulate(5)
    assert height(empty, "ball") < 0.05
    assert len(contact_shapes(empty.item("bowl"))) == 17 and contact_shapes(empty.item("ball")) == empty.item("ball").shapes


# --------------------------------------------------------------------------------------------------------------------- motions


def test_a_motion_takes_time_and_joints_follow_it(robot):
    before = kernel.now()
    robot.move_torso(0.2)
    assert kernel.now() - before == pytest.approx(0.05 / 0.013, abs=0.6)  # metres, metres in a second
    assert robot.machine.joint("torso_lift_joint") == pytest.approx(0.2, abs=0.005)
    with pytest.raises(BeyondLimits):
        robot.look_at(np.array([0.1, 0, -5]))


def test_an_evaporated_motion_leaves_the_joints_where_they_are(robot):

    def rise():
        robot.move_torso(0.33)

    cpl.run(lambda: cpl.pursue(rise, lambda: cpl.sleep(2)))
    kernel.sleep(1)
    there = robot.machine.joint("torso_lift_joint")
    kernel.sleep(3)
    assert 0.26 < there < 0.3 and robot.machine.joint("torso_lift_joint") == pytest.approx(there, abs=1e-3)
    assert not robot.world.engine.trajectories


def test_motions_go_side_by_side(robot):
    before = kernel.now()
    cpl.run(lambda: cpl.par(lambda: robot.move_torso(0.2), lambda: robot.look_at(np.array([2.0, 1.0, 1.0]))))
    assert kernel.now() - before < 0.05 / 0.013 + 1
    assert robot.machine.joint("head_pan_joint") == pytest.approx(0.45, abs=0.1)


def test_what_is_in_the_way_of_a_joint_stops_it(robot):
    robot.world.add_item("ceiling", (Shape("box", (1, 1, 0.1)),), placement((0, 0, 1.68)), mass=0)
    with pytest.raises(NotReached, match="torso_lift_joint did not get there"):
        robot.move_torso(0.33)
    assert robot.machine.joint("torso_lift_joint") < 0.32


def test_a_base_drives_around_what_stands_there(robot):
    for number, y in enumerate((-0.5, 0, 0.5)):
        robot.world.add_item(f"wall-{number}", (Shape("box", (0.1, 0.5, 1)),), placement((-1.0, y, 0.5)), mass=0)
    before = kernel.now()
    robot.drive(placement((-2.2, 0.0, 0.0)))
    assert robot.machine.placement.position[:2] == pytest.approx((-2.2, 0.0), abs=0.01)
    assert kernel.now() - before > 2.2 / 0.5 + 1


def test_a_base_that_would_touch_something_or_finds_no_way_stays(robot):
    with pytest.raises(Blocked) as caught:
        robot.drive(placement((0.6, 0.3, 0)))
    assert [thing.name for thing in caught.value.things] == ["block"]
    for number, (x, y, turn) in enumerate([(-3.5, 0, 0), (-5.5, 0, 0), (-4.5, 1, np.pi / 2), (-4.5, -1, np.pi / 2)]):
        robot.world.add_item(number, (Shape("box", (0.1, 2.1, 1)),), placement((x, y, 0.5), turned(0, 0, turn)), mass=0)
    with pytest.raises(NoWay, match="no way for the base"):
        robot.drive(placement((-4.5, 0, 0)))
    assert robot.machine.placement.position[:2] == pytest.approx((0, 0), abs=1e-3)


def test_a_place_out_of_reach_is_told(robot):
    with pytest.raises(OutOfReach, match="left"):
        robot.move_tools({"left": placement((3, 0, 1))})


def test_without_the_arm_being_told_about_a_wall_it_goes_around(robot):
    goal = placement((0.75, 0.25, 1.0))
    robot.world.remove("bottle")
    robot.move_tools({"left": goal})
    assert np.linalg.norm(robot._tool("left").position - goal.position) < 0.02


# ----------------------------------------------------------------------------------------------------------------------- hands


def test_friction_holds_a_bottle(robot):
    grasp, gripped = take(robot)
    assert [thing.name for thing in gripped] == ["bottle"]
    before = height(robot.world)
    robot.move_tools({"left": grasp.moved(z=0.15)}, lenient=True)
    robot.move_joints("left", CARRYING["left"])
    robot.drive(placement((-0.5, 0, 0), turned(0, 0, 1.5)))
    assert height(robot.world) > before + 0.1
    robot.open_gripper("left")
    robot.world.simulate(3)
    assert height(robot.world) < 0.2  # nothing else held it


@pytest.mark.parametrize("arm_is", ["parked", "stretched aside"])
def test_a_hand_that_is_around_something_leaves_it_standing(robot, arm_is, monkeypatch):
    """Where no way around is found, it is drawn back first, though nobody has asked for a pose from which it is free."""
    monkeypatch.setattr(arm_ways, "_MOST_BRANCHES", 0)
    at = robot.world.item("bottle").placement
    robot.open_gripper("left")
    grasp = placement(at.position).moved(x=0.02, z=0.005)
    robot.move_tools({"left": grasp.moved(x=-0.15)})
    robot.move_tools({"left": grasp}, lenient=True)
    joints = {"parked": CARRYING["left"], "stretched aside": (1.6, 0.2, 1.5, -0.3, 0.0, -0.2, 0.0)}[arm_is]
    robot.move_joints("left", joints)
    assert robot.world.item("bottle").placement.near(at, 0.02, 0.1)


def test_a_hand_goes_on_gripping_when_things_come_and_joints_are_put(robot):
    grasp, _ = take(robot)
    robot.move_tools({"left": grasp.moved(z=0.1)}, lenient=True)
    before = height(robot.world)
    robot.world.add_item("cube", CUBE, placement((3, 3, 0.5)))
    robot.world.bend("pr2", {"head_pan_joint": 0.3})
    kernel.sleep(3)
    assert height(robot.world) == pytest.approx(before, abs=0.01)


def test_what_is_too_heavy_slips(robot):
    robot.world.item("bottle").mass = 9.0
    robot.world._rebuild()
    grasp, _ = take(robot, newtons=15.0)
    with pytest.raises(Slipped, match="bottle slipped out of the left hand"):
        robot.move_tools({"left": grasp.moved(z=0.2)}, lenient=True)
    assert robot.machine.holds == {} and height(robot.world) < 1.0


def test_fingers_that_close_on_nothing_say_so(robot):
    robot.open_gripper("left")
    with pytest.raises(NothingGripped):
        robot.grip("left")
    assert robot.machine.joint("l_gripper_l_finger_joint") == pytest.approx(0, abs=0.01)


# ---------------------------------------------------------------------------------------------------------------------- copies


def test_a_copy_is_kinematic_and_what_is_held_goes_with_it(robot):
    grasp, _ = take(robot)
    robot.move_tools({"left": grasp.moved(z=0.1)}, lenient=True)
    copy = robot.world.copy()
    assert type(copy) is World
    before = height(copy)
    copy.bend("pr2", {"torso_lift_joint": 0.15})
    assert height(copy) == pytest.approx(before - 0.1, abs=0.005)
    assert height(robot.world) == pytest.approx(before, abs=1e-6)


# ---------------------------------------------------------------------------------------------------------------- trajectories


@pytest.mark.parametrize(
    "postures", [[[0.0, 0.0], [1.0, -0.2]], [[0.0, 0.0], [0.5, 0.1], [0.5, 0.1], [-1.0, 2.0]], [[0.3, 0.1], [0.301, 0.1]]]
)
def test_joints_go_softly_from_posture_to_posture_and_none_is_too_fast(postures):
    speeds, step = np.array([0.5, 2.0]), 0.008
    trajectory = Trajectory(("a", "b"), [np.array(posture) for posture in postures], speeds)
    way = [np.array(postures[0])]
    while not trajectory.done:
        way.append(trajectory.after(step))
        assert trajectory.passed == pytest.approx(min(step * (len(way) - 1), trajectory.seconds))
    assert len(way) == pytest.approx(trajectory.seconds / step, abs=2) and np.array_equal(way[-1], postures[-1])
    assert np.array_equal(trajectory.after(step), postures[-1])  # it stays there
    moved = np.abs(np.diff(way, axis=0)) / step / speeds
    assert moved.max() <= 1 + 1e-9 and moved[0].max() < 0.3 and moved[-1].max() < 0.3
    for posture in postures:
        assert np.abs(np.array(way) - posture).max(axis=1).min() < 0.02


def test_a_way_of_no_length_is_done_at_once():
    trajectory = Trajectory(("a",), [np.array([0.4]), np.array([0.4])], np.array([1.0]))
    assert trajectory.done and trajectory.after(0.008)[0] == 0.4
