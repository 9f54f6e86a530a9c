"""Patterns that are met often are functions. They match as the others do, also when the pattern has changed meanwhile."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, list_from
from cramhy_runtime.lisp_core.equality import eql, equal
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.utilities import patterns
from cramhy_runtime.utilities.compiled_patterns import unfit
from cramhy_runtime.utilities.lazy_lists import from_iterator

X, Y = (sym(f"CRAM-USER::?{name}") for name in "XY")
A, B, KEY = sym("CRAM-USER::A"), sym("CRAM-USER::B"), sym(":KEY")
SEGMENT = sym("CRAM-USER::!?S")
few = settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
atoms = st.sampled_from([None, False, True, A, B, KEY, 0, 1, 1.0, -0.0, 0.0, "s", LispString("s"), Symbol("")])


def trees(leaves):
    return st.recursive(leaves, lambda inner: st.builds(Cons, inner, inner), max_leaves=10)


data = trees(atoms)
wild_data = trees(st.one_of(atoms, st.sampled_from([X, SEGMENT])))
patterns_ = trees(st.one_of(atoms, st.sampled_from([X, Y, patterns.ANONYMOUS])))
wild_patterns = trees(st.one_of(atoms, st.sampled_from([X, Y, SEGMENT])))


def outcome(pattern, thing, *options):
    """What a match returns, or the text of its error."""
    try:
        found, matched = patterns.pat_match(pattern, thing, *options)
    except Condition as problem:
        return str(problem)
    except RecursionError:
        return "too deep"
    return found, matched


def same(one, other):
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    return one[1] is other[1] and equal(one[0], other[0]) is True


def by_parts(pattern, thing):
    """The outcome without a function, which patterns have for the ordinary test only."""
    return outcome(pattern, thing, sym(":TEST"), lambda a, b: eql(a, b))


def often(pattern, thing):
    for _ in range(4):
        found = outcome(pattern, thing)
    return found


def filled(pattern, values):
    if isinstance(pattern, Cons):
        return Cons(filled(pattern.car, values), filled(pattern.cdr, values))
    return values.get(pattern, pattern) if isinstance(pattern, Symbol) else pattern


@pytest.mark.soak
@few
@given(st.one_of(patterns_, wild_patterns), st.one_of(data, wild_data))
def test_a_match_is_that_of_going_through_the_pattern(pattern, thing):
    assert same(often(pattern, thing), by_parts(pattern, thing))


@pytest.mark.soak
@few
@given(patterns_, data, data, data)
def test_what_fits_matches(pattern, x, y, other):
    thing = filled(pattern, {X: x, Y: y, patterns.ANONYMOUS: other})
    assert same(often(pattern, thing), by_parts(pattern, thing))


@pytest.mark.soak
@few
@given(patterns_, st.data(), data, data)
def test_a_pattern_that_changes_matches_as_it_is_now(pattern, choice, x, other):
    cells, waiting = [], [pattern]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Cons):
            cells.append(part)
            waiting += (part.car, part.cdr)
    if not cells:
        return
    thing = filled(pattern, {X: x, Y: x, patterns.ANONYMOUS: other})
    often(pattern, thing)
    cell = choice.draw(st.sampled_from(cells))
    if choice.draw(st.booleans()):
        cell.car = choice.draw(st.one_of(patterns_, atoms))
    else:
        cell.cdr = choice.draw(st.one_of(patterns_, atoms))
    for probe in (thing, filled(pattern, {X: x, Y: x, patterns.ANONYMOUS: other})):
        expected = by_parts(pattern, probe)
        assert all(same(outcome(pattern, probe), expected) for _ in range(5))


def test_a_constant_pattern_becomes_a_function_and_a_fresh_one_does_not():
    constant = list_from([A, X])
    often(constant, list_from([A, 1]))
    assert constant in patterns._functions
    for _ in range(100):
        patterns.pat_match(list_from([A, X]), list_from([A, 1]))
    assert len(patterns._matchers.met) <= 50


def test_patterns_without_end_and_with_segments_stay_as_they_are():
    endless = list_from([A, X])
    endless.cdr.cdr = endless
    for _ in range(5):
        assert patterns.pat_match(endless, list_from([A, 1, A, 1, B])) == (None, None)
    assert patterns._functions[endless] is unfit
    segment = list_from([A, SEGMENT])
    found, matched = often(segment, list_from([A, 1, 2]))
    assert matched and equal(found.car.cdr, list_from([1, 2])) is True
    assert patterns._functions[segment] is unfit


def test_a_lazy_list_is_computed_as_far_as_it_is_matched():
    asked = []
    pattern = list_from([X, Y], patterns.ANONYMOUS)
    for _ in range(4):
        asked.clear()
        numbers = from_iterator(asked.append(n) or n for n in range(10))
        found, matched = patterns.pat_match(pattern, numbers)
        assert matched and patterns.var_value(Y, found) == 1 and asked == [0, 1, 2]


@pytest.mark.parametrize("variable", [X, SEGMENT])
def test_a_variable_on_the_right_is_an_error_each_time(variable):
    pattern, text = list_from([A, X]), f"Found variable {variable.name} on right hand side of pattern match."
    often(pattern, list_from([A, 1]))
    for _ in range(5):
        assert outcome(pattern, list_from([A, variable])).replace("CRAM-USER::", "") == text
        assert outcome(pattern, list_from([A, 1]))[1] is True


def test_bindings_that_are_there_already_count():
    pattern, known = list_from([A, X]), list_from([Cons(X, 2)])
    often(pattern, list_from([A, 1]))
    assert patterns.pat_match(pattern, list_from([A, 1]), known) == (None, None)
    assert patterns.pat_match(pattern, list_from([A, 2]), known) == (known, True)
