"""Random messages of all our types pass a live session of rosbridge both ways and come back equal, in JSON and in the forms of CBOR."""

import json
import math

import pytest
from hypothesis import HealthCheck, given, settings
from random_messages import any_message, one_nan
from systems import SOAK

from cramhy_runtime import kernel
from cramhy_runtime.ros import received, serialization, wire
from cramhy_runtime.ros.message_cbor import TAGS
from cramhy_runtime.ros.message_json import to_json
from cramhy_runtime.ros.messages import message_class_exact

EXAMPLES = settings(
    max_examples=1000 if SOAK else 15, deadline=None, database=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def from_cbor(cls, data):
    """The message of ``cls`` that a client makes of the form cbor."""
    message = cls()
    for field in cls.fields:
        setattr(message, field.attribute, _value(field, data[field.name]))
    return message


def _value(field, value):
    if field.is_array:
        if field.base in TAGS:
            numpy = pytest.importorskip("numpy")
            tag, letter = TAGS[field.base]
            assert value.tag == tag
            numbers = numpy.frombuffer(value.value, "<" + letter).tolist()
            return [one_nan(each) if letter in "fd" else each % 256 if field.base == "byte" else each for each in numbers]
        if field.base in ("uint8", "char"):
            assert isinstance(value, bytes)
            return value
        return [_one(field, each) for each in value]
    return _one(field, value)


def _one(field, value):
    if field.base in ("time", "duration"):
        return value["secs"] + value["nsecs"] / 1e9
    if not field.primitive:
        return from_cbor(message_class_exact(field.base), value)
    return one_nan(value) if isinstance(value, float) else value


def published(talk, message, compression):
    """What a client is sent that subscribed in the form ``compression``."""
    kind = type(message)
    node = kernel_node(talk)
    publication = node.advertise("/random", kind)
    try:
        talk.say(op="subscribe", topic="/random", type=kind.ros_type, compression=compression, id="random")
        publication.publish(message)
        kernel.yield_()
        (found,) = talk.heard()
        return found
    finally:
        talk.say(op="unsubscribe", topic="/random", id="random")
        node.unadvertise("/random")


def kernel_node(talk):
    graph = talk.session.hub.graph
    return graph.nodes.get("/random_node") or graph.node("random_node")


@EXAMPLES
@given(message=any_message())
def test_a_client_gets_an_equal_message_in_cbor(talk, message):
    cbor2 = pytest.importorskip("cbor2")
    found = cbor2.loads(published(talk, message, "cbor"))
    assert found["op"] == "publish" and from_cbor(type(message), found["msg"]) == message
    raw = cbor2.loads(published(talk, message, "cbor-raw"))
    octets = iter(raw["msg"]["bytes"])
    back = serialization.deserialize(type(message), lambda count: bytes(next(octets) for _ in range(count)))
    assert received.for_python(back) == message


@EXAMPLES
@given(message=any_message(finite=True))
def test_a_message_comes_back_equal_in_json(talk, message):
    kind, heard = type(message), []
    node = kernel_node(talk)
    node.subscribe("/echo", kind, received.python_receiver(kind, heard.append))
    try:
        sent = published(talk, message, "none")
        assert sent["msg"] == to_json(wire.transmit(message))
        talk.say(op="advertise", topic="/echo", type=kind.ros_type, id="echo")
        talk.say(op="publish", topic="/echo", msg=json.loads(json.dumps(sent["msg"])))
        kernel.sleep(0.01)
        assert heard == [message]
    finally:
        talk.say(op="unadvertise", topic="/echo", id="echo")
        node.unsubscribe("/echo")


def test_a_client_may_send_an_infinity(talk):
    kind, heard = message_class_exact("sensor_msgs/LaserScan"), []
    kernel_node(talk).subscribe("/echo", kind, received.python_receiver(kind, heard.append))
    talk.say(op="publish", topic="/echo", type=kind.ros_type, msg=json.loads('{"ranges": [1.5, 1e999, -1e999, null]}'))
    kernel.sleep(0.01)
    ranges = heard[0].ranges
    assert ranges[:3] == [1.5, math.inf, -math.inf] and math.isnan(ranges[3])
