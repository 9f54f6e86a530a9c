"""What is told of a robot's world: what it is made of, each motion, what the plan considers; and what a hand may do there."""

from __future__ import annotations

import json
from math import pi, sin

import pytest

pytest.importorskip("mujoco", reason="pip install 'cramhy[robot]'")

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import merge, robot_scene
from cramhy_runtime.robot_world import remarks, shown
from cramhy_runtime.robot_world.descriptions import Description, Frame, Joint, Link, Shape
from cramhy_runtime.robot_world.placements import placement
from cramhy_runtime.robot_world.world import World
from cramhy_runtime.ros.message_json import from_json, to_json
from cramhy_runtime.ros.messages import message_class_exact

TOPIC, TYPE = "/cramhy/robot_world", "cramhy_msgs/RobotWorld"


def robot():
    links = {
        "base": Link("base", (Shape("box", (0.4, 0.4, 0.4), Frame((0.0, 0.0, 0.2))),)),
        "arm": Link("arm", (Shape("box", (0.6, 0.05, 0.05), Frame((0.3, 0.0, 0.0))),)),
        "eye_optical_frame": Link("eye_optical_frame"),
    }
    joints = {
        "shoulder": Joint("shoulder", "revolute", "base", "arm", Frame((0.0, 0.0, 1.0)), (0.0, 0.0, 2.0), -2.0, 2.0),
        "neck": Joint("neck", "fixed", "base", "eye_optical_frame", Frame((0.0, 0.0, 1.5))),
    }
    return Description("robot", links, joints)


@pytest.fixture
def world(session):
    """A table with a bottle on it, beside a robot."""
    made = World()
    made.add_item("ground", [Shape("plane", ())], mass=0)
    made.add_item("table", [Shape("box", (1.0, 1.0, 0.5))], placement((0.0, 0.0, 0.25)), mass=0)
    made.add_item("bottle", [Shape("cylinder", (0.05, 0.2))], placement((0.0, 0.0, 0.6)), colour=(1.0, 0.0, 0.0, 1.0), types=("bottle",))
    made.add_machine("robot", robot(), placement((-1.5, 0.0, 0.0)))
    shown.show(made)
    yield made
    shown.show(None)


def told(looker):
    looker.chronicler.look()
    messages, looker.told["robots"] = looker.told["robots"], []
    return messages


def moves(message):
    return [{state.name: state for state in step.states} for step in message.steps]


def test_everything_is_told_first_and_then_each_motion(world, looker):
    (first,) = told(looker)
    things = {thing.name: thing for thing in first.things}
    assert first.complete is True and list(things) == ["ground", "table", "bottle", "robot"]
    assert [things[name].kind for name in things] == ["ground", "ground", "object", "robot"]
    assert things["bottle"].movable is True and things["table"].movable is not True and list(things["bottle"].types) == ["bottle"]
    shape = things["bottle"].links[0].shapes[0]
    assert (shape.kind, list(shape.size), list(shape.colour)) == ("cylinder", [0.05, 0.2], [1.0, 0.0, 0.0, 1.0])
    base, arm, eye = things["robot"].links
    assert (base.name, base.parent, base.joint) == ("base", -1, -1)
    assert (arm.name, arm.parent, arm.joint, list(arm.axis), list(arm.frame[:3])) == ("arm", 0, 0, [0.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    assert (eye.parent, eye.joint, list(things["robot"].cameras)) == (0, -1, ["eye_optical_frame"])
    assert list(moves(first)[0]["robot"].joints) == [0.0]
    assert told(looker) == []

    world.put("robot", placement((-1.0, 0.0, 0.0)))
    world.bend("robot", {"shoulder": 1.0})
    world.put("robot", placement((-1.0, 1.0, 0.0)))
    (message,) = told(looker)
    assert message.complete is not True and not message.things
    assert [(list(step["robot"].pose[:3]), list(step["robot"].joints)) for step in moves(message)] == [
        ([-1.0, 0.0, 0.0], [0.0]),
        ([-1.0, 0.0, 0.0], [1.0]),
        ([-1.0, 1.0, 0.0], [1.0]),
    ]
    assert [step.seconds for step in message.steps] == [0.5, 0.833, 1.0]


def test_what_is_held_goes_with_its_link_and_what_is_only_tried_is_not_told(world, looker):
    told(looker)
    world.attach("robot", "bottle", "arm")
    world.put("robot", placement((-1.0, 0.0, 0.0)))
    (step,) = moves(told(looker)[0])
    assert (step["bottle"].holder, step["bottle"].link, list(step["bottle"].grip[:3])) == ("robot", "arm", [1.5, 0.0, -0.4])
    with world.trial():
        world.put("robot", placement((9.0, 9.0, 0.0)))
        world.put("robot", placement((-1.0, 0.0, 0.0)))
    assert told(looker) == []


def test_things_come_and_go_and_another_world_is_told_from_the_beginning(world, looker):
    told(looker)
    world.add_item("cup", [Shape("sphere", (0.05,))], placement((0.3, 0.0, 0.55)))
    world.remove("bottle")
    (message,) = told(looker)
    assert ([thing.name for thing in message.things], list(message.removed)) == (["cup"], ["bottle"])
    world.add_item("bottle", [Shape("sphere", (0.1,))])
    told(looker)
    assert [thing.name for thing in looker.chronicler.state.messages()["robots"].things] == ["ground", "table", "robot", "cup", "bottle"]
    other = World()
    other.add_item("ball", [Shape("sphere", (0.05,))])
    shown.show(other)
    world.put("cup", placement())  # nobody sees it any more
    (message,) = told(looker)
    assert message.complete is True and [thing.name for thing in message.things] == ["ball"]
    shown.show(None)
    (message,) = told(looker)
    assert message.complete is True and not message.things


def test_what_the_plan_considers_is_told_to_those_who_look_on_only(world, looker):
    from cramhy_runtime.robot_world.costmaps.costmap import LocationCostmap

    told(looker)
    costmap = LocationCostmap(width=1.0, height=0.5, origin_x=-1.0, origin_y=2.0, resolution=0.25)
    costmap.register(lambda x, y: 1.0 if x > 0 else 0.5, 1)
    remarks.costmap(costmap)
    remarks.grasp(world.machine("robot"), placement((0.5, 0.0, 1.0)), False)
    remarks.seen("bottle", placement((0.1, 0.0, 0.6)))
    remarks.seen("nobody", placement())
    (message,) = told(looker)
    (marks,) = message.marks
    (map_,) = marks.costmap
    assert (map_.x, map_.y, map_.resolution, map_.columns * map_.rows) == (-1.0, 2.0, 0.25, len(map_.cells))
    assert max(map_.cells) == 255
    assert [(one.name, list(one.pose[:3]), one.good is True) for one in marks.grasps] == [("robot", [-1.0, 0.0, 1.0], False)]
    assert [(one.name, list(one.pose[:3])) for one in marks.seen] == [("bottle", [0.1, 0.0, 0.6])]
    remarks.seen("bottle", None)
    assert not told(looker)[0].marks[0].seen
    assert remarks.heard()
    looker.chronicler.close()
    assert not remarks.heard() and not shown._watchers
    remarks.seen("bottle", placement())  # nobody hears it, and it costs nothing


def test_messages_add_up_to_what_there_is_and_go_through_json(world, looker):
    sums, state = merge.CHANGES["robots"](), merge.State()
    for act in (
        lambda: None,
        lambda: world.put("bottle", placement((0.2, 0.0, 0.6))),
        lambda: world.bend("robot", {"shoulder": 0.5}),
        lambda: world.remove("table"),
        lambda: world.add_item("cup", [Shape("sphere", (0.05,))]),
    ):
        act()
        for message in told(looker):
            message = from_json(message_class_exact(TYPE), to_json(message))
            sums.add(message)
            state.add("robots", message)
    all_at_once, another = merge.State(), state.copy()
    all_at_once.add("robots", sums.message())
    assert to_json(all_at_once.messages()["robots"]) == to_json(state.messages()["robots"]) == to_json(another.messages()["robots"])
    assert sorted(state.sums["robots"].states) == ["bottle", "cup", "ground", "robot"]


def test_a_recording_shows_the_robot_in_foxglove_and_the_page_replays_it(world, session, tmp_path):
    pytest.importorskip("mcap")
    from mcap.reader import make_reader

    path = tmp_path / "run.mcap"
    with chronicle.record(path):
        kernel.sleep(1)
        world.put("robot", placement((-1.0, 0.0, 0.0)))
        world.bend("robot", {"shoulder": pi / 2})
        kernel.sleep(1)
        world.remove("bottle")
        kernel.sleep(1)
    with open(path, "rb") as file:
        drawn = [(channel.topic, json.loads(message.data)) for _, channel, message in make_reader(file).iter_messages()]
    scenes = [data for topic, data in drawn if topic == robot_scene.TOPIC]
    assert {entity["id"] for entity in scenes[0]["entities"]} == {"ground", "table", "bottle", "robot"}
    (robot_,) = scenes[1]["entities"]
    base, arm = robot_["cubes"]
    assert base["size"] == {"x": 0.4, "y": 0.4, "z": 0.4}
    assert arm["pose"]["position"] == pytest.approx({"x": -1.0, "y": 0.3, "z": 1.0}, abs=1e-4)
    assert [one["id"] for one in scenes[2]["deletions"]] == ["bottle"]
    frames = [data for topic, data in drawn if topic == robot_scene.FRAMES_TOPIC][-1]["transforms"]
    assert [(one["parent_frame_id"], one["child_frame_id"]) for one in frames] == [
        ("world", "base"),
        ("base", "arm"),
        ("base", "eye_optical_frame"),
    ]
    assert frames[1]["rotation"]["z"] == pytest.approx(sin(pi / 4), abs=1e-4)
    told = list(chronicle.read(path).messages())
    joints = [data for _, topic, _, data in told if topic == robot_scene.JOINTS_TOPIC]
    assert [list(one["position"]) for one in joints] == [[0.0], pytest.approx([pi / 2], abs=1e-4)] and joints[0]["name"] == ["arm"]
    state = merge.State()
    for _, topic, _, data in told:
        if topic == TOPIC:
            state.add("robots", from_json(message_class_exact(TYPE), data))
    assert sorted(state.sums["robots"].things) == ["ground", "robot", "table"]


def test_a_hand_moves_an_object_while_a_plan_runs_and_it_falls_to_where_it_lies(world, looker):
    looker.open_board()
    heard = looker.listen(TOPIC, TYPE)
    seen = []
    plan = kernel.spawn(lambda: [(kernel.sleep(1), seen.append(float(world.item("bottle").placement.position[0]))) for _ in range(4)])
    kernel.sleep(1.5)
    answer = looker.call("/cramhy/move_thing", "cramhy_msgs/MoveThing", name="bottle", x=0.3, y=0.1, z=0.75)
    assert [answer.x, answer.y, answer.z] == pytest.approx([0.3, 0.1, 0.6], abs=2e-3)
    assert [state.name for step in heard[-1].steps for state in step.states][-1] == "bottle"  # told at once
    plan.join()
    assert seen == pytest.approx([0.0, 0.3, 0.3, 0.3], abs=2e-3)
    answer = looker.call("/cramhy/move_thing", "cramhy_msgs/MoveThing", name="bottle", x=2.0, y=0.0, z=0.7)
    assert answer.z == pytest.approx(0.1, abs=2e-3)  # beside the table


@pytest.mark.parametrize(
    "request_, reason",
    [
        ({"name": "nix"}, "There is nothing called nix in the robot's world."),
        ({"name": "table"}, "table cannot be moved by hand: only free objects can, and it is part of the house or a robot."),
        ({"name": "robot"}, "robot cannot be moved by hand: only free objects can, and it is part of the house or a robot."),
        ({"name": "bottle", "x": float("nan")}, "bottle cannot be put at (nan, 0, 0): a place is three numbers of metres, up to 100."),
        ({"name": "bottle", "z": 1e6}, "bottle cannot be put at (0, 0, 1e+06): a place is three numbers of metres, up to 100."),
    ],
)
def test_what_a_hand_cannot_do_is_refused_with_the_reason(world, looker, request_, reason):
    looker.open_board()
    looker.chronicler.look()
    before = {name: thing.placement for name, thing in world.things.items()}
    place = {"x": 0.0, "y": 0.0, "z": 0.0}
    assert looker.call("/cramhy/move_thing", "cramhy_msgs/MoveThing", **place | request_) == reason
    assert all(world.thing(name).placement is place for name, place in before.items())


def test_what_a_robot_holds_is_refused_too_and_so_is_a_session_without_a_world(world, looker):
    looker.open_board()
    looker.chronicler.look()
    world.attach("robot", "bottle", "arm")
    move = {"name": "bottle", "x": 0.0, "y": 0.0, "z": 1.0}
    assert looker.call("/cramhy/move_thing", "cramhy_msgs/MoveThing", **move) == (
        "bottle cannot be moved by hand: robot holds it with arm. Let the plan put it down first."
    )
    shown.show(None)
    assert looker.call("/cramhy/move_thing", "cramhy_msgs/MoveThing", **move) == (
        "Nothing can be moved by hand: the session has no robot world. (robot.world() makes one.)"
    )
