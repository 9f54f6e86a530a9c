"""``gethash`` and its ``setf`` in compiled code, which look into the dictionary behind a table: the same as the functions, for every kind
of table and key."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

DEFINITIONS = """
(defun in-place (key table &optional (new nil new-p))
  (list (gethash key table) (gethash key table :none) (multiple-value-list (gethash key table :none))
        (multiple-value-bind (value found) (gethash key table) (list value found)) (if (gethash key table) :true :false)
        (when new-p (setf (gethash key table) new))))
(defun called (key table &optional (new nil new-p))
  (flet ((get-it (&rest rest) (apply #'gethash key table rest)))
    (list (values (get-it)) (values (get-it :none)) (multiple-value-list (get-it :none))
          (multiple-value-bind (value found) (get-it) (list value found)) (if (values (get-it)) :true :false)
          (when new-p (funcall #'(setf gethash) new key table)))))
(defvar *string* (make-string 1 :initial-element #\\a))
(defun contents (table) (let ((all nil)) (maphash (lambda (k v) (push (cons k v) all)) table) (list (hash-table-count table) (reverse all))))
(defun remove-both (key one other) (list (remhash key one) (remhash key other)))
"""
TABLES = [
    ":test 'eq",
    ":test 'eql",
    ":test 'equal",
    ":test 'equalp",
    ":test 'eql :weakness :key",
    ":test 'equal :weakness :value",
    ":test 'numbered :hash-function 'number-of",
]
KEYS = [
    "1", "2", "nil", "t", ":key", "'symbol", "#\\a", '"a"', "*string*", "1.0", "1.0d0", "0.0", "-0.0", "1/2", "#c(1 2)", "'(1 a)", "(list 1 'a)", "#(1)",
    "#*101", "12345678901234567890", "#'car", "*package*", '"A"', "#\\A", "(floor 7 2)", "*standard-output*",
]  # fmt: skip


@pytest.fixture(scope="module")
def lisp(session_of_module):
    session = session_of_module
    session.evaluate_text("(in-package :cl-user)")
    session.evaluate_text("(defun numbered (a b) (equal a b)) (defun number-of (a) (sxhash a))")
    session.evaluate_text(DEFINITIONS)

    def run(text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in session.evaluate_text(text))

    return run


@pytest.fixture(scope="module")
def session_of_module():
    from cramhy_runtime.repl.session import Session

    return Session(time="virtual", turtlesim=False)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("table", TABLES)
def test_in_place_and_called_they_are_the_same(lisp, table):
    lisp(f"(progn (defvar *one*) (defvar *other*) (setf *one* (make-hash-table {table}) *other* (make-hash-table {table})))")
    for number, key in enumerate([*KEYS, *KEYS]):
        for new in ("", str(number), "nil"):
            assert lisp(f"(in-place {key} *one* {new})") == lisp(f"(called {key} *other* {new})"), key
        assert lisp("(contents *one*)") == lisp("(contents *other*)"), key
    for key in KEYS[::2]:
        assert len(set(lisp(f"(remove-both {key} *one* *other*)").strip("()").split())) == 1
        assert lisp("(contents *one*)") == lisp("(contents *other*)"), key
    assert lisp("(progn (clrhash *one*) (setf (gethash 1.5 *one*) 1 (gethash 1 *one*) 2) (contents *one*))") == "(2 ((1.5 . 1) (1 . 2)))"


@pytest.mark.soak
@given(
    steps=st.lists(st.tuples(st.sampled_from(KEYS[:16]), st.sampled_from(["put", "get", "remove"])), max_size=12),
    table=st.sampled_from(TABLES[:4]),
)
def test_any_steps_leave_the_same_entries(lisp, steps, table):
    lisp(f"(progn (defvar *one*) (defvar *other*) (setf *one* (make-hash-table {table}) *other* (make-hash-table {table})))")
    for number, (key, step) in enumerate(steps):
        if step == "remove":
            lisp(f"(remove-both {key} *one* *other*)")
        else:
            new = number if step == "put" else ""
            assert lisp(f"(in-place {key} *one* {new})") == lisp(f"(called {key} *other* {new})")
    assert lisp("(contents *one*)") == lisp("(contents *other*)")


def test_an_entry_keeps_the_key_that_came_first(lisp):
    for first, second in [("*string*", '"a"'), ('"a"', "*string*")]:
        keys = f"(let ((h (make-hash-table :test 'equal))) (setf (gethash {first} h) 1 (gethash {second} h) 2) (contents-of h))"
        lisp("(defun contents-of (h) (let (found) (maphash (lambda (k v) (push (list (eq k *string*) v) found)) h) found))")
        assert lisp(keys) == ("((T 2))" if first == "*string*" else "((NIL 2))")
        again = f"(let ((h (make-hash-table :test 'equal))) (setf (gethash {first} h) 1) (remhash {second} h) (setf (gethash {second} h) 2) (contents-of h))"
        assert lisp(again) == ("((NIL 2))" if first == "*string*" else "((T 2))")


@pytest.mark.parametrize("table", ["5", "nil", "'(1)", '"text"'])
@pytest.mark.parametrize(
    "form",
    [
        "(gethash 1 ~)",
        "(multiple-value-list (gethash 1 ~ 2))",
        "(setf (gethash 1 ~) 2)",
        "(incf (gethash 1 ~ 0))",
        "(when (gethash 1 ~) 1)",
    ],
)
def test_what_is_no_table_is_told_alike(lisp, table, form):
    told = lisp(f"(handler-case (funcall (lambda (it) {form.replace('~', 'it')}) {table}) (type-error (c) (princ-to-string c)))")
    called = lisp(f"(handler-case (apply #'gethash (list 1 {table})) (type-error (c) (princ-to-string c)))")
    assert told == called and "HASH-TABLE" in told


@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(gethash (note 1 :k) (note 2 h) (note 3 :d))", "(:D (1 2 3))"),
        ("(setf (gethash (note 1 :k) (note 2 h)) (note 3 :new))", "(:NEW (1 2 3))"),
        ("(setf (gethash (note 1 :k) (note 2 h) (note 3 :d)) (note 4 :new))", "(:NEW (1 2 3 4))"),
        ("(progn (setf (gethash :k h) 1) (incf (gethash (note 1 :k) (note 2 h) (note 3 0)) (note 4 5)))", "(6 (1 2 3 4))"),
        ("(multiple-value-bind (v p) (gethash (note 1 :k) (note 2 h) (note 3 :d)) (list v p))", "((:D NIL) (1 2 3))"),
        ("(let ((k 1)) (gethash k (progn (setf (gethash 1 h) :one k 2) h)))", "(:ONE NIL)"),
        ("(let ((k 1)) (flet ((table () (setf (gethash 1 h) :one k 2) h)) (gethash k (table))))", "(:ONE NIL)"),
        ("(let ((k 1)) (flet ((table () (setf k 2) h)) (setf (gethash k (table)) :one) (gethash 1 h)))", "(:ONE NIL)"),
        ("(let ((i 0)) (setf (gethash (incf i) h) (incf i)) (list (gethash 1 h) i))", "((2 2) NIL)"),
        ("(and (gethash 1 h) (note 1 1))", "(NIL NIL)"),
        ("(progn (setf (gethash 1 h) nil) (multiple-value-list (gethash 1 h :d)))", "((NIL T) NIL)"),
        ("(progn (setf (gethash (values 1 2) h) (values 3 4)) (multiple-value-list (gethash (values 1 9) h)))", "((3 T) NIL)"),
        ("(multiple-value-list (let ((x (gethash 1 h (values 5 6)))) x))", "((5) NIL)"),
        ("(let ((fs (loop for i below 3 collect (let ((i i)) (lambda () (setf (gethash i h) (* i i)) (gethash i h)))))) (mapcar #'funcall fs))",
         "((0 1 4) NIL)"),
    ],
)  # fmt: skip
def test_arguments_are_evaluated_from_left_to_right(lisp, form, answer):
    lisp("(defvar *log* nil) (defun note (number value) (push number *log*) value)")
    assert (
        lisp(f"(progn (setf *log* nil) (defun try (h) {form}) (let ((value (try (make-hash-table)))) (list value (reverse *log*))))")
        == answer
    )


def test_a_function_of_the_user_that_is_called_so_is_none_of_it(lisp):
    lisp("(defpackage :other-gethash (:use :cl) (:shadow #:gethash)) (defun other-gethash::gethash (a b) (list a b))")
    assert lisp("(other-gethash::gethash 1 2)") == "(1 2)"
    assert (
        lisp(
            "(macrolet ((entry (k h) `(gethash ,k ,h))) (let ((h (make-hash-table))) (setf (entry 1 h) 2) (incf (entry 1 h)) (entry 1 h)))"
        )
        == "3 ; T"
    )
