"""``(explain goal)``: which clause came furthest, which goal of it failed, and why; what proves a goal; proofs without end."""

import pytest
from systems import SOAK
import textbook
from hypothesis import given, settings
from hypothesis import strategies as st
from prolog_text import HERE, group, read
from test_against_reference import canonical, goals_over, programs

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.prolog.explanations import explaining
from cramhy_runtime.prolog.engine import fact_groups as facts, machine
from cramhy_runtime.prolog import query
from cramhy_runtime.prolog.explanations.explanations import explain
from cramhy_runtime.prolog.terms.terms import resolve, unify

boot()

FAMILY = (
    "((parent abe homer))",
    "((parent homer bart))",
    "((parent homer lisa))",
    "((age abe 80))",
    "((age bart 10))",
    "((grand ?x ?z) (parent ?x ?y) (parent ?y ?z))",
    "((old ?x) (age ?x ?a) (> ?a 60))",
    "((wise ?x) (old ?x) (not (silly ?x)) (lisp-fun list ?x 1 ?s) (== ?s (?_ 4)))",
    "((wise ?x) (or (and (age ?x ?a) (> ?a 100)) (parent ?x ?x)))",
    "((silly homer))",
)


@pytest.fixture
def family():
    group("family", *FAMILY)


def told(goal, **options):
    with binding(sym("*PACKAGE*"), HERE):
        return str(explain(read(goal), **options))


# ------------------------------------------------------------------------------------------------------------- what it tells


def test_the_goal_that_failed_is_shown_in_its_clause_with_the_bindings_there(family):
    assert (
        told("(old bart)")
        == """\
(old bart) has no solution.
There is one clause, clause 1 of family:
  (old ?x)
  holds  (age ?x ?a)
  FAILS  (> ?a 60)
           10 is not greater than 60.
  with ?x = bart, ?a = 10"""
    )


def test_of_several_clauses_the_one_that_came_furthest_is_told_and_the_others_in_a_line(family):
    assert (
        told("(wise abe)")
        == """\
(wise abe) has no solution.
Of 2 clauses this one came furthest, clause 1 of family:
  (wise ?x)
  holds  (old ?x)
  holds  (not (silly ?x))
  holds  (lisp-fun list ?x 1 ?s)
  FAILS  (== ?s (?_ 4))
           Element 2: 1 is not 4.
  with ?x = abe, ?s = (abe 1)
The others:
  clause 2: 80 is not greater than 100"""
    )


def test_the_explanation_goes_down_to_the_real_culprit(family):
    assert (
        told("(wise bart)")
        == """\
(wise bart) has no solution.
Of 2 clauses this one came furthest, clause 2 of family:
  (wise ?x)
  FAILS  (or (and (age ?x ?a) (> ?a 100)) (parent ?x ?x))
           (and (age bart ?a) (> ?a 100)) fails:
             holds  (age ?x ?a)
             FAILS  (> ?a 100)
                      10 is not greater than 100.
             with ?a = 10
  with ?x = bart
The others:
  clause 1: 10 is not greater than 60"""
    )
    assert (
        told("(grand bart ?who)")
        == """\
(grand bart ?who) has no solution.
There is one clause, clause 1 of family:
  (grand ?x ?z)
  FAILS  (parent ?x ?y)
           None of the 3 clauses of parent matches; in the nearest, clause 1 of family, argument 1 is abe, not bart.
    -    (parent ?y ?z)
  with ?x = bart"""
    )


def test_a_goal_that_fails_for_every_solution_before_it_says_how_often(family):
    group("gifts", "((gift ?x) (parent homer ?x) (likes ?x ?y) (== ?y flute))", "((likes bart skateboard))", "((likes lisa book))")
    assert (
        told("(gift ?who)")
        == """\
(gift ?who) has no solution.
There is one clause, clause 1 of gifts:
  (gift ?x)
  holds  (parent homer ?x)
  holds  (likes ?x ?y)
  FAILS  (== ?y flute) for each of 2 solutions of the goals before it; for one:
           skateboard is not flute.
  with ?x = bart, ?y = skateboard"""
    )


def test_what_is_called_outside_of_clauses_is_told_without_them(family):
    assert (
        told("(and (parent ?x ?y) (age ?y ?a) (> ?a 20))")
        == """\
(and (parent ?x ?y) (age ?y ?a) (> ?a 20)) has no solution.
holds  (parent ?x ?y)
holds  (age ?y ?a)
FAILS  (> ?a 20)
         10 is not greater than 20.
with ?x = homer, ?y = bart, ?a = 10"""
    )


@pytest.mark.parametrize(
    "goal, reason",
    [
        (
            "(parent hommer ?x)",
            "None of the 3 clauses of parent matches; in the nearest, clause 2 of family, argument 1 is homer, not hommer.",
        ),
        (
            "(parent homer maggie)",
            "None of the 3 clauses of parent matches; in the nearest, clause 2 of family, argument 2 is bart, not maggie.",
        ),
        ("(silly bart)", "The only clause of silly does not match: in clause 1 of family, argument 1 is homer, not bart."),
        ("(parent ?x)", "It has 1 argument, and parent takes 2."),
        ("(parent ?x ?y ?z)", "It has 3 arguments, and parent takes 2."),
        ("(length (1 2))", "It has 1 argument, and length takes 2."),
        ("(parnet homer ?x)", "Nobody defines parnet; did you mean parent?"),
        ("(xyzzy)", "Nobody defines xyzzy."),
        (
            "(cl-user::parent homer ?x)",
            "Nobody defines common-lisp-user::parent; there is prolog-tests-here:parent, another symbol of that name: write it so, or import it.",
        ),
        ("(?goal 1)", "?goal is not a functor; (call ?goal) proves a goal that is the value of a variable."),
        ("(not (parent abe homer))", "(parent abe homer) holds."),
        ("(== (a b (c d)) (a b (c e)))", "Element 3: of it element 2: d is not e."),
        ("(== (1 2) (1 2 3))", "One list is shorter than the other."),
        ("(== ?x 1)", None),
        ("(< 5 3)", "5 is not less than 3."),
        ("(>= ?x 3)", "?x has no value."),
        ("(bound ?x)", "?x has no value."),
        ("(and (== ?x (1 ?y)) (ground ?x))", None),
        ("(ground (1 ?y))", "?y has no value."),
        ("(member dogg (cat dog))", ("dogg is not among (cat dog); did you mean dog?")),
        ("(member 4 (1 2))", "4 is not among (1 2)."),
        ("(member 4 ())", "The list is empty."),
        ("(length (1 2) 3)", "The list has 2 elements, not 3."),
        ("(lisp-type 3 string)", "3 is not of type string."),
        ("(lisp-fun list 1 2 (1 3))", "(list 1 2) returned (1 2), which is not (1 3)."),
        ("(lisp-pred consp 3)", "(consp 3) returned nil."),
        (
            "(-> (silly bart) (true))",
            "(silly bart) fails:\n  The only clause of silly does not match: in clause 1 of family, argument 1 is homer, not bart.",
        ),
        (
            "(forall (parent homer ?x) (age ?x ?a))",
            "(age lisa ?a) fails:\n"
            "  None of the 2 clauses of age matches; in the nearest, clause 1 of family, argument 1 is abe, not lisa.",
        ),
        (
            "(bagof ?x (silly lisa) ?l)",
            "(silly lisa) fails:\n  The only clause of silly does not match: in clause 1 of family, argument 1 is homer, not lisa.",
        ),
        ("(findall ?x (parent homer ?x) (bart))", "What the solutions of (parent homer ?x) give is not (bart)."),
        ("(rete-holds (on cup ?where))", "No fact that is asserted matches (on cup ?where)."),
    ],
)
def test_reasons(family, goal, reason):
    text = told(goal)
    if reason is None:
        assert "has no solution" not in text or goal.startswith("(and")
    else:
        assert text == f"{text.splitlines()[0]}\n{reason}" and text.splitlines()[0].endswith(" has no solution.")


def test_a_lisp_function_that_signals_is_told_with_its_error(family, warnings_given):
    assert told("(lisp-fun length foo ?n)").startswith("(lisp-fun length foo ?n) has no solution.\n(length foo) signalled an error: ")
    assert len(warnings_given) == 1, "and it warns as in every proof"


def test_an_error_that_ends_the_proof_is_told_with_the_goals_it_was_in():
    group("broken", "((broken ?x) (== ?x 1) (not))")
    assert (
        told("(broken ?y)")
        == """\
The proof of (broken ?y) ends with an error: invalid number of arguments: 0
It was in these goals, the outermost first:
  (broken ?y)
  (not)"""
    )


def test_what_holds_is_told_with_the_clauses_that_prove_it(family):
    assert (
        told("(grand abe ?who)")
        == """\
(grand abe ?who) holds with ?who = bart.
  (grand abe bart)  by clause 1 of family
    (parent abe homer)  by clause 1 of family
    (parent homer bart)  by clause 2 of family"""
    )
    assert (
        told("(and (or (silly bart) (age abe ?a)) (not (silly abe)))")
        == """\
(and (or (silly bart) (age abe ?a)) (not (silly abe))) holds with ?a = 80.
  (or (silly bart) (age abe 80))
    (age abe 80)  by clause 1 of family
  (not (silly abe))"""
    )


def test_of_a_large_table_the_nearest_fact_is_told():
    group("table", *(f"((row {number} {number * number}))" for number in range(3000)), "((rows ?x) (row ?x ?y) (row ?y ?z) (row ?z 7))")
    assert (
        told("(row 2000 7)")
        == """\
(row 2000 7) has no solution.
None of the 3000 clauses of row matches; in the nearest, clause 2001 of table, argument 2 is 4000000, not 7."""
    )
    assert told("(rows 3)").splitlines()[-2:] == [
        "           None of the 3000 clauses of row matches; in the nearest, clause 82 of table, argument 2 is 6561, not 7.",
        "  with ?x = 3, ?y = 9, ?z = 81",
    ]
    machine, _ = explaining.start(read("(rows 3)"), 1000)
    assert not machine.next_solution() and len(machine.record.root.attempts) == 1
    last = machine.record.root.attempts[0].boxes[2][0]
    assert last.tried == 3000 and len(last.attempts) < 600, "it remembers no more than it needs"


def test_long_values_are_cut_short():
    group("long", "((long ?l ?n) (length ?l ?n))")
    numbers = " ".join(map(str, range(100)))
    assert (
        told(f"(long ({numbers}) 3)")
        == """\
(long (0 1 2 3 4 5 6 7 8 9 10 11 ...) 3) has no solution.
There is one clause, clause 1 of long:
  (long ?l ?n)
  FAILS  (length ?l ?n)
           The list has 100 elements, not 3.
  with ?l = (0 1 2 3 4 5 6 7 8 9 10 11 ...), ?n = 3"""
    )


# ------------------------------------------------------------------------------------------------------------- without an end


def test_a_goal_that_comes_back_to_itself_is_told():
    group("paths", "((path ?x ?y) (path ?x ?z) (edge ?z ?y))", "((path ?x ?y) (edge ?x ?y))", "((edge a b))")
    assert (
        told("(path a ?where)", limit=100)
        == """\
The proof of (path a ?where) was given up after 100 goals; it may be endless. It was in these goals, the outermost first:
  (path a ?where)
  (path a ?z)
  (path a ?z)
  (path a ?z)
  ... 92 more ...
  (path a ?z)
  (path a ?z)
  (path a ?z)
  (path a ?z)
(path a ?z) comes back to itself through clause 1 of paths: nothing has changed in between, so it never ends."""
    )


def test_a_proof_that_only_takes_long_says_how_to_go_on():
    group("count", "((down 0))", "((down ?n) (> ?n 0) (lisp-fun 1- ?n ?m) (down ?m))")
    assert told("(down 1000)", limit=50).splitlines()[-1] == "If it only takes long, allow it more goals: (explain goal :limit 500)."
    assert told("(down 1000)").startswith("(down 1000) holds.")


def test_a_limit_that_is_none_is_refused():
    with pytest.raises(Error) as problem:
        explain(read("(loop)"), limit=0)
    assert str(problem.value) == "The :LIMIT of EXPLAIN is the number of goals after which a proof is given up, 1 or more: 0 is none."


def test_what_is_no_goal_is_refused():
    with pytest.raises(Error) as problem:
        explain(3)
    assert str(problem.value) == "EXPLAIN takes a goal, quoted as for PROLOG, or a designator: 3 is neither."


def test_an_endless_proof_inside_of_a_findall_is_given_up_too():
    group("loop", "((loop) (loop))")
    assert told("(findall 1 (loop) ?l)", limit=50).startswith("The proof of (findall 1 (loop) ?l) was given up after 50 goals")


# ------------------------------------------------------------------------------------------------------- agreement, and faces


def solutions(proof, symbols, variables):
    found = []
    while len(found) < 60 and proof.next_solution():
        found.append(canonical([resolve(variables[symbol]) if symbol in variables else symbol for symbol in symbols]))
    return found


def unify_without_cycles(a, b, trail):
    textbook.unify(resolve(a), resolve(b), {})
    return unify(a, b, trail)


def explained_solutions(goal):
    """What the explainer finds, and the variables of the goal; `textbook.Cyclic` where a variable would become part of its value."""
    proof, variables = explaining.start(goal, 100_000)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(machine, "unify", unify_without_cycles)
        patch.setattr(explaining, "unify", unify_without_cycles)
        return solutions(proof, list(variables), variables), variables


def with_cut(goals):
    """Goals in which some conjunctions and conditions cut, and solutions are collected."""
    cut = list_from([read("cut")])
    return st.one_of(
        goals,
        st.builds(lambda a, b: list_from([read("and"), a, cut, b]), goals, goals),
        st.builds(lambda a, b: list_from([read("or"), list_from([read("and"), a, cut]), b]), goals, goals),
        st.builds(lambda a: list_from([read("once"), a]), goals),
        st.builds(lambda a, b: list_from([read("*->"), a, b]), goals, goals),
        st.builds(lambda a: list_from([read("findall"), read("(?u ?v)"), a, read("?w")]), goals),
        st.builds(lambda a, b: list_from([read("forall"), a, b]), goals, goals),
        st.builds(lambda a: list_from([read("call"), list_from([read("and"), a, cut])]), goals),
    )


@given(programs, with_cut(goals_over(["P1", "P2", "P3"])), st.lists(st.integers(0, 20), max_size=4))
@settings(max_examples=300 if SOAK else 40, deadline=None)
def test_an_explained_proof_finds_the_solutions_of_the_engine(program, goal, cuts):
    kernel.start(clock="virtual")
    clauses = [clause for part in program for clause in part]
    for number in cuts:  # some clauses begin with a cut
        at = number % len(clauses)
        clauses[at] = Cons(clauses[at].car, Cons(list_from([read("cut")]), clauses[at].cdr))
    name = read("random-program")
    facts.remove_fact_group(name)
    facts.define_fact_group(name, None, clauses)
    try:
        explained, variables = explained_solutions(goal)
        proof = query.Proof(goal)
        assert explained == solutions(proof, list(variables), dict(proof.variables))
        assert explain(goal, 100_000).outcome == ("holds" if explained else "fails")
    except textbook.Cyclic:
        pass
    finally:
        facts.remove_fact_group(name)


def test_lisp_functions_are_called_as_often_as_in_a_proof(family):
    calls = []
    read("note").function = lambda item: calls.append(item) or True
    goal = read("(and (parent ?x ?y) (lisp-pred note ?y) (age ?y ?a) (> ?a 20))")
    assert query.prolog(goal) is None
    proved, calls[:] = list(calls), []
    explain(goal)
    assert calls == proved and len(calls) == 3


def test_a_dry_proof_calls_nothing(family):
    calls = []
    read("note").function = lambda item: calls.append(item) or True
    text = told("(and (parent homer ?y) (lisp-pred note ?y) (age ?y ?a))", dry=True)
    assert calls == []
    assert (
        text
        == """\
(and (parent homer ?y) (lisp-pred note ?y) (age ?y ?a)) has no solution.
holds  (parent homer ?y)
STOPS  (lisp-pred note ?y) for each of 2 solutions of the goals before it; for one:
         What it calls was not called again here.
  -    (age ?y ?a)
with ?y = bart"""
    )


def test_python_gets_the_parts(family):
    failed = explain(read("(wise abe)"))
    assert (failed.outcome, failed.holds, failed.bindings) == ("fails", False, None)
    assert (failed.clause.group, failed.clause.goals[0]) == (read("family"), failed.clause.goals[0])
    assert failed.reason == "element 2: 1 is not 4"
    held = explain(read("(grand abe ?who)"))
    assert (held.outcome, held.holds, held.bindings) == ("holds", True, {read("?who"): read("bart")})
    assert held.clause.head.car is read("grand")
