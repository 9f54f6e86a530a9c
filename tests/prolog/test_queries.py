"""What queries answer: control, cut, negation, collections. Source: prolog.md sections 5, 7, 9, 10, 16 and recorded answers."""

import pytest
from prolog_text import ask, error_text, first, group, read, show

from cramhy_runtime.utilities.lazy_lists import lazy_cdr, lazy_list_p


@pytest.mark.soak(all_but=24)
@pytest.mark.parametrize(
    "goal, answer",
    [
        ("(and)", "(NIL)"),
        ("(or)", "NIL"),
        ("(fail)", "NIL"),
        ("(true)", "(NIL)"),
        ("(or (true) (true))", "(NIL NIL)"),
        ("(member ?x (1 2 3))", "(((?X . 1)) ((?X . 2)) ((?X . 3)))"),
        ("(member 2 (1 2 3))", "(NIL)"),
        ("(member 1 (1 2 1))", "(NIL NIL)"),
        ("(member 9 (1 2 3))", "NIL"),
        ("(member ?x ())", "NIL"),
        ("(and (member ?x (1 2 3)) (< ?x 3))", "(((?X . 1)) ((?X . 2)))"),
        ("(or (== ?x 1) (== ?x 2))", "(((?X . 1)) ((?X . 2)))"),
        ("(or (== 1 2) (== 1 1) (== 1 3))", "(NIL)"),
        ("(and (== ?x ?y) (== ?y ?z) (== ?z 3))", "(((?X . 3) (?Y . 3) (?Z . 3)))"),
        ("(not (member 9 (1 2 3)))", "(NIL)"),
        ("(not (member 1 (1 2 3)))", "NIL"),
        ("(and (not (== ?x 1)) (== ?x 2))", "NIL"),
        ("(and (not (fail)) (== ?x 1))", "(((?X . 1)))"),
        ("(== (?a . ?b) (1 2 3))", "(((?A . 1) (?B 2 3)))"),
        ("(== (?a ?b) (1 . 2))", "NIL"),
        ("(== (?a 2) (1 ?b))", "(((?A . 1) (?B . 2)))"),
        ("(== (a ?a 2) (b 1 ?b))", "NIL"),
        ("(== ?x ?y)", "(((?X . ?Y)))"),
        ("(== ?x ?x)", "(NIL)"),
        ("(== (?_ ?_) (1 2))", "(NIL)"),
        ('(== "a" "A")', "NIL"),
        ('(== "a" "a")', "(NIL)"),
        ("(== 1 1.0)", "NIL"),
        ("(== 1.0 1.0d0)", "NIL"),
        ("(== t 1)", "NIL"),
        ("(== #\\a #\\a)", "(NIL)"),
        ("(equal ?x 1)", "(((?X . 1)))"),
        ("(equal (1 2) (1 2))", "(NIL)"),
        ("(findall ?x (member ?x ()) ?l)", "(((?L)))"),
        ("(bagof ?x (member ?x ()) ?l)", "NIL"),
        ("(setof ?x (member ?x ()) ?l)", "NIL"),
        ("(setof ?x (member ?x (1 2 1 3)) ?l)", "(((?L 2 1 3)))"),
        ("(and (findall (?x ?y) (and (member ?x (1 2)) (member ?y (a b))) ?l) (== ?l (?_ ?second . ?_)) (== ?l 1))", "NIL"),
        (
            "(and (findall (?x ?y) (and (member ?x (1 2)) (member ?y (a b))) ?l) (length ?l ?n) (== ?l ?_) (filter-bindings (?n)))",
            "(((?N . 4)))",
        ),
        ("(forall (member ?x (1 2 3)) (< ?x 5))", "(NIL)"),
        ("(forall (member ?x (1 2 3)) (< ?x 3))", "NIL"),
        ("(forall (fail) (fail))", "(NIL)"),
        ("(every (member ?x (1 1 1)) (== ?y ?x))", "(((?Y . 1)))"),
        ("(every (member ?x (1 2 3)) (== ?y ?x))", "NIL"),
        ("(every (member ?x (1 2)) (member ?y (a b)))", "(((?Y . A)) ((?Y . B)))"),
        ("(every (fail) (fail))", "(NIL)"),
        ("(-> (member 1 (1 2)) (== ?x yes) (== ?x no))", "(((?X . YES)))"),
        ("(-> (fail) (== ?x yes) (== ?x no))", "(((?X . NO)))"),
        ("(-> (fail) (true))", "NIL"),
        ("(-> (member ?y (1 2)) (== ?x ?y))", "(((?Y . 1) (?X . 1)))"),
        ("(*-> (member ?y (1 2)) (== ?x ?y) (== ?x no))", "(((?Y . 1) (?X . 1)) ((?Y . 2) (?X . 2)))"),
        ("(*-> (fail) (true) (== ?x no))", "(((?X . NO)))"),
        ("(once (member ?x (1 2 3)))", "(((?X . 1)))"),
        ("(and (== ?g (member ?x (1 2))) (call ?g) (filter-bindings (?x)))", "(((?X . 1)) ((?X . 2)))"),
        ("(append ?a ?b (1 2))", "(((?A) (?B 1 2)) ((?A 1) (?B 2)) ((?A 1 2) (?B)))"),
        ("(append (1) ?b (1 2))", "(((?B 2)))"),
        ("(append (1) (2) ?c)", "(((?C 1 2)))"),
        ("(length (1 2 3) ?n)", "(((?N . 3)))"),
        ("(length (1 2 3) 2)", "NIL"),
        ("(length ?l 2)", "NIL"),
        ("(bound ?x)", "NIL"),
        ("(and (== ?x ?y) (bound ?x))", "NIL"),
        ("(bound (?x))", "(NIL)"),
        ("(bound 1)", "(NIL)"),
        ("(ground (1 ?x))", "NIL"),
        ("(and (== ?y (1 ?x)) (ground ?y))", "NIL"),
        ("(and (== ?x 1) (ground (1 ?x)))", "(((?X . 1)))"),
        ("(and (== ?x 1) (filter-bindings () (== ?y ?x)) (== ?x 2))", "(((?X . 2)))"),
        ("(and (== ?x 1) (filter-bindings (?y) (== ?y (?x))))", "(((?Y 1)))"),
        ('(string-concat "a" "b" "ac")', "NIL"),
    ],
)
def test_answers(goal, answer):
    assert ask(goal) == answer


def test_solutions_are_lazy():
    answers = first("(member ?x (1 2 3))")
    assert lazy_list_p(answers)
    assert show(answers.car) == "((?X . 1))"
    assert show(lazy_cdr(answers).car) == "((?X . 2))"


def test_findall_binds_a_lazy_list():
    solution = first("(findall ?x (member ?x (1 2 3)) ?l)").car
    assert "(?L 1 . #S(CRAM-UTILITIES::LAZY-CONS-ELEM :GENERATOR" in show(solution).replace("\n", " ")


def test_take_binds_a_lazy_prefix():
    assert ask("(and (take 2 (1 2 3) ?l) (== ?l (?a ?b)) (filter-bindings (?a ?b)))") == "(((?A . 1) (?B . 2)))"


def test_member_of_an_unknown_list_enumerates_its_extensions():
    answers = first("(member 1 ?l)")
    assert show(answers.car).startswith("((?L 1 . #:?V-")
    assert show(lazy_cdr(answers).car.car.cdr.cdr.car) == "1"


def test_a_variable_that_a_findall_leaves_unset_stays_itself():
    assert ask("(and (findall (?x ?y) (member ?x (1 2)) ?l) (== ?y 5) (== ?l ((1 5) (2 5))))").count("(1 5) (2 5)") == 1


# ---------------------------------------------------------------------------------------------------------------------- cut


@pytest.mark.parametrize(
    "goal, answer",
    [
        ("(cut)", "(NIL)"),
        ("(and (member ?n (7 8 9)) (cut))", "(((?N . 7)))"),
        ("(or (== ?x 1) (cut) (== ?x 2))", "(((?X . 1)) NIL)"),
        (
            "(and (member ?x (1 2)) (or (cut) (true)) (member ?y (1 2)))",
            "(((?X . 1) (?Y . 1)) ((?X . 1) (?Y . 2)) ((?X . 2) (?Y . 1)) ((?X . 2) (?Y . 2)))",
        ),
        ("(or (or (== ?x 1) (cut)) (== ?x 2))", "(((?X . 1)) NIL ((?X . 2)))"),
        ("(and (member ?n (5 6 7 8)) (-> (== ?n 7) (cut) (true)))", "(((?N . 5)) ((?N . 6)) ((?N . 7)))"),
        ("(not (cut))", "NIL"),
        ("(not (and (member ?x (1 2)) (cut) (fail)))", "(NIL)"),
        ("(and (member ?z (1 2)) (once (cut)) (member ?x (a)))", "(((?Z . 1) (?X . A)) ((?Z . 2) (?X . A)))"),
        ("(and (member ?z (1 2)) (call (and (member ?x (a b)) (cut))))", "(((?Z . 1) (?X . A)) ((?Z . 2) (?X . A)))"),
        ("(and (member ?z (1 2)) (findall ?x (and (member ?x (a b)) (cut)) (a)))", "(((?Z . 1)) ((?Z . 2)))"),
        ("(-> (cut) (== ?x 1) (== ?x 2))", "(((?X . 1)))"),
        ("(and (member ?z (1 2)) (filter-bindings (?z) (member ?x (a b)) (cut)))", "(((?Z . 1)) ((?Z . 2)))"),
    ],
)
def test_cut_stops_at_its_barrier(goal, answer):
    assert ask(goal) == answer


def test_a_cut_in_a_clause_keeps_the_goals_after_it_open():
    group("cuts", "((q 1))", "((q 2))", "((r ?x ?y) (q ?x) (cut) (q ?y))", "((r 9 9))")
    assert ask("(r ?x ?y)") == "(((?X . 1) (?Y . 1)) ((?X . 1) (?Y . 2)))"


def test_a_cut_in_a_called_predicate_does_not_prune_the_caller():
    group("cuts", "((q 1))", "((q 2))", "((one ?x) (q ?x) (cut))")
    assert ask("(and (q ?y) (one ?x))") == "(((?Y . 1) (?X . 1)) ((?Y . 2) (?X . 1)))"


def test_a_cut_inside_a_condition_of_a_clause():
    group("cuts", "((q 1))", "((q 2))", "((s ?x) (q ?x) (-> (== ?x 1) (cut) (true)))", "((s 9))")
    assert ask("(s ?x)") == "(((?X . 1)))"


# ------------------------------------------------------------------------------------------------------- what cannot be proved


def test_an_undefined_functor_warns_and_fails(warnings_given):
    assert ask("(nobody-knows ?x 1)") == "NIL"
    assert warnings_given[0].startswith("Trying to prove goal (NOBODY-KNOWS ?X 1) with undefined functor ")


def test_nil_as_a_query_is_an_undefined_functor(warnings_given):
    assert ask("nil") == "NIL"
    assert warnings_given == ["Trying to prove goal NIL with undefined functor NIL."]


def test_a_variable_as_functor_is_undefined(warnings_given):
    assert ask("(and (== ?f true) (?f))") == "NIL"
    assert len(warnings_given) == 1


def test_another_number_of_arguments_fails_silently(warnings_given):
    group("g", "((foo 1 2))")
    assert ask("(foo ?x)") == "NIL"
    assert ask("(length (1 2))") == "NIL"
    assert warnings_given == []


def test_a_query_that_is_no_list_is_a_type_error():
    from cramhy_runtime.prolog import query

    assert error_text(lambda: query.prolog(5)).startswith("The value\n  5\nis not of type\n  LIST")


def test_a_handler_with_a_wrong_number_of_arguments_is_a_program_error():
    assert error_text(lambda: ask("(bound)")) == "invalid number of arguments: 0"


def test_initial_bindings_come_last():
    assert ask("(== ?x ?y)", "((?y . 2) (?z . 3))") == "(((?X . 2) (?Y . 2) (?Z . 3)))"


def test_query_var_looks_in_the_first_solution():
    from cramhy_runtime.prolog import query

    assert query.query_var(read("?x"), query.prolog, read("(member ?x (4 5))")) == 4
    assert query.query_var(read("?x"), query.prolog, read("(fail)")) is None


def test_python_asks_with_dicts_and_tuples():
    from cramhy_runtime.lisp_core.data import list_from
    from cramhy_runtime.prolog import query
    from cramhy_runtime.prolog.terms.terms import Var

    x = read("?x")
    assert [solution[x] for solution in query.solve(read("(member ?x (1 2))"))] == [1, 2]
    assert query.first(read("(member ?x (1 2))"), x) == 1
    assert list(query.ask(read("member"), Var(), list_from([1, 2]))) == [(1,), (2,)]
