"""A ``uint8[]`` is seen by numpy without a copy, equal to lists of numbers, and a vector in Lisp."""

import array
import copy
import pickle
import sys

import numpy as np
import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import wire
from cramhy_runtime.ros.arrays import Octets
from cramhy_runtime.ros.message_cbor import to_cbor_data
from cramhy_runtime.ros.python import advertise, message_class, publish, ros_node, subscribe, wait_duration
from cramhy_runtime.ros.roslisp import topics
from cramhy_runtime.session import Image

NUMBERS = [0, 1, 254, 255]
KIND = "std_msgs/UInt8MultiArray"
FORMS = {
    "list": list, "tuple": tuple, "bytes": bytes, "bytearray": bytearray, "octets": Octets, "range of numpy": np.array,
    "numpy's uint8": lambda numbers: np.array(numbers, dtype=np.uint8), "every second one": lambda numbers: np.repeat(np.array(numbers, dtype=np.uint8), 2)[::2],
    "memoryview": lambda numbers: memoryview(bytes(numbers)), "array": lambda numbers: array.array("B", numbers),
    "numbers of numpy": lambda numbers: list(np.array(numbers, dtype=np.uint8)),
}  # fmt: skip


def message(data):
    return message_class(KIND)(data=data)


@pytest.fixture(autouse=True)
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("form", FORMS)
def test_all_forms_arrive_as_octets_and_in_lisp_as_a_list(form):
    in_python, in_lisp = [], []
    subscribe("topic", KIND, in_python.append)
    topics.subscribe("topic", KIND, in_lisp.append)
    publish(advertise("topic", KIND), message(FORMS[form](NUMBERS)))
    wait_duration(1)
    data = in_python[0].data
    assert data.__class__ is Octets and data == NUMBERS and data == tuple(NUMBERS) and data == bytes(NUMBERS)
    assert in_lisp[0].data.__class__ is list and in_lisp[0].data == NUMBERS
    seen = np.asarray(data)
    assert seen.dtype == np.uint8 and seen.tolist() == NUMBERS and np.frombuffer(data, np.uint8).tolist() == NUMBERS
    seen[0] = 7
    assert data[0] == 7, "numpy looks at another object"


def test_the_receiver_has_octets_of_its_own():
    pixels = np.zeros(3, dtype=np.uint8)
    there = wire.transmit(message(pixels))
    another = wire.fresh(there)
    pixels[0] = 1
    another.data[1] = 2
    assert there.data == [0, 0, 0] and another.data == [0, 2, 0] and another.data.__class__ is Octets


def test_they_are_compared_copied_and_pickled():
    there = wire.transmit(message(NUMBERS))
    assert there == message(NUMBERS) == there and there != message([0, 1, 254])
    assert pickle.loads(pickle.dumps(there)) == there == copy.deepcopy(there)
    assert there.data[1:3] == [1, 254] and there.data[1:3].__class__ is Octets and there.data.tolist() == NUMBERS
    assert there.data != [0, 1] and there.data != "text" and not Octets() and list(there.data) == NUMBERS


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("values", [[256], [-1], [1.5], ["a"], [None], np.zeros((2, 2), np.uint8), np.array([1.5])])
def test_other_values_are_refused(values):
    with pytest.raises(Exception, match="range|INTEGER|VECTOR"):
        publish(advertise("topic", KIND), message(values)) or publish("topic", message(values))
        subscribe("topic", KIND, print)
        publish("topic", message(values))


def test_lisps_messages_are_cut_to_their_bits():
    assert wire.transmit(message([256, -1, 3])).data == [0, 255, 3]


def test_cbor_has_bytes():
    assert to_cbor_data(wire.transmit(message(NUMBERS)))["data"] == bytes(NUMBERS)


INTEGERS = {"int8": (72, "<i1"), "int16": (77, "<i2"), "int32": (78, "<i4"), "int64": (79, "<i8"),
            "uint16": (69, "<u2"), "uint32": (70, "<u4"), "uint64": (71, "<u8")}  # fmt: skip


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("base", INTEGERS)
def test_arrays_of_numpy_need_no_loop_of_python(base):
    tag, kind = INTEGERS[base]
    values = np.arange(100_000, dtype=kind) if base[-1] != "8" else np.arange(100_000).astype(kind)
    there = message_class(f"std_msgs/{'UInt' if base[0] == 'u' else 'Int'}{base.strip('uint')}MultiArray")(data=values)
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event == "call"

    sys.setprofile(count)
    try:
        found = wire.transmit(there)
    finally:
        sys.setprofile(None)
    assert found.data == values.tolist() and calls < 50
    data = to_cbor_data(found)["data"]
    assert data.tag == tag and np.frombuffer(data.value, kind).tolist() == values.tolist()


@pytest.mark.parametrize("bits", ["32", "64"])
def test_arrays_of_floats_neither(bits):
    values = np.linspace(0, 1, 10_000, dtype=f"<f{int(bits) // 8}")
    calls = 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event == "call"

    there = message_class(f"std_msgs/Float{bits}MultiArray")(data=values)
    sys.setprofile(count)
    try:
        found = wire.transmit(there)
    finally:
        sys.setprofile(None)
    assert np.array_equal(np.asarray(found.data), values.astype(float)) and calls < 50
