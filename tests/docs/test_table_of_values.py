"""The table of values in docs/python.md and docs/hy.md: each row is sent over its border and read on both sides.

``CRAMHY_WRITE_TABLES=1 pytest tests/docs/test_table_of_values.py`` writes the table into the pages.
"""

import os
from pathlib import Path

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.ground.printing import prin1_to_string
from cramhy_runtime.ros import message_building, received, wire
from cramhy_runtime.ros.python import get_param, message_class, ros_node, set_param
from cramhy_runtime.ros.roslisp import parameters
from cramhy_runtime.session import Image

PAGES = [Path(__file__).parents[2] / "docs" / name for name in ("python.md", "hy.md")]
BEGIN, END = "<!-- table of values: written by tests/docs/test_table_of_values.py -->\n", "<!-- end of the table of values -->\n"


def as_parameter(value):
    set_param("value", value)
    return parameters.get_param("value"), get_param("value")


def as_field(kind):
    def sent(value):
        message = wire.transmit(message_class(kind)(data=value))
        return message_building.msg_slot_value(received.for_lisp(message), "DATA"), received.for_python(message).data

    return sent


def as_fluent(value):
    fluent = cpl.make_fluent(value=value)
    return cpl.value(fluent), fluent.value


BORDERS = {
    "a parameter": as_parameter,
    "a field `bool`": as_field("std_msgs/Bool"),
    "a field `int32`": as_field("std_msgs/Int32"),
    "a field `float64`": as_field("std_msgs/Float64"),
    "a field `string`": as_field("std_msgs/String"),
    "a field `float64[]`": as_field("std_msgs/Float64MultiArray"),
    "a field `uint8[]`": as_field("std_msgs/UInt8MultiArray"),
    "a fluent": as_fluent,
}
ROWS = [
    ("a parameter", "False", "NIL", "False"),
    ("a parameter", "True", "T", "True"),
    ("a parameter", "3", "3", "3"),
    ("a parameter", "1.5", "1.5", "1.5"),
    ("a parameter", "'a'", '"a"', "'a'"),
    ("a parameter", "[]", "NIL", "[]"),
    ("a parameter", "['a', False]", '("a" NIL)', "['a', False]"),
    ("a parameter", "(1, 2)", "(1 2)", "[1, 2]"),
    ("a parameter", "{'a': 1}", None, "{'a': 1}"),
    ("a field `bool`", "False", "NIL", "False"),
    ("a field `bool`", "None", "NIL", "False"),
    ("a field `bool`", "True", "T", "True"),
    ("a field `int32`", "3", "3", "3"),
    ("a field `float64`", "3", "3.0d0", "3.0"),
    ("a field `float64`", "float('inf')", ":POSITIVE-INFINITY", "float('inf')"),
    ("a field `string`", "'ä€'", '"ä€"', "'ä€'"),
    ("a field `float64[]`", "()", "#()", "[]"),
    ("a field `float64[]`", "[1, 2.5]", "#(1.0d0 2.5d0)", "[1.0, 2.5]"),
    ("a field `float64[]`", "[float('-inf')]", "#(:NEGATIVE-INFINITY)", "[float('-inf')]"),
    ("a field `uint8[]`", "[1, 255]", "#(1 255)", "bytearray(b'\\x01\\xff')"),
    ("a field `uint8[]`", "b'\\x01'", "#(1)", "bytearray(b'\\x01')"),
    ("a fluent", "False", "NIL", "False"),
    ("a fluent", "None", "NIL", "None"),
    ("a fluent", "(1, 2)", None, "(1, 2)"),
]


@pytest.fixture
def node(session):
    with Image(as_now=True):
        kernel.start(clock="virtual", time_limit=3600)
        try:
            with ros_node("tester"):
                yield
        finally:
            kernel.stop()


def table():
    lines = ["| through | Python gives | Lisp reads | Python reads |", "|---|---|---|---|"]
    lines += [f"| {border} | `{given}` | {f'`{lisp}`' if lisp else 'an object'} | `{back}` |" for border, given, lisp, back in ROWS]
    return BEGIN + "\n".join(lines) + "\n" + END


@pytest.mark.parametrize("border, given, lisp, back", ROWS)
def test_each_row_is_so(node, border, given, lisp, back):
    in_lisp, in_python = BORDERS[border](eval(given))
    if lisp is not None:
        assert prin1_to_string(in_lisp) == lisp
    wanted = eval(back)
    assert in_python == wanted and isinstance(in_python, type(wanted))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_page_has_the_table(page):
    text = page.read_text()
    before, _, rest = text.partition(BEGIN)
    if os.environ.get("CRAMHY_WRITE_TABLES"):
        page.write_text(before + table() + rest.partition(END)[2])
        text = page.read_text()
    assert table() in text
