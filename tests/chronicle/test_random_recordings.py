"""Random messages of all our types come back equal from a recording, with infinities."""

import math

import pytest
from hypothesis import HealthCheck, given, settings
from random_messages import any_message
from systems import SOAK
from hypothesis import strategies as some

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.ros import graph, received
from cramhy_runtime.ros.message_json import from_json
from cramhy_runtime.ros.messages import message_class_exact

pytest.importorskip("mcap")


@settings(max_examples=60 if SOAK else 3, deadline=None, database=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(messages=some.lists(any_message(), min_size=1, max_size=10))
def test_random_messages_come_back_equal_from_a_recording(session, tmp_path, messages):
    path = tmp_path / "random.mcap"
    node = graph.active().nodes.get("/random_node") or graph.active().node("random_node")
    with chronicle.record(path):
        for number, message in enumerate(messages):
            node.advertise(f"/random{number}", type(message), latch=True).publish(message)
            kernel.sleep(0.1)
    for number in range(len(messages)):
        node.unadvertise(f"/random{number}")
    found = {topic: (kind, data) for _, topic, kind, data in chronicle.read(path).messages() if topic.startswith("/random")}
    assert len(found) == len(messages)
    for number, message in enumerate(messages):
        kind, data = found[f"/random{number}"]
        assert received.for_python(from_json(message_class_exact(kind), data)) == message


def test_a_laser_that_sees_nothing(session, tmp_path):
    message = message_class_exact("sensor_msgs/LaserScan")(ranges=[1.5, math.inf, -math.inf, math.nan])
    with chronicle.record(tmp_path / "x.mcap"):
        graph.active().node("laser").advertise("/scan", type(message), latch=True).publish(message)
        kernel.sleep(0.1)
    (data,) = [data for _, topic, _, data in chronicle.read(tmp_path / "x.mcap").messages() if topic == "/scan"]
    assert data["ranges"] == [1.5, math.inf, -math.inf, None]
