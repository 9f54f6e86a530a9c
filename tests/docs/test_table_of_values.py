import os
from pathlib import Path

import numpy as np
import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.designators import Action, Motion, action_grounding, desig_prop_value, forget
from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.lisp_core.printing import prin1_to_string, speak
from cramhy_runtime.process_modules import executive, perform
from cramhy_runtime.prolog import P, V, fact_group, facts_asserted, findall, function, kw, query, remove_fact_group
from cramhy_runtime.ros import message_building, messages, received, wire
from cramhy_runtime.ros.python import get_param, message_class, ros_node, set_param
from cramhy_runtime.ros.roslisp import parameters
from cramhy_runtime.session import Image

PAGES = [Path(__file__).parents[2] / "docs" / name for name in ("python.md", "hy.md")]
BEGIN, END = "<!-- table of values: written by tests/docs/test_table_of_values.py -->\n", "<!-- end of the table of values -->\n"
FIELDS = (
    "bool int8 uint8 int16 uint16 int32 uint32 int64 uint64 byte char float32 float64 string time duration "
    "bool[] uint8[] int32[] float64[] float64[3] string[] time[] geometry_msgs/Point geometry_msgs/Point[]"
).split()
PACKAGE = "table_of_values_msgs"
MEANS = {"kw": kw, "P": P, "np": np, "Point": lambda **fields: message_class("geometry_msgs/Point")(**fields)}
"""The names in the cells of the table."""


class Valued(Action):
    pass


class Declared(Motion):
    flag: bool = True
    things: list = [1]


def as_parameter(value):
    set_param("value", value)
    return parameters.get_param("value"), get_param("value")


def as_field(kind):
    def sent(value):
        message = wire.transmit(message_class(f"{PACKAGE}/Of{FIELDS.index(kind)}")(data=value))
        return message_building.msg_slot_value(received.for_lisp(message), "DATA"), received.for_python(message).data

    return sent


def as_fluent(value):
    fluent = cpl.make_fluent(value=value)
    return cpl.value(fluent), fluent.value


def as_property(value):
    motion = Motion(("value", value), type=kw.driving)
    return desig_prop_value(motion, kw.value), motion.value


def as_declared(name):
    def made(value):
        motion = Declared(**{name: value})
        return desig_prop_value(motion, kw[name]), getattr(motion, name)

    return made


def as_lisp(goal):
    """The value of ``?x`` in the first answer that Lisp gets."""
    answer = python_list(query.prolog(goal.form))[0]
    return next(pair.cdr for pair in python_list(answer) if pair.car is V.x.symbol)


def as_fact(value):
    goal = P.table_of_values(V.x)
    with facts_asserted(P.table_of_values(value)), fact_group("table of values") as group:
        group.fact(P.table_of_values(value))
        (asserted,) = findall(V.x, P.rete_holds(goal))
    try:
        (answer,) = findall(V.x, goal)
        assert asserted == answer
        return as_lisp(goal), answer
    finally:
        remove_fact_group("table of values")


def as_result_of_function(value):
    goal = function(name=P.value_of_table)(lambda: value)(V.x)
    return as_lisp(goal), findall(V.x, goal)[0]


def as_result_of_plan(value):
    def how(action):
        return (lambda: value,)

    action_grounding(Valued)(how)
    try:
        return cpl.run(lambda: executive.perform(Valued())), cpl.run(lambda: perform(Valued()))
    finally:
        forget(how)


BORDERS = {
    "a parameter": as_parameter,
    **{f"a field `{kind}`": as_field(kind) for kind in FIELDS},
    "a fluent": as_fluent,
    "a property": as_property,
    "a property declared `bool`": as_declared("flag"),
    "a property declared `list`": as_declared("things"),
    "a fact": as_fact,
    "the result of a `@function`": as_result_of_function,
    "the result of a plan": as_result_of_plan,
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
    ("a field `int8`", "-3", "-3", "-3"),
    ("a field `uint8`", "200", "200", "200"),
    ("a field `int16`", "-300", "-300", "-300"),
    ("a field `uint16`", "300", "300", "300"),
    ("a field `int32`", "3", "3", "3"),
    ("a field `int32`", "np.int64(3)", "3", "3"),
    ("a field `uint32`", "4_000_000_000", "4000000000", "4000000000"),
    ("a field `int64`", "-(2**40)", "-1099511627776", "-1099511627776"),
    ("a field `uint64`", "2**63", "9223372036854775808", "9223372036854775808"),
    ("a field `byte`", "200", "200", "200"),
    ("a field `char`", "65", "65", "65"),
    ("a field `float32`", "0.5", "0.5d0", "0.5"),
    ("a field `float32`", "3", "3.0d0", "3.0"),
    ("a field `float64`", "3", "3.0d0", "3.0"),
    ("a field `float64`", "0.1", "0.1d0", "0.1"),
    ("a field `float64`", "float('inf')", ":POSITIVE-INFINITY", "float('inf')"),
    ("a field `string`", "'ä€'", '"ä€"', "'ä€'"),
    ("a field `string`", "None", '""', "''"),
    ("a field `time`", "1.5", "1.5d0", "1.5"),
    ("a field `duration`", "1.5", "1.5d0", "1.5"),
    ("a field `bool[]`", "[True, False]", "#(T NIL)", "[True, False]"),
    ("a field `uint8[]`", "b'ab'", "#(97 98)", "bytearray(b'ab')"),
    ("a field `uint8[]`", "np.array([1, 2], np.uint8)", "#(1 2)", "bytearray(b'\\x01\\x02')"),
    ("a field `int32[]`", "range(3)", "#(0 1 2)", "[0, 1, 2]"),
    ("a field `int32[]`", "[]", "#()", "[]"),
    ("a field `float64[]`", "()", "#()", "[]"),
    ("a field `float64[]`", "[1, 2.5]", "#(1.0d0 2.5d0)", "[1.0, 2.5]"),
    ("a field `float64[]`", "np.array([1, 2])", "#(1.0d0 2.0d0)", "[1.0, 2.0]"),
    ("a field `float64[3]`", "(1, 2, 3)", "#(1.0d0 2.0d0 3.0d0)", "[1.0, 2.0, 3.0]"),
    ("a field `string[]`", "['a', 'b']", '#("a" "b")', "['a', 'b']"),
    ("a field `time[]`", "[1.5]", "#(1.5d0)", "[1.5]"),
    ("a field `geometry_msgs/Point`", "Point(x=1)", None, "Point(x=1)"),
    ("a field `geometry_msgs/Point[]`", "[Point(x=1)]", None, "[Point(x=1)]"),
    ("a field `float64[]`", "[float('-inf')]", "#(:NEGATIVE-INFINITY)", "[float('-inf')]"),
    ("a field `uint8[]`", "[1, 255]", "#(1 255)", "bytearray(b'\\x01\\xff')"),
    ("a fluent", "False", "NIL", "False"),
    ("a fluent", "None", "NIL", "None"),
    ("a fluent", "'a'", '"a"', "'a'"),
    ("a fluent", "kw.left", ":LEFT", "kw.left"),
    ("a fluent", "[]", "#()", "[]"),
    ("a fluent", "(1, 2)", None, "(1, 2)"),
    ("a fluent", "{'a': 1}", None, "{'a': 1}"),
    ("a property", "False", "NIL", "False"),
    ("a property", "True", "T", "True"),
    ("a property", "3", "3", "3"),
    ("a property", "1.5", "1.5d0", "1.5"),
    ("a property", "'a'", '"a"', "'a'"),
    ("a property", "kw.left", ":LEFT", "kw.left"),
    ("a property", "P.cup", "PYTHON-USER:CUP", "P.cup"),
    ("a property", "[]", "NIL", "[]"),
    ("a property", "['a', False]", '("a" NIL)', "['a', False]"),
    ("a property", "(1, 2)", "(1 2)", "[1, 2]"),
    ("a property", "{'a': 1}", None, "{'a': 1}"),
    ("a property", "{2, 1}", None, "{1, 2}"),
    ("a property declared `bool`", "False", "NIL", "False"),
    ("a property declared `bool`", "True", "T", "True"),
    ("a property declared `list`", "[]", "NIL", "[]"),
    ("a property declared `list`", "[1]", "(1)", "[1]"),
    ("a fact", "False", "NIL", "False"),
    ("a fact", "None", "NIL", "None"),
    ("a fact", "True", "T", "True"),
    ("a fact", "3", "3", "3"),
    ("a fact", "1.5", "1.5d0", "1.5"),
    ("a fact", "'a'", '"a"', "'a'"),
    ("a fact", "kw.left", ":LEFT", "kw.left"),
    ("a fact", "P.cup", "PYTHON-USER:CUP", "P.cup"),
    ("a fact", "[]", "NIL", "[]"),
    ("a fact", "['a', False, None]", '("a" NIL NIL)', "['a', False, None]"),
    ("a fact", "(1, 2)", "(1 2)", "[1, 2]"),
    ("a fact", "{'a': 1}", None, "{'a': 1}"),
    ("a fact", "{2, 1}", "(1 2)", "[1, 2]"),
    ("the result of a `@function`", "False", "NIL", "False"),
    ("the result of a `@function`", "None", "NIL", "None"),
    ("the result of a `@function`", "True", "T", "True"),
    ("the result of a `@function`", "3", "3", "3"),
    ("the result of a `@function`", "1.5", "1.5d0", "1.5"),
    ("the result of a `@function`", "'a'", '"a"', "'a'"),
    ("the result of a `@function`", "kw.left", ":LEFT", "kw.left"),
    ("the result of a `@function`", "P.cup", "PYTHON-USER:CUP", "P.cup"),
    ("the result of a `@function`", "[]", "NIL", "[]"),
    ("the result of a `@function`", "['a', False]", '("a" NIL)', "['a', False]"),
    ("the result of a `@function`", "(1, 2)", "(1 2)", "[1, 2]"),
    ("the result of a `@function`", "{'a': 1}", None, "{'a': 1}"),
    ("the result of a `@function`", "{2, 1}", "(1 2)", "[1, 2]"),
    ("the result of a plan", "False", "NIL", "False"),
    ("the result of a plan", "None", "NIL", "None"),
    ("the result of a plan", "'a'", '"a"', "'a'"),
    ("the result of a plan", "kw.left", ":LEFT", "kw.left"),
    ("the result of a plan", "[]", "#()", "[]"),
    ("the result of a plan", "['a', False]", '#("a" NIL)', "['a', False]"),
    ("the result of a plan", "(1, 2)", None, "(1, 2)"),
    ("the result of a plan", "{'a': 1}", None, "{'a': 1}"),
]


@pytest.fixture(scope="module")
def own_messages(tmp_path_factory):
    """A package with a message for each type of field, with one field of it."""
    folder = tmp_path_factory.mktemp("packages")
    (folder / PACKAGE / "msg").mkdir(parents=True)
    for number, kind in enumerate(FIELDS):
        (folder / PACKAGE / "msg" / f"Of{number}.msg").write_text(f"{kind} data\n")
    yield folder
    messages._loaded.pop(PACKAGE, None)
    for name in [name for name in messages._messages if name.startswith(PACKAGE + "/")]:
        del messages._messages[name]


@pytest.fixture
def node(session, own_messages, monkeypatch):
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(own_messages))
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


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize("border, given, lisp, back", ROWS)
def test_each_row_is_so(node, border, given, lisp, back):
    in_lisp, in_python = BORDERS[border](eval(given, MEANS))
    if lisp is not None:
        speak(lisp=True)
        assert prin1_to_string(in_lisp) == lisp
    wanted = eval(back, MEANS)
    if border.startswith("a field") and isinstance(wanted, list):
        in_python = list(in_python)  # of numbers it may be an array
    assert in_python == wanted and (isinstance(in_python, type(wanted)) or back.startswith("P."))


def test_each_border_and_each_type_of_field_has_a_row():
    assert {border for border, *_ in ROWS} == set(BORDERS)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_page_has_the_table(page):
    text = page.read_text()
    before, _, rest = text.partition(BEGIN)
    if os.environ.get("CRAMHY_WRITE_TABLES"):
        page.write_text(before + table() + rest.partition(END)[2])
        text = page.read_text()
    assert table() in text
