"""Numbers, texts and truth values as Python has them, in messages: they arrive as they went, or are refused as rospy does."""

import enum

import numpy as np
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros.definition_text import INTEGERS
from cramhy_runtime.ros.python import advertise, call_service, message_class, publish, register_service, ros_node, subscribe, wait_duration
from cramhy_runtime.session import Image


@pytest.fixture(autouse=True)
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


def heard(kind, **fields):
    seen = []
    subscribe("topic", kind, seen.append)
    publish(advertise("topic", kind), message_class(kind)(**fields))
    wait_duration(1)
    return seen[0]


RANGES = [(name, -(1 << bits - 1) if signed else 0, (1 << bits - signed) - 1) for name, (bits, signed) in INTEGERS.items()]
TYPES = {"byte": "Byte", "char": "Char", **{name: name.title().replace("Ui", "UI") for name in INTEGERS if "int" in name}}


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("name, least, most", RANGES)
def test_an_integer_out_of_range_is_refused(name, least, most):
    kind = f"std_msgs/{TYPES[name]}"
    least = -128 if name == "byte" else least  # signed in rospy, unsigned in roslisp
    topic = advertise("topic", kind)
    for value in (least - 1, most + 1, most + 300):
        with pytest.raises(ValueError, match=f"data holds {value}, which is out of the range of {name}: {least} to {most}"):
            publish(topic, message_class(kind)(data=value))
    for value in (least, most):
        publish(topic, message_class(kind)(data=value))


def test_integers_inside_messages_and_arrays_are_checked_too():
    header = message_class("std_msgs/Header")(seq=-1)
    with pytest.raises(ValueError, match=r"geometry_msgs/PoseStamped.header.seq holds -1"):
        publish(advertise("pose", "geometry_msgs/PoseStamped"), message_class("geometry_msgs/PoseStamped")(header=header))
    with pytest.raises(ValueError, match=r"data\[1\] holds 256"):
        publish(advertise("octets", "std_msgs/UInt8MultiArray"), message_class("std_msgs/UInt8MultiArray")(data=[1, 256]))
    with pytest.raises(ValueError, match=r"data\[1\] holds 256"):
        publish("octets", message_class("std_msgs/UInt8MultiArray")(data=np.array([1, 256])))


def test_services_check_requests_and_responses():
    kind = "roscpp_tutorials/TwoInts"
    register_service("add", kind, lambda request: {"sum": request.a * 4})
    with pytest.raises(ValueError, match="out of the range of int64"):
        call_service("add", kind, a=2**63, b=0)
    with pytest.raises(Exception, match="out of the range of int64"):
        call_service("add", kind, a=2**62, b=0)


class Level(enum.IntEnum):
    HIGH = 7


@pytest.mark.parametrize("value", [np.int64(7), np.uint8(7), np.array(7), Level.HIGH, 7])
def test_an_integer_of_a_library_is_an_integer(value):
    received = heard("std_msgs/Int32", data=value).data
    assert received == 7 and type(received) is int


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("value", [np.float64(0.5), np.float32(0.5), np.array(0.5), 0.5])
@pytest.mark.parametrize("kind", ["std_msgs/Float32", "std_msgs/Float64"])
def test_a_number_of_a_library_is_a_number(kind, value):
    assert heard(kind, data=value).data == 0.5


@pytest.mark.parametrize("value", [[1.0, 2.5], (1.0, 2.5), np.array([1.0, 2.5]), np.array([1, 2.5], dtype=np.float32)])
def test_an_array_of_numbers_is_a_list(value):
    assert heard("std_msgs/Float32MultiArray", data=value).data == [1.0, 2.5]


@pytest.mark.parametrize("value", [[1, 255], bytes([1, 255]), bytearray([1, 255]), np.array([1, 255], dtype=np.uint8), np.array([1, 255])])
def test_octets_come_in_all_their_forms(value):
    assert heard("std_msgs/UInt8MultiArray", data=value).data == [1, 255]


@pytest.mark.parametrize("kind", ["std_msgs/UInt8MultiArray", "std_msgs/Float64MultiArray"])
def test_an_array_of_two_dimensions_is_refused(kind):
    with pytest.raises(Exception, match="VECTOR"):
        heard(kind, data=np.zeros((2, 2), dtype=np.uint8))


@pytest.mark.parametrize("value", [False, np.False_, None])
def test_false_arrives_as_false(value):
    assert heard("std_msgs/Bool", data=value).data is False
    assert message_class("std_msgs/Bool")().data is False


@pytest.mark.parametrize("value", ["no", 0, [], 0.0])
def test_a_truth_value_is_true_or_false(value):
    with pytest.raises(TypeError, match="no truth value. Write True or False"):
        heard("std_msgs/Bool", data=value)


@pytest.mark.parametrize("text", ["Grüße", "日本語", "🤖", "Ã¤", ""])
def test_texts_are_unicode(text):
    assert heard("std_msgs/String", data=text).data == text


def test_a_message_of_another_type_is_refused_even_where_nobody_listens():
    door = advertise("door", "std_msgs/Bool")
    for topic in (door, "door"):
        with pytest.raises(TypeError, match="/door has messages of the type std_msgs/Bool, not std_msgs/String."):
            publish(topic, message_class("std_msgs/String")(data="open"))


@pytest.mark.parametrize("value", [{"x": 1.0}, (1, 0, 0), 3])
def test_a_part_is_a_message(value):
    with pytest.raises(TypeError, match="geometry_msgs/Twist.linear holds .*, which is no geometry_msgs/Vector3. message_class"):
        heard("geometry_msgs/Twist", linear=value)
