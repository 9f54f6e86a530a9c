"""Compiler macros are applied to calls of the global function, unless it is declared NOTINLINE; the answers are SBCL's."""

import pytest

from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

DEFINITIONS = """
(defun sq (x) (list :fn x))
(define-compiler-macro sq (&whole form x &environment env)
  (declare (ignore env))
  (if (numberp x) `(list :cm ,(* x x)) form))
(defun plus3 (a b c) (list a b c))
(define-compiler-macro plus3 (&rest args) `(vector ,@(reverse args)))
"""


@pytest.fixture
def lisp(session):
    session.package = "COMMON-LISP-USER"
    session.evaluate_text(DEFINITIONS)
    return lambda form: prin1_to_string(session.evaluate_text(form)[0])


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    ("form", "answer"),
    [
        ("(sq 4)", "(:CM 16)"),
        ("(let ((a 4)) (sq a))", "(:FN 4)"),
        ("(funcall #'sq 4)", "(:CM 16)"),
        ("(funcall 'sq 4)", "(:FN 4)"),
        ("(mapcar #'sq '(4))", "((:FN 4))"),
        ("(locally (declare (notinline sq)) (sq 4))", "(:FN 4)"),
        ("(list (let ((z 1)) (declare (notinline sq)) (list z (sq 4))) (sq 4))", "((1 (:FN 4)) (:CM 16))"),
        ("(flet ((sq (x) (list :local x))) (list (sq 4) (funcall #'sq 4)))", "((:LOCAL 4) (:LOCAL 4))"),
        ("(flet ((f () (declare (notinline sq)) (sq 4))) (list (f) (sq 4)))", "((:FN 4) (:CM 16))"),
        ("(plus3 1 2 3)", "#(3 2 1)"),
        ("(apply #'plus3 '(1 2 3))", "(1 2 3)"),
        ("(funcall (compiler-macro-function 'sq) '(sq 5) nil)", "(LIST :CM 25)"),
        ("(progn (declaim (notinline sq)) (list (sq 4) (progn (eval '(declaim (inline sq))) (eval '(sq 4)))))", "((:FN 4) (:CM 16))"),
        ("(progn (setf (compiler-macro-function 'plus3) nil) (eval '(plus3 1 2 3)))", "(1 2 3)"),
        (
            "(mapcar (lambda (form) (if (constantp form) t nil)) '(1 x :x nil pi 'x (+ 1 2) (car x) \"s\" t (quote) (if t 1 2) (progn 1 2)"
            " (list 1) (the integer 3) (let ((a 1)) a)))",
            "(T NIL T T T T T NIL T T NIL T T NIL T NIL)",
        ),
    ],
)
def test_a_call(lisp, form, answer):
    assert lisp(form) == answer
