"""``describe``, ``documentation`` and ``apropos``: what is known about a thing, as SBCL 2.2.9 lays it out."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.languages.commonlisp.streams.streams import ERROR_OUTPUT, STANDARD_OUTPUT, StringOutputStream

DEFINITIONS = """
(defun fib (n &optional (k 2) &rest r &key (z 3) w) "Fibonacci.
Two lines." (list n k r z w))
(defmacro my-mac (a &body b) "Mac doc." `(progn ,a ,@b))
(defvar *v* 3 "A var.")
(defvar *unb*)
(defconstant +c+ 5 "const doc")
(define-symbol-macro smac (car *v*))
(deftype small () "a small type" '(integer 0 5))
(defclass base () ())
(defclass robot (base)
  ((name :initarg :name :initform "R2" :accessor robot-name :documentation "its name")
   (speed :initarg :speed :reader robot-speed :type integer)
   (count :allocation :class :initform 0))
  (:documentation "A robot."))
(defstruct point "A point." (x 0 :type fixnum) (y 0))
(define-condition my-err (error) ((why :initarg :why :reader why)) (:documentation "cond") (:report "hm"))
(defgeneric area (shape &key scale) (:documentation "Area of it."))
(defmethod area ((s robot) &key scale) "robot area" scale)
(defmethod area ((s (eql 3)) &key scale) scale)
(defun (setf foo) (v x) "setf foo doc" (list v x))
(defsetf bar set-bar "defsetf doc")
(defpackage :described (:use :cl) (:nicknames :dsc) (:export #:aa) (:documentation "pk doc"))
"""


@pytest.fixture
def lisp(session, monkeypatch):
    """``lisp(text)``: what evaluating ``text`` in CL-USER printed, addresses left out."""

    def lisp(text):
        output = StringOutputStream()
        for stream in (STANDARD_OUTPUT, ERROR_OUTPUT):  # globally: tasks of plans print too
            monkeypatch.setattr(stream, "value", output)
        lisp.values = session.evaluate_text(text)
        return re.sub(r"\{[0-9A-F]{10}\}", "{address}", output.text())

    session.package = "COMMON-LISP-USER"
    session.evaluate_text(DEFINITIONS)
    yield lisp
    session.evaluate_text("(delete-package :described)")


def without_place(text):
    return re.sub(r"^ *Source file: .*\n", "", text, flags=re.M)


def test_functions_and_macros(lisp):
    text = lisp("(describe 'fib)")
    assert "  Source file: <repl 1>:2\n" in text
    assert (
        without_place(text)
        == """\
COMMON-LISP-USER::FIB
  [symbol]

FIB names a compiled function:
  Lambda-list: (N &OPTIONAL (K 2) &REST R &KEY (Z 3) W)
  Documentation:
    Fibonacci.
    Two lines.
"""
    )
    assert (
        without_place(lisp("(describe #'fib)"))
        == """\
#<FUNCTION FIB>
  [compiled function]


Lambda-list: (N &OPTIONAL (K 2) &REST R &KEY (Z 3) W)
Documentation:
  Fibonacci.
  Two lines.
"""
    )
    assert (
        without_place(lisp("(describe 'my-mac)"))
        == """\
COMMON-LISP-USER::MY-MAC
  [symbol]

MY-MAC names a macro:
  Lambda-list: (A &BODY B)
  Documentation:
    Mac doc.
"""
    )
    assert without_place(lisp("(describe 'foo)")).splitlines()[3:] == [
        "(SETF FOO) names a compiled function:",
        "  Lambda-list: (V X)",
        "  Documentation:",
        "    setf foo doc",
    ]
    assert lisp("(describe 'bar)").splitlines()[3:] == ["(SETF BAR) has setf-expansion: SET-BAR", "  Documentation:", "    defsetf doc"]
    assert lisp("(describe 'when)").splitlines()[3:] == ["WHEN names a macro:", "  Lambda-list: (TEST &REST BODY)"]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("*v*", "*V* names a special variable:\n  Value: 3\n  Documentation:\n    A var."),
        ("*unb*", "*UNB* names a special variable:\n  Currently unbound."),
        ("+c+", "+C+ names a constant variable:\n  Value: 5\n  Documentation:\n    const doc"),
        ("smac", "SMAC names a symbol macro:\n  Expansion: (CAR *V*)"),
        ("small", "SMALL names a type-specifier:\n  Documentation:\n    a small type\n  Lambda-list: ()\n  Expansion: (INTEGER 0 5)"),
        (":key", "KEY names a constant variable:\n  Value: :KEY"),
        ("nil", "NIL names a constant variable:\n  Value: NIL"),
    ],
)
def test_what_a_symbol_names(lisp, name, shown):
    assert lisp(f"(describe '{name})").partition("\n\n")[2].rstrip() == shown


def test_a_symbol_without_meaning(lisp):
    assert lisp("(describe 'unknown)") == "COMMON-LISP-USER::UNKNOWN\n  [symbol]\n"


def test_classes_and_instances(lisp):
    assert (
        lisp("(describe 'robot)")
        == """\
COMMON-LISP-USER::ROBOT
  [symbol]

ROBOT names the standard-class #<STANDARD-CLASS COMMON-LISP-USER::ROBOT>:
  Documentation:
    A robot.
  Class precedence-list: ROBOT, BASE, STANDARD-OBJECT, T
  Direct superclasses: BASE
  No subclasses.
  Direct slots:
    NAME
      Initargs: :NAME
      Initform: "R2"
      Readers: ROBOT-NAME
      Writers: (SETF ROBOT-NAME)
      Documentation:
       its name
    SPEED
      Type: INTEGER
      Initargs: :SPEED
      Readers: ROBOT-SPEED
    COUNT
      Allocation: :CLASS
      Initform: 0
"""
    )
    assert (
        lisp("(describe (make-instance 'robot))")
        == """\
#<ROBOT {address}>
  [standard-object]

Slots with :CLASS allocation:
  COUNT                          = 0
Slots with :INSTANCE allocation:
  NAME                           = "R2"
  SPEED                          = #<unbound slot>
"""
    )
    assert (
        lisp("(describe (make-point :y '(1 2)))")
        == """\
#S(POINT :X 0 :Y (1 2))
  [structure-object]

Slots with :INSTANCE allocation:
  X                              = 0
  Y                              = (1 2)
"""
    )
    assert (
        lisp("(describe (make-condition 'my-err :why 3))")
        == """\
#<MY-ERR {address}>
  [condition]

Slots with :INSTANCE allocation:
  WHY                            = 3
"""
    )
    assert "MY-ERR names the condition-class #<SB-PCL::CONDITION-CLASS COMMON-LISP-USER::MY-ERR>:\n  Documentation:\n    cond\n" in lisp(
        "(describe 'my-err)"
    )


def test_generic_functions_with_their_methods(lisp):
    assert (
        lisp("(describe #'area)")
        == """\
#<STANDARD-GENERIC-FUNCTION COMMON-LISP-USER::AREA (2)>
  [generic-function]


Lambda-list: (SHAPE &KEY SCALE)
Documentation:
  Area of it.
Method-combination: STANDARD
Methods:
  (AREA ((EQL 3)))
  (AREA (ROBOT))
    Documentation:
      robot area
"""
    )


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    ("form", "shown"),
    [
        ("3", "3\n  [fixnum]\n"),
        ("(expt 2 100)", "1267650600228229401496703205376\n  [bignum]\n"),
        ("3.5d0", "3.5d0\n  [double-float]\n"),
        ("1/2", "1/2\n  [ratio]\n"),
        (r"#\a", "#\\a\n  [standard-char]\n\nChar-code: 97\nChar-name: LATIN_SMALL_LETTER_A\n"),
        ('"abc"', '"abc"\n  [simple-string]\n\nElement-type: CHARACTER\nLength: 3\n'),
        ("(vector 1 2)", "#(1 2)\n  [simple-vector]\n\nElement-type: T\nLength: 2\n"),
        ("#*101", "#*101\n  [simple-bit-vector]\n\nElement-type: BIT\nLength: 3\n"),
        (
            "(make-array 3 :fill-pointer 1 :adjustable t)",
            "#(0)\n  [vector]\n\nElement-type: T\nFill-pointer: 1\nSize: 3\nAdjustable: yes\nDisplaced: no\n",
        ),
        (
            "(make-array '(2 2) :element-type 'double-float)",
            "#2A((0.0d0 0.0d0) (0.0d0 0.0d0))\n  [simple specialized array]\n\nElement-type: DOUBLE-FLOAT\nDimensions: (2 2)\n",
        ),
        ("'(1 2)", "(1 2)\n  [list]\n"),
        ("'(1 . 2)", "(1 . 2)\n  [cons]\n"),
        (
            "(make-hash-table :test 'equal)",
            "#<HASH-TABLE :TEST EQUAL :COUNT 0 {address}>\n  [hash-table]\n\nOccupancy: 0.0\n"
            "Rehash-threshold: 1.0\nRehash-size: 1.5\nSize: 7\nSynchronized: no\n",
        ),
        (
            "(find-package :described)",
            '#<PACKAGE "DESCRIBED">\n  [package]\n\n\nDocumentation:\n  pk doc\nNicknames: DSC\n'
            "Use-list: COMMON-LISP\nExports: AA\n0 internal symbols.\n",
        ),
        ("(make-string-output-stream)", "#<SB-IMPL::STRING-OUTPUT-STREAM {address}>\n  [stream]\n"),
        ("(loop for i below 60 collect i)", "(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 2..\n  [list]\n"),
    ],
)
def test_objects(lisp, form, shown):
    assert lisp(f"(describe {form})") == shown
    assert lisp.values == []


def test_users_describe_their_own_classes(lisp):
    lisp('(defmethod describe-object ((x base) stream) (format stream "I am ~a.~%" (type-of x)))')
    assert lisp("(describe (make-instance 'robot))") == "I am ROBOT.\n"
    assert lisp("(princ (with-output-to-string (s) (describe (make-instance 'base) s)))") == "I am BASE.\n"


def test_things_of_cram(lisp):
    assert (
        lisp("(describe (cpl:make-fluent :name :distance :value 3))")
        == """\
#<FLUENT DISTANCE [3]>
  [fluent]

Name: :DISTANCE
Value: 3
Pulses: 0
Waiting tasks: NIL
Fluents computed from it: NIL
Callbacks: NIL
"""
    )
    assert (
        lisp("(describe (desig:a motion (type going) (to (1 2))))")
        == """\
#<A MOTION
    (TYPE GOING)
    (TO (1 2))>
  [designator]

Class: CRAM-DESIGNATORS:MOTION-DESIGNATOR
Properties: ((:TYPE :GOING) (:TO (1 2)))
Effective: NIL
Data: NIL
Timestamp: NIL
"""
    )
    lisp("(cpm:def-process-module described-pm (d) d)")
    assert "  [process-module]\n\nName: DESCRIBED-PM\nStatus: :WAITING\n" in lisp("""
        (cpl:top-level (cpm:with-process-modules-running (described-pm)
          (describe (cpm:get-running-process-module 'described-pm))))""")
    shown = lisp("""
        (let ((go (cpl:make-fluent :name :go)))
          (cpl:top-level
            (cpl:with-tags
              (cpl:par (:tag waiter (cpl:wait-for go))
                       (progn (cpl:sleep 1) (describe waiter) (setf (cpl:value go) t))))))""")
    assert '  [task]\n\nName: "[TAG-WAITER]-' in shown
    assert "\nStatus: :RUNNING\n" in shown and "\nWaits for: the fluent #<FLUENT GO [NIL]>\n" in shown


def test_python_objects(lisp, session):
    from cramhy_runtime.lisp_core.packages import sym

    class Gripper:
        """A hand."""

        def __init__(self):
            self.width, self._secret = 0.5, 1

    sym("COMMON-LISP-USER::*HAND*").value = Gripper()
    sym("COMMON-LISP-USER::*HAND*").special = True
    shown = lisp("(describe *hand*)")
    assert "  [Python object]\n" in shown
    assert "Documentation:\n  A hand.\nAttributes:\n  width                          = 0.5d0\n" in shown


@pytest.mark.soak(all_but=6)
@pytest.mark.parametrize(
    ("form", "text"),
    [
        ("'fib 'function", "Fibonacci.\nTwo lines."),
        ("#'fib t", "Fibonacci.\nTwo lines."),
        ("#'fib 'function", "Fibonacci.\nTwo lines."),
        ("'my-mac 'function", "Mac doc."),
        ("(macro-function 'my-mac) t", "Mac doc."),
        ("'*v* 'variable", "A var."),
        ("'+c+ 'variable", "const doc"),
        ("'small 'type", "a small type"),
        ("'robot 'type", "A robot."),
        ("(find-class 'robot) t", "A robot."),
        ("'point 'structure", "A point."),
        ("'point 'type", "A point."),
        ("'my-err 'type", "cond"),
        ("'area 'function", "Area of it."),
        ("(find-method #'area nil (list (find-class 'robot))) t", "robot area"),
        ("'(setf foo) 'function", "setf foo doc"),
        ("'bar 'setf", "defsetf doc"),
        ("(find-package :described) t", "pk doc"),
        ("(first (sb-mop:class-direct-slots (find-class 'robot))) t", "its name"),
        ("'undefined-thing 'function", None),
    ],
)
def test_documentation_is_read_and_set(lisp, form, text):
    lisp(f"(documentation {form})")
    assert lisp.values == [text]
    lisp(f'(list (setf (documentation {form}) "new") (documentation {form}))')
    assert list(lisp.values[0]) == ["new", "new"]


def test_documentation_of_an_unknown_kind_is_a_warning(lisp):
    assert lisp("(documentation 'fib 'nonsense)") == "WARNING: unsupported DOCUMENTATION: doc-type NONSENSE for object of type SYMBOL\n"
    assert lisp.values == [None]


def test_users_may_add_kinds_of_documentation(lisp):
    lisp("""(defmethod documentation ((x (eql 'fib)) (kind (eql 'manual))) "see page 3")""")
    lisp("(documentation 'fib 'manual)")
    assert lisp.values == ["see page 3"]


def test_apropos(lisp):
    assert lisp('(apropos "hash-table-c" :cl)') == "HASH-TABLE-COUNT (fbound)"
    assert lisp('(apropos "*print-b")') == "*PRINT-BASE* = 10"
    assert lisp('(apropos "fib" :cl-user)') == "FIB (fbound)"
    lisp("(apropos-list 'eval- :cl)")
    assert [symbol.name for symbol in lisp.values[0]] == ["EVAL-WHEN"]
    lisp('(list (apropos-list "aa" :described t) (apropos-list "no such name"))')
    assert [symbol.name for symbol in lisp.values[0].car] == ["AA"]
    assert lisp.values[0].cdr.car is None
