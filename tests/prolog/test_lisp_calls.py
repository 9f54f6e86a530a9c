"""Goals that call Lisp: evaluation rules, errors, warnings. Source: prolog.md section 8."""

import pytest
from prolog_text import ask, error_text, function, group, read, show

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import MultipleValues, Symbol, lisp_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.prolog.builtins.function_calls import BREAK_ON_LISP_ERRORS


@pytest.fixture(autouse=True)
def functions():
    function("plus")(lambda *numbers: sum(numbers))
    function("same")(lambda item: item)
    function("two-values")(lambda: MultipleValues((1, 2)))
    function("make-pair")(lambda a, b: lisp_list(a, b))
    function("nothing")(lambda *ignored: None)
    function("broken")(lambda *ignored: conditions.error("It is ~a.", read("broken")))


@pytest.mark.parametrize(
    "goal, answer",
    [
        ("(lisp-fun plus 1 2 ?x)", "(((?X . 3)))"),
        ("(lisp-fun plus 1 2 3)", "(NIL)"),
        ("(lisp-fun plus 1 2 4)", "NIL"),
        ("(lisp-fun two-values ?x)", "(((?X . 1)))"),
        ("(lisp-fun nothing 1 ?x)", "(((?X)))"),
        ("(lisp-fun nothing)", "(NIL)"),
        ("(lisp-fun two-values)", "NIL"),
        ("(and (== ?f plus) (lisp-fun ?f 1 1 ?x))", "(((?F . PLUS) (?X . 2)))"),
        ("(and (== ?a 5) (lisp-fun make-pair ?a b ?x))", "(((?A . 5) (?X 5 B)))"),
        ("(and (== ?a 5) (lisp-fun same (?a b) ?x))", "(((?A . 5) (?X 5 B)))"),
        ("(lisp-fun make-pair 1 2 (?p ?q))", "(((?P . 1) (?Q . 2)))"),
        ("(lisp-fun make-pair 1 2 (?p ?p))", "NIL"),
        ("(and (== ?x (1 2)) (lisp-fun make-pair 1 2 ?x))", "(((?X 1 2)))"),
        ("(and (lisp-fun same ?v ?x) (== ?v 3))", "(((?V . 3) (?X . 3)))"),
        ("(lisp-pred same 1)", "(NIL)"),
        ("(lisp-pred same nil)", "NIL"),
        ("(and (== ?x 1) (lisp-pred same ?x))", "(((?X . 1)))"),
    ],
)
def test_calls(goal, answer):
    assert ask(goal) == answer
    group("g", f"((run . ?args) {goal})")
    assert (ask("(run)") == "NIL") == (answer == "NIL")


def test_an_unset_variable_is_passed_as_its_symbol():
    seen = []
    function("look")(lambda item: seen.append(item))
    ask("(lisp-fun look ?v ?_)")
    assert seen == [read("?v")]
    group("g", "((inside) (lisp-fun look ?v ?_))")
    ask("(inside)")
    assert isinstance(seen[1], Symbol) and seen[1].package is None and seen[1].name.startswith("?")


def test_lists_are_passed_as_they_are_written():
    seen = []
    function("look")(lambda item: seen.append(show(item)))
    ask("(and (== ?a 5) (lisp-fun look (?a b) ?_) (== ?l (?a)) (lisp-fun look ?l ?_))")
    assert seen == ["(?A B)", "(5)"]


def test_an_error_becomes_one_warning_and_a_failure(warnings_given):
    assert ask("(lisp-fun broken 1 ?x)") == "NIL"
    assert ask("(lisp-pred broken 1)") == "NIL"
    assert warnings_given == [
        "An error occurred while executing the lisp function `BROKEN': `It is BROKEN.'",
        "An error occurred while executing the lisp predicate `BROKEN': `It is BROKEN.'",
    ]


def test_an_undefined_function_warns(warnings_given):
    assert ask("(lisp-fun no-such-function ?x)") == "NIL"
    assert len(warnings_given) == 1 and "is undefined" in warnings_given[0]


def test_a_variable_is_no_predicate_even_if_it_is_bound(warnings_given):
    assert ask("(and (== ?p same) (lisp-pred ?p 1))") == "NIL"
    assert len(warnings_given) == 1


def test_a_function_object_is_rejected(warnings_given):
    from cramhy_runtime.lisp_core.data import list_from
    from cramhy_runtime.prolog import query

    goal = list_from([read("lisp-fun"), lambda: 1, read("?x")])
    assert query.prolog(goal) is None
    assert "is not of type SYMBOL" in " ".join(warnings_given[0].split())


def test_errors_propagate_if_asked_to():
    with binding(BREAK_ON_LISP_ERRORS, True):
        assert error_text(lambda: ask("(lisp-fun broken 1 ?x)")) == "It is BROKEN."


def test_python_errors_are_lisp_errors(warnings_given):
    function("python-broken")(lambda: 1 / 0)
    assert ask("(lisp-fun python-broken ?x)") == "NIL"
    assert len(warnings_given) == 1


def test_conditions_that_are_no_errors_go_through():
    class PlanFailure(conditions.SeriousCondition):
        lisp_name = "PROLOG-TESTS-HERE::FAILURE"

        def report(self):
            return "the plan failed"

    function("fail-plan")(lambda: conditions.error(PlanFailure()))
    assert error_text(lambda: ask("(lisp-fun fail-plan ?x)"), PlanFailure) == "the plan failed"


def test_comparing_what_is_no_number_warns(warnings_given, monkeypatch):
    monkeypatch.setattr(sym("<"), "function", lambda a, b: conditions.type_error(a, "NUMBER"))
    try:
        assert ask("(< a 1)") == "NIL"
    finally:
        assert len(warnings_given) == 1 and warnings_given[0].startswith(
            "An error occurred while executing the lisp predicate `<': `The value"
        )


def test_error_and_warn_goals(warnings_given):
    assert ask('(error "no way")') == "NIL"
    assert ask('(warn "careful")') == "(NIL)"
    assert warnings_given == [
        "An error occurred while executing the lisp function `APPLY': `[PROLOG ERROR] no way'",
        "[PROLOG WARNING] careful",
    ]


def test_symbol_values():
    boot()  # the functions that the predicates call are Lisp's
    read("*thing*").value = 4
    assert ask("(symbol-value *thing* ?x)") == "(((?X . 4)))"
    assert ask("(set-symbol-value *thing* (1 2))") == "(NIL)"
    assert show(read("*thing*").value) == "(1 2)"


def test_a_whole_findall_list_reaches_lisp():
    function("count-elements")(lambda items: sum(1 for _ in items))
    assert ask("(and (findall ?x (member ?x (1 2 3)) ?l) (lisp-fun count-elements ?l ?n) (filter-bindings (?n)))") == "(((?N . 3)))"


def test_a_called_function_may_ask_queries_and_wait():
    from cramhy_runtime import kernel
    from cramhy_runtime.prolog import query

    def wait_and_ask(x):
        kernel.sleep(0.5)
        return sum(solution[read("?y")] for solution in query.solve(read("(member ?y (1 2 3))"))) + x

    function("wait-and-ask")(wait_and_ask)
    results = []
    tasks = [kernel.spawn(lambda n=n: results.append(ask(f"(lisp-fun wait-and-ask {n} ?x)")), name="asker") for n in (10, 20)]
    for task in tasks:
        task.join("an asker")
    assert results == ["(((?X . 16)))", "(((?X . 26)))"]
