"""When a Lisp function signalled while a designator was resolved, its explanation says so first: that is the cause."""

import pytest

SPEED = "(defun speed-of (d) (if (> (desig-prop-value d :speed) 3) 1 2))"


def clauses(*bodies, predicate="motion-grounding"):
    return f"(def-fact-group causes ({predicate} helper) {' '.join(bodies)})"


def grounding(goals, predicate="motion-grounding"):
    return f"(<- ({predicate} ?d (drive ?s)) {goals})"


def hint(lisp, form="(reference (a motion (type driving)))"):
    condition = lisp.condition(f"(handler-bind ((warning #'muffle-warning)) {form})")
    return condition.hint.splitlines()


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("goals", "kind"),
    [
        ("(desig-prop ?d (:type :driving)) (lisp-fun speed-of ?d ?s)", "function speed-of"),
        ("(desig-prop ?d (:type :driving)) (lisp-pred speed-of ?d) (== ?s 1)", "predicate speed-of"),
        ("(not (lisp-pred speed-of ?d)) (== ?s 1) (fail)", "predicate speed-of"),
        ("(findall ?x (lisp-fun speed-of ?d ?x) ?all) (member ?s ?all)", "function speed-of"),
        ("(once (lisp-fun speed-of ?d ?s))", "function speed-of"),
        ("(forall (lisp-fun speed-of ?d ?x) (fail)) (== ?s 1) (fail)", "function speed-of"),
    ],
)
def test_the_cause_comes_first(lisp, goals, kind):
    lisp(SPEED + clauses(grounding(goals)))
    first, second, *_ = hint(lisp)
    assert first.startswith(f"The Lisp {kind}") and first.endswith("signalled an error:")
    assert second == "  The value NIL is not of type REAL"


def test_it_says_where_and_which_clause(lisp):
    lisp(SPEED + clauses(grounding("(desig-prop ?d (:type :driving)) (helper ?d ?s)"), "(<- (helper ?d ?s) (lisp-fun speed-of ?d ?s))"))
    told = hint(lisp)
    assert "The Lisp function speed-of, which is called by clause 1 of causes" in told[0] and told[2].startswith("  at <repl")
    assert "There is one clause, clause 1 of causes" in "\n".join(told[3:])


def test_a_misspelt_function_says_what_was_meant(lisp):
    lisp(SPEED + clauses(grounding("(lisp-fun speedof ?d ?s)")))
    assert "  Did you mean SPEED-OF?" in hint(lisp)


def test_a_variable_without_a_value_is_named(lisp):
    lisp("(defun twice (n) (* 2 n))" + clauses(grounding("(lisp-fun twice ?speed ?s)")))
    assert any(line.endswith("has no value.") for line in hint(lisp)[2:4])


def test_actions_and_locations_too(lisp):
    lisp(SPEED + clauses(grounding("(lisp-fun speed-of ?d ?s)", "action-grounding"), predicate="action-grounding"))
    assert hint(lisp, "(reference (an action (type driving)))")[0] == "The Lisp function speed-of signalled an error:"
    lisp("(def-fact-group places (location-grounding) (<- (location-grounding ?d ?s) (desig-prop ?d (:at ?x)) (lisp-fun speed-of ?d ?s)))")
    told = hint(lisp, "(reference (a location (at sea)))")
    assert told[:2] == ["The Lisp function speed-of signalled an error:", "  The value NIL is not of type REAL"]
    assert told[-1].startswith("None of the location generators gave a candidate")


def test_a_second_try_tells_the_cause_again_and_calls_nothing(lisp):
    lisp('(defun noted (d) (note d) (error "no speed"))' + clauses(grounding("(lisp-fun noted ?d ?s)")) + "(defvar *m* (a motion))")
    for _ in range(2):
        assert hint(lisp, "(reference *m*)")[:2] == ["The Lisp function noted signalled an error:", "  no speed"]
    assert lisp("(length *notes*)") == "1"


def test_of_many_errors_the_first_are_told_and_none_twice(lisp):
    lisp('(defun picky (n) (error "not ~a" (mod n 6)))' + clauses(grounding("(member ?n (1 2 3 4 5 6 7 8 9)) (lisp-fun picky ?n ?s)")))
    told = [line for line in hint(lisp) if line.startswith("  not ")]
    assert told == ["  not 1", "  not 2", "  not 3", "  not 4"]


def test_without_an_error_nothing_is_said_of_one(lisp):
    lisp("(defun slow (d) (declare (ignore d)) nil)" + clauses(grounding("(lisp-pred slow ?d) (== ?s 1)")))
    assert "signalled" not in "\n".join(hint(lisp))


def test_an_error_that_cannot_be_printed_is_told_all_the_same(lisp):
    lisp(
        """(define-condition broken (error) () (:report (lambda (c s) (declare (ignore c s)) (error "no report"))))
            (defun breaks (d) (declare (ignore d)) (error 'broken))"""
        + clauses(grounding("(lisp-fun breaks ?d ?s)"))
    )
    assert hint(lisp)[0] == "The Lisp function breaks signalled an error:"
