"""The engine agrees with a textbook interpreter on random programs, and unification with its laws."""

import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
from prolog_text import HERE, read

from cramhy_runtime import kernel
from cramhy_runtime.lisp.data import Cons, Symbol, list_from
from cramhy_runtime.prolog import facts, query
from cramhy_runtime.utilities import patterns
from cramhy_runtime.utilities.lazy_lists import elements

variables = st.sampled_from([read(f"?{letter}") for letter in "uvwxyz"])
atoms = st.one_of(st.sampled_from([read("a"), read("b"), None, True, 1, 2, 1.0, "s", read(":k")]))
terms = st.recursive(st.one_of(variables, atoms), lambda inner: st.builds(Cons, inner, inner), max_leaves=6)
_FUNCTORS = {name: HERE.intern(name) for name in ("P1", "P2", "P3")}


def normal(term, names):
    """``term`` with variables numbered in order of occurrence, as a Python value that can be compared."""
    if patterns.variable(term):
        return "var", names.setdefault(term, len(names))
    if isinstance(term, Cons):
        return normal(term.car, names), normal(term.cdr, names)
    return type(term).__name__, repr(term)


def canonical(pairs):
    names = {}
    return [normal(term, names) for term in pairs]


@given(terms, terms)
@settings(max_examples=400, deadline=None)
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
    return st.builds(lambda name, arguments: Cons(_FUNCTORS[name], list_from(arguments)), st.sampled_from(callable_names),
                     st.lists(terms, min_size=2, max_size=2))


def goals_over(names):
    """Goals that call only the predicates ``names``, so that programs end."""
    basic = st.builds(lambda a, b: list_from([read("=="), a, b]), terms, terms)
    simple = st.one_of(basic, calls(names)) if names else basic
    return st.one_of(simple, simple, simple, st.recursive(
        simple,
        lambda inner: st.one_of(
            st.builds(lambda goals: Cons(read("and"), list_from(goals)), st.lists(inner, max_size=3)),
            st.builds(lambda goals: Cons(read("or"), list_from(goals)), st.lists(inner, max_size=3)),
            st.builds(lambda goal: list_from([read("not"), goal]), inner),
            st.builds(lambda parts: Cons(read("->"), list_from(parts)), st.lists(inner, min_size=2, max_size=3))),
        max_leaves=4))


def clauses_of(name, below):
    clause = st.builds(lambda arguments, goals: Cons(Cons(_FUNCTORS[name], list_from(arguments)), list_from(goals)),
                       st.lists(terms, min_size=2, max_size=2), st.lists(goals_over(below), max_size=2))
    return st.lists(clause, min_size=1, max_size=4)


programs = st.tuples(clauses_of("P1", []), clauses_of("P2", ["P1"]), clauses_of("P3", ["P1", "P2"]))


@given(programs, goals_over(["P1", "P2", "P3"]))
@settings(max_examples=300, deadline=None)
def test_random_programs_have_the_answers_of_the_textbook(program, goal):
    kernel.start(clock="virtual")
    clauses = [clause for part in program for clause in part]
    group = read("random-program")
    facts.remove_fact_group(group)
    facts.define_fact_group(group, None, clauses)
    symbols = [symbol for symbol in patterns.variables_of(goal)]
    expected = []
    try:
        for bindings in textbook.solve(goal, clauses, {}):
            expected.append(canonical([textbook.substitute(symbol, bindings) for symbol in symbols]))
            if len(expected) > 60:
                break
    except textbook.Cyclic:
        return
    got = []
    for table in elements(query.prolog(goal)):
        got.append(canonical([patterns.var_value(symbol, table) for symbol in symbols]))
        if len(got) > 60:
            break
    facts.remove_fact_group(group)
    assert got == expected


def test_a_fresh_name_is_no_name_of_the_program():
    assert patterns.gen_var().package is None
    assert isinstance(patterns.gen_var("?FOO-"), Symbol)
