"""Errors of every phase have one format: what, file:line:column, the source line with a marker, what to try."""

import pytest

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.repl.session import condition_of, signalled_here

READING = [
    (
        "(list 1\n  '(1 . 2 3))",
        """\
  More than one object follows . in list.
  at plan.lisp:2:11
    '(1 . 2 3))
            ^
  After the dot and one object the list must end.""",
    ),
    (
        "(list 1\n  (nope::x))",
        """\
  Package NOPE does not exist.
  at plan.lisp:2:4
    (nope::x))
     ^
  There is no package NOPE. Is the system that defines it loaded?""",
    ),
]
EXPANSION = [
    (
        "(defun f (x)\n  (dolist x '(1 2)\n    (print x)))",
        """\
  The DOLIST form (DOLIST X '(1 2) (PRINT X)) is malformed: it has the wrong number of parts, or a part is not a list.
  at plan.lisp:2:3
      (dolist x '(1 2)
      ^
  It is written (dolist (variable list [result]) form...), for example (dolist (x '(1 2 3)) (print x))""",
    ),
    (
        "(defun f (x)\n  (cond (= x 1) 2))",
        """\
  The COND form (COND (= X 1) 2) is malformed: it has the wrong number of parts, or a part is not a list.
  at plan.lisp:2:3
      (cond (= x 1) 2))
      ^
  It is written (cond (test form...) (test form...)...).""",
    ),
    (
        "(defmacro twice-of (a b)\n  `(list ,a ,b))\n(print\n  (twice-of x))",
        """\
  Error while parsing arguments to DEFMACRO TWICE-OF:
    too few elements in
      (X)
    to satisfy lambda list
      (A B):
    exactly 2 expected, but got 1
  at plan.lisp:4:3
      (twice-of x))
      ^""",
    ),
    (
        "(defmacro broken-one (a)\n  `(list ,a ,(car 5)))\n(print\n  (broken-one x))",
        """\
  The value
    5
  is not of type
    LIST
  when binding LIST
  at plan.lisp:2:14
      `(list ,a ,(car 5)))
                 ^
  in the expansion of the macro call at plan.lisp:4:3
      (broken-one x))
      ^""",
    ),
    (
        "(defmacro misspelt (form)\n  `(list ,form ,fom))\n(misspelt 1)",
        """\
  The variable FOM is unbound.
  at plan.lisp:2:17
      `(list ,form ,fom))
                    ^
  in the expansion of the macro call at plan.lisp:3:1
    (misspelt 1)
    ^
  Did you mean FORM?""",
    ),
    (
        "(macrolet ((m (x)\n             (car x)))\n  (m 7))",
        """\
  The value
    7
  is not of type
    LIST
  when binding LIST
  at plan.lisp:2:14
                 (car x)))
                 ^
  in the expansion of the macro call at plan.lisp:3:3
      (m 7))
      ^""",
    ),
]
COMPILATION = [
    (
        "(defun f x\n  x)",
        """\
  The lambda list X is malformed: the parameters stand in a list, as in (x).
  at plan.lisp:1:1
    (defun f x
    ^""",
    ),
    (
        "(defun f\n  (dotimes (i 4) (print i)))",
        """\
  The lambda list (DOTIMES (I 4) (PRINT I)) is malformed: a parameter must be a symbol.
  at plan.lisp:1:1
    (defun f
    ^
  The list of the parameters comes behind the name of the function. If it has none, write () there: (defun name () ...)""",
    ),
    (
        "(defun f\n  (nobody (i 4)))",
        """\
  The lambda list (NOBODY (I 4)) is malformed: a parameter must be a symbol.
  at plan.lisp:1:1
    (defun f
    ^""",
    ),
    (
        "(defun f ()\n  (list 1\n    (return-from g 2)))",
        """\
  return for unknown block: G
  at plan.lisp:3:5
        (return-from g 2)))
        ^""",
    ),
    (
        "(defun f ()\n  (let ((x 1))\n    ((g x) 2)))",
        """\
  (G X) cannot be called: the head of a form must be a symbol or a lambda expression.
  at plan.lisp:3:5
        ((g x) 2)))
        ^
  Is a parenthesis too many in front of it? A function that a form gives is called so: (funcall (G X) 2)""",
    ),
    (
        "(list 1\n  (24 * 60 * 60))",
        """\
  24 cannot be called: the head of a form must be a symbol or a lambda expression.
  at plan.lisp:2:3
      (24 * 60 * 60))
      ^
  The name of the function comes first: (* 24 ...)""",
    ),
    (
        '(defvar *it*\n  (1 "a" x))',
        """\
  1 cannot be called: the head of a form must be a symbol or a lambda expression.
  at plan.lisp:2:3
      (1 "a" x))
      ^
  In a call the name of the function comes first. A list that is no call has a quote: '(1 "a" X)""",
    ),
    (
        "(list\n  (+1 2))",
        """\
  1 cannot be called: the head of a form must be a symbol or a lambda expression.
  at plan.lisp:2:3
      (+1 2))
      ^
  Is a space missing behind the +? (+ 1 ...)""",
    ),
]
RUNNING = [
    (
        "(defvar *speed-limit* 3)\n(defun f ()\n  (list 1\n    (+ 2 speed-limit)))\n(f)",
        """\
  The variable SPEED-LIMIT is unbound.
  at plan.lisp:4:10
        (+ 2 speed-limit)))
             ^
  There is a variable *SPEED-LIMIT*, with stars.""",
    ),
    (
        "(defgeneric speed-of (wheel) (:method ((wheel symbol)) 1) (:method ((wheel (eql 5))) 2))\n(list\n  (speed-of 6))",
        """\
  There is no applicable method for the generic function
    #<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::SPEED-OF (2)>
  when called with arguments
    (6).
  See also:
  The ANSI Standard, Section 7.6.6
  at plan.lisp:3:3
      (speed-of 6))
      ^
  Methods are defined for (SYMBOL) and ((EQL 5)).""",
    ),
    (
        "(dolist (x\n         identity)\n  x)",
        """\
  The variable IDENTITY is unbound.
  at plan.lisp:2:10
             identity)
             ^
  IDENTITY is a function, no variable: a call of it is (identity ...), in parentheses of its own.""",
    ),
    (
        "(list\n  dotimes (i 4) (print i))",
        """\
  The variable DOTIMES is unbound.
  at plan.lisp:2:3
      dotimes (i 4) (print i))
      ^
  DOTIMES is a macro, no variable: a call of it is (dotimes ...), in parentheses of its own.""",
    ),
    (
        "(list\n  progn)",
        """\
  The variable PROGN is unbound.
  at plan.lisp:2:3
      progn)
      ^
  PROGN is a special operator, no variable: a call of it is (progn ...), in parentheses of its own.""",
    ),
    (
        '(defun other (heights)\n  heights)\n(defun area (width height) "(heigt"\n  (* width heigth))\n(area 2 3)',
        """\
  The variable HEIGTH is unbound.
  at plan.lisp:4:12
      (* width heigth))
               ^
  Did you mean HEIGHT?""",
    ),
    (
        "(defun area (width height)\n  (* width height))\n(list heigth)",
        """\
  The variable HEIGTH is unbound.
  at plan.lisp:3:7
    (list heigth)
          ^""",
    ),
    (
        "(list\n  (*24 60))",
        """\
  The function COMMON-LISP-USER::*24 is undefined.
  at plan.lisp:2:3
      (*24 60))
      ^
  Is a space missing behind the *? (* 24 ...)""",
    ),
    (
        "(let ((x 1)\n      (y no-such-variable))\n  (list x y))",
        """\
  The variable NO-SUCH-VARIABLE is unbound.
  at plan.lisp:2:10
          (y no-such-variable))
             ^""",
    ),
    (
        "(cond\n  ((evenp 3) 1)\n  (t (list no-such-variable)))",
        """\
  The variable NO-SUCH-VARIABLE is unbound.
  at plan.lisp:3:12
      (t (list no-such-variable)))
               ^""",
    ),
    (
        '(defvar *seen* 1) ; a (comment\n(list ")" #\\( (def-fact-group animals\n  (legs)))',
        """\
  The variable ANIMALS is unbound.
  at plan.lisp:2:31
    (list ")" #\\( (def-fact-group animals
                                  ^
  Nobody has defined def-fact-group here, so (def-fact-group ...) is taken for a call, whose arguments are evaluated.
  There is prolog:def-fact-group in another package.""",
    ),
    (
        "(case 3\n  (3 no-such-variable))",
        """\
  The variable NO-SUCH-VARIABLE is unbound.
  at plan.lisp:2:6
      (3 no-such-variable))
         ^""",
    ),
    (
        "(defun f ()\n  (prnit 1))\n(f)",
        """\
  The function COMMON-LISP-USER::PRNIT is undefined.
  at plan.lisp:2:3
      (prnit 1))
      ^
  Did you mean PRINT?""",
    ),
    (
        "(define-condition lost (eror) ())",
        """\
  There is no class named COMMON-LISP-USER::EROR.
  at plan.lisp:1:1
    (define-condition lost (eror) ())
    ^
  Did you mean ERROR?""",
    ),
    (
        "(defclass arm (standar-object) ())\n(make-instance 'arm)",
        """\
  While computing the class precedence list of the class named COMMON-LISP-USER::ARM.
  The class named COMMON-LISP-USER::STANDAR-OBJECT is a forward referenced class.
  The class named COMMON-LISP-USER::STANDAR-OBJECT is a direct superclass of the class named COMMON-LISP-USER::ARM.
  at plan.lisp:2:1
    (make-instance 'arm)
    ^
  Did you mean STANDARD-OBJECT?""",
    ),
    (
        "(defclass arm (standar-object) ())\n(make-instance 'standar-object)",
        """\
  FINALIZE-INHERITANCE was called on a forward referenced class:
  #<SB-MOP:FORWARD-REFERENCED-CLASS COMMON-LISP-USER::STANDAR-OBJECT>
  at plan.lisp:2:1
    (make-instance 'standar-object)
    ^
  Did you mean STANDARD-OBJECT?""",
    ),
    (
        '(error "speed ~a of ~a" 1)',
        """\
  #<error printing a SIMPLE-ERROR "speed ~a of ~a": error in FORMAT: No more arguments speed ~a of ~a ^>
  at plan.lisp:1:1
    (error "speed ~a of ~a" 1)
    ^""",
    ),
]


@pytest.fixture
def shown(session, tmp_path, monkeypatch):
    """What is shown of the error of a file with this text."""
    monkeypatch.chdir(tmp_path)
    session.package = "COMMON-LISP-USER"
    monkeypatch.setattr(conditions._debugger, "value", signalled_here)

    def load(text):
        (tmp_path / "plan.lisp").write_text(text)
        with pytest.raises((Condition, Exception)) as caught:
            session.evaluate_text('(load "plan.lisp")')
        return explanation(condition_of(caught.value))

    return load


@pytest.mark.soak(all_but=7)
@pytest.mark.parametrize(("text", "expected"), [*READING, *EXPANSION, *COMPILATION, *RUNNING])
def test_an_error_in_a_file(shown, text, expected):
    assert shown(text) == expected
