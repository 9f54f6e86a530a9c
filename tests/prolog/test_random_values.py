"""Random values of Python come back equal from facts, rules, functions, predicates and the properties of designators."""

import datetime
import decimal

from hypothesis import given, settings
from hypothesis import strategies as some
from systems import SOAK

from cramhy_runtime import cpl
from cramhy_runtime.designators import Object, properties, property_values, replace
from cramhy_runtime.prolog import P, V, fact_group, findall, first, function, kw, predicate

EXAMPLES = settings(max_examples=1000 if SOAK else 25, deadline=None, database=None)
ATOMS = (
    some.booleans() | some.integers() | some.floats(allow_nan=False) | some.text(max_size=4) | some.binary(max_size=4) | some.dates()
    | some.decimals(allow_nan=False, allow_infinity=False) | some.sampled_from([kw.red, kw.python_style, datetime.timedelta(1), decimal.Decimal(1)])
)  # fmt: skip
PLAIN = some.recursive(ATOMS, lambda inner: some.lists(inner, min_size=1, max_size=3), max_leaves=6)
TERMS = some.recursive(ATOMS | some.none(), lambda inner: some.lists(inner, max_size=3), max_leaves=6)
OBJECTS = some.dictionaries(some.text(max_size=2), some.integers(), max_size=2)


def same(found, value):
    """Whether the two are equal and of the same types, all the way down."""
    if isinstance(value, list):
        return type(found) is list and len(found) == len(value) and all(map(same, found, value))
    return type(found) is type(value) and found == value


@EXAMPLES
@given(TERMS | OBJECTS)
def test_a_random_term_comes_back_equal(value):
    @function
    def gives(key):
        return value

    @predicate
    def yields(key):
        yield value

    with fact_group("random") as group:
        group.fact(P.random_value("it", value), P.random_value("in a list", [value, 1]))
        group.rule(P.random_rule(V.x), P.random_value("it", V.x))
    for goal in (
        P["=="](V.x, value),
        P.random_value("it", V.x),
        P.random_value("in a list", [V.x, 1]),
        P.random_rule(V.x),
        gives("it", V.x),
        yields("it", V.x),
        P.lisp_fun(lambda key: value, "it", V.x),
        P.member(V.x, [value]),
    ):
        assert same(first(goal).x, value), goal
        assert [same(each, value) for each in findall(V.x, goal)] == [True]
    assert findall(V.key, P.random_value(V.key, value)) == ["it"]


@EXAMPLES
@given(PLAIN | some.just([]) | OBJECTS)
def test_a_random_property_comes_back_equal(value):
    made = Object(type=kw.cup, value=value)
    for each in (made, replace(Object(type=kw.cup), value=value), Object(("value", value), type=kw.cup)):
        assert same(each.value, value) and same(each["value"], value) and same(property_values(each, "value")[0], value)
        assert same(dict(properties(each))["value"], value)


@EXAMPLES
@given(TERMS | OBJECTS)
def test_a_random_value_of_a_fluent_is_the_object_itself(value):
    fluent = cpl.make_fluent(value=value)
    assert fluent.value is value
    fluent.value = None
    fluent.value = value
    assert fluent.value is value and cpl.peek_value(fluent) is value
