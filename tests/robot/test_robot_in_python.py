"""The robot as a Python library: worlds, actions, their failures, and what is tried when one of them fails."""

import subprocess
import sys

import pytest

from cramhy_runtime import cpl, kernel

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy import robot  # noqa: E402  it starts a kernel, which must not be there when nothing can be tested

CUP, SPOON, MILK = (1.45, 0.6, 0.9), (1.42, 0.9, 0.87), (1.45, 0.25, 0.95)
TABLE = robot.at(-0.95, 1.5, 0.9, yaw=180)


@pytest.fixture
def kitchen(session):
    made = robot.world()
    made.spawn("cup", CUP)
    made.settle()
    return made


def at_the_cup():
    robot.lift(0.3)
    robot.park()
    robot.go(robot.at(0.8, 0.6))
    robot.look(CUP)
    return robot.detect("cup")


def test_a_world_begins_with_kitchen_and_robot(kitchen):
    assert [thing.name.name for thing in kitchen.core.things.values()][:2] == ["FLOOR", "KITCHEN"]
    assert kitchen.place() == (0.0, 0.0, 0.0) and kitchen.yaw() == 0.0
    assert kitchen.names() == ["cup-1"] and kitchen.picture() == {"cup-1": (1.45, 0.6, 0.896)}
    assert kitchen.touching("cup-1") == ["kitchen"] and kitchen.held() == {}


def test_objects_come_go_and_are_moved(kitchen):
    assert [kitchen.spawn("cup", (1.45, 1.0, 0.9)), kitchen.spawn("milk", MILK, name="full-milk")] == ["cup-2", "full-milk"]
    kitchen.move("cup-2", robot.at(1.5, 1.0, 0.9, yaw=90))
    assert kitchen.place("cup-2") == (1.5, 1.0, 0.9) and round(kitchen.yaw("cup-2")) == 90
    kitchen.remove("cup-1")
    assert kitchen.names() == ["cup-2", "full-milk"]


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("wrong", "error", "text"),
    [
        (lambda kitchen: kitchen.spawn("car", CUP), Exception, "there is no model of the object car"),
        (lambda kitchen: kitchen.spawn("cup", CUP, name="cup-1"), ValueError, "There is a thing named cup-1 already"),
        (lambda kitchen: kitchen.spawn("cup", "here"), TypeError, "A place is robot.at"),
        (lambda kitchen: kitchen.move("cup-7", CUP), KeyError, "There is nothing named cup-7; there are cup-1"),
        (lambda kitchen: robot.go(None), TypeError, "A place is robot.at"),
        (lambda kitchen: robot.pick_up("cup"), TypeError, "An object that was detected is expected"),
        (lambda kitchen: robot.world("cram_porter_description"), ValueError, "This image has the robot PR2 already"),
    ],
)
def test_what_is_asked_wrongly_is_told(kitchen, wrong, error, text):
    with pytest.raises(error, match=text):
        wrong(kitchen)
    assert kitchen.names() == ["cup-1"]


def test_a_cup_is_carried_to_the_table(kitchen):
    @robot.run
    def found():
        cup = robot.pick_up(at_the_cup(), arm="left", grasp="left-side")
        held = kitchen.held()
        robot.go(robot.at(-0.3, 1.5, yaw=180))
        robot.place(cup, TABLE)
        return held, cup["name"].name

    assert found == ({"cup-1": "left"}, "CUP-1")
    kitchen.settle()
    assert kitchen.place("cup-1") == (-0.95, 1.5, 0.9) and kitchen.held() == {}


@pytest.mark.soak
def test_without_arm_and_grasp_rules_choose(kitchen):
    robot.pick_up(at_the_cup())
    assert list(kitchen.held()) == ["cup-1"]


def test_functions_are_plans_of_their_own(kitchen):
    robot.go(robot.at(0.8, 0.6, yaw=10))
    assert kitchen.place() == (0.8, 0.6, 0.0) and round(kitchen.yaw()) == 10


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("plan", "failure", "text"),
    [
        (lambda: robot.go(robot.at(1.5, 0.6)), "NavigationPoseUnreachable", "would touch KITCHEN"),
        (lambda: robot.detect("milk"), "PerceptionObjectNotFound", "Could not find object"),
        (lambda: robot.lift(2.0), "TorsoGoalNotReached", "out of joint limits"),
        (lambda: robot.look((0.01, 0.0, 0.0)), "PtuGoalNotReached", "twist the neck"),
        (lambda: robot.pick_up(at_the_cup(), arm="right", grasp="front"), "ManipulationPoseUnreachable", "unreachable"),
        (lambda: robot.transport("milk", MILK, TABLE), "ObjectNowhereToBeFound", r"No milk was seen from \d+ places"),
        (lambda: robot.transport("cup", CUP, (1.45, 0.6, 3.0)), "ObjectUndeliverable", r"Nothing could be put at \(1.45, 0.6, 3\)"),
    ],
)
def test_failures_are_those_of_cram(kitchen, plan, failure, text):
    with pytest.raises(getattr(robot.failures, failure), match=text) as caught:
        plan()
    assert isinstance(caught.value, cpl.SimplePlanFailure)


def test_what_slips_away_closes_the_gripper_completely(kitchen):
    def plan():
        cup = at_the_cup()
        kitchen.move("cup-1", (1.45, 1.1, 0.9))  # somebody takes it away
        robot.pick_up(cup, arm="left", grasp="left-side")

    with pytest.raises(robot.failures.GripperClosedCompletely):
        robot.run(plan)
    assert kitchen.held() == {}


def test_a_plan_copes_with_failures(kitchen):
    spots = iter(((1.45, 1.5, 0.9), CUP))
    robot.go(robot.at(0.8, 0.6))

    def plan():
        for attempt in cpl.attempts(2, on=robot.failures.PerceptionObjectNotFound):
            with attempt:
                robot.look(next(spots))
                return robot.detect("cup")["name"].name

    assert robot.run(plan) == "CUP-1"


@pytest.mark.soak
def test_transporting_chooses_places_arms_and_grasps(kitchen):
    kitchen.spawn("spoon", SPOON)
    kitchen.settle()
    for kind, place, z in (("cup", CUP, 0.9), ("spoon", SPOON, 0.865)):
        thing = robot.transport(kind, place, robot.at(-0.95, 1.2 if kind == "cup" else 1.5, z, yaw=180))
        assert robot.ways_to_hold(thing)
    assert kitchen.picture() == {"cup-1": (-0.95, 1.2, 0.9), "spoon-1": (-0.95, 1.5, 0.864)}


def test_places_to_stand_are_free_and_turned_to_the_target(kitchen):
    places = list(robot.standing_places(CUP))
    assert places and places[0].origin.x == pytest.approx(0.8) and places[0].origin.y == pytest.approx(0.6)
    assert all(place.origin.x < 1.0 for place in places), "the others are in the wall"
    assert kitchen.place() == (0.0, 0.0, 0.0)


@pytest.mark.soak
def test_without_the_extra_one_line_names_it():
    code = "import sys; sys.modules['mujoco'] = None\nfrom cramhy import robot\nrobot.world()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode and "cramhy" in done.stderr and "robot" in done.stderr
    assert "Robot worlds need MuJoCo, which is not installed" in done.stderr.splitlines()[-1]


def test_another_mode_is_told():
    with pytest.raises(ValueError, match="The mode of a world is 'kinematic' or 'physical', not 'dreamt'"):
        robot.world(mode="dreamt")


@pytest.mark.soak
def test_in_a_physical_world_time_passes_and_friction_holds(session):
    made = robot.world(mode="physical")
    made.spawn("bottle", (1.45, 0.6, 0.96))
    made.settle(3)
    before = kernel.now()

    @robot.run
    def plan():
        robot.go(robot.at(0.7, 0.6))
        robot.look((1.45, 0.6, 0.95))
        bottle = robot.pick_up(robot.detect("bottle"))
        held = made.held(), made.place("bottle-1")
        robot.place(bottle, (1.45, 0.9, 0.96))
        return held

    (held, there), seconds = plan, kernel.now() - before
    assert list(held) == ["bottle-1"] and there[2] > 0.97 and made.held() == {}
    assert made.place("bottle-1") == pytest.approx((1.45, 0.9, 0.95), abs=0.04)
    assert 10 < seconds < 90
    assert robot.world().core.copy().__class__ is made.core.copy().__class__
