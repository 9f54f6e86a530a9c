"""Random values of Python in messages of all our types come back equal: over the wire, as JSON, as bytes of ROS, copied and pickled."""

import copy
import json
import pickle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from cramhy_runtime.ros import definition_files, messages, serialization, strict, wire
from cramhy_runtime.ros.definition_text import INTEGERS
from cramhy_runtime.ros.message_json import from_json, to_json, to_json_text

FOLDERS = sorted(folder.name for folder in definition_files.OURS.iterdir())


def types():
    return [cls for package in FOLDERS for cls in (messages.load_package(package) or ([],))[0]]


def values(field):
    if field.base in INTEGERS:
        bits, signed = INTEGERS[field.base]
        one = some.integers(-(1 << bits - 1), (1 << bits - 1) - 1) if signed else some.integers(0, (1 << bits) - 1)
    elif field.base in ("time", "duration"):
        one = some.integers(0, 2**31 - 1)
    elif field.primitive:
        one = {
            "bool": some.booleans(),
            "string": some.text(some.characters(exclude_categories=["Cs"]), max_size=6),
            "float32": some.floats(width=32, allow_nan=False, allow_infinity=False),
            "float64": some.floats(allow_nan=False, allow_infinity=False),
        }[field.base]
    else:
        one = some.deferred(lambda: made(messages.message_class_exact(field.base)))
    return some.lists(one, min_size=field.length, max_size=field.length or 2) if field.is_array else one


def made(cls):
    return some.builds(cls, **{field.attribute: values(field) for field in cls.fields})


@settings(max_examples=60, deadline=None, database=None)
@given(some.data())
def test_a_random_message_comes_back_equal(data):
    message = data.draw(some.sampled_from(types()).flatmap(made))
    strict.check(message)
    received = wire.transmit(message)
    assert received == message
    assert wire.fresh(received) == message
    assert copy.deepcopy(message) == message == pickle.loads(pickle.dumps(message))
    assert from_json(type(message), json.loads(json.dumps(to_json(received)))) == message
    assert from_json(type(message), json.loads(to_json_text(received))) == message
    octets = iter(serialization.serialize(received))
    assert serialization.deserialize(type(message), lambda count: bytes(next(octets) for _ in range(count))) == message


def test_all_our_packages_have_types():
    assert len(types()) > 60


@pytest.mark.parametrize("value", [True, False])
def test_truth_values_in_arrays_are_those_of_python(value):
    field = messages.message_class("std_msgs/Bool").fields[0]
    assert wire._converter(field)(value) is value
