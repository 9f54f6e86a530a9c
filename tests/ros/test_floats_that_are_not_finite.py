"""Infinities and not-a-number are floats in Python and Hy, however a message came, and roslisp's keywords in Lisp."""

import json
import math

import numpy as np
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.ros import arrays, messages, received, serialization, wire
from cramhy_runtime.ros.message_cbor import to_cbor_data
from cramhy_runtime.ros.message_json import from_json, to_json, to_json_text, to_record_text
from cramhy_runtime.ros.python import advertise, call_service, message_class, publish, register_service, ros_node, subscribe, wait_duration
from cramhy_runtime.ros.roslisp import topics
from cramhy_runtime.session import Image

INFINITE = [math.inf, -math.inf, math.nan]
KEYWORDS = [keyword("POSITIVE-INFINITY"), keyword("NEGATIVE-INFINITY"), keyword("NOT-A-NUMBER")]


@pytest.fixture(autouse=True)
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


def same(one, other):
    return type(one) is float and (one == other or math.isnan(one) and math.isnan(other))


def scan(**fields):
    return message_class("sensor_msgs/LaserScan")(**fields)


def heard_by_both(kind, message):
    in_python, in_lisp = [], []
    subscribe("topic", kind, in_python.append)
    topics.subscribe("topic", kind, in_lisp.append)
    publish(advertise("topic", kind), message)
    wait_duration(1)
    return in_python[0], in_lisp[0]


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("value, word", list(zip(INFINITE, KEYWORDS, strict=True)), ids=["inf", "-inf", "nan"])
@pytest.mark.parametrize("kind", ["std_msgs/Float32", "std_msgs/Float64"])
@pytest.mark.parametrize("number", [float, np.float32, np.float64])
def test_a_float(kind, value, word, number):
    in_python, in_lisp = heard_by_both(kind, message_class(kind)(data=number(value)))
    assert same(in_python.data, value) and in_lisp.data is word


@pytest.mark.parametrize("make", [list, tuple, np.array, lambda values: np.array(values, dtype=np.float32)])
def test_the_ranges_of_a_laser(make):
    in_python, in_lisp = heard_by_both("sensor_msgs/LaserScan", scan(ranges=make([1.5, *INFINITE]), range_max=math.inf))
    assert in_python.ranges[0] == 1.5 and all(map(same, in_python.ranges[1:], INFINITE)) and in_python.range_max == math.inf
    assert in_lisp.ranges == [1.5, *KEYWORDS] and in_lisp.range_max is KEYWORDS[0]
    assert np.asarray(in_python.ranges).dtype == np.float64


def test_a_float32_that_is_too_large_is_infinite():
    in_python, in_lisp = heard_by_both("std_msgs/Float32MultiArray", message_class("std_msgs/Float32MultiArray")(data=[1e39, -1e39, 1]))
    assert in_python.data == [math.inf, -math.inf, 1.0] and in_lisp.data == [*KEYWORDS[:2], 1.0]


def test_floats_of_messages_inside_and_in_arrays():
    pose, point, poses = (message_class(f"geometry_msgs/{name}") for name in ("Pose", "Point", "PoseArray"))
    in_python, in_lisp = heard_by_both("geometry_msgs/PoseArray", poses(poses=[pose(), pose(position=point(x=math.nan, y=math.inf))]))
    assert math.isnan(in_python.poses[1].position.x) and in_python.poses[1].position.y == math.inf
    assert in_lisp.poses[1].position.x is KEYWORDS[2] and in_lisp.poses[0].position.x == 0.0


def test_a_covariance():
    message = message_class("geometry_msgs/PoseWithCovariance")(covariance=[math.nan, *[0.0] * 34, math.inf])
    in_python, in_lisp = heard_by_both("geometry_msgs/PoseWithCovariance", message)
    assert math.isnan(in_python.covariance[0]) and in_python.covariance[35] == math.inf
    assert in_lisp.covariance[35] is KEYWORDS[0]


def test_requests_and_responses_of_services():
    asked = []
    register_service("there", "turtlesim/Spawn", lambda request: asked.append(request.x) or {"name": "a"})
    call_service("there", "turtlesim/Spawn", x=math.inf)
    assert asked == [math.inf]
    service = messages.service_type("turtlesim/Spawn")
    assert received.for_python(wire.transmit(service.request(x=math.nan))).x is math.nan


def test_a_message_without_such_floats_is_not_copied():
    received_one = wire.transmit(scan(ranges=[1.0]))
    assert received.for_python(received_one) is received_one
    assert received.python_receiver(message_class("std_msgs/String"), print) is print


def test_json_has_null_and_a_recording_an_infinity():
    there = wire.transmit(scan(ranges=[1.5, *INFINITE], range_max=math.inf))
    assert to_json(there)["ranges"] == json.loads(to_json_text(there))["ranges"] == [1.5, None, None, None]
    text = to_record_text(there)
    assert '"ranges":[1.5,1e999,-1e999,null]' in text and '"range_max":1e999' in text
    back = received.for_python(from_json(type(there), json.loads(text)))
    assert back.ranges[0] == 1.5 and all(map(same, back.ranges[1:], INFINITE)) and back.range_max == math.inf
    finite = wire.transmit(scan(ranges=[1.5]))
    assert to_record_text(finite) == to_json_text(finite)


def test_cbor_and_the_bytes_of_ros():
    there = wire.transmit(scan(ranges=[1.5, *INFINITE], range_max=math.inf))
    data = to_cbor_data(there)
    assert data["range_max"] == math.inf and data["ranges"].tag == 85
    assert all(map(same, np.frombuffer(data["ranges"].value, "<f4").astype(float).tolist()[1:], INFINITE))
    octets = serialization.serialize(there)
    place = iter(octets)
    back = serialization.deserialize(type(there), lambda count: bytes(next(place) for _ in range(count)))
    assert back.ranges == [1.5, *KEYWORDS]


@pytest.mark.parametrize("value", INFINITE)
def test_there_and_back(value):
    assert same(arrays.as_float(arrays.lisp_float(value)), value)
