"""A predicate that goes along a list, one solution at a time: its alternatives come from a generator, and nobody can tell."""

from __future__ import annotations

import pytest
from prolog_text import ask, first, group, read, show

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.engine.machine import again
from cramhy_runtime.prolog.query import Proof
from cramhy_runtime.utilities.lazy_lists import force_ll, from_iterator, lazy_cdr

MEM = ("((mem ?x (?x . ?_)))", "((mem ?x (?_ . ?t)) (mem ?x ?t))")
LAST = ("((last (?x) ?x))", "((last (?_ . ?t) ?x) (last ?t ?x))")
PAIR = ("((pair ?x ?y (?x ?y . ?_)))", "((pair ?x ?y (?y ?x . ?_)))", "((pair ?x ?y (?_ . ?t)) (pair ?x ?y ?t))")
TESTED = ("((big ?x (?x . ?_)) (== ?x (?_ . ?_)))", "((big ?x (?_ . ?t)) (big ?x ?t))")


def kinds_of_choices(goal):
    proof = Proof(read(goal))
    assert proof.next_solution()
    return [step[0] for step in proof.choices]


def test_the_alternatives_of_a_list_come_from_a_generator():
    group("lists", *MEM)
    assert kinds_of_choices("(mem ?x (1 2))") == [again]
    group("lists", *MEM, "((mem ?x ?_) (never ?x))", "((never 0))")  # the last clause calls something else
    assert again not in kinds_of_choices("(mem ?x (1 2))")


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize(
    "goal, found",
    [
        ("(mem ?x (1 2 3))", "1 2 3"),
        ("(mem (a ?x) ((a 1) (b 2) ?y (a 3)))", "1 ?X 3"),
        ("(and (mem ?x (1 2 3)) (mem ?x (3 2)))", "2 3"),
        ("(and (mem ?x (1 2 3)) (cut))", "1"),
        ("(once (mem ?x (1 2 3)))", "1"),
        ("(or (once (mem ?x (1 2 3))) (mem ?x (4)))", "1 4"),
        ("(-> (mem ?x (1 2 3)) (true) (fail))", "1"),
        ("(*-> (mem ?x (1 2 3)) (true) (fail))", "1 2 3"),
        ("(and (not (mem 4 (1 2 3))) (mem ?x (5)))", "5"),
        ("(and (findall ?y (mem ?y (1 2 3)) ?l) (mem ?x ?l))", "1 2 3"),
        ("(and (setof ?y (mem ?y (1 2 1)) ?l) (length ?l ?x))", "2"),
        ("(and (mem ?y (1 2)) (findall (?y ?z) (mem ?z (?y a)) ?l) (length ?l ?x))", "2 2"),
        ("(and (forall (mem ?y (1 2)) (mem ?y (2 1))) (== ?x yes))", "YES"),
        ("(and (last (1 2 3) ?x))", "3"),
        ("(pair 1 ?x (1 2 1 3))", "2 2 3"),
        ("(big ?x (1 (2) 3 (4 5)))", "(2) (4 5)"),
        ("(and (== ?x (?a ?b ?c)) (mem 1 ?x) (mem 2 ?x) (mem 3 ?x))", "(1 2 3) (1 3 2) (2 1 3) (3 1 2) (2 3 1) (3 2 1)"),
        ("(and (mem ?x ()))", ""),
        ("(and (mem ?x 7))", ""),
        ("(and (mem ?x (1 2 . 7)))", "1 2"),
    ],
)
def test_solutions(goal, found):
    group("lists", *MEM, *LAST, *PAIR, *TESTED)
    shown = [show(answer[read("?x")]) if read("?x") in answer else "?X" for answer in query.solve(read(goal))]
    assert " ".join(shown) == found
    collected = force_ll(query.prolog(read(goal)))
    assert len(list(collected or ())) == len(shown)


def test_an_open_list_grows_and_each_solution_undoes_what_it_alone_set():
    group("lists", *MEM)
    answers = first("(and (mem a ?l) (mem b ?l))")
    found = []
    for _ in range(3):
        found.append(show(answers.car))
        answers = lazy_cdr(answers)
    assert all(text.startswith("((?L A ") and " B . " in text for text in found)
    assert len({text.count(" ") for text in found}) == 3  # each list is longer than the one before
    assert ask("(and (== ?l (?a ?b)) (mem 1 ?l) (mem 2 ?l))") == "(((?L 1 2) (?A . 1) (?B . 2)) ((?L 2 1) (?A . 2) (?B . 1)))"


def test_a_list_that_comes_element_by_element_is_computed_as_far_as_it_is_read():
    group("lists", *MEM)
    asked = []
    numbers = from_iterator(asked.append(n) or n for n in range(1000))
    solutions = query.solve(list_from([read("mem"), read("?x"), numbers]))
    assert [next(solutions)[read("?x")] for _ in range(3)] == [0, 1, 2]
    assert len(asked) <= 4


def test_a_predicate_that_changes_goes_on():
    group("lists", *MEM)
    solutions = query.solve(list_from([read("mem"), read("?x"), list_from(range(250))]))
    assert next(solutions)[read("?x")] == 0
    group("lists", "((mem done ?_))")
    rest = [answer[read("?x")] for answer in solutions]
    assert rest[:50] == list(range(1, 51))
    assert rest[-1] in (249, read("done"))
    assert ask("(mem ?x (1))") == "(((?X . DONE)))"


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@pytest.mark.parametrize("rest", ["(== 1 2)", "(mem 2 ?l)"])
def test_an_endless_enumeration_is_evaporated(backend, rest):
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    kernel.stop()
    kernel.start(clock="virtual", backend=backend, time_limit=3600)
    group("lists", *MEM)
    cpl.top_level(lambda: cpl.pursue(lambda: cpl.sleep(0.1), lambda: ask(f"(and (== ?l (1 . ?l)) (mem 1 ?l) {rest})")))
    cpl.top_level(lambda: cpl.pursue(lambda: cpl.sleep(0.1), lambda: ask("(and (== ?l (1 . ?l)) (not (and (mem 1 ?l) (fail))))")))
    assert ask("(mem ?x (1))") == "(((?X . 1)))"


def test_the_collection_of_very_many_solutions_lets_others_run():
    group("lists", *MEM)
    turns = []

    def other():
        for _ in range(20):
            turns.append(1)
            kernel.yield_()

    task = kernel.spawn(other, name="other")
    long = list_from(range(20_000))
    found = force_ll(query.prolog(list_from([read("mem"), read("?x"), long])))
    assert len(list(found)) == 20_000 and turns
    task.join("the other")
