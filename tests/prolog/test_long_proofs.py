"""Proofs of any length, deep or in a circle: what they leave behind, and what ends those that would not end by themselves."""

import pytest
from prolog_text import HERE, RegisteredWarnings, ask, error_text, function, group, read

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.condition_types import StorageCondition
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.engine.machine import DEPTH_LIMIT
from cramhy_runtime.prolog.terms.terms import Var

MANY = 50_000


@pytest.fixture(autouse=True)
def arithmetic():
    function("minus-one")(lambda n: n - 1)
    function("plus-one")(lambda n: n + 1)


def run(functor, *arguments):
    """The machine of a goal, which has a solution."""
    m = query.Machine()
    m.prove((query.find_predicate(read(functor), len(arguments)).call, query.SOLVED, *arguments))
    assert m.next_solution()
    return m


@pytest.mark.soak
@pytest.mark.parametrize(
    "start, clauses",
    [
        ("count", ["((count 0))", "((count ?n) (> ?n 0) (lisp-fun minus-one ?n ?m) (count ?m))"]),
        ("count", ["((count ?n) (-> (== ?n 0) (true) (and (lisp-fun minus-one ?n ?m) (count ?m))))"]),
        ("count", ["((count ?n) (or (and (== ?n 0) (cut)) (and (> ?n 0) (lisp-fun minus-one ?n ?m) (cut) (count ?m))))"]),
        ("count", ["((zero 0))", "((count ?n) (-> (zero ?n) (true) (and (lisp-fun minus-one ?n ?m) (count ?m))))"]),
        (
            "count",
            ["((zero 0))", "((count ?n) (not (zero ?n)) (lisp-fun minus-one ?n ?m) (once (member ?m (?m ?m))) (count ?m))", "((count 0))"],
        ),
        (
            "even",
            [
                "((even 0))",
                "((even ?n) (> ?n 0) (lisp-fun minus-one ?n ?m) (odd ?m))",
                "((odd ?n) (> ?n 0) (lisp-fun minus-one ?n ?m) (even ?m))",
            ],
        ),
    ],
)
def test_a_loop_leaves_neither_trail_nor_choice_points_behind(start, clauses):
    group("loop", *clauses)
    m = run(start, MANY)
    assert len(m.trail) < 500 and len(m.choices) <= 1


def test_a_loop_above_an_open_choice_forgets_what_nobody_can_see():
    """The trail must keep what failing would unset, but not the variables of turns that are over."""
    group(
        "count",
        "((count 0))",
        "((count ?n) (> ?n 0) (lisp-fun minus-one ?n ?m) (next ?m))",
        "((next ?n) (count ?n))",
        "((start ?n) (count ?n))",
        "((start ?n))",
    )
    m = run("start", MANY)
    assert len(m.trail) < 12_000 and len(m.choices) <= 2


@pytest.mark.soak
def test_a_million_goals_wait_for_one_another():
    group("walk", "((walk ()))", "((walk (?h . ?t)) (walk ?t) (seen ?h))", "((seen ?h))")
    run("walk", list_from(range(1_000_000)))


def test_goals_with_lisp_functions_wait_for_one_another():
    group("size", "((size () 0))", "((size (?_ . ?t) ?n) (size ?t ?m) (lisp-fun plus-one ?m ?n))")
    n = Var()
    run("size", list_from(range(MANY)), n)
    assert n.ref == MANY


@pytest.mark.soak
def test_a_long_list_is_built_measured_and_appended():
    group(
        "lists",
        "((upto ?n ?n (?n)))",
        "((upto ?n ?m (?n . ?r)) (< ?n ?m) (lisp-fun plus-one ?n ?o) (upto ?o ?m ?r))",
        "((app () ?l ?l))",
        "((app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))",
    )
    assert query.first(read(f"(and (once (upto 1 {MANY} ?l)) (length ?l ?n))"), read("?n")) == MANY
    many = list_from(range(500_000))
    assert len(query.first(list_from([read("app"), many, list_from([1]), read("?l")]), read("?l"))) == 500_001


@pytest.mark.soak
def test_many_choice_points_are_kept_and_taken():
    group("between", "((from ?n ?m ?n) (<= ?n ?m))", "((from ?n ?m ?x) (< ?n ?m) (lisp-fun plus-one ?n ?o) (from ?o ?m ?x))")
    assert ask(f"(and (from 1 {MANY} ?x) (== ?x {MANY}) (cut))") == f"(((?X . {MANY})))"
    assert ask(f"(not (and (from 1 {MANY} ?x) (== ?x 0)))") == "(NIL)"


# --------------------------------------------------------------------------------------------------------- proofs without an end


def too_deep(goal, limit=20_000):
    with binding(DEPTH_LIMIT, limit, sym("*PACKAGE*"), HERE):
        return error_text(lambda: ask(goal), StorageCondition)


def test_a_left_recursion_ends_in_an_error_that_shows_the_clause():
    group("left", "((p ?x) (p ?y) (q ?y ?x))", "((q 1 2))")
    assert too_deep("(p ?x)") == (
        "A proof is more than 20,000 goals deep and goes on, perhaps without end.\n"
        "The goals that wait are of this clause, again and again:\n"
        "  (<- (p ?x) (p ?y) (q ?y ?x)) of left\n"
        "Put a goal that ends the recursion before the one that goes on, or raise CRAM-PROLOG:*PROLOG-DEPTH-LIMIT*."
    )
    assert ask("(q ?x ?y)") == "(((?X . 1) (?Y . 2)))"


def test_a_recursion_through_several_clauses_shows_their_circle():
    group(
        "circle",
        "((a ?x) (b ?x) (true-of ?x))",
        "((b ?x) (or (c ?x) (true-of ?x)) (true-of ?x))",
        "((c ?x) (not (a ?x)))",
        "((true-of ?x))",
    )
    text = too_deep("(a 1)")
    assert "again and again, the innermost first:\n" in text
    assert "  (<- (b ?x) (or (c ?x) (true-of ?x)) (true-of ?x)) of circle\n  (<- (a ?x) (b ?x) (true-of ?x)) of circle\n" in text


def test_a_recursion_that_leaves_choice_points_is_found_too():
    group("choices", "((r ?x) (r ?x))", "((r ?x))")
    assert too_deep("(r 1)").startswith("A proof is more than 20,000 goals deep")


def test_without_a_limit_a_proof_may_be_as_deep_as_it_likes():
    group("walk", "((walk ()))", "((walk (?h . ?t)) (walk ?t) (seen ?h))", "((seen ?h))")
    with binding(DEPTH_LIMIT, None):
        run("walk", list_from(range(MANY)))
    with binding(DEPTH_LIMIT, 30_000):
        assert error_text(lambda: run("walk", list_from(range(MANY))), StorageCondition).startswith("A proof is more than 30,000 goals")


def test_collections_within_collections_without_end_are_an_error():
    group("inner", "((s ?l) (findall ?x (s ?x) ?l))")
    assert "" != error_text(lambda: ask("(s ?l)"), StorageCondition)
    assert ask("(member ?x (1))") == "(((?X . 1)))"


def test_a_group_may_be_redefined_while_a_query_waits_in_it():
    """The goals that the query has entered go on with the clauses that were; those that it enters afterwards see the new ones."""
    function("wait")(lambda n: cpl.sleep(1) or n)
    group("rules", "((step ?x ?y) (item ?x) (lisp-fun wait ?x ?z) (item ?y) (same ?x ?y))", "((same ?x ?x))", "((item 1))", "((item 2))")

    def redefine():
        cpl.sleep(0.5)
        group("rules", "((step 9 9))", "((item 2))", "((item 3))", "((same ?x ?y) (< ?x ?y))")

    answers = []
    with RegisteredWarnings():
        cpl.top_level(lambda: cpl.par(lambda: answers.append(ask("(step ?x ?y)")), redefine))
        assert answers == ["(((?X . 1) (?Y . 2)) ((?X . 1) (?Y . 3)) ((?X . 2) (?Y . 3)))"]
        assert ask("(step ?x ?y)") == "(((?X . 9) (?Y . 9)))"


def test_a_group_may_be_removed_while_a_query_waits_in_it():
    function("wait")(lambda n: cpl.sleep(1) or n)
    group("rules", "((step ?x) (item ?x) (lisp-fun wait ?x ?z))", "((item 1))", "((item 2))")
    answers = []
    cpl.top_level(
        lambda: cpl.par(lambda: answers.append(ask("(step ?x)")), lambda: (cpl.sleep(0.5), facts.remove_fact_group(read("rules"))))
    )
    assert answers == ["(((?X . 1)) ((?X . 2)))"]


@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@pytest.mark.parametrize("goal", ["(forever)", "(forever-in-turn 1)", "(and (or-forever) (fail))", "(nothing-ever)"])
def test_a_proof_that_never_ends_is_evaporated(backend, goal):
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    kernel.stop()
    kernel.start(clock="virtual", backend=backend, time_limit=3600)
    group(
        "endless",
        "((forever) (forever))",
        "((forever-in-turn ?n) (lisp-fun plus-one ?n ?m) (forever-in-turn ?m))",
        "((or-forever))",
        "((or-forever) (or-forever))",
        *(f"((row {n}))" for n in range(30)),
        "((nothing-ever) (row ?a) (row ?b) (row ?c) (row ?d) (row ?e) (row ?f) (row ?g) (fail))",
    )
    cpl.top_level(lambda: cpl.pursue(lambda: cpl.sleep(0.1), lambda: ask(goal)))
    assert ask("(member ?x (1))") == "(((?X . 1)))"
