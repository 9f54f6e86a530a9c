"""Waits and plans of Python refuse what would be over at once, without a word."""

from __future__ import annotations

import functools
import threading

import pytest

from cramhy_runtime import cpl
from cramhy_runtime.designators import Motion, motion_grounding
from cramhy_runtime.process_modules import process_module
from cramhy_runtime.prolog import function, predicate, test as prolog_test
from cramhy_runtime.session.session import Session

f = cpl.make_fluent(name="f", value=3.0)
OF_COMPARISONS = (
    "A comparison of a fluent's value gives {0} once, and so do `f == x` and `f != x`, which ask whether two fluents are the same one. "
    "Write cpl.wait_for(f < x), cpl.wait_for(cpl.fl_eql(f, x)) or cpl.wait_for(~cpl.fl_eql(f, x)) with the fluent f itself."
)
OF_FUNCTIONS = (
    "Nobody would tell the plan when to call a function again. Keep what it looks at in a fluent, f = cpl.make_fluent(value=...), and write "
    "cpl.wait_for(cpl.fl_funcall(function, f)) or cpl.wait_for(f < 1)."
)
OF_VALUES = "Write cpl.wait_for(f) with a fluent f, not with f.value, and cpl.make_fluent(value=...) to make one."


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "thing, advice",
    [(f.value < 5, OF_COMPARISONS.format(True)), (f == 3, OF_COMPARISONS.format(False)), (f != 3, OF_COMPARISONS.format(True)),
     (lambda: False, OF_FUNCTIONS), (drive := len, OF_FUNCTIONS), (0, OF_VALUES), (None, OF_VALUES), ("f", OF_VALUES), ([f, f], OF_VALUES),
     (threading.Event(), OF_VALUES)],
    ids=["comparison", "equal", "unequal", "lambda", "function", "number", "nil", "name", "list", "event"],
)  # fmt: skip
def test_a_wait_for_what_is_not_a_fluent_says_what_to_write(thing, advice):
    with pytest.raises(TypeError) as problem:
        cpl.run(lambda: cpl.wait_for(thing), clock="virtual")
    text = str(problem.value)
    assert text.startswith("cpl.wait_for takes a fluent, but was given ") and text.endswith(f"which never changes. {advice}")
    with pytest.raises(TypeError, match="cpl.whenever takes a fluent"):
        cpl.run(lambda: next(cpl.whenever(thing)), clock="virtual")


def test_lisp_waits_for_any_object_as_the_original_does():
    assert Session(time="virtual").evaluate_text("(cpl:top-level (cpl:wait-for 5))")[-1] == 5


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("wait", [cpl.sleep, lambda time: cpl.wait_for(cpl.make_fluent(), timeout=time)], ids=["sleep", "wait_for"])
@pytest.mark.parametrize("time", [float("nan"), "3", None, True, [1]], ids=repr)
def test_a_time_that_is_not_a_number_is_an_error(wait, time):
    if time is None and wait is not cpl.sleep:
        pytest.skip("no time limit")
    with pytest.raises(Exception, match="is not of type"):
        cpl.run(lambda: wait(time), clock="virtual", time_limit=100)


FORMS = ["try_all", "try_in_order", "try_each_in_order"]


async def asynchronous(*arguments):
    """A function of asyncio."""


def generator(*arguments):
    """A function that yields."""
    yield


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("wrong", [asynchronous, generator, functools.partial(asynchronous, 3)], ids=["async", "generator", "partial"])
@pytest.mark.parametrize("run", [lambda plan: plan(), lambda plan: cpl.par(plan, lambda: 1), lambda plan: cpl.pursue(plan),
                                 lambda plan: cpl.with_task(plan)], ids=["run", "par", "pursue", "with_task"])  # fmt: skip
def test_a_plan_that_would_not_run_is_refused(wrong, run):
    with pytest.raises(
        TypeError, match="and has run nothing of it. Write .*: plans are plain functions, and wait by calls such as cpl.sleep"
    ):
        cpl.run(lambda: run(wrong), clock="virtual")


def test_a_generator_expression_is_a_value_like_others():
    assert list(cpl.run(lambda: (n for n in [1, 2]), clock="virtual")) == [1, 2]


@pytest.mark.parametrize("decorate", [prolog_test, function, process_module, motion_grounding], ids=lambda each: each.__name__)
def test_a_decorator_refuses_what_would_not_run(decorate):
    with pytest.raises(TypeError, match="asynchronous is an `async def`, and cannot be .*: its call would return at once, and run nothing"):
        decorate(asynchronous)


def test_predicates_yield_their_solutions():
    assert predicate(generator) and Motion


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("form", [cpl.try_all, cpl.try_in_order, lambda *ways: cpl.try_each_in_order(ways, lambda way: way())], ids=FORMS)
@pytest.mark.parametrize("error", [AssertionError, NameError, SyntaxError, MemoryError])
def test_a_mistake_in_the_program_is_not_tried_another_way(form, error):
    def wrong():
        raise error("in the program")

    with pytest.raises(error, match="in the program"):
        cpl.run(lambda: form(wrong, lambda: cpl.sleep(1)), clock="virtual")


@pytest.mark.parametrize("form", [cpl.try_all, cpl.try_in_order, lambda *ways: cpl.try_each_in_order(ways, lambda way: way())], ids=FORMS)
def test_other_exceptions_are_failures_of_an_attempt(form):
    def fails():
        raise ConnectionError("no signal")

    assert cpl.run(lambda: form(fails, lambda: "other"), clock="virtual") == "other"
    with pytest.raises(cpl.CompositeFailure) as problem:
        cpl.run(lambda: form(fails, fails), clock="virtual")
    assert [type(each) for each in problem.value.exceptions] == [ConnectionError, ConnectionError]
