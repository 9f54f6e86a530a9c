"""The engine agrees with a textbook interpreter on random programs, and unification with its laws."""

import pytest
import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import SOAK
from prolog_text import HERE, read

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog import query
from cramhy_runtime.utilities import patterns
from cramhy_runtime.utilities.lazy_lists import LazyTail, elements

variables = st.sampled_from([read(f"?{letter}") for letter in "uvwxyz"])
atoms = st.one_of(st.sampled_from([read("a"), read("b"), None, True, 1, 2, 1.0, "s", read(":k")]))
terms = st.recursive(st.one_of(variables, atoms), lambda inner: st.builds(Cons, inner, inner), max_leaves=6)
_FUNCTORS = {name: HERE.intern(name) for name in ("P1", "P2", "P3")}


def normal(term, names):
    """``term`` with variables numbered in order of occurrence, as a Python value that can be compared; lazy lists are computed."""
    if isinstance(term, LazyTail):
        return normal(term.force(), names)
    if patterns.variable(term):
        return "var", names.setdefault(term, len(names))
    if isinstance(term, Cons):
        return normal(term.car, names), normal(term.cdr, names)
    return type(term).__name__, repr(term)


def canonical(pairs):
    names = {}
    return [normal(term, names) for term in pairs]


@pytest.mark.soak
@given(terms, terms)
@settings(max_examples=150 if SOAK else 60, deadline=None)
def test_unification_makes_both_sides_the_same(a, b):
    kernel.start(clock="virtual")
    try:
        expected = textbook.unify(a, b, {})
    except textbook.Cyclic:
        return
    wanted = None if expected is None else canonical([textbook.substitute(a, expected)])
    bindings, unified = patterns.unify(a, b)
    assert bool(unified) == (expected is not None)
    if unified:
        left, right = patterns.substitute_vars(a, bindings), patterns.substitute_vars(b, bindings)
        assert canonical([left]) == canonical([right]) == wanted
    solution = query.prolog(list_from([read("=="), a, b]))
    assert (solution is not None) == (expected is not None)
    if solution is not None:
        table = solution.car
        assert canonical([patterns.substitute_vars(a, table)]) == canonical([patterns.substitute_vars(b, table)]) == wanted


def calls(callable_names):
    return st.builds(
        lambda name, arguments: Cons(_FUNCTORS[name], list_from(arguments)),
        st.sampled_from(callable_names),
        st.lists(terms, min_size=2, max_size=2),
    )


def compound(name, *parts):
    return st.tuples(*parts).map(lambda items: list_from([read(name), *items]))


def goals_over(names):
    """Goals that call only the predicates ``names``, so that programs end."""
    basic = compound("==", terms, terms)
    simple = st.one_of(basic, calls(names), st.just(list_from([read("cut")]))) if names else basic
    return st.one_of(
        simple,
        simple,
        simple,
        st.recursive(
            simple,
            lambda inner: st.one_of(
                *(
                    st.lists(inner, max_size=3).map(lambda goals, name=name: Cons(read(name), list_from(goals)))
                    for name in ("and", "or", "once")
                ),
                compound("not", inner),
                compound("call", inner),
                compound("forall", inner, inner),
                *(compound(name, terms, inner, terms) for name in ("findall", "bagof")),
                *(compound(name, *[inner] * count) for name in ("->", "*->") for count in (2, 3)),
            ),
            max_leaves=5,
        ),
    )


def clauses_of(name, below):
    clause = st.builds(
        lambda arguments, goals: Cons(Cons(_FUNCTORS[name], list_from(arguments)), list_from(goals)),
        st.lists(terms, min_size=2, max_size=2),
        st.lists(goals_over(below), max_size=2),
    )
    return st.lists(clause, min_size=1, max_size=4)


programs = st.tuples(clauses_of("P1", []), clauses_of("P2", ["P1"]), clauses_of("P3", ["P1", "P2"]))


MOST = 60
"""Solutions of a program that are compared."""


def answers_of(goal, symbols):
    """The values of ``symbols`` in the answers that the engine gives."""
    got = []
    for table in elements(query.prolog(goal)):
        got.append(canonical([patterns.substitute_vars(symbol, table) for symbol in symbols]))
        if len(got) > MOST:
            break
    return got


def compare_with_textbook(goal, clauses, times=1):
    """Ask ``goal`` some ``times`` in a group of ``clauses``; the answers are those of the textbook, up to `MOST`."""
    kernel.start(clock="virtual")
    symbols = [symbol for symbol in patterns.variables_of(goal)]
    expected = []
    try:
        for bindings in textbook.solve(goal, clauses, {}, textbook.Barrier()):
            expected.append(canonical([textbook.substitute(symbol, bindings) for symbol in symbols]))
            if len(expected) > MOST:
                break
    except textbook.Cyclic:
        return
    group = read("random-program")
    facts.remove_fact_group(group)
    facts.define_fact_group(group, None, clauses)
    try:
        for _ in range(times):
            assert answers_of(goal, symbols) == expected
    finally:
        facts.remove_fact_group(group)


@given(programs, goals_over(["P1", "P2", "P3"]))
@settings(max_examples=150 if SOAK else 60, deadline=None)
def test_random_programs_have_the_answers_of_the_textbook(program, goal):
    """Asked as data, which is interpreted, and as the body of a clause, which is compiled."""
    clauses = [clause for part in program for clause in part]
    compare_with_textbook(goal, clauses)
    head = Cons(HERE.intern("WHOLE-GOAL"), list_from(patterns.variables_of(goal)))
    compare_with_textbook(head, [*clauses, list_from([head, goal])])


values = st.one_of(
    st.sampled_from([read("a"), read("b"), read("c"), None, True, 1, 2, 1.0, "s", read(":k")]),
    st.sampled_from([read("(a 1)"), read("(a b)"), read("(b)"), read("(1 a)")]),
)
plain_values = st.sampled_from([read("a"), read("b"), read("c"), 1, "s"])
patterns_of_values = st.one_of(
    variables, variables, variables, values, st.sampled_from([read("(a ?x)"), read("(?x . ?y)"), read("(b . ?z)")])
)


def table(name, arity, of):
    return st.lists(
        st.lists(of, min_size=arity, max_size=arity).map(lambda row: list_from([Cons(HERE.intern(name), list_from(row))])),
        min_size=1,
        max_size=8,
    )


def asked(name, arity, arguments):
    return st.lists(arguments, min_size=arity, max_size=arity).map(lambda row: Cons(HERE.intern(name), list_from(row)))


@pytest.mark.soak
@given(
    st.tuples(table("R1", 1, values), table("R2", 2, values), table("R3", 3, values)),
    st.lists(st.one_of(*(asked(f"R{arity}", arity, patterns_of_values) for arity in (1, 2, 3))), min_size=1, max_size=3),
)
@settings(max_examples=100 if SOAK else 50, deadline=None)
def test_facts_have_the_answers_of_the_textbook(tables, goals):
    compare_with_textbook(Cons(read("and"), list_from(goals)), sum(tables, []))


@pytest.mark.soak
@given(
    st.tuples(table("R1", 1, plain_values), table("R2", 2, plain_values), table("R3", 3, plain_values)),
    st.lists(
        st.one_of(*(asked(f"R{arity}", arity, st.one_of(variables, variables, plain_values)) for arity in (1, 2, 3))),
        min_size=1,
        max_size=4,
    ),
)
@settings(max_examples=100 if SOAK else 50, deadline=None)
def test_joins_that_are_asked_again_have_the_answers_of_the_textbook(tables, goals):
    compare_with_textbook(Cons(read("and"), list_from(goals)) if len(goals) > 1 else goals[0], sum(tables, []), times=3)


items = st.one_of(st.sampled_from([read("?u"), read("?v")]), plain_values)


def partial_list(tail):
    return st.builds(list_from, st.lists(items, max_size=4), st.sampled_from([None, read(tail)]))


APPEND = [read("((app () ?l ?l))"), read("((app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))")]


@pytest.mark.soak
@given(partial_list("?x"), partial_list("?y"), partial_list("?z"))
@settings(max_examples=100 if SOAK else 50, deadline=None)
def test_lists_that_a_loop_builds_are_those_of_the_textbook(a, b, c):
    compare_with_textbook(list_from([read("app"), a, b, c]), APPEND)


def test_a_loop_that_runs_along_the_list_that_it_builds_never_ends():
    """``?rest`` is both what is read and what is built, so each turn reads what the one before it has built."""
    kernel.start(clock="virtual")
    facts.define_fact_group(read("loop"), None, APPEND)
    ended = []
    cpl.top_level(
        lambda: cpl.pursue(lambda: cpl.sleep(0.01), lambda: ended.append(query.prolog(read("(and (== ?l (1 . ?rest)) (app ?l () ?rest))"))))
    )
    assert not ended


def test_a_fresh_name_is_no_name_of_the_program():
    assert patterns.gen_var().package is None
    assert isinstance(patterns.gen_var("?FOO-"), Symbol)
