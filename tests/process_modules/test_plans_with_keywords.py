"""A grounding (plan designator) calls a plan that takes keywords with the designator's properties, as since CRAM's branch devel."""

import itertools
import re

import pytest

from cramhy_runtime.cpl import PlanFailure
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.repl.session import Session

numbers = itertools.count(1)
PRELUDE = """(defpackage :keyword-plans-{0} (:use :cpl :exe) (:import-from :prolog #:def-fact-group #:<- #:lisp-fun #:bound #:==)) (in-package :keyword-plans-{0})
  (def-fact-group pouring (desig:action-grounding)
    (<- (desig:action-grounding ?action (pour ?resolved))
      (desig:desig-prop ?action (:type :pouring))
      (desig:current-designator ?action ?resolved))
    (<- (desig:action-grounding ?action (stir :for ?seconds))
      (desig:desig-prop ?action (:type :stirring))
      (desig:desig-prop ?action (:seconds ?seconds))))
  (defun stir (&key for) (list :stirred for))
  (defvar *done* nil)"""
GOAL = """(def-fact-group poured (coe:holds) (<- (coe:holds ?occasion) (lisp-fun reached ?occasion ?answer) (bound ?answer) (== ?answer t)))
  (defun reached (occasion) (declare (ignore occasion)) *done*) (defvar *goal* '(poured :milk))"""


@pytest.fixture
def lisp(fresh_kernel):
    session = Session(time="virtual", backend=fresh_kernel.backend.name, turtlesim=False)

    def evaluate(text):
        return " ".join(map(prin1_to_string, session.evaluate_text(text)))

    evaluate(PRELUDE.format(next(numbers)))
    return evaluate


POUR = "(top-level (perform (desig:an action (type pouring) (object :milk) (amount 3))))"


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize(
    ("plan", "values"),
    [
        ("(defun pour (&key type object amount) (list type object amount))", "(:POURING :MILK 3)"),
        ("(defun pour (&key ((:object ?object)) &allow-other-keys) ?object)", ":MILK"),
        ("(defgeneric pour (&key &allow-other-keys) (:method (&key amount &allow-other-keys) (* 2 amount)))", "6"),
        ("(def-cram-function pour (&key amount &allow-other-keys) (* 3 amount))", "9"),
        ("(defun pour (designator) (desig:desig-prop-value designator :amount))", "3"),
        ("(defun pour (&optional designator) (desig:desig-prop-value designator :object))", ":MILK"),
        ("(defun pour (&rest arguments) (length arguments))", "1"),
    ],
)
def test_a_plan_of_keywords_gets_the_properties_and_one_with_an_argument_the_designator(lisp, plan, values):
    assert lisp(f"{plan} (values {POUR})") == values


def test_the_values_are_the_plans_and_the_designator(lisp):
    assert lisp(f"(defun pour (&key &allow-other-keys) (values 1 2)) (let ((all (multiple-value-list {POUR}))) (list (length all) (first all) (typep (second all) 'desig:action-designator)))") in (
        "(2 1 T)",
        "(1 1 NIL)",
    )  # fmt: skip


def test_groundings_with_arguments_are_called_with_them_as_before(lisp):
    assert lisp("(top-level (perform (desig:an action (type stirring) (seconds 5))))") == "(:STIRRED 5)"


def test_a_property_that_the_plan_does_not_take_is_the_error_of_the_call(lisp):
    with pytest.raises(Condition) as error:
        lisp(f"(defun pour (&key object) object) {POUR}")
    assert re.search(r"unknown &KEY argument|unknown keyword", error.value.report(), re.IGNORECASE)


def test_the_first_of_two_properties_counts_and_one_may_be_nil(lisp):
    plan = "(defun pour (&key amount object &allow-other-keys) (list amount object))"
    assert lisp(f"{plan} (values (top-level (perform (desig:an action (type pouring) (amount 1) (amount 2) (object nil)))))") == "(1 NIL)"


def test_a_plan_that_is_not_defined_is_the_usual_failure(lisp):
    with pytest.raises(PlanFailure) as failure:
        lisp(POUR)
    assert "but it isn't defined. Cannot perform action." in failure.value.report()


def test_properties_are_those_of_the_designator_that_the_grounding_names(lisp):
    text = """(def-fact-group other (desig:action-grounding)
                (<- (desig:action-grounding ?action (pour ?better))
                  (desig:desig-prop ?action (:type :asking))
                  (desig:designator action ((:type :pouring) (:amount 7)) ?better)))
              (defun pour (&key type amount) (list type amount))
              (values (top-level (perform (desig:an action (type asking)))))"""
    assert lisp(text.replace("designator action", "designator :action")) == "(:POURING 7)"


@pytest.mark.parametrize(
    ("plan", "result", "warned"),
    [
        ("(defun pour (&key &allow-other-keys) (setf *done* t) :poured)", ":POURED", 0),
        ("(defun pour (&key &allow-other-keys) :spilled)", ":SPILLED", 1),
    ],
)
def test_a_goal_that_such_a_plan_does_not_achieve_is_a_warning(lisp, capsys, plan, result, warned):
    assert lisp(f"{GOAL} {plan} (let ((?goal *goal*)) (top-level (perform (desig:an action (type pouring) (goal ?goal)))))") == result
    assert capsys.readouterr().err.count("was not achieved.") == warned


def test_a_plan_can_be_called_with_the_properties_of_any_designator(lisp):
    text = "(multiple-value-list (exe:call-plan-with-designator-properties 'pour (desig:an action (type pouring) (amount 4))))"
    assert lisp(f"(defun pour (&key type amount) (list type amount)) (first {text})") == "(:POURING 4)"
