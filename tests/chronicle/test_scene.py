"""The scene for Foxglove's 3D panel: what it adds up to is the world."""

from __future__ import annotations

import json

import pytest

from cramhy_runtime import chronicle
from cramhy_runtime.chronicle import scene

pytest.importorskip("mcap")

PLAN = """(progn (roslisp:start-ros-node "n") (sleep 0.1)
  (roslisp:call-service "/spawn" 'turtlesim-srv:Spawn :x 2 :y 3 :theta 0 :name "bob")
  (let ((pub (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist")))
    (roslisp:publish pub (roslisp:make-message "geometry_msgs/Twist" (x linear) 2 (z angular) 1)))
  (sleep 1.5) ~a
  (sleep 0.1))"""
CLEAR = '(roslisp:call-service "/clear" \'std_srvs-srv:Empty)'
KILL = '(roslisp:call-service "/kill" \'turtlesim-srv:Kill :name "bob")'


def recorded(session, path, last=""):
    """(schema of the scene, its messages, the last message about the world)."""
    from mcap.reader import make_reader

    with chronicle.record(path):
        session.evaluate_text(PLAN.replace("~a", last))
    with open(path, "rb") as file:
        found = [(schema, channel.topic, json.loads(message.data)) for schema, channel, message in make_reader(file).iter_messages()]
    updates = [data for _, topic, data in found if topic == scene.TOPIC]
    (kind,) = {(schema.name, schema.data) for schema, topic, _ in found if topic == scene.TOPIC}
    return kind, updates, [data for _, topic, data in found if topic == "/cramhy/world"]


def shown(updates):
    """What Foxglove shows after these updates: entities by id."""
    entities = {}
    for update in updates:
        for deletion in update["deletions"]:
            entities = {} if deletion["type"] == 1 else {name: entity for name, entity in entities.items() if name != deletion["id"]}
        entities.update({entity["id"]: entity for entity in update["entities"]})
    return entities


def fits(data, schema):
    kind = schema["type"]
    if kind == "object":
        assert set(data) == set(schema["properties"]) or not schema.get("properties")
        for name, inner in schema.get("properties", {}).items():
            fits(data[name], inner)
    elif kind == "array":
        for each in data:
            fits(each, schema["items"])
    else:
        assert isinstance(data, {"number": (int, float), "integer": int, "string": str, "boolean": bool}[kind])


def test_every_line_and_the_last_places_are_there(session, tmp_path):
    _, updates, worlds = recorded(session, tmp_path / "x.mcap")
    entities = shown(updates)
    drawn = [(stroke["x1"], stroke["y1"], stroke["x2"], stroke["y2"]) for world in worlds for stroke in world["strokes"]]
    points = [point for entity in entities.values() for line in entity["lines"] for point in line["points"]]
    lines = [(a["x"], a["y"], b["x"], b["y"]) for a, b in zip(points[::2], points[1::2])]
    assert lines == drawn and len(drawn) > 50
    for turtle in worlds[-1]["turtles"]:
        (arrow,) = entities[f"turtle {turtle['name']}"]["arrows"]
        assert arrow["pose"]["position"] == {"x": turtle["x"], "y": turtle["y"], "z": 0.1}
    assert {name.split()[0] for name in entities} == {"paper", "turtle", "ink"}


def test_a_clear_and_a_kill_take_away_what_was_there(session, tmp_path):
    _, updates, worlds = recorded(session, tmp_path / "x.mcap", CLEAR + KILL)
    assert worlds[-1]["clears"] > worlds[0]["clears"]
    assert set(shown(updates)) == {"paper", "turtle turtle1"}


def test_the_messages_are_such_as_the_schema_says(session, tmp_path):
    (name, text), updates, _ = recorded(session, tmp_path / "x.mcap")
    assert name == "foxglove.SceneUpdate"
    for update in updates:
        fits(update, json.loads(text))


def test_it_is_no_topic_that_is_replayed(session, tmp_path):
    recorded(session, tmp_path / "x.mcap")
    found = chronicle.read(tmp_path / "x.mcap")
    assert scene.TOPIC not in found.topics and scene.TOPIC not in found.skipped


def test_few_messages_tell_it(session, tmp_path):
    _, updates, worlds = recorded(session, tmp_path / "x.mcap")
    assert len(updates) < len(worlds) / 2
