"""What CRAM-UTILITIES has since CRAM's branch devel: two method combinations and four functions."""

import itertools
import re

import pytest

from cramhy_runtime.lisp_core.conditions import Condition

numbers = itertools.count(1)
GENERIC = """(defpackage :newer (:use :cl)) (in-package :newer)
  (defclass animal () ()) (defclass dog (animal) ())"""
FIRST = (
    GENERIC
    + """(defgeneric speak (who &key loud)
  (:method-combination cut:first-in-order-and-around)
  (:documentation "What it says.")
  (:method :heuristics 20 ((who animal) &key loud) (declare (ignore loud)) :by-default))"""
)
HOOKS = GENERIC + "(defgeneric visit (who) (:method-combination cut:ordered-hooks))"


def fresh(text):
    """The text, in a package of its own."""
    return text.replace(":newer", f":newer-{next(numbers)}")


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    ("methods", "value"),
    [
        ("", ":BY-DEFAULT"),
        ("(defmethod speak :knowledge 10 ((who animal) &key loud) (list :known loud))", "(:KNOWN T)"),
        ("(defmethod speak :guess 30 ((who dog) &key loud) (list :guessed loud))", ":BY-DEFAULT"),
        ("(defmethod speak :heuristics 20 ((who dog) &key loud) (list :dog loud))", "(:DOG T)"),
        (
            "(defmethod speak :knowledge 0 ((who animal) &key loud) (list :zero loud)) (defmethod speak :x 5 ((who dog) &key loud) loud)",
            "(:ZERO T)",
        ),
        (
            "(defmethod speak :around ((who dog) &key loud) (declare (ignore loud)) (list :around (call-next-method)))",
            "(:AROUND :BY-DEFAULT)",
        ),
        (
            """(defmethod speak :around ((who animal) &key loud) (declare (ignore loud)) (list :outer (call-next-method)))
               (defmethod speak :around ((who dog) &key loud) (declare (ignore loud)) (list :inner (call-next-method)))
               (defmethod speak :knowledge 1 (who &key loud) (declare (ignore loud)) :one)""",
            "(:INNER (:OUTER :ONE))",
        ),
    ],
)
def test_of_numbered_methods_the_lowest_number_is_called_with_the_around_methods_around_it(lisp, methods, value):
    assert lisp(fresh(FIRST) + f" {methods} (speak (make-instance 'dog) :loud t)") == value


def test_a_method_without_a_number_is_an_error_of_its_call(lisp):
    with pytest.raises(Condition) as error:
        lisp(
            fresh(FIRST)
            + "(handler-bind ((warning #'muffle-warning)) (eval '(defmethod speak :odd ((who dog) &key loud) loud))) (speak (make-instance 'dog))"
        )
    assert "The method combination type FIRST-IN-ORDER-AND-AROUND requires :AROUND, or a name and a number" in error.value.report()


def test_no_applicable_method_is_the_usual_error(lisp):
    with pytest.raises(Condition) as error:
        lisp(fresh(FIRST) + "(speak 5)")
    assert "There is no applicable method for the generic function" in re.sub(r"\s+", " ", error.value.report())


@pytest.mark.parametrize(
    ("methods", "value"),
    [
        (
            """(defmethod visit :c 3 ((who dog)) :three) (defmethod visit :a 1 ((who animal)) :one) (defmethod visit :z (who) :any)
               (defmethod visit :b 2 (who) :two)""",
            "(:ONE :TWO :THREE :ANY)",
        ),
        ("(defmethod visit :c -3 ((who dog)) :minus) (defmethod visit :a 7 (who) :seven)", "(:SEVEN :MINUS)"),
        ("(defmethod visit :c 1.5 ((who dog)) :float) (defmethod visit :a 7 (who) :seven)", "(:SEVEN :FLOAT)"),
        ("(defmethod visit :a ((who dog)) :dog) (defmethod visit :b ((who animal)) :animal)", "(:DOG :ANIMAL)"),
    ],
)
def test_hooks_with_numbers_are_called_in_their_order_and_then_the_others(lisp, methods, value):
    assert lisp(fresh(HOOKS) + f" {methods} (visit (make-instance 'dog))") == value


def test_hooks_in_order_may_be_combined_and_be_none(lisp):
    text = fresh(GENERIC) + "(cut:define-hook visit (who) (:method-combination cut:ordered-hooks :hook-combination append))"
    assert lisp(text + "(visit 1)") == "NIL"
    assert lisp("(defmethod visit :b 2 (who) (list who)) (defmethod visit :a 1 ((who integer)) (list (- who) who)) (visit 1)") == "(-1 1 1)"


@pytest.mark.parametrize(
    ("form", "values"),
    [
        ("(loop repeat 200 always (<= 3 (cut:random-with-minimum 6 3) 5))", "T"),
        ("(loop repeat 50 always (and (floatp (cut:random-with-minimum 2.5 0.5)) (<= 0.5 (cut:random-with-minimum 2.5 0.5) 2.5)))", "T"),
        ("(remove-duplicates (sort (loop repeat 200 collect (cut:random-with-minimum 2 -1)) #'<))", "(-1 0 1)"),
        (
            """(let ((table (cut:recursive-alist-hash-table '(("a" . 1) ("b" ("c" . 2) ("d" ("e" . 3))) ("a" . 4)) :test #'equal)))
                 (list (gethash "a" table) (gethash "c" (gethash "b" table)) (gethash "e" (gethash "d" (gethash "b" table)))
                       (hash-table-test (gethash "b" table)) (hash-table-count table)))""",
            "(1 2 3 EQUAL 2)",
        ),
        ("(hash-table-count (gethash :x (cut:recursive-alist-hash-table '((:x)))))", "0"),
        ('(cut:replace-all "a-b-c" "-" "::")', '"a::b::c"'),
        ('(cut:replace-all "aaa" "aa" "b")', '"ba"'),
        ('(cut:replace-all "none" "-" "+")', '"none"'),
        ('(cut:replace-all "-x-" "-" "")', '"x"'),
        ('(cut:replace-all "AbaB" "b" "." :test #\'char-equal)', '"A.a."'),
        ('(cut:replace-all "" "b" ".")', '""'),
    ],
)
def test_the_functions(lisp, form, values):
    assert lisp(form) == values


def test_the_text_to_replace_may_not_be_empty(lisp):
    with pytest.raises(Condition) as error:
        lisp('(cut:replace-all "abc" "" "x")')
    assert error.value.report() == "The text to replace is empty."
