"""The functions of the plan language in plain Hy: called by macros, as values, and next to names of the user's own."""

from __future__ import annotations

import types

import hy
import pytest

import cramhy
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, UndefinedFunction
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.repl.session import Session


def run(text):
    """The value of the last form of ``text``."""
    module = types.ModuleType("functions_in_hy")
    value = None
    for form in hy.read_many("(require cramhy *)" + text):
        value = hy.eval(form, module=module)
    return value


@pytest.mark.soak
def test_import_gives_the_functions_as_values():
    assert run("(import cramhy *) (list (map value [(make-fluent :value 1) (make-fluent :value 2)]))") == [1, 2]
    assert run("(import cramhy [v-dist]) (setv f v-dist) (f (make-3d-vector 1 0 0) (make-3d-vector 3 0 0))") == 2
    assert run("(import cramhy *) (setv m make-fluent) (. (m :name 'x :value 7) value)") == 7


def test_what_a_star_imports_hides_nothing_of_python():
    names = set(cramhy.__all__)
    assert {"reference", "pm_execute", "wait_for", "value", "make_fluent", "perform", "prolog", "force_ll"} <= names
    assert not names & {"abs", "max", "print", "list", "not", "x", "y", "hy", "macros", "functions", "language"}
    run("(top-level 1)")  # loads the files of macros, which are modules of the package
    assert all(callable(getattr(cramhy, name)) for name in names)


@pytest.mark.soak
def test_a_function_of_the_users_is_called_and_a_value_of_that_name_is_not_in_the_way():
    assert run("(defn value [x] (* 2 x)) (value 4)") == 8
    assert run("(setv value 5) (value (make-fluent :value value))") == 5
    assert run("(defn f [fluent] (setv value (value fluent)) value) (f (make-fluent :value 6))") == 6


@pytest.mark.soak
def test_all_with_one_argument_is_the_function_of_python():
    assert run("(all (gfor x [1 2] (> x 0)))") is True and run("(all [1 0])") is False
    assert run("(str (all objects (type cup)))") == run("(str (desig:all objects (type cup)))")


@pytest.mark.parametrize(
    "name, hint",
    [
        ("SimplePlanFailure", r"It is imported by \(import cramhy_runtime.cpl \[SimplePlanFailure\]\)."),
        ("door-stuck", "Is it imported, and spelled like this?"),
    ],
)
def test_a_handler_of_a_type_that_nobody_has_defined_is_told(name, hint):
    text = f'(top-level (with-failure-handling [[{name} [e] (leave 1)]] (fail "no")))'
    with pytest.raises(
        (NameError, Condition), match=f"A handler names the type {name}, which is no class of Hy and no type of Lisp. {hint}"
    ):
        run(text)
    assert run('(top-level (with-failure-handling [[simple-plan-failure [e] (leave 1)]] (fail "no")))') == 1


@pytest.mark.soak
def test_a_rule_calls_a_class_of_hy_with_keywords():
    text = """
    (import dataclasses [dataclass])
    (defclass [dataclass] Speed [] (setv #^ float ahead 0  #^ float turn 0))
    (defn twice [x [offset 0]] (+ offset x x))
    (def-fact-group speeds-of-a-test []
      (<- (speed-of ?ahead ?speed) (lisp-fun Speed :ahead ?ahead ?speed))
      (<- (turn-of ?turn ?speed) (lisp-fun Speed 1 :turn ?turn ?speed))
      (<- (twice-of ?x ?y) (lisp-fun twice ?x :offset 1 ?y)))
    (defn first-answer [answers] (. (get (list (get (list answers) 0)) 0) cdr))
    """
    speed = run(text + "(first-answer (prolog '(speed-of 3 ?s)))")
    assert (speed.ahead, speed.turn) == (3, 0)
    speed = run(text + "(first-answer (prolog '(turn-of 3 ?s)))")
    assert (speed.ahead, speed.turn) == (1, 3)
    assert run(text + "(first-answer (prolog '(twice-of 3 ?y)))") == 7


def test_a_line_of_the_log_has_a_text_with_or_without_a_condition(capsys):
    run('(ros-warn (turtle) "~a went wrong" 1) (ros-warn (turtle) (> 1 2) "never ~a" 1) (ros-warn (turtle) (> 2 1) "~a as well" 2)')
    told = capsys.readouterr().out
    assert "1 went wrong" in told and "2 as well" in told and "never" not in told


def test_vectors_need_no_prefix():
    assert run("(. (transform-point (make-identity-transform) (make-3d-vector 1 2 3)) y)") == 2
    assert run("(cl-transforms:y (make-3d-vector 1 2 3))") == 2


def test_a_quoted_name_is_the_symbol_of_a_function():
    assert run("(. (fl-funcall 'v-norm (make-fluent :value (make-3d-vector 0 3 4))) value)") == 5


@pytest.mark.soak
def test_lists_of_lisp_are_gone_through_by_hy():
    assert isinstance(run("(lisp (1 2 3))"), Cons)
    assert run("(lfor x (lisp (1 2 3)) (* x 2))") == [2, 4, 6]
    assert run("(setv [a b #* rest] (lisp (1 2 3 4))) [a b rest]") == [1, 2, [3, 4]]
    assert kernel.now() == 0


def test_functions_of_hy_named_like_those_of_lisp_leave_lisps_alone():
    """A Hy package uses COMMON-LISP, so the names are Lisp's own symbols."""
    before = {name: sym(name).function for name in ("POSITION", "LIST", "SEARCH")}
    assert isinstance(sym("SPEED").function, UndefinedFunction)
    assert run(
        """
        (defn position [x] (* 2 x))
        (defclass speed [] (defn __init__ [self x] (setv self.x x)))
        (def-fact-group names-of-lisp []
          (<- (twice ?x ?y) (lisp-fun position ?x ?y))
          (<- (fast ?x ?s) (lisp-fun speed ?x ?s))
          (<- (pair ?x ?l) (lisp-fun list ?x ?x ?l)))
        (def-cram-function search [x] (+ x 1))
        (setv first-of (fn [goal] (. (next (iter (force-ll (prolog goal)))) car cdr)))
        [(first-of (lisp (twice 4 ?y))) (. (first-of (lisp (fast 4 ?s))) x) (list (first-of (lisp (pair 4 ?l)))) (top-level (search 4))]
        """
    ) == [8, 4, [4, 4], 5]
    assert {name: sym(name).function for name in before} == before
    assert isinstance(sym("SPEED").function, UndefinedFunction)


@pytest.mark.soak
@pytest.mark.parametrize(
    ("values", "first"), [("(values nil 1)", None), ("(values 0 1)", 0), ('(values "" 1)', ""), ("(values 2 nil)", 2), ("(values)", None)]
)
def test_several_values_are_a_tuple_that_is_as_true_as_its_first_value(values, first):
    """Where it is asked whether it is true; and who takes the first value alone gets that, whether it is true or not."""
    session = Session(time="virtual", turtlesim=False)
    session.evaluate_text(f"(defpackage sev (:use :cpl)) (in-package :sev) (defun several () {values}) (defvar *first* (several))")
    text = "(lisp-package :sev) (import cramhy_runtime.lisp_core.functions [function_of])(setv f (function-of (lisp several)))"
    assert run(text + "(top-level (bool (par (f) 1)))") is bool(first)
    assert run(text + "(top-level (if (seq (f)) (cond (f) 1 True 2) (or (not (f)) 3)))") == (1 if first else True)
    assert len(run(text + "(f)")) == (0 if values == "(values)" else 2)
    assert session.evaluate_text("*first*") == [first]
    [found] = session.evaluate_text("(list (car (mapcar (lambda (x) (declare (ignore x)) (several)) '(1))) (if (several) 1 2))")
    assert list(found) == [first, 2 if first is None else 1]
