"""Messages as JSON (rosbridge v2): out, in, and what comes in and is none."""

import json
import math
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some
from systems import SOAK

from cramhy_runtime.ros import definition_files, messages, wire
from cramhy_runtime.ros.definition_text import INTEGERS
from cramhy_runtime.ros.message_json import (
    MessageJsonError,
    from_json,
    request_from_json,
    MOST_TEXTS,
    float_texts,
    service_named,
    text_of,
    to_json,
    to_json_text,
    type_named,
)
from cramhy_runtime.ros.messages import RosMessage, message_class

quick = settings(
    max_examples=60 if SOAK else 30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)


def delivered(type_name, **fields):
    return wire.transmit(message_class(type_name)(**fields))


def same(one, other):
    """Whether two messages are of one class and all their values are equal."""
    if isinstance(one, RosMessage):
        return type(one) is type(other) and all(map(same, one.values(), other.values()))
    if isinstance(one, list):
        return len(one) == len(other) and all(map(same, one, other))
    return one == other and type(one) is type(other)


class TestOut:
    def test_numbers_texts_truth_and_times_are_plain(self):
        log = delivered("rosgraph_msgs/Log", level=2, msg="hello", topics=["/a"])
        log.header.stamp = 5.25
        data = to_json(log)
        assert data == {
            "header": {"seq": 0, "stamp": {"secs": 5, "nsecs": 250_000_000}, "frame_id": ""},
            "level": 2, "name": "", "msg": "hello", "file": "", "function": "", "line": 0, "topics": ["/a"],
        }  # fmt: skip
        pose = to_json(delivered("turtlesim/Pose", x=1))
        assert pose == {"x": 1.0, "y": 0.0, "theta": 0.0, "linear_velocity": 0.0, "angular_velocity": 0.0}
        assert {type(value) for value in pose.values()} == {float}

    def test_true_and_nil_are_true_and_false(self):
        assert to_json(delivered("std_msgs/Bool", data=0)) == {"data": True}
        assert to_json(delivered("std_msgs/Bool")) == {"data": False}

    @pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
    def test_what_is_not_finite_is_null(self, value):
        assert to_json(delivered("std_msgs/Float64", data=value)) == {"data": None}
        assert to_json(delivered("std_msgs/Float32MultiArray", data=[1.0, value]))["data"] == [1.0, None]
        assert to_json(message_class("std_msgs/Float64")(data=value)) == {"data": None}  # as it was made
        assert to_json(message_class("std_msgs/Float32MultiArray")(data=[1.0, value]))["data"] == [1.0, None]

    def test_octets_are_base64(self):
        assert to_json(delivered("std_msgs/UInt8MultiArray", data=[104, 105, 255]))["data"] == "aGn/"

    @pytest.mark.parametrize("text", ["ä", "€ ä", "Ã¤", "ä\x82", ""])
    def test_texts(self, text):
        assert to_json(delivered("std_msgs/String", data=text)) == {"data": text}
        assert from_json(message_class("std_msgs/String"), {"data": text}).data == text

    @pytest.mark.parametrize("seconds, secs, nsecs", [(-0.5, -1, 500_000_000), (0.9999999999, 1, 0), (17952186.5, 17952186, 500_000_000)])
    def test_durations(self, seconds, secs, nsecs):
        assert to_json(message_class("std_msgs/Duration")(data=seconds)) == {"data": {"secs": secs, "nsecs": nsecs}}

    def test_a_message_as_it_was_made_will_do(self):
        twist = message_class("geometry_msgs/Twist")()
        twist.linear.x = 2
        assert to_json(twist)["linear"] == {"x": 2.0, "y": 0.0, "z": 0.0}

    def test_what_no_message_may_hold_is_an_error(self):
        twist = message_class("geometry_msgs/Twist")()
        twist.linear.x = "abc"
        with pytest.raises(MessageJsonError) as error:
            to_json(twist)
        assert str(error.value) == "geometry_msgs/Twist message requires a float64 for field linear.x, but got a text, 'abc'."
        with pytest.raises(MessageJsonError) as error:
            to_json(3)
        assert str(error.value) == "Only a message can be sent, not an object of class int."


class TestText:
    """`to_json_text` writes what `json` writes of `to_json`."""

    @pytest.mark.parametrize(
        "type_name, fields",
        [
            ("std_msgs/Float64", {"data": math.nan}),
            ("std_msgs/Float64", {"data": wire.POSITIVE_INFINITY}),
            ("std_msgs/Float64", {"data": 3}),
            ("std_msgs/Float32", {"data": 0.1}),
            ("std_msgs/Float32MultiArray", {"data": [1, math.inf, 1e300]}),
            ("std_msgs/String", {"data": 'a "quoted" \\ text\n\x01 %s'}),
            ("std_msgs/String", {"data": "â\x82¬"}),
            ("std_msgs/String", {"data": None}),
            ("std_msgs/Int64", {"data": -(2**63)}),
            ("std_msgs/UInt8", {"data": True}),
            ("std_msgs/UInt8", {"data": None}),
            ("std_msgs/Bool", {"data": 0}),
            ("std_msgs/Duration", {"data": -0.5}),
            ("std_msgs/UInt8MultiArray", {"data": [104, 105, 255]}),
            ("std_msgs/Empty", {}),
        ],
    )
    def test_of_values_of_all_kinds(self, type_name, fields):
        message = message_class(type_name)(**fields)
        assert to_json_text(message) == text_of(to_json(message))

    @pytest.mark.parametrize("values", [(0.0, -0.0, 0), (-0.0, 0.0), (2, 2.0, 2.0), (2.5, Fraction(5, 2)), (2**53 + 1, 2.0**53)])
    def test_numbers_that_are_equal_have_the_texts_of_their_own_whichever_comes_first(self, values):
        float_texts.clear()
        texts = [to_json_text(message_class("std_msgs/Float64")(data=value)) for value in values]
        assert texts == [f'{{"data":{float(value)!r}}}' for value in values]

    def test_texts_are_not_kept_without_end(self):
        for number in range(3 * MOST_TEXTS):
            float_texts[number + 0.5]
        assert len(float_texts) <= MOST_TEXTS

    def test_what_no_message_may_hold_is_the_same_error(self):
        twist = message_class("geometry_msgs/Twist")()
        twist.angular.z = "abc"
        with pytest.raises(MessageJsonError, match="requires a float64 for field angular.z, but got a text, 'abc'"):
            to_json_text(twist)
        with pytest.raises(MessageJsonError, match="not an object of class int"):
            to_json_text(3)


class TestIn:
    def test_the_values_are_those_that_a_subscriber_sees(self):
        twist = from_json(message_class("geometry_msgs/Twist"), {"linear": {"x": 2}})
        assert same(twist, delivered("geometry_msgs/Twist", linear=message_class("geometry_msgs/Vector3")(x=2)))
        assert type(twist.linear.x) is float
        assert from_json(message_class("turtlesim/Pose"), {"x": 5.544445}).x == 5.544445037841797

    def test_fields_that_are_missing_have_their_defaults(self):
        for name in ("rosgraph_msgs/Log", "geometry_msgs/PoseWithCovarianceStamped", "std_msgs/UInt8MultiArray"):
            assert same(from_json(message_class(name), {}), delivered(name))

    def test_messages_share_no_parts(self):
        cls = message_class("geometry_msgs/Twist")
        assert from_json(cls, {}).linear is not from_json(cls, {}).linear

    def test_times_of_ros_2_and_now(self):
        header = message_class("std_msgs/Header")
        assert from_json(header, {"stamp": {"sec": 3, "nanosec": 500_000_000}}).stamp == 3.5
        assert from_json(header, {"stamp": "now"}, now=7.5).stamp == 7.5
        assert from_json(header, {"frame_id": "map"}, now=7.5).stamp == 7.5
        assert from_json(header, {"frame_id": "map"}).stamp == 0.0
        assert from_json(message_class("std_msgs/Duration"), {"data": {"secs": -1, "nsecs": 500_000_000}}).data == -0.5

    def test_octets_come_as_base64_or_as_a_list(self):
        cls = message_class("std_msgs/UInt8MultiArray")
        assert from_json(cls, {"data": "aGn/"}).data == from_json(cls, {"data": [104, 105, 255]}).data == [104, 105, 255]

    def test_null_is_not_a_number(self):
        assert from_json(message_class("std_msgs/Float64"), {"data": None}).data is wire.NOT_A_NUMBER
        assert from_json(message_class("std_msgs/Float64"), {"data": math.inf}).data is wire.POSITIVE_INFINITY

    def test_arguments_of_services_by_name_or_in_order(self):
        request = service_named("turtlesim/srv/Spawn").request
        assert [request_from_json(request, args).values() for args in ({"x": 1, "name": "a"}, [1, 0, 0, "a"], None)] == [
            [1.0, 0.0, 0.0, "a"], [1.0, 0.0, 0.0, "a"], [0.0, 0.0, 0.0, ""],
        ]  # fmt: skip
        with pytest.raises(MessageJsonError) as error:
            request_from_json(request, [1, 2, 3, "a", 5])
        assert str(error.value) == "turtlesim/SpawnRequest takes 4 arguments (x, y, theta, name), but 5 were given."


class TestNames:
    def test_of_ros_1_and_of_ros_2(self):
        assert type_named("turtlesim/Pose") is type_named("turtlesim/msg/Pose") is message_class("turtlesim/Pose")
        assert service_named("turtlesim/Spawn").name == service_named("turtlesim/srv/Spawn").name == "turtlesim/Spawn"

    @pytest.mark.parametrize("name", ["turtlesim/Nope", "Pose", "", None, 3, "../../etc/passwd", "a/b/c/d", "turtlesim/pose", "x" * 999])
    def test_those_that_there_are_not(self, name):
        with pytest.raises(MessageJsonError) as error:
            type_named(name)
        assert str(error.value).startswith(f"There is no type {repr(name)[:15]}")
        assert str(error.value).endswith('. A type is written "package/Name"; its package must be on ROS_PACKAGE_PATH.')


MISTAKES = [
    ("turtlesim/Pose", {"x": "abc"}, "turtlesim/Pose message requires a float32 for field x, but got a text, 'abc'."),
    ("turtlesim/Pose", {"x": True}, "turtlesim/Pose message requires a float32 for field x, but got a truth value, True."),
    ("turtlesim/Pose", [], "turtlesim/Pose message requires a turtlesim/Pose, but got a list, []: write an object with some of the "
     "fields x, y, theta, linear_velocity, angular_velocity."),
    ("turtlesim/Pose", {"q": 1}, "Message type turtlesim/Pose does not have a field q. The fields of turtlesim/Pose are x, y, theta, "
     "linear_velocity, angular_velocity."),
    ("geometry_msgs/PoseArray", {"poses": [{}, {"position": {"q": 1}}]},
     "Message type geometry_msgs/PoseArray does not have a field poses[1].position.q. The fields of geometry_msgs/Point are x, y, z."),
    ("geometry_msgs/Twist", {"linear": None}, "geometry_msgs/Twist message requires a geometry_msgs/Vector3 for field linear, but got "
     "null: write an object with some of the fields x, y, z."),
    ("std_msgs/Float64", {"data": 10**400}, "std_msgs/Float64 message requires a float64 for field data, but got an integer, "
     "100000000000000000...0000000000000000000: its range ends at 1.8e308."),
    ("turtlesim/Color", {"r": 300}, "turtlesim/Color message requires a uint8 for field r, but got an integer, 300: "
     "0 to 255 is its range."),
    ("turtlesim/Color", {"r": 3.0}, "turtlesim/Color message requires a uint8 for field r, but got a number, 3.0."),
    ("turtlesim/Color", {"r": True}, "turtlesim/Color message requires a uint8 for field r, but got a truth value, True."),
    ("std_msgs/Int64", {"data": 10**9000}, "std_msgs/Int64 message requires a int64 for field data, but got an integer, a very large int: "
     "-9223372036854775808 to 9223372036854775807 is its range."),
    ("std_msgs/Bool", {"data": 1}, "std_msgs/Bool message requires a bool for field data, but got an integer, 1: write true or false."),
    ("std_msgs/String", {"data": 3}, "std_msgs/String message requires a string for field data, but got an integer, 3."),
    ("std_msgs/String", {"data": "\ud800"}, "std_msgs/String message requires a string for field data, but got a text, '\\ud800': "
     "half of a surrogate pair is no character."),
    ("geometry_msgs/PoseWithCovariance", {"covariance": [1.0]},
     "geometry_msgs/PoseWithCovariance message requires a float64[36] for field covariance, but got a list of 1 element."),
    ("std_msgs/UInt8MultiArray", {"data": "a"}, "std_msgs/UInt8MultiArray message requires a uint8[] for field data, but got a text, 'a': "
     "a text must be base64."),
    ("std_msgs/UInt8MultiArray", {"data": [1, 256]}, "std_msgs/UInt8MultiArray message requires a uint8[] for field data, but got an "
     "integer, 256: element 1 is no integer from 0 to 255."),
    ("std_msgs/UInt8MultiArray", {"data": 3}, "std_msgs/UInt8MultiArray message requires a uint8[] for field data, but got an integer, 3: "
     "write a list, or a text in base64."),
    ("std_msgs/Header", {"stamp": 3}, "std_msgs/Header message requires a time for field stamp, but got an integer, 3: write "
     '{"secs": 1, "nsecs": 500000000}.'),
    ("std_msgs/Header", {"stamp": {"secs": -1}}, "std_msgs/Header message requires a time for field stamp, but got an object, "
     "{'secs': -1}: -1 is no integer from 0 to 4294967295."),
    ("std_msgs/Header", {"stamp": {"secs": 1, "nanosec": 2}}, "std_msgs/Header message requires a time for field stamp, but got an object, "
     '{\'nanosec\': 2, \'secs\': 1}: it has the fields "sec" and "nanosec".'),
]  # fmt: skip


@pytest.mark.parametrize("type_name, data, text", MISTAKES)
def test_what_is_no_message_is_an_error_that_names_the_field(type_name, data, text):
    with pytest.raises(MessageJsonError) as error:
        from_json(message_class(type_name), data)
    assert str(error.value) == text


# ------------------------------------------------------------------------------------------------------------ properties

_latin = some.text(some.characters(max_codepoint=255), max_size=8)
_float64 = some.floats(allow_nan=True, allow_infinity=False)  # infinities come back as not-a-number
_float32 = some.floats(width=32, allow_infinity=False)
_moments = some.integers(0, 2**31 - 1).map(float) | some.floats(0, 2e9)


def _value(field):
    """A strategy for the values that a program may give to ``field``."""
    if not field.primitive:
        one = message_of(messages.message_class_exact(field.base))
    elif field.base in INTEGERS:
        one = some.integers(-(2**70), 2**70)
    elif field.base in ("time", "duration"):
        one = _moments
    else:
        one = {"bool": some.booleans(), "string": _latin, "float32": _float32, "float64": _float64}[field.base]
    if not field.is_array:
        return one
    return some.lists(one, min_size=field.length, max_size=field.length or 3)


def message_of(cls):
    return some.builds(cls, **{field.attribute: _value(field) for field in cls.fields})


def _all_classes():
    for package in definition_files.known_packages():
        classes, services = messages.load_package(package)
        yield from classes
        for service in services:
            yield from (service.request, service.response)


def class_named(text):
    return next(cls for cls in _all_classes() if cls.lisp_name == text)


names_of_classes = some.deferred(lambda: some.sampled_from([cls.lisp_name for cls in _all_classes()]))


@pytest.mark.soak
@quick
@given(some.data())
def test_there_and_back_is_the_same_message(data):
    cls = class_named(data.draw(names_of_classes))
    message = wire.transmit(data.draw(message_of(cls)))
    text = json.dumps(to_json(message), allow_nan=False)
    assert to_json_text(message) == text_of(to_json(message))
    again = from_json(cls, json.loads(text))
    assert same(again, message)
    assert same(wire.transmit(again), message)  # and it can be sent on


_json = some.recursive(
    some.none() | some.booleans() | some.integers() | some.floats() | some.text(max_size=5),
    lambda inner: some.lists(inner, max_size=3) | some.dictionaries(some.text(max_size=5), inner, max_size=3),
    max_leaves=12,
)


@pytest.mark.soak
@quick
@given(some.data())
def test_hostile_data_raise_nothing_but_the_one_error(data):
    cls = class_named(data.draw(names_of_classes))

    def spoiled(value):
        """``value`` with something in it replaced by any JSON; or left as it is."""
        if isinstance(value, dict) and value and data.draw(some.booleans()):
            key = data.draw(some.sampled_from(sorted(value)))
            return {**value, key: spoiled(value[key])}
        if isinstance(value, list) and value and data.draw(some.booleans()):
            return [spoiled(value[0]), *value[1:]]
        return data.draw(_json)

    hostile = spoiled(to_json(cls()))
    try:
        wire.transmit(from_json(cls, hostile))
    except MessageJsonError as problem:
        assert cls.ros_type in str(problem) and len(str(problem)) < 2000
