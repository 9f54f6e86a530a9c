"""Core Hy forms mean to our translation to Python what they mean to Hy's own compiler."""

import types

import pytest
from hy import models
from hy.compiler import hy_compile

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.compiler.core import hy_model
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.repl.session import Session

PROGRAMS = """
(let ((s 0)) (dotimes (i 5 s) (when (oddp i) (incf s i))))
(loop for x in '(1 2 3) for y = 1 then (* y x) when (evenp x) collect (list x y))
(loop for i from 10 downto 1 by 3 sum i)
(let ((l nil)) (tagbody (go b) a (push 1 l) (go c) b (push 2 l) (go a) c) l)
(block out (mapc (lambda (x) (when (= x 2) (return-from out (list :found x)))) '(1 2 3)) :none)
(unwind-protect (+ 1 2) (print 3))
(handler-case (/ 1 0) (division-by-zero () :zero) (:no-error (x) x))
(labels ((f (n &optional (k 2) &key (z 1 zp)) (if (< n 1) (list k z zp) (f (- n 1) (1+ k) :z n)))) (f 3))
(let ((fs (loop for i below 3 collect (let ((j i)) (lambda () (incf j)))))) (mapcar #'funcall fs))
(multiple-value-bind (q r) (floor 17 5) (list q r))
(flet ((raise (x) (list x)) (cut (y) y)) (list (raise 1) (cut 2)))
(let ((cut 1) (fn 2) (if 3)) (list cut fn if))
(progv '(*print-base*) '(2) (prin1-to-string 5))
(flet ((f (&rest r) r)) (apply #'f 1 '(2 3)))
(let ((x 2.5) (y 1/2)) (list (+ x 1) (* x x) (- y) (< x y) (1+ y)))
""".strip().splitlines()


@pytest.fixture(scope="module")
def session():
    yield Session(time="virtual", turtlesim=False)
    kernel.stop()


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("program", PROGRAMS)
def test_hy_agrees(session, program):
    unit = evaluator.Unit("<test>")
    statements = unit.statements(Reader(program).read())
    ours = unit.run(unit.code(statements))
    tree = hy_compile(models.Expression([models.Symbol("do"), *map(hy_model, statements)]), types.ModuleType("test"), import_stdlib=False)
    hys = unit.run(compile(tree, "<test>", "exec"))
    assert prin1_to_string(ours) == prin1_to_string(hys)


def test_code_that_fails_stands_where_the_form_does(session):
    with pytest.raises(Exception) as raised:
        session.evaluate_text("(list 1\n  (car 2))")
    assert raised.value.position[1:] == (2, 3)
