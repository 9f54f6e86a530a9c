"""Patterns and lazy lists at random: matching, substituting and renaming against each other, lazy lists against plain ones."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from systems import SOAK

from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from, python_list
from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.utilities import lazy_lists as ll
from cramhy_runtime.utilities import patterns

few = settings(max_examples=150 if SOAK else 50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
X, Y, Z = (sym(f"CRAM-USER::?{name}") for name in "XYZ")

atoms = st.one_of(st.integers(-3, 3), st.sampled_from([None, sym("CRAM-USER::A"), sym("CRAM-USER::B"), "s", "S"]))


def trees(leaves):
    return st.recursive(leaves, lambda inner: st.builds(Cons, inner, inner), max_leaves=12)


data = trees(atoms)
pattern_trees = trees(st.one_of(atoms, st.sampled_from([X, Y, Z, patterns.ANONYMOUS])))
named_patterns = trees(st.one_of(atoms, st.sampled_from([X, Y, Z])))
bindings = st.fixed_dictionaries({X: data, Y: data, Z: data})


def filled(pattern, values):
    """``pattern`` with its variables replaced by ``values``, without the code that is tested."""
    if isinstance(pattern, Cons):
        return Cons(filled(pattern.car, values), filled(pattern.cdr, values))
    return values.get(pattern, pattern) if isinstance(pattern, Symbol) else pattern


def match(pattern, thing):
    found, matched = patterns.pat_match(pattern, thing, sym(":TEST"), equal)
    return found, matched is True


@pytest.mark.law(116)
@few
@given(data)
def test_ground_data_matches_itself(thing):
    assert match(thing, thing) == (None, True)


@pytest.mark.law(116)
@few
@given(data, data)
def test_a_repeated_variable_matches_equal_data_only(left, right):
    assert match(list_from([X, X]), list_from([left, right]))[1] == (equal(left, right) is True)


@pytest.mark.law(117)
@few
@given(named_patterns, bindings)
def test_a_pattern_matches_what_it_was_filled_to_and_its_bindings_rebuild_that(pattern, values):
    thing = filled(pattern, values)
    found, matched = match(pattern, thing)
    assert matched and equal(patterns.substitute_vars(pattern, found), thing) is True


@pytest.mark.law(117)
@few
@given(named_patterns, data)
def test_whatever_matches_is_rebuilt(pattern, thing):
    found, matched = match(pattern, thing)
    if matched:
        assert equal(patterns.substitute_vars(pattern, found), thing) is True
        assert {pair.car for pair in python_list(found)} == set(python_list(patterns.vars_in(pattern)))
    else:
        assert found is None


@pytest.mark.law(118)
@few
@given(pattern_trees, data, bindings)
def test_a_renamed_pattern_matches_exactly_what_the_pattern_matches(pattern, thing, values):
    renamed = patterns.rename_vars(pattern)
    for candidate in (thing, filled(pattern, {**values, patterns.ANONYMOUS: thing})):
        assert match(pattern, candidate)[1] == match(renamed, candidate)[1]


@pytest.mark.law(118)
@few
@given(pattern_trees)
def test_renaming_changes_nothing_but_named_variables_and_each_to_one_fresh_one(pattern):
    fresh = {}

    def compare(old, new):
        if isinstance(old, Cons):
            compare(old.car, new.car)
            compare(old.cdr, new.cdr)
        elif old in (X, Y, Z):
            assert patterns.is_genvar(new) is True and fresh.setdefault(old, new) is new
        else:
            assert new is old

    compare(pattern, patterns.rename_vars(pattern))
    assert len(set(fresh.values())) == len(fresh)


lists = st.lists(st.integers(-5, 5), max_size=8)


def lazy(items):
    """The lazy list of ``items``, made by the operator."""

    def body(cont, next_, finish, index):
        if index == len(items):
            return None
        return cont(items[index], index + 1)

    return ll.lazy_list([0], body)


def forced(thing):
    return python_list(ll.force_ll(thing))


@pytest.mark.law(112, 113)
@few
@given(lists, st.lists(st.integers(0, 7), max_size=4))
def test_a_lazy_list_is_the_plain_one_in_whatever_order_it_is_looked_at(items, places):
    made = lazy(items)
    for place in places:
        assert ll.lazy_elt(made, place) == (items[place] if place < len(items) else None)
    assert forced(made) == items and ll.lazy_list_p(made) is None


@pytest.mark.soak
@few
@given(lists, lists, st.integers(0, 10))
def test_functions_on_lazy_lists_are_those_on_plain_ones(left, right, n):
    def wrapped(element):
        return list_from([element] * (element % 3))

    assert forced(ll.lazy_take(n, lazy(left))) == left[:n]
    assert forced(ll.lazy_skip(n, lazy(left))) == left[n:]
    assert forced(ll.lazy_append(lazy(left), None, lazy(right))) == left + right
    assert forced(ll.lazy_filter(lambda element: element > 0 or None, lazy(left))) == [element for element in left if element > 0]
    assert forced(ll.lazy_mapcar(lambda a, b: a - b, lazy(left), lazy(right))) == [a - b for a, b in zip(left, right, strict=False)]
    assert forced(ll.lazy_mapcan(wrapped, lazy(left))) == [element for element in left for _ in range(element % 3)]
    assert forced(ll.lazy_flatten(list_from([list_from(left), None, list_from([list_from(right)])]))) == left + right
    assert [python_list(rest) for rest in forced(ll.lazy_rests(list_from(left)))] == [left[index:] for index in range(len(left))]
    assert ll.lazy_fold(lambda a, b: a - b, lazy(left), initial_value=n) == n - sum(left)
    copy = ll.copy_lazy_list(made := lazy(left))
    assert forced(copy) == left == forced(made)
    seen = []
    ll.lazy_dolist(lazy(left), seen.append)
    assert seen == left


@pytest.mark.law(114)
@few
@given(st.integers(0, 12), st.integers(0, 4))
def test_taking_from_an_endless_list_computes_as_many_elements_as_are_taken(n, skipped):
    computed = []

    def body(cont, next_, finish, index):
        computed.append(index)
        return cont(index, index + 1)

    source = ll.lazy_skip(skipped, ll.lazy_list([0], body))
    assert forced(ll.lazy_take(n, source)) == list(range(skipped, skipped + n))
    assert len(computed) == max(n + skipped, skipped + 1)
