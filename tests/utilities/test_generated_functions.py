"""Functions made of text: tracebacks show their lines, and the lines go when the functions go."""

from __future__ import annotations

import gc
import linecache
import re
import subprocess
import sys
import traceback

import pytest

from cramhy_runtime.kernel.reports import of_the_library
from cramhy_runtime.ros import messages
from cramhy_runtime.utilities.generated_functions import define_functions, generated_function


def kept(title):
    """The file names that `linecache` has for generated texts with this in their title."""
    gc.collect()
    return [name for name in linecache.cache if re.fullmatch(f"<.*{re.escape(title)}, text [0-9]+>", name)]


def traceback_of(function, *arguments):
    try:
        function(*arguments)
    except Exception as problem:
        return "".join(traceback.format_exception(problem))
    raise AssertionError("the function raised nothing")


def test_a_function_has_the_name_parameters_body_and_scope_that_it_was_given():
    scope = {"offset": 10}
    add = generated_function(
        "adding", "add", ["x", "y=2", "*rest", "**others"], ["total = x + y", "return total + offset, rest, others"], scope
    )
    assert add.__name__ == "add"
    assert add(1) == (13, (), {})
    assert add(1, 5, 6, z=7) == (16, (6,), {"z": 7})
    assert "add" not in scope


def test_a_function_without_lines_returns_none():
    assert generated_function("nothing", "nothing", [], [], {})() is None


def test_functions_that_are_defined_together_call_each_other():
    scope = {}
    even = ("even", ["n"], ["return n == 0 or odd(n - 1)"])
    odd = ("odd", ["n"], ["return n != 0 and even(n - 1)"])
    define_functions("parity", [even, odd], scope)
    assert scope["even"](10) and not scope["odd"](10)


def test_reports_to_the_user_leave_generated_code_out():
    add = generated_function("adding", "add", ["x"], ["return x + 1"], {})
    assert of_the_library(add.__code__.co_filename)
    assert not any(map(of_the_library, ["<repl 1>", "<stdin>", "<string>", "", "plans/first, text 1.py"]))


def test_a_traceback_shows_the_generated_line():
    divide = generated_function("dividing", "divide", ["x"], ["y = x - x", "return x / y"], {})
    text = traceback_of(divide, 1)
    assert 'File "<dividing, text ' in text
    assert "line 3, in divide\n    return x / y\n" in text


def test_a_traceback_shows_the_line_of_the_second_of_two_functions():
    scope = {}
    define_functions("two", [("first", [], ["second()"]), ("second", [], ["", "raise ValueError('here')"])], scope)
    text = traceback_of(scope["first"])
    assert "line 2, in first\n    second()\n" in text
    assert "line 5, in second\n    raise ValueError('here')\n" in text


def test_two_functions_of_one_name_do_not_share_lines():
    one = generated_function("alike", "f", [], ["return 1 / 0"], {})
    two = generated_function("alike", "f", [], ["return [][0]"], {})
    assert one.__code__.co_filename != two.__code__.co_filename
    assert "return 1 / 0" in traceback_of(one)
    assert "return [][0]" in traceback_of(two)


def test_the_lines_go_with_the_function():
    function = generated_function("short lived", "f", [], ["return 1"], {})
    assert len(kept("short lived")) == 1
    del function
    assert kept("short lived") == []


def test_the_lines_stay_while_a_traceback_needs_them():
    try:
        generated_function("in a traceback", "f", [], ["return 1 / 0"], {})()
    except ZeroDivisionError as problem:
        assert len(kept("in a traceback")) == 1
        assert "return 1 / 0" in "".join(traceback.format_exception(problem))
    assert kept("in a traceback") == []


def test_the_lines_stay_while_one_of_several_functions_is_left():
    scope = {}
    define_functions("together", [("f", [], ["return 1"]), ("g", [], ["return 1 / 0"])], scope)
    g = scope["g"]
    del scope["f"], scope
    assert len(kept("together")) == 1
    assert "return 1 / 0" in traceback_of(g)
    del g
    assert kept("together") == []


@pytest.mark.parametrize("name", ["two words", "", "class", "1st", "f(x): pass\ndef g"])
def test_a_name_that_is_not_a_python_name_is_refused(name):
    with pytest.raises(ValueError) as caught:
        generated_function("bad", name, [], [], {})
    assert str(caught.value) == f"A generated function cannot be called {name!r}: this is not a Python name."
    assert kept("bad") == []


@pytest.mark.parametrize("parameter", ["two words", "", "class", "x-y=1", "*1"])
def test_a_parameter_that_is_not_a_python_name_is_refused(parameter):
    with pytest.raises(ValueError) as caught:
        generated_function("bad", "f", ["x", parameter], [], {})
    assert str(caught.value) == f"The generated function f cannot have the parameter {parameter!r}: it does not begin with a Python name."


def test_text_that_python_cannot_read_is_refused_with_its_line():
    scope = {}
    with pytest.raises(SyntaxError) as caught:
        generated_function("unreadable", "f", ["x"], ["y = x", "return y y"], scope)
    assert (caught.value.lineno, caught.value.text) == (3, "    return y y\n")
    del scope
    assert kept("unreadable") == []


def test_the_initializer_of_a_message_shows_its_line():
    pose = messages.message_class("turtlesim/Pose")
    pose()
    function = pose.__init__
    lines = linecache.getlines(function.__code__.co_filename)
    assert function.__code__.co_filename.startswith("<__init__ of turtlesim/Pose, text ")
    assert lines[:2] == ["def __init__(self, x=0.0, y=0.0, theta=0.0, linear_velocity=0.0, angular_velocity=0.0):\n", "    self.x = x\n"]


def test_a_predicate_that_changes_often_leaves_no_lines(lisp):
    for number in range(20):
        clause = f"(cram-prolog:<- (changing-rule ?x) (cram-prolog:member ?x ({number} 100)))"
        lisp(f"(cram-prolog:def-fact-group changing (changing-rule) {clause})")
        assert lisp("(cut:lazy-car (cram-prolog:prolog '(changing-rule ?x)))") == f"((?X . {number}))"
    names = kept("CHANGING-RULE/1")
    assert len(names) == 1, names  # that of the code as it is now


def test_the_module_is_light():
    """It loads nothing but the standard library, so that any room above the ground can use it."""
    told = "import sys, cramhy_runtime.utilities.generated_functions; print(*[n for n in sys.modules if n.startswith('cramhy_runtime.')])"
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == {"cramhy_runtime.utilities", "cramhy_runtime.utilities.generated_functions"}
