"""Random values of Python in messages of all our types, and in parameters, come back equal: over the wire, as JSON, as CBOR, as bytes of
ROS, copied and pickled."""

import copy
import json
import pickle

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some
from random_messages import any_message, one_nan, types
from systems import SOAK

from cramhy_runtime import kernel
from cramhy_runtime.ros import messages, received, serialization, strict, wire
from cramhy_runtime.ros.message_json import from_json, to_json, to_json_text, to_record_text
from cramhy_runtime.ros.python import get_param, ros_node, set_param
from cramhy_runtime.session import Image

EXAMPLES = settings(
    max_examples=2000 if SOAK else 25, deadline=None, database=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@EXAMPLES
@given(any_message())
def test_a_random_message_comes_back_equal(message):
    strict.check(message)
    there = wire.transmit(message)
    assert received.for_python(there) == message
    assert received.for_python(wire.fresh(there)) == message
    assert received.for_python(wire.transmit(received.for_lisp(there))) == message
    assert received.for_python(from_json(type(message), json.loads(to_record_text(there)))) == message
    octets = iter(serialization.serialize(there))
    back = serialization.deserialize(type(message), lambda count: bytes(next(octets) for _ in range(count)))
    assert received.for_python(back) == message


@EXAMPLES
@given(any_message(finite=True))
def test_a_random_message_that_json_can_have_comes_back_equal(message):
    there = wire.transmit(message)
    assert copy.deepcopy(message) == message == pickle.loads(pickle.dumps(message))
    assert from_json(type(message), json.loads(json.dumps(to_json(there)))) == message
    assert from_json(type(message), json.loads(to_json_text(there))) == message
    assert json.loads(to_record_text(there)) == to_json(there)


def test_all_our_packages_have_types():
    assert len(types()) > 60


@pytest.mark.parametrize("value", [True, False])
def test_truth_values_in_arrays_are_those_of_python(value):
    field = messages.message_class("std_msgs/Bool").fields[0]
    assert wire._converter(field)(value) is value


VALUES = some.recursive(
    some.booleans()
    | some.integers(-(2**31), 2**31 - 1)
    | some.floats().map(one_nan)
    | some.text(some.characters(codec="utf-8"), max_size=5),
    lambda inner: (
        some.lists(inner, max_size=3) | some.dictionaries(some.from_regex(r"[a-z][a-z0-9_]{0,4}", fullmatch=True), inner, max_size=3)
    ),
    max_leaves=8,
)


def same(found, value):
    """Whether the two are equal and of the same types, all the way down."""
    if type(found) is not type(value):
        return False
    if isinstance(value, list):
        return len(found) == len(value) and all(map(same, found, value))
    if isinstance(value, dict):
        return found.keys() == value.keys() and all(same(found[key], value[key]) for key in value)
    return found == value or found != found and value != value


@pytest.fixture
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


@EXAMPLES
@given(value=VALUES)
def test_a_random_parameter_comes_back_equal(node, value):
    set_param("value", value)
    assert same(get_param("value"), value), get_param("value")
    if isinstance(value, dict):
        assert all(same(get_param(f"value/{key}"), part) for key, part in value.items())
