"""Constructors by position give each slot its value, its default or nothing, in the first calls and when they are called often."""

from __future__ import annotations

from itertools import count

import pytest

from lisp_text import LispText

from cramhy_runtime.repl.session import Session

_numbers = count(1)
OFTEN = 50
CASES = [
    ("() ()", "(:constructor m ())", "(m)", "#S(S)"),
    ("() (a) (b 2)", "(:constructor m ())", "(m)", "#S(S :A NIL :B 2)"),
    ("() (a 1 :type integer) (b 2)", "(:constructor m (a))", "(m 5)", "#S(S :A 5 :B 2)"),
    ("() (a 1 :type integer) (b 2)", "(:constructor m (b a))", "(m :x 5)", "#S(S :A 5 :B :X)"),
    ("() (a 1 :type integer) (b 2)", "(:constructor m (&optional a b))", "(m)", "#S(S :A 1 :B 2)"),
    ("() (a 1) (b 2)", "(:constructor m (&key (b 3 given) &aux (a given)))", "(m :b 4)", "#S(S :A T :B 4)"),
    ("() (a 1) (b 2)", "(:constructor m (a &rest b))", "(m 1 2 3)", "#S(S :A 1 :B (2 3))"),
    ("() (a 1 :type integer) (b 2)", "(:constructor m (b &aux a))", "(list (s-b (m 7)))", "(7)"),
    ("() (b 2 :type integer)", "(:constructor m (&aux (b 7)))", "(m)", "#S(S :B 7)"),
    ("(:include base (x 9)) (a 1)", "(:constructor m (a))", "(m 3)", "#S(S :X 9 :Y 4 :A 3)"),
    ("(:include base) (a 1)", "(:constructor m (y a))", "(m 3 5)", "#S(S :X 8 :Y 3 :A 5)"),
    ("(:type list) (a 1) (b 2)", "(:constructor m (b))", "(m 3)", "(1 3)"),
    ("(:type vector) :named (a 1) (b 2)", "(:constructor m (b))", "(m 3)", "#(S 1 3)"),
    ("() (a (values 1 2)) (b (if nil 1))", "(:constructor m ())", "(m)", "#S(S :A 1 :B NIL)"),
]


@pytest.fixture(scope="module")
def lisp():
    return LispText(Session(time="virtual", turtlesim=False), "(in-package :cl-user)")


@pytest.fixture
def place(lisp):
    number = next(_numbers)
    lisp(f"(defpackage :cp-{number} (:use :cl)) (in-package :cp-{number}) (defstruct base (x 8 :type integer) (y 4))")


def definition(slots, constructor):
    option, _, rest = slots.partition(") ")
    option = "" if option == "(" else option + ")"
    named, rest = ("(:type vector) :named", rest.removeprefix(":named ")) if rest.startswith(":named") else (option, rest)
    return f"(defstruct (s {constructor} {named}) {rest.replace('()', '')})"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(("slots", "constructor", "call", "printed"), CASES)
def test_each_call_gives_what_the_first_one_gives(lisp, place, slots, constructor, call, printed):
    lisp(definition(slots, constructor))
    lisp(f"(defun called () {call})")
    assert [lisp("(called)") for _ in range(OFTEN)] == [printed] * OFTEN


def test_a_value_of_another_type_is_refused_in_the_first_call_and_later(lisp, place):
    lisp("(defstruct (s (:constructor m (a &optional (b 1)))) (a 1 :type integer) (b 2 :type (member 1 2)))")
    for _ in range(OFTEN):
        assert lisp("(list (handler-case (m 'x) (type-error (e) (type-error-datum e))) (s-a (m 3)))") == "(X 3)"
        assert "when setting slot B of structure S" in lisp('(handler-case (m 1 "no") (type-error (e) (princ-to-string e)))')


def test_a_default_is_computed_in_each_call(lisp, place):
    lisp("(defvar *n* 0) (defstruct (s (:constructor m ())) (a (incf *n*)) (b (list *n*)))")
    assert [lisp("(let ((s (m))) (list (s-a s) (s-b s)))") for _ in range(OFTEN)] == [f"({n} ({n}))" for n in range(1, OFTEN + 1)]


def test_instances_of_a_definition_with_other_slots_come_from_its_own_constructor(lisp, place):
    lisp("(defstruct (s (:constructor m (a))) a)")
    assert {lisp("(m 1)") for _ in range(OFTEN)} == {"#S(S :A 1)"}
    lisp("(handler-bind ((error #'continue)) (defstruct (s (:constructor m (b a))) a b))")
    assert {lisp("(m 1 2)") for _ in range(OFTEN)} == {"#S(S :A 2 :B 1)"}
