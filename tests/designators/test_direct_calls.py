"""Generic functions whose one method is called without dispatch, as long as it is the only one."""

from __future__ import annotations

import pytest

from cramhy_runtime.designators.classes import make_designator
from cramhy_runtime.designators.protocol import reference
from cramhy_runtime.designators.resolution import resolve_designator
from cramhy_runtime.lisp_core.condition_types import SimpleProgramError
from cramhy_runtime.lisp_core.data import UNSUPPLIED
from cramhy_runtime.lisp_core.dispatch.generic_errors import NoApplicableMethodError
from cramhy_runtime.lisp_core.dispatch.generic_functions import add_method, generic, remove_method
from cramhy_runtime.lisp_core.packages import keyword

MOTION = keyword("MOTION")


def shouting():
    """A generic function with one method that is called directly."""
    shout = generic("CRAM-USER::SHOUT-DIRECTLY", "(text)")
    shout.methods.clear()

    @shout.call_directly
    @shout.method(str)
    def _shout(text=UNSUPPLIED, *more):
        return text.upper() if isinstance(text, str) and not more else shout.refuse(text, *more)

    return shout


def test_a_method_that_is_added_is_called_and_one_that_is_removed_is_not():
    shout = shouting()
    assert shout("a") == "A"
    added = add_method(shout, (), [int], lambda number: number * 2, uses_next=False)
    assert (shout("a"), shout(2)) == ("A", 4)
    remove_method(shout, added)
    assert shout("a") == "A"
    with pytest.raises(NoApplicableMethodError):
        shout(2)


def test_calls_are_watched_like_those_of_any_generic_function():
    shout, seen = shouting(), []

    def watcher(function, arguments, keywords):
        seen.append(arguments)
        return function(*arguments, **keywords)

    shout.watch(watcher)
    assert shout("a") == "A"
    shout.watch(None)
    assert shout("b") == "B"
    assert seen == [("a",)]


@pytest.mark.parametrize(
    "call, given",
    [
        (lambda: make_designator(), 0),
        (lambda: make_designator(MOTION), 1),
        (lambda: make_designator(MOTION, None, None, None), 4),
        (lambda: reference(), 0),
        (lambda: reference(5, 6, 7), 3),
        (lambda: reference(make_designator(MOTION, None), 6, 7), 3),
        (lambda: resolve_designator(5), 1),
    ],
)
def test_a_wrong_number_of_arguments_is_a_program_error(call, given):
    with pytest.raises(SimpleProgramError) as caught:
        call()
    assert str(caught.value) == f"invalid number of arguments: {given}"


@pytest.mark.parametrize("thing", [5, None, "motion"])
def test_only_designators_have_references(thing):
    with pytest.raises(NoApplicableMethodError):
        reference(thing)
