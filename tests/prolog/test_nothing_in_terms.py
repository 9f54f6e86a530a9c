"""None, False and an empty list are one term, as Lisp has one object for them, and come back to Python as they went in."""

import pytest

from cramhy_runtime.designators import Motion, Object, properties, property_values
from cramhy_runtime.designators.classes import desig_prop_value
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.prolog import P, V, fact_group, findall, first, function, holds, kw, predicate, query
from cramhy_runtime.prolog.python.terms import Name

NILS = {"None": None, "False": False, "[]": [], "()": ()}


def comes_back(value):
    return [] if value == () else value


def same_kind(found, value):
    return found == comes_back(value) and type(found) is type(comes_back(value))


@pytest.mark.parametrize("name", NILS)
def test_none_false_and_an_empty_list_are_one_term_and_come_back_as_they_went_in(name):
    value = NILS[name]

    @function
    def gives(key):
        return NILS[key]

    @predicate
    def yields(key):
        yield NILS[key]
        yield 1

    with fact_group("nils") as nils:
        nils.fact(*(P.nil_of(key, each) for key, each in NILS.items()), P.nil_of("pair", [1, value]))
        nils.rule(P.nil_by_rule(V.key, V.value), P.nil_of(V.key, V.value))
    for found in (
        first(P["=="](V.x, value)).x,
        findall(V.x, P.nil_of(name, V.x))[0],
        findall(V.x, P.nil_by_rule(name, V.x))[0],
        findall(V.x, P.nil_of("pair", [1, V.x]))[0],
        findall(V.x, P.nil_of("pair", V.x))[0][1],
        findall(V.x, gives(name, V.x))[0],
        findall(V.x, yields(name, V.x))[0],
        findall(V.x, P.member(V.x, [1, value]))[1],
        findall(V.x, P.lisp_fun(lambda key: NILS[key], name, V.x))[0],
    ):
        assert same_kind(found, value), (found, value)
    for other in NILS.values():
        assert holds(P["=="](value, other)) and holds(P["=="]([1, value], [1, other]))
    assert set(findall(V.key, P.nil_of(V.key, value))) == set(NILS) == set(findall(V.key, P.nil_by_rule(V.key, value)))
    assert not holds(P["=="](value, 0)) and not holds(P["=="](value, "")) and not holds(P["=="](value, True))


@pytest.mark.parametrize("name", NILS)
def test_lisp_gets_nil_for_each_of_them(name):
    got = []
    symbol = Symbol("TAKES")
    symbol.function = lambda *arguments: got.append(arguments)
    goal = P["=="](V.x, NILS[name])
    assert query.prolog(goal.form).car.car.cdr is None
    assert holds(P.lisp_pred(Name(symbol), NILS[name])) is False and got == [(None,)]


def test_properties_come_back_too_and_lisp_reads_nil():
    made = Object(("nothing", None), type=kw.cup, clean=False, parts=[], tags={}, number=0, text="", flags=[True, False])
    assert made.clean is False and made["clean"] is False and made.nothing is None
    assert made.parts == [] and isinstance(made.parts, list) and property_values(made, "parts") == [[]]
    assert made.tags == {} and made.number == 0 and made.text == "" and made.flags == [True, False]
    assert dict(properties(made))["clean"] is False
    for name in ("clean", "parts", "nothing"):
        assert desig_prop_value(made, kw[name.upper()]) is None
    assert holds(P.desig_prop(made, [kw.clean, []])) and holds(P.desig_prop(made, [kw.nothing, False]))
    assert holds(P.desig_prop(made, [kw.parts, None])) and not holds(P.desig_prop(made, [kw.number, None]))


class Careful(Motion):
    careful: bool = True
    things: list = ()
    label: str | None = None


def test_declared_properties_are_what_they_are_declared_to_be():
    made = Careful(careful=False, things=[])
    assert made.careful is False and made.things == [] and made.label is None
