"""Clauses: fact groups, their order and errors, compiled clauses, long recursions. Source: prolog.md section 6."""

import pytest
from prolog_text import ask, error_text, first, function, group, read, show

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.prolog.engine import database
from cramhy_runtime.prolog.engine import fact_groups as facts
from cramhy_runtime.prolog.builtins import native_predicates as natives
from cramhy_runtime.prolog import query
from cramhy_runtime.repl.session import Session, condition_of
from cramhy_runtime.utilities.lazy_lists import elements, lazy_cdr
from cramhy_runtime.prolog.terms.terms import Var


def test_a_group_returns_its_facts_by_functor():
    assert group("g", "((foo 1))", "((bar ?x) (foo ?x))", "((foo 2))") == "((FOO ((FOO 1)) ((FOO 2))) (BAR ((BAR #:?X) (FOO #:?X))))"
    assert group("empty") == "NIL"


def test_groups_answer_in_order_of_definition():
    group("g1", "((p 1))", "((p 2))")
    group("g2", "((p 3))", extendable="(p)")
    assert ask("(p ?x)") == "(((?X . 1)) ((?X . 2)) ((?X . 3)))"


def test_a_redefined_group_moves_to_the_end_and_warns(warnings_given):
    group("g1", "((p 1))")
    group("g2", "((p 2))", extendable="(p)")
    group("g1", "((p 3))", extendable="(p)")
    assert ask("(p ?x)") == "(((?X . 2)) ((?X . 3)))"
    assert warnings_given == ["Redefining prolog fact-group G1."]


def test_a_redefinition_asks_once_for_the_groups_of_a_predicate(warnings_given, monkeypatch):
    """Each time all its clauses are looked at, so a large group took minutes."""
    group("g", *(f"((p {i}))" for i in range(20)), "((q 1))", "((q 2))")
    asked, groups = [], database.Functor.groups
    monkeypatch.setattr(database.Functor, "groups", lambda entry: asked.append(entry) or groups(entry))
    group("g", *(f"((p {i}))" for i in range(30)), "((q 1))")
    assert len(asked) == 2
    assert len(ask("(p ?x)").split("?X")) == 31


def test_extending_without_permission_is_an_error():
    group("g1", "((p 1))")
    assert error_text(lambda: group("g2", "((p 2))")) == (
        "Functor P is being redefined in fact-group G2.\n                Other definitions were in fact-groups (G1)."
    )
    assert ask("(p ?x)") == "(((?X . 1)))"
    with pytest.raises(BaseException) as refused:
        group("g2", "((p 2))")
    told = "The list behind the name of a group names the predicates of others that it may add to: p is missing there."
    assert hint_for(condition_of(refused.value)).splitlines()[-1] == told


@pytest.mark.parametrize("head", ["?x", "5", "nil", '"foo"'])
def test_a_head_needs_a_symbol(head):
    text = error_text(lambda: group("g", f"(({head} 1))"))
    assert text.startswith("Functor ") and text.endswith(" is not valid.")


@pytest.mark.parametrize(
    "clause, text",
    [
        ("()", "The value\n  NIL\nis not of type\n  CONS"),
        ("(nil)", "The value\n  NIL\nis not of type\n  CONS"),
        ("(7)", "The value\n  7\nis not of type\n  LIST"),
        ("((:p 1) . :q)", "The value\n  ((:P 1) . :Q)\nis not of type\n  LIST"),
    ],
)
def test_a_clause_that_is_none_leaves_the_old_group(warnings_given, clause, text):
    group("g", "((p 1))")
    assert error_text(lambda: group("g", "((p 2))", clause)) == text
    assert ask("(p ?x)") == "(((?X . 1)))"


def test_an_extendable_name_must_be_a_functor():
    assert error_text(lambda: group("g", extendable="(?x)")) == (
        "Extendible predicates in the definition of fact group G\n            contained an invalid functor ?X."
    )


def test_built_in_groups_are_protected_and_extendable():
    assert "Other definitions were in fact-groups (LIST-UTILS)." in error_text(lambda: group("g", "((member a b))"))
    group("g", "((member own nil))", extendable="(member)")
    assert ask("(member ?x (1))") == "(((?X . 1)))"
    assert ask("(member ?x nil)") == "(((?X . OWN)))"


def test_a_predicate_that_is_there_to_be_extended_fails_without_a_warning(warnings_given):
    facts.built_in_group(read("groundings"), read("grounding"))
    assert ask("(grounding ?x)") == "NIL" and warnings_given == []
    assert "Other definitions were in fact-groups (GROUNDINGS)." in error_text(lambda: group("g", "((grounding 1))"))
    group("g", "((grounding 1))", extendable="(grounding)")
    assert ask("(grounding ?x)") == "(((?X . 1)))"
    facts.remove_fact_group(read("g"))
    assert ask("(grounding ?x)") == "NIL" and warnings_given == []
    facts.remove_fact_group(read("groundings"))
    assert ask("(grounding ?x)") == "NIL" and "with undefined functor " in warnings_given[0]


def test_facts_for_a_handler_act_when_it_gives_nothing():
    group("g", "((fail) (== 1 1))", "((bound ?x) (== ?x 7))")
    assert ask("(fail)") == "(NIL)"
    assert ask("(bound 1)") == "(NIL)"
    assert ask("(bound ?x)") == "(((?X . 7)))"
    facts.remove_fact_group(read("g"))
    assert ask("(fail)") == "NIL"
    assert ask("(bound ?x)") == "NIL"


def test_extending_an_inlined_built_in_reaches_clauses_that_exist():
    group("g1", "((p ?x) (== ?x 1))")
    assert ask("(p ?x)") == "(((?X . 1)))"
    group("g2", "((== 5 ?_))", extendable="(==)")
    assert ask("(p 5)") == "(NIL)"
    facts.remove_fact_group(read("g2"))
    assert ask("(p 5)") == "NIL"


def test_removing_the_last_group_makes_a_functor_undefined(warnings_given):
    group("g1", "((p 1))")
    facts.remove_fact_group(read("g1"))
    assert ask("(p ?x)") == "NIL"
    assert len(warnings_given) == 1


def test_facts_outside_a_group():
    assert error_text(facts.fact_outside_group) == "Facts cannot be declared outside fact-groups."


def test_facts_added_by_a_query_are_not_seen_by_goals_already_entered():
    group("g1", "((p 1))", "((p 2))")
    answers = first("(p ?x)")
    group("g2", "((p 3))", extendable="(p)")
    assert show(list_from(list(elements(answers)))) == "(((?X . 1)) ((?X . 2)))"


# ------------------------------------------------------------------------------------------------------------------ clauses


def test_clause_variables_do_not_clash_with_those_of_the_query():
    group("g", "((p ?x ?y) (== ?y (?x)))")
    assert ask("(p ?y ?x)") == "(((?X ?Y)))"


def test_a_rule_binds_in_the_callers_variables():
    group("g", "((each ?l ?x) (== ?l (1 2)) (member ?x ?l))")
    assert ask("(each ?a ?b)") == "(((?A 1 2) (?B . 1)) ((?A 1 2) (?B . 2)))"


def test_a_dotted_head_takes_any_number_of_arguments():
    group("g", "((any ?first . ?rest) (== ?rest ?rest))")
    assert ask("(any 1)") == "(NIL)"
    assert ask("(any ?a 2 3)") == "(NIL)"
    group("h", "((all . ?args) (== ?args (1 ?b)))")
    assert ask("(all ?x 2)") == "(((?X . 1)))"


def test_a_goal_may_end_in_a_variable():
    group("g", "((pair 1 2))", "((through . ?args) (pair . ?args))")
    assert ask("(through ?a ?b)") == "(((?A . 1) (?B . 2)))"


def test_the_anonymous_variable_in_a_head():
    group("g", "((p ?_ ?_ ?x) (== ?x 1))")
    assert ask("(p 1 2 ?x)") == "(((?X . 1)))"


@pytest.mark.parametrize(
    "goal, answer",
    [
        ("(kind 1 ?k)", "(((?K . ONE)))"),
        ("(kind 1.0 ?k)", "(((?K . FLOAT)))"),
        ("(kind t ?k)", "(((?K . TRUE)))"),
        ('(kind "s" ?k)', "(((?K . STRING)))"),
        ("(kind nil ?k)", "(((?K . EMPTY)))"),
        ("(kind (1) ?k)", "(((?K LIST 1)))"),
        ("(kind :k ?k)", "(((?K . KEY)))"),
        ("(kind 2 ?k)", "NIL"),
        ("(kind 1/2 ?k)", "(((?K . HALF)))"),
        ("(kind #\\a ?k)", "(((?K . A)))"),
        ("(kind 1.0d0 ?k)", "NIL"),
    ],
)
def test_the_first_argument_selects_clauses(goal, answer):
    group(
        "g",
        "((kind 1 one))",
        "((kind 1.0 float))",
        "((kind t true))",
        '((kind "s" string))',
        "((kind nil empty))",
        "((kind (?x) (list ?x)))",
        "((kind :k key))",
        "((kind 1/2 half))",
        "((kind #\\a a))",
    )
    assert ask(goal) == answer


def test_ground_facts_form_a_table_that_answers_in_order():
    group("g", "((edge a b))", "((edge b c))", "((edge a c))", "((edge d (x y)))", "((edge e e))")
    assert ask("(edge a ?x)") == "(((?X . B)) ((?X . C)))"
    assert ask("(edge ?x c)") == "(((?X . B)) ((?X . A)))"
    assert ask("(edge ?x ?x)") == "(((?X . E)))"
    assert ask("(edge d (?x . ?y))") == "(((?X . X) (?Y Y)))"
    assert ask("(edge a b)") == "(NIL)"
    assert ask("(and (edge ?a ?b) (edge ?b ?c))") == "(((?A . A) (?B . B) (?C . C)) ((?A . E) (?B . E) (?C . E)))"


LISTS = (
    "((app nil ?l ?l))",
    "((app (?h . ?t) ?l (?h . ?r)) (app ?t ?l ?r))",
    "((nrev nil nil))",
    "((nrev (?h . ?t) ?r) (nrev ?t ?rt) (app ?rt (?h) ?r))",
    "((mem ?x (?x . ?_)))",
    "((mem ?x (?_ . ?t)) (mem ?x ?t))",
)


def test_naive_reverse():
    group("lists", *LISTS)
    assert ask("(nrev (1 2 3) ?r)") == "(((?R 3 2 1)))"
    assert ask("(app ?a ?b (1 2))") == "(((?A) (?B 1 2)) ((?A 1) (?B 2)) ((?A 1 2) (?B)))"


def test_recursion_is_not_limited_by_the_python_stack():
    group("lists", *LISTS, "((len nil 0))", "((len (?_ . ?t) ?n) (len ?t ?m) (lisp-fun one-more ?m ?n))")
    function("one-more")(lambda n: n + 1)
    long = list_from(range(20_000))
    (whole,) = next(query.ask(read("app"), long, None, Var()))
    assert sum(1 for _ in whole) == 20_000
    assert next(query.ask(read("len"), list_from(range(3000)), Var())) == (3000,)
    assert sum(1 for _ in query.ask(read("mem"), Var(), long)) == 20_000
    assert sum(1 for _ in query.ask(read("member"), Var(), long)) == 20_000


def test_an_endless_proof_can_be_cancelled():
    from cramhy_runtime import kernel

    group("loop", "((loop-for-ever ?x) (loop-for-ever ?x))")
    task = kernel.spawn(lambda: query.holds(read("(loop-for-ever 1)")), name="prover")
    kernel.sleep(1)
    task.cancel("enough")
    task.join("the prover")
    assert task.dead


def test_answers_that_are_not_asked_for_are_not_computed():
    calls = []
    function("note")(lambda x: calls.append(x) or True)
    group("g", "((noisy ?x) (member ?x (1 2 3)) (lisp-pred note ?x))")
    answers = first("(and (noisy ?x) (member ?y (a b)) (lisp-pred note ?y))")
    assert [str(call) for call in calls] == ["1", str(read("a"))]
    lazy_cdr(answers)
    assert len(calls) == 3


# ----------------------------------------------------------------------------------------------------------------- handlers


def test_a_handler_written_on_binding_lists():
    from cramhy_runtime.utilities.patterns import add_bdg, var_value

    def twice(bindings, var, value):
        number = var_value(value, bindings)
        return list_from([add_bdg(var, n, bindings)[0] for n in (number, number * 2)])

    natives.define_handler(read("twice"), twice)
    assert ask("(and (== ?n 4) (twice ?x ?n))") == "(((?N . 4) (?X . 4)) ((?N . 4) (?X . 8)))"
    natives.define_handler(read("twice"), lambda bindings, *arguments: None)
    assert ask("(twice ?x 1)") == "NIL"


def test_a_handler_that_asks_a_query_of_its_own():
    natives.define_handler(read("also"), lambda bindings, goal: query.prolog(goal, bindings))
    assert ask("(and (== ?x 1) (also (member ?y (a ?x))))") == "(((?X . 1) (?Y . A)) ((?X . 1) (?Y . 1)))"


def test_predicates_written_in_python():
    @natives.predicate("PROLOG-TESTS-HERE::BETWEEN")
    def between(m, low, high, x):
        for number in range(natives.resolve(low), natives.resolve(high) + 1):
            if m.unify(x, number):
                yield

    @natives.test("PROLOG-TESTS-HERE::EVEN")
    def even(m, x):
        return natives.resolve(x) % 2 == 0

    assert ask("(and (between 1 6 ?x) (even ?x))") == "(((?X . 2)) ((?X . 4)) ((?X . 6)))"
    assert error_text(lambda: ask("(even)")) == "invalid number of arguments: 0"


@pytest.mark.parametrize("rule", ["", " (== ?m ?n)"])
def test_facts_are_found_by_values_that_are_the_same_in_lisp(rule):
    """Python's ``1 == True == 1.0`` and ``0.0 == -0.0`` must not mix up the rows of a table, nor the clauses of an index."""
    atoms = ("1", "t", "1.0", "0.0", "-0.0", '"a"', "a", "nil")
    group("same", *(f"((v {atom} {number}){rule})" for number, atom in enumerate(atoms)))
    for number, atom in enumerate(atoms):
        assert ask(f"(v {atom} ?n)") == f"(((?N . {number})))"
    assert ask("(v 1.0d0 ?n)") == "NIL"


def test_the_hooks_of_a_proof_take_methods():
    seen = []
    query.on_prepare_prolog_prove.add(lambda goal, binds: seen.append(show(goal)) or "id", "test")
    query.on_finish_prolog_prove.add(lambda log_id, success: seen.append((log_id, success)), "test")
    try:
        ask("(member ?x (1))")
    finally:
        query.on_prepare_prolog_prove.remove("test")
        query.on_finish_prolog_prove.remove("test")
    assert seen == ["(MEMBER ?X (1))", ("id", True)]


# ------------------------------------------------------------------------------------------------------------------- errors


def test_an_error_in_a_definition_names_the_clause_and_its_place(fresh_kernel):
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text("(defpackage :slips (:use :cl :prolog)) (in-package :slips)")
    with pytest.raises(BaseException) as problem:
        session.evaluate_text("(def-fact-group shelf ()\n  (<- (on cup shelf))\n  (<- (member cup shelf)))")
    assert hint_for(condition_of(problem.value)).splitlines() == [
        "in the clause (<- (member cup shelf)) at <repl 2>:3:3",
        "The list behind the name of a group names the predicates of others that it may add to: member is missing there.",
    ]


@pytest.mark.parametrize("result, datum", [("5", "5"), ("'(5)", "5"), ("'((?x . 1))", "(?X . 1)"), ("t", "T")])
def test_a_handler_whose_result_is_no_list_of_binding_lists(fresh_kernel, result, datum):
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text("(defpackage :slips (:use :cl :prolog)) (in-package :slips)")
    with pytest.raises(BaseException) as problem:
        session.evaluate_text(f"(def-prolog-handler slip (bdgs) (declare (ignore bdgs)) {result}) (prolog '(slip))")
    assert str(condition_of(problem.value)).replace("SLIPS::", "") == (
        f"The value\n  {datum}\nis not of type\n  LIST\n"
        "(A handler returns a list of binding lists, one for each solution: (list bdgs) for one that binds nothing, nil for none.)"
    )


def test_t_is_a_functor_like_any_other(warnings_given):
    group("odd", "((t 1))", "((p 2))")
    assert ask("(t ?x)") == "(((?X . 1)))"
    assert ask("(pp ?x)") == "NIL" and len(warnings_given) == 1  # what else may be meant is looked for among all functors
