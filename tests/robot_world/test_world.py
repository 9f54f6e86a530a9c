"""The world: what is let go falls, what is held goes along, and a copy goes its own way."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")

from cramhy_runtime.robot_world import scene, vision
from cramhy_runtime.robot_world.descriptions import Frame, Shape, turned
from cramhy_runtime.robot_world.placements import Placement, of_pose, placement
from cramhy_runtime.robot_world.world import World, WorldError

BOTTLE = (Shape("cylinder", (0.0357, 0.1814), Frame((0.0, 0.0, -0.01))),)
BOX = (Shape("box", (0.1, 0.1, 0.2)),)
TABLE, ISLAND = (-2.0, -0.9, 0.86), (-0.8, 2.0, 0.9)


def test_bottles_drop_onto_table_and_island(world):
    world.add_item("on-table", BOTTLE, placement(TABLE))
    world.add_item("in-island", BOTTLE, placement(ISLAND))  # its bottom begins 6 cm inside, as in the tutorials
    world.simulate(100)
    assert world.item("on-table").placement.position == pytest.approx((-2.0, -0.9, 0.823), abs=2e-3)
    assert world.item("in-island").placement.position == pytest.approx((-0.8, 2.0, 0.959), abs=2e-3)
    assert [thing.name for thing in world.touching("on-table")] == ["kitchen"]
    assert world.stable("on-table")


def test_what_nothing_holds_up_falls_to_the_floor(world):
    world.add_item("bottle", BOTTLE, placement((-2.0, 0.0, 1.0)))
    assert not world.stable("bottle")
    world.simulate(10)
    lowest, _ = world.bounds("bottle")
    assert lowest[2] == pytest.approx(0.0, abs=2e-3)
    assert world.contacts("bottle")[0][1] is None


CARTON = (Shape("box", (0.06, 0.14, 0.22)),)
ON_COUNTER = 0.855  # metres


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    "places",
    [
        [(1.4, 0.8), (1.4, 0.8)],
        [(1.4, 0.8), (1.42, 0.85)],
        [(1.4, 0.8), (1.4, 0.8), (1.4, 0.8)],
        [(1.29, 0.8), (1.3, 0.8)],
        [(1.3, 0.8), (1.29, 0.8)],
    ],
    ids=["at one place", "half inside", "three", "the first at the edge", "the second at the edge"],
)
def test_items_that_are_inside_of_each_other_are_parted_and_none_falls(world, places):
    for number, (x, y) in enumerate(places):
        world.add_item(number, CARTON, placement((x, y, ON_COUNTER + 0.11)))
    world.simulate(10)
    for number, (x, y) in enumerate(places):
        now = world.item(number).placement
        assert now.position[2] == pytest.approx(ON_COUNTER + 0.11, abs=0.01)
        assert np.hypot(*(now.position[:2] - (x, y))) < 0.2
        assert 2 * (now.rotation[1] ** 2 + now.rotation[2] ** 2) < 0.01  # upright
    assert np.allclose(world.item(0).placement.position[:2], places[0], atol=2e-3)  # it was there first
    assert not any(isinstance(thing, type(world.item(0))) for number in range(len(places)) for thing in world.touching(number))


SHELF, BOARD_TOP = (-2.0, 1.0), 0.51  # a board with a low wall along y


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("shape", [CARTON, BOTTLE], ids=["a carton", "a bottle"])
@pytest.mark.parametrize(
    "into_wall, into_board, aside, raised",
    [(0.02, 0.0, 0.03, 0.01), (0.028, 0.0, 0.04, 0.01), (0.0, 0.03, 0.002, 0.0), (0.02, 0.01, 0.03, 0.0), (0.0, 0.0, 0.002, 0.01)],
    ids=["in the wall", "nearly its middle in the wall", "in the board", "in both", "in neither"],
)
def test_an_item_that_is_in_a_low_wall_is_put_beside_it_and_stands(world, shape, into_wall, into_board, aside, raised):
    """As what a hand lets go in a tray or a drawer: raised to the top of the wall, it would topple, and fall out of the drawer.

    An item whose middle is over the wall is raised as before.
    """
    world.add_item("board", (Shape("box", (0.3, 0.3, 0.02)),), placement((*SHELF, BOARD_TOP - 0.01)), mass=0)
    world.add_item("wall", (Shape("box", (0.02, 0.3, 0.1)),), placement((SHELF[0] + 0.14, SHELF[1], BOARD_TOP + 0.05)), mass=0)
    width, low = (0.06, 0.11) if shape is CARTON else (0.0714, 0.1007)
    before = placement((SHELF[0] + 0.13 - width / 2 + into_wall, SHELF[1], BOARD_TOP + low - into_board + raised))
    world.add_item("thing", shape, before)
    world.simulate(10)
    now = world.item("thing").placement
    assert 2 * (now.rotation[1] ** 2 + now.rotation[2] ** 2) < 0.01  # upright
    assert now.position[2] == pytest.approx(BOARD_TOP + low, abs=5e-3)
    assert np.hypot(*(now.position[:2] - before.position[:2])) < aside and abs(now.position[1] - SHELF[1]) < 0.02
    assert not world.stuck


def test_what_lies_on_something_stays_on_it(world):
    world.add_item("below", CARTON, placement((1.4, 0.8, ON_COUNTER + 0.11)))
    world.add_item("above", BOTTLE, placement((1.4, 0.8, ON_COUNTER + 0.22 + 0.1)))
    world.simulate(10)
    assert np.allclose(world.item("above").placement.position[:2], (1.4, 0.8), atol=2e-3)


def test_what_cannot_be_parted_where_it_stands_is_left_to_the_physics(world):
    """Over the floor of a pit there is no room for a second one; both are free to fall."""
    world.add_item("post", (Shape("box", (0.05, 0.05, 0.8)),), placement((-2.0, 1.0, 0.4)), mass=0)
    for name in ("one", "other"):
        world.add_item(name, (Shape("box", (0.3, 0.3, 0.1)),), placement((-2.0, 1.0, 0.86)))
    world.simulate(10)
    assert not world.stuck


def test_a_thing_without_mass_hangs_where_it_is(world):
    world.add_item("sign", BOX, placement((-2.0, 0.0, 1.0)), mass=0)
    world.simulate(10)
    assert world.item("sign").placement.position == pytest.approx((-2.0, 0.0, 1.0))


def test_what_is_held_goes_along_and_falls_when_it_is_let_go(world):
    hand = "r_wrist_roll_link"
    world.add_item("bottle", BOTTLE, world.link("pr2", hand).moved(0.2))
    world.attach("pr2", "bottle", hand)
    before = world.link("pr2", hand).inverse() @ world.item("bottle").placement
    for change in (
        lambda: world.put("pr2", placement((-0.5, 0.5, 0.0), turned(0, 0, 1.0))),
        lambda: world.bend("pr2", {"torso_lift_joint": 0.3}),
        lambda: world.bend("pr2", {"r_shoulder_pan_joint": -0.7, "r_elbow_flex_joint": -1.0}),
        lambda: world.simulate(5),
    ):
        change()
        assert (world.link("pr2", hand).inverse() @ world.item("bottle").placement).near(before, 1e-9, 1e-6)
    assert world.holders("bottle") == [(world.machine("pr2"), hand)]
    world.detach("pr2", "bottle")
    height = world.item("bottle").placement.position[2]
    world.simulate(10)
    assert world.item("bottle").placement.position[2] < height - 0.3
    assert world.holders("bottle") == []


@pytest.mark.parametrize("without", [None, "pr2"])
def test_a_hand_that_has_let_go_does_not_push(world, without):
    """As a bowl whose rim is between the fingers: they are inside of its shape, and would throw it aside."""
    place = placement((-1.1, 1.5, 0.92))
    world.add_item("bowl", (Shape("cylinder", (0.07, 0.067)),), place)
    hand = world.link("pr2", "r_gripper_tool_frame").position
    world.put("pr2", placement(np.array(place.position) - hand + (0.07, 0.0, 0.0)))
    world.simulate(2, without=without)
    stays = np.allclose(world.item("bowl").placement.position, (-1.1, 1.5, 0.8915), atol=2e-3)
    assert stays == (without == "pr2")


def test_an_item_between_fingers_that_let_go_falls_straight_until_they_are_away(world):
    """As a bowl whose rim a hand has held: the fingers would throw it away. A hand that is beside it later is a hand again."""
    hand = world.link("pr2", "r_gripper_palm_link")
    world.add_item("bowl", BOX, Placement(hand.position, np.array((1.0, 0.0, 0.0, 0.0))))
    world.attach("pr2", "bowl", "r_wrist_roll_link")
    world.detach("pr2", "bowl")
    before = world.item("bowl").placement
    ahead = world.copy()
    for seen in (world, ahead):
        seen.simulate(10)
        now = seen.item("bowl").placement
        assert now.position[:2] == pytest.approx(before.position[:2], abs=5e-3)
        assert now.position[2] == pytest.approx(0.1, abs=5e-3) and now.near(Placement(now.position, before.rotation), 1, 0.05)
    world.put("bowl", Placement(hand.position + (0, 0, 0.2), before.rotation))
    world.simulate(10)
    assert world.item("bowl").placement.position[2] > 0.3  # it lies on the arm, or fell off it to the floor on a side


def test_lengths_are_those_of_the_box_around_a_copy_that_is_turned(world):
    world.add_item("bottle", BOTTLE, placement((1.0, 2.0, 0.5), (0.5, 0.1, -0.7, 0.2)))
    turns = [placement(rotation=turn).rotation for turn in ((1, 0, 0, 0), (0.7, 0.7, 0, 0), (0.3, -0.2, 0.8, 0.1))]
    links = [name for name, link in world.machine("kitchen").description.links.items() if link.shapes]
    for turn in turns:
        for thing, link in [("bottle", None), ("pr2", None), *(("kitchen", name) for name in links[::7])]:
            copied = world.copy()
            whole = copied.thing(thing).placement
            part = whole if link is None else copied.link(thing, link)
            copied.put(thing, Placement(np.zeros(3), turn) @ (part.inverse() @ whole))
            lowest, highest = copied.bounds(thing, link)
            assert world.lengths(thing, link, turn) == pytest.approx(highest - lowest, abs=1e-9)


def test_the_firm_grip_decides_where_an_item_goes(world):
    right, left = "r_wrist_roll_link", "l_wrist_roll_link"
    world.add_item("tray", BOX, world.link("pr2", right).moved(0.2))
    world.attach("pr2", "tray", right)
    world.attach("pr2", "tray", left, loose=True)
    before = world.link("pr2", right).inverse() @ world.item("tray").placement
    world.bend("pr2", {"l_elbow_flex_joint": -1.5})
    assert (world.link("pr2", right).inverse() @ world.item("tray").placement).near(before, 1e-9, 1e-6)
    world.detach("pr2", "tray", right)
    assert world.holders("tray") == [(world.machine("pr2"), left)]


def test_robots_touch_furniture_but_neither_floor_nor_themselves(world):
    world.put("pr2", placement((0.0, 0.5, 0.0)))
    assert world.contacts("pr2") == []
    world.put("pr2", placement((-0.8, 2.0, 0.0)))
    assert {other.thing.name for _, other in world.contacts("pr2")} == {"kitchen"}


def test_robots_touch_no_plane_while_items_do(world):
    """In CRAM a plane has the mask of items only, so that a robot whose lowest link ends on the floor is not in collision."""
    world.add_item("ground", (Shape("plane", ()),), placement(), mass=0)
    world.add_item("bottle", BOTTLE, placement((3.0, 3.0, 0.05)))
    for height in (0.0, -0.02, 0.5):
        world.put("pr2", placement((0.0, 0.5, height)))
        assert world.contacts("pr2") == []
    world.put("pr2", placement((0.0, 0.5, -0.02)))
    assert [{part.thing.name for part in pair} for pair in world.contacts("ground")] == [{"ground", "bottle"}]
    world.put("bottle", placement((0.0, 0.5, 0.1)))
    assert {other.thing.name for _, other in world.contacts("pr2")} == {"bottle"}


def test_a_copy_goes_its_own_way(world):
    world.add_item("bottle", BOTTLE, placement(TABLE))
    world.attach("pr2", "bottle", "r_wrist_roll_link")
    copied = world.copy()
    copied.detach("pr2", "bottle")
    copied.put("bottle", placement((0.0, 0.0, 1.0)))
    copied.bend("pr2", {"torso_lift_joint": 0.3})
    copied.remove("kitchen")
    assert world.item("bottle").placement.position == pytest.approx(TABLE)
    assert world.machine("pr2").joint("torso_lift_joint") == 0.0
    assert world.holders("bottle")
    assert "kitchen" in world.things


def test_a_copy_sees_with_a_model_that_is_there_but_where_its_own_things_are(world):
    world.add_item("bottle", BOTTLE, placement(TABLE))
    world.simulate(5)
    contacts = [part.thing.name for part, _ in world.contacts()]
    copied = world.copy()
    assert copied.scene.model is world.scene.model
    assert [part.thing.name for part, _ in copied.contacts()] == contacts
    copied.put("bottle", placement((-2.0, -0.9, 1.5)))
    assert copied.touching("bottle") == [] and [thing.name for thing in world.touching("bottle")] == ["kitchen"]
    assert all(part.thing.world is copied for part in copied.scene.parts)
    copied.attach("pr2", "bottle", "r_wrist_roll_link")
    copied.simulate(5)
    assert copied.item("bottle").placement.position[2] == 1.5 and copied.scene.model is not world.scene.model


def test_a_copy_makes_nothing_for_mujoco_until_it_is_asked(world, monkeypatch):
    world.add_item("bottle", BOTTLE, placement(TABLE))
    world.contacts()
    made = []
    monkeypatch.setattr(scene.Scene, "of_copies", lambda self, copies, old=scene.Scene.of_copies: made.append("data") or old(self, copies))
    monkeypatch.setattr(scene.Scene, "_find_parts", lambda self, old=scene.Scene._find_parts: made.append("model") or old(self))
    copied = world.copy()
    again = copied.copy()
    without = world.copy()
    without.remove("bottle")
    assert made == []
    again.contacts()
    assert made == ["data"]  # a copy of a copy has the model of the first world
    without.contacts()
    assert made == ["data", "model"]


def test_the_same_falls_are_the_same_to_the_bit(world):
    world.add_item("bottle", BOTTLE, placement(TABLE, turned(0.3, 0.2, 0.1)))
    other = world.copy()
    world.simulate(5)
    other.simulate(5)
    assert (world.item("bottle").placement.position == other.item("bottle").placement.position).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda w: w.add_item("kitchen", BOX), 'a thing named "kitchen" already'),
        (lambda w: w.add_item("floor", BOX), 'a thing named "floor" already'),
        (lambda w: w.put("cup", placement()), 'no thing named "cup"; there are "kitchen", "pr2"'),
        (lambda w: w.item("pr2"), "has joints"),
        (lambda w: w.bend("pr2", {"tail_joint": 1.0}), "no joint tail_joint"),
        (lambda w: w.link("pr2", "tail_link"), "no link tail_link"),
        (lambda w: w.remove("cup"), "no thing named"),
        (lambda w: w.attach("pr2", "kitchen", "r_wrist_roll_link"), "an item was expected"),
    ],
)
def test_what_the_world_cannot_do_says_why(world, call, message):
    with pytest.raises(WorldError, match=message):
        call(world)


# ------------------------------------------------------------------------------------------------------------------ the camera

CAMERA = placement((0.0, 0.0, 1.0), (0.5, -0.5, 0.5, -0.5))  # looks along the x axis of the world


def scenery(*others):
    world = World()
    world.add_item("box", BOX, placement((2.0, 0.0, 1.0)), mass=0)
    for number, place in enumerate(others):
        world.add_item(f"other {number}", BOX, placement(place), mass=0)
    return world


@pytest.mark.parametrize(
    ("others", "part", "hiding"),
    [
        ([], 1.0, []),
        ([(1.0, 0.0, 1.0)], 0.0, ["other 0"]),
        ([(1.0, 0.05, 1.0)], 0.5, ["other 0"]),
        ([(3.0, 0.0, 1.0)], 1.0, []),
        ([(1.0, 0.5, 1.0)], 1.0, []),
    ],
)
def test_what_stands_before_an_item_hides_it(others, part, hiding):
    world = scenery(*others)
    seen, hidden_by = vision.seen(world.scene, CAMERA, world.item("box"))
    assert seen == pytest.approx(part, abs=0.08)
    assert [thing.name for thing in hidden_by] == hiding


@pytest.mark.parametrize("place", [(-2.0, 0.0, 1.0), (2.0, 2.0, 1.0), (2.0, 0.0, 2.5), (12.0, 0.0, 1.0)])
def test_what_is_not_in_the_picture_is_not_seen(place):
    world = scenery()
    world.put("box", placement(place))
    assert vision.seen(world.scene, CAMERA, world.item("box")) == (0.0, [])


# ------------------------------------------------------------------------------------------------------------------ placements

numbers = st.floats(-5, 5)
turns = st.builds(turned, st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3))
placements = st.builds(placement, st.tuples(numbers, numbers, numbers), turns)


@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.too_slow])  # the first call is slow where the machine is busy
@given(placements, placements)
def test_placements_multiply_as_transforms_do(one, other):
    assert (one @ one.inverse()).near(placement(), 1e-9, 1e-6)
    assert ((one @ other).inverse()).near(other.inverse() @ one.inverse(), 1e-9, 1e-6)
    assert of_pose(one.pose()).near(one, 1e-9, 1e-6)


def test_a_rotation_without_length_is_refused():
    with pytest.raises(ValueError, match="has none"):
        placement((0, 0, 0), (0, 0, 0, 0))
    assert isinstance(placement((0, 0, 0), (2, 0, 0, 0)), Placement)
    assert np.linalg.norm(placement((0, 0, 0), (2, 0, 0, 1)).rotation) == pytest.approx(1.0)
