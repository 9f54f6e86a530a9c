"""A symbol in ``(a motion ...)`` that is bound when the form is expanded stands for its value, as in the original; others are keywords.

The value is that of the time when the designator is made. A variable that is defined after a form was expanded, in which its name became a
keyword, is warned of. Source: designators.md 3.2.
"""

import pytest
from lisp_text import LispText

from cramhy_runtime.lisp_core.packages import find_package

DEFINED = """
(defpackage :variables-in-descriptions (:use :cl :desig :cram-prolog))
(in-package :variables-in-descriptions)
(defvar start-pose '(1 2 0))
(defparameter speed-of-today 3)
(defconstant half 0.5)
(defvar side 'left)
(defvar nothing nil)
(defvar place-to-be (a location (x 1)))
(defvar first-of-chain 'second-of-chain)
(defvar second-of-chain 7)
(defvar in-a-ring 'in-another-ring)
(defvar in-another-ring 'in-a-ring)
(defvar key-of-today :colour)
(defvar goal-pose 5)
(setf (symbol-value 'set-only) 4)
(defvar ?there 6)
(defvar no-value)
(defun props (designator) (description designator))
"""


@pytest.fixture
def lisp(session):
    return LispText(session, "(in-package :variables-in-descriptions)" if find_package("VARIABLES-IN-DESCRIPTIONS") else DEFINED)


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("properties", "shown"),
    [
        ("(type picking) (from start-pose)", "((:TYPE :PICKING) (:FROM (1 2 0)))"),
        ("(angle pi)", "((:ANGLE 3.141592653589793d0))"),
        ("(angle (pi 2 half))", "((:ANGLE (3.141592653589793d0 2 0.5)))"),
        ("(speed speed-of-today)", "((:SPEED 3))"),
        ("(arm side)", "((:ARM :LEFT))"),
        ("(arm (side right))", "((:ARM (:LEFT :RIGHT)))"),
        ("(flag nothing)", "((:FLAG NIL))"),
        ("(flag t) (other nil)", "((:FLAG T) (:OTHER NIL))"),
        ("(when nothing (arm left))", "NIL"),
        ("(when half (arm left))", "((:ARM :LEFT))"),
        ("(x first-of-chain)", "((:X 7))"),
        ("(x in-a-ring)", "((:X :IN-A-RING))"),
        ("(key-of-today blue)", "((:COLOUR :BLUE))"),
        ("(x set-only)", "((:X 4))"),
        ("(x ?there)", "((:X 6))"),
        ("(x no-value)", "((:X :NO-VALUE))"),
        ("(x unheard-of)", "((:X :UNHEARD-OF))"),
        ("(sign (* + - / ** ///))", "((:SIGN (:* :+ :- :/ :** :///)))"),
        ("(most most-positive-fixnum)", "((:MOST 4611686018427387903))"),
        ("(:key :start-pose)", "((:KEY :START-POSE))"),
    ],
)
def test_a_symbol_that_is_bound_is_its_value(lisp, properties, shown):
    assert lisp(f"(props (an action {properties}))") == shown


def test_a_designator_is_its_value_too(lisp):
    assert lisp("(eq place-to-be (desig-prop-value (an action (to place-to-be)) :to))") == "T"
    assert lisp("(props (desig-prop-value (an action (to (a location (z speed-of-today)))) :to))") == "((:Z 3))"
    assert lisp("(props (all object (size half)))") == "((:SIZE 0.5))"


def test_a_variable_of_the_surrounding_code_is_a_keyword_as_ever(lisp):
    assert lisp("(let ((arm 3) (set-only 5)) (list arm set-only (props (an action (arm arm) (x set-only)))))") == (
        "(3 5 ((:ARM :ARM) (:X 4)))"
    )


def test_the_value_is_that_of_the_time_when_the_designator_is_made(lisp):
    lisp("(defun driving () (props (a motion (speed speed-of-today))))")
    assert lisp("(list (driving) (let ((speed-of-today 9)) (driving)))") == "(((:SPEED 3)) ((:SPEED 9)))"


def test_a_key_that_is_a_variable_with_another_value_than_a_symbol_is_the_key(lisp):
    said = lisp.warnings("(defun to-goal () (props (a motion (goal-pose 1))))")
    assert "GOAL-POSE is a variable, and the key of a property of a designator here: its value, 5, cannot be a key, so the key is" in said
    assert lisp("(to-goal)") == "((:GOAL-POSE 1))"


@pytest.mark.parametrize(
    ("name", "definition"),
    [
        ("LATER-1", "(defvar later-1 1)"),
        ("LATER-2", "(defparameter later-2 1)"),
        ("LATER-3", "(defconstant later-3 1)"),
        ("LATER-4", "(cpl-impl:define-task-variable later-4 1)"),
    ],
)
def test_a_later_definition_is_warned_of_once(lisp, name, definition):
    lisp.name = "plan.lisp"
    assert lisp(f"(defun early () (props (a motion\n  (x {name}))))\n(early)") == f"((:X :{name}))"
    said = " ".join(lisp.warnings(definition).split())
    assert said == (
        f"STYLE-WARNING: VARIABLES-IN-DESCRIPTIONS::{name} becomes a variable, but in a designator that was expanded before it is the "
        f"keyword :{name}. at plan.lisp:1:24 Define a variable before the forms that use it, and evaluate those forms again."
    ).replace("VARIABLES-IN-DESCRIPTIONS::", "")
    assert lisp("(early)") == f"((:X :{name}))"
    assert lisp(f"(props (a motion (x {name})))") == "((:X 1))"
    assert lisp.warnings(definition) == ""


def test_a_definition_without_a_value_changes_nothing_and_is_not_warned_of(lisp):
    lisp("(defun early () (props (a motion (x later-5))))")
    assert lisp.warnings("(defvar later-5)") == ""
