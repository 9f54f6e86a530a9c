"""Random Lisp data as goals and as fact groups: a list of solutions, nil, or a Lisp condition; never an error of Python's, never a hang."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import SOAK
from prolog_text import RegisteredWarnings, read

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.prolog.builtins import control
from cramhy_runtime.prolog.engine import database, fact_groups as facts
from cramhy_runtime.prolog import query
from cramhy_runtime.utilities.lazy_lists import elements

boot()
FUNCTORS = sorted(
    {*control.CONTROL, *(name for name, entry in database.functors.items() if entry.defined and name.package is not None)},
    key=lambda symbol: (symbol.package.name, symbol.name),
)
FUNCTORS = [
    symbol
    for symbol in FUNCTORS
    if symbol.package.name in ("COMMON-LISP", "CRAM-PROLOG")
    and symbol.name not in ("SET-SYMBOL-VALUE", "LISP-FUN", "LISP-PRED", "GENERATE-VALUES", "FORMAT")
]
FUNCTIONS = [read(name) for name in "list + car cons length list1 ?f 5".split()]
atoms = st.one_of(
    st.sampled_from([read(text) for text in "?x ?y ?z ?_ a b nil t :k 0 1 2 -1 1.5 member and foo".split()]),
    st.sampled_from(['"s"', "~a", 10**30]),
)
forms = st.recursive(
    atoms,
    lambda inner: st.builds(
        lambda items, end: list_from(items, end), st.lists(inner, max_size=4), st.one_of(st.none(), st.none(), st.none(), inner)
    ),
    max_leaves=8,
)


def goals_of(inner):
    return st.one_of(
        st.builds(
            lambda functor, arguments, end: Cons(functor, list_from(arguments, end)),
            st.sampled_from(FUNCTORS),
            st.lists(st.one_of(inner, forms), max_size=4),
            st.one_of(st.none(), st.none(), st.none(), st.none(), atoms),
        ),
        st.builds(
            lambda kind, function, arguments: Cons(kind, Cons(function, list_from(arguments))),
            st.sampled_from([read("lisp-fun"), read("lisp-pred")]),
            st.sampled_from(FUNCTIONS),
            st.lists(forms, max_size=3),
        ),
    )


goals = st.recursive(forms, goals_of, max_leaves=8)


def tried(goal):
    """Prove ``goal``, no more than ten solutions of it."""
    kernel.start(clock="virtual")
    outcome = []
    with RegisteredWarnings():
        try:
            solutions = query.prolog(goal)
            assert solutions is None or isinstance(solutions, Cons)
            for bindings in elements(solutions):
                outcome.append(bindings)
                assert bindings is None or isinstance(bindings, Cons)
                if len(outcome) == 10:
                    break
        except (Condition, RecursionError):  # what Lisp programs see as a storage-condition
            pass


@pytest.mark.soak
@given(goals)
@settings(max_examples=150 if SOAK else 50, deadline=None)
def test_anything_can_be_asked(goal):
    tried(goal)


@pytest.mark.soak
@given(
    st.lists(
        st.one_of(
            forms,
            st.builds(
                lambda head, body: Cons(head, list_from(body)),
                st.builds(
                    lambda functor, arguments: Cons(functor, list_from(arguments)),
                    st.sampled_from([read("p"), read("q"), read("member")]),
                    st.lists(forms, max_size=2),
                ),
                st.lists(goals, max_size=2),
            ),
        ),
        max_size=4,
    ),
    forms,
    forms,
)
@settings(max_examples=100 if SOAK else 50, deadline=None)
def test_anything_can_be_a_fact_group(clauses, extendable, argument):
    kernel.start(clock="virtual")
    name = read("at-random")
    facts.remove_fact_group(name)
    facts.define_fact_group(name, None, [read("((p 1))")])
    with RegisteredWarnings():
        try:
            facts.define_fact_group(name, extendable, clauses)
        except Condition:
            assert query.holds(read("(p 1)"))
            return
        finally:
            defined = [Cons(read(functor), Cons(argument, None)) for functor in ("p", "q")]
    try:
        for goal in defined:
            if database.functors.get(goal.car) is not None:
                tried(goal)
    finally:
        facts.remove_fact_group(name)
