"""Forward kinematics give the recorded poses of the PR2 and the kitchen; inverse kinematics are their inverse."""

import json

import numpy as np
import pytest
from make_descriptions import FIGURES

from cramhy_runtime.robot_world.descriptions import Description, Joint, Link
from cramhy_runtime.robot_world.inverse_kinematics import PRECISION, Reach
from cramhy_runtime.robot_world.placements import Placement, placement
from cramhy_runtime.robot_world.skeleton import Skeleton

ROUNDING = 0.5e-4 + 1e-6  # the figures have four decimals


@pytest.fixture(scope="module")
def figures():
    if not FIGURES.is_dir():
        pytest.skip("needs ../shared/robots")
    return {name: json.loads((FIGURES / f"{name}.json").read_text()) for name in ("pr2", "kitchen")}


def states(figures):
    constants = figures["pr2"]["constants"]
    parking = {**constants["parking_joint_states"]["left"], **constants["parking_joint_states"]["right"]}
    carrying = {**constants["carrying_joint_states"]["left"], **constants["carrying_joint_states"]["right"]}
    return {
        "zero joints": {},
        "parking joint states, torso 0": parking,
        "state after setup-world-database (parking, torso 0.15)": {**parking, "torso_lift_joint": 0.15},
        "carrying joint states (park-arms default), torso 0.3": {**carrying, "torso_lift_joint": 0.3},
        "head pan 0.5 tilt 0.6 torso 0": {"head_pan_joint": 0.5, "head_tilt_joint": 0.6},
    }


def test_the_links_of_the_pr2_are_where_the_figures_say(pr2, figures):
    looked = 0
    for label, joints in states(figures).items():
        for link, wanted in figures["pr2"]["checks"][label].items():
            position, (w, x, y, z) = pr2.pose(pr2.positions(joints), link)
            turn = np.array([x, y, z, w])
            sign = 1.0 if turn @ wanted["quat_xyzw"] > 0 else -1.0
            assert np.abs(position - wanted["xyz"]).max() < ROUNDING, (label, link)
            assert np.abs(sign * turn - wanted["quat_xyzw"]).max() < ROUNDING, (label, link)
            looked += 1
    assert looked > 18


def test_handles_of_the_kitchen_move_with_doors_and_drawers(kitchen, figures):
    for label, wanted in figures["kitchen"]["checks"].items():
        if "fridge" in label:
            joints, link = {"iai_fridge_door_joint": float(label.split()[-1])}, "iai_fridge_door_handle"
        else:
            value = 0.0 if label.endswith("closed") else float(label.split()[-1])
            joints, link = {"sink_area_left_upper_drawer_main_joint": value}, "sink_area_left_upper_drawer_handle"
        assert np.abs(kitchen.pose(kitchen.positions(joints), link)[0] - wanted).max() < 6e-3, label


def test_a_root_that_stands_elsewhere_takes_all_links_with_it(pr2):
    joints = pr2.positions({"torso_lift_joint": 0.2})
    root = placement((1.0, -2.0, 0.0), (0.6, 0.0, 0.0, 0.8))
    positions, rotations = pr2.placed(root, joints)
    for link, number in pr2.links.items():
        wanted = root @ Placement(*pr2.pose(joints, link))
        assert wanted.near(Placement(positions[number], rotations[number]), 1e-9, 1e-6), link


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_arms_reach_what_they_can_reach(pr2, side):
    reach = Reach(pr2.description, "torso_lift_link", f"{side}_wrist_roll_link")
    chain, draw, found = reach.skeleton, np.random.default_rng(7), 0
    low = np.where(np.isfinite(chain.lower), chain.lower, -np.pi)
    high = np.where(np.isfinite(chain.upper), chain.upper, np.pi)
    for _ in range(60):
        position, rotation = chain.pose(draw.uniform(low, high), reach.tip)
        answer = reach.solve(position, rotation)
        if answer is not None:
            found += 1
            assert (answer >= chain.lower).all()
            assert (answer <= chain.upper).all()
            assert Placement(*chain.pose(answer, reach.tip)).near(Placement(position, rotation), PRECISION, 3 * PRECISION)
    assert found >= 58


def test_the_same_question_has_the_same_answer(pr2):
    goal = np.array([0.6, -0.2, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])
    first, second = (Reach(pr2.description, "torso_lift_link", "r_wrist_roll_link").solve(*goal) for _ in range(2))
    assert first is not None
    assert (first == second).all()


def test_what_is_beyond_the_arm_is_not_reached(pr2):
    reach = Reach(pr2.description, "torso_lift_link", "r_wrist_roll_link")
    assert reach.solve(np.array([1.5, 0.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])) is None
    assert reach.solve(np.array([-0.2, 0.5, 0.3]), np.array([0.0, 0.0, 0.0, 1.0])) is None


def test_an_arm_of_sliding_joints_is_solved_too():
    links = {name: Link(name) for name in ("base", "x", "y", "z")}
    axes = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
    joints = {
        f"slide_{child}": Joint(f"slide_{child}", "prismatic", parent, child, axis=axes[child], lower=-2.0, upper=2.0)
        for parent, child in (("base", "x"), ("x", "y"), ("y", "z"))
    }
    reach = Reach(Description("gantry", links, joints), "base", "z")
    answer = reach.solve(np.array([1.0, -1.5, 0.5]), np.array([1.0, 0.0, 0.0, 0.0]))
    assert answer == pytest.approx([1.0, -1.5, 0.5], abs=1e-3)
    assert Skeleton(Description("gantry", links, joints)).pose(answer, "z")[0] == pytest.approx([1.0, -1.5, 0.5], abs=1e-3)
