"""Terms that contain themselves are an error with a text, never a hang; long and deeply nested ones are terms like others."""

import pytest
from prolog_text import ask, error_text, function, group, read

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import StorageCondition
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.terms.terms import import_term, resolve
from cramhy_runtime.utilities.lazy_lists import force_ll

ENDLESS = "A variable was unified with a list that contains it, which makes the list endless."


@pytest.fixture(autouse=True)
def all_of_lisp():
    boot()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "goal",
    [
        "(== ?x (1 . ?x))",
        "(== ?x (f ?x))",
        "(== (?x ?y) ((?y) (?x)))",
        *(
            f"(and (== ?x {term}) {rest})"
            for term in ("(1 . ?x)", "(f ?x)")
            for rest in (
                "(findall ?x (true) ?l)",
                "(setof ?x (true) ?l)",
                "(ground ?x)",
                "(lisp-fun first ?x ?y)",
                '(format "~a" ?x)',
                "(max ?x ?m)",
                "(filter-bindings (?x))",
                "(every (member ?y (1 2)) (== ?x ?z))",
            )
        ),
        "(and (== ?x (1 . ?x)) (== ?y (1 . ?y)) (== ?x ?y))",
        "(and (== ?x (f ?x)) (== ?y (f ?y)) (== ?x ?y))",
        *(
            f"(and (== ?x (1 . ?x)) {rest})"
            for rest in (
                "(length ?x ?n)",
                "(member 2 ?x)",
                "(once (member 1 ?x))",
                "(append ?x (2) ?y)",
                "(sort ?x < ?y)",
                "(reduce + ?x ?y)",
            )
        ),
    ],
)
def test_a_term_that_contains_itself_is_an_error(goal):
    assert error_text(lambda: ask(goal), StorageCondition) == ENDLESS


def test_a_circular_list_of_lisp_is_an_error():
    circle = read("(1 2 3)")
    circle.cdr.cdr.cdr = circle
    function("circle")(lambda: circle)
    assert error_text(lambda: ask("(lisp-fun circle ?x)"), StorageCondition) == ENDLESS


def test_what_is_not_looked_at_may_be_endless():
    assert ask("(and (once (and (== ?x (1 . ?x)) (== ?x (1 . ?_)))) (fail))") == "NIL"


def nested(depth, innermost, rest=None):
    term = innermost
    for _ in range(depth):
        term = Cons(read("s"), Cons(term, rest))
    return term


@pytest.mark.soak
@pytest.mark.parametrize("depth", [10, 3_000])
def test_deeply_nested_terms_are_terms_like_others(depth):
    x, names = read("?x"), {}
    term = import_term(nested(depth, x), names)
    names[x].ref = 7
    assert resolve(term).cdr.car.car is read("s")
    group("peano", "((less z (s ?_)))", "((less (s ?x) (s ?y)) (less ?x ?y))", "((copied ?x ?y) (findall ?x (true) (?y)))")
    z = read("z")
    goal = Cons(read("less"), Cons(nested(depth, z), Cons(nested(depth + 1, z), None)))
    assert query.prolog(goal) is not None
    copied = query.query_var(read("?y"), query.prolog, Cons(read("copied"), Cons(nested(depth, read("?a")), Cons(read("?y"), None))))
    count = 0
    while isinstance(copied, Cons):
        copied, count = copied.cdr.car, count + 1
    assert count == depth


@pytest.mark.soak
def test_long_lists():
    function("many")(lambda n: list_from([read("a")] * n))
    text = """(and (lisp-fun many 210000 ?l) (append ?l (b) ?m) (length ?m ?n) (once (member b ?m)) (append ?l ?r ?m)
                   (filter-bindings (?n ?r)))"""
    assert ask(text) == "(((?N . 210001) (?R B)))"
    assert force_ll(query.prolog(read("(fail)"))) is None
