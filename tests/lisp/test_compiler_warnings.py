"""What the compiler warns of: the texts are SBCL's, the place and the source line are ours."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.repl import json_lines
from cramhy_runtime.repl.session import Session


@pytest.fixture
def lisp(monkeypatch, tmp_path):
    """Evaluates a text as at the prompt, in a folder of its own; ``lisp.said()`` is what was printed to *error-output* since."""
    monkeypatch.chdir(tmp_path)
    known = dict(COMMON_LISP_USER.internal)
    session = Session(time="virtual", turtlesim=False)
    output = streams.StringOutputStream()
    monkeypatch.setattr(streams.ERROR_OUTPUT, "value", output)

    def evaluate(text):
        values = session.evaluate_text(text, "<repl 1>")
        return values

    evaluate.said = lambda text=None: (text and evaluate(text), output.take())[1]
    evaluate.session = session
    yield evaluate
    kernel.stop()
    COMMON_LISP_USER.internal.clear()
    COMMON_LISP_USER.internal.update(known)


def printed(values):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    return [prin1_to_string(value) for value in values]


NOTICE = """(defun notices (form)
  (let ((seen nil))
    (handler-bind ((warning (lambda (c) (push (princ-to-string c) seen) (muffle-warning c))))
      (compile nil (list 'lambda nil form)))
    (sort seen #'string<)))
(defun two (x y) (list x y))
(defun maybe (a &optional b c) (list a b c))
(defun more (a &rest c) (list a c))
(defun keyed (a &key c) (list a c))
(defgeneric gf (a b))
(defclass cl () (a b))
(defstruct m15 a b)"""


def recorded():
    text = (Path(__file__).parent / "sbcl" / "warnings.txt").read_text().split("\n", 1)[1]
    return [tuple(case.rsplit("\n=> ", 1)) for case in re.split(r"\n(?=[(#])", text.strip()) if "\n=> " in case]


def test_the_compiler_notices_what_sbcl_notices(lisp):
    lisp(NOTICE)
    lisp.said()
    cases = recorded()
    assert len(cases) > 80
    for form, answer in cases:
        assert printed(lisp(f"(let ((*print-right-margin* 10000)) (prin1-to-string (notices '{form})))")) == printed([answer]), form
    assert lisp.said() == ""  # whatever is muffled is not shown


def test_a_file_is_warned_of_at_its_end_in_the_order_of_its_text(lisp, tmp_path):
    (tmp_path / "plan.lisp").write_text("""\
(defun drive (speed angle)
  (turn speed)
  (stop))

(defun stop ()
  (let ((unused 1)
        (fast (speed-of *turtle*)))
    (drive fast)
    (turn 1 2)))

(defun turn-off (x &key now)
  (declare (ignore now))
  (turn-of x :quick t))
""")
    assert (
        lisp.said('(load "plan.lisp")')
        == """\
; caught STYLE-WARNING:
;   The variable ANGLE is defined but never used.
;   at plan.lisp:1:21
;     (defun drive (speed angle)
;                         ^
; caught STYLE-WARNING:
;   undefined function: COMMON-LISP-USER::TURN
;   at plan.lisp:2:3
;       (turn speed)
;       ^
;   also at plan.lisp:9:5
;   Did you mean RETURN?
; caught STYLE-WARNING:
;   The variable UNUSED is defined but never used.
;   at plan.lisp:6:10
;       (let ((unused 1)
;              ^
; caught STYLE-WARNING:
;   undefined function: COMMON-LISP-USER::SPEED-OF
;   at plan.lisp:7:15
;             (fast (speed-of *turtle*)))
;                   ^
; caught WARNING:
;   undefined variable: COMMON-LISP-USER::*TURTLE*
;   at plan.lisp:7:25
;             (fast (speed-of *turtle*)))
;                             ^
; caught STYLE-WARNING:
;   The function DRIVE is called with one argument, but wants exactly two.
;   at plan.lisp:8:5
;         (drive fast)
;         ^
; caught STYLE-WARNING:
;   undefined function: COMMON-LISP-USER::TURN-OF
;   at plan.lisp:13:3
;       (turn-of x :quick t))
;       ^
;   Did you mean TURN-OFF?
"""
    )


def test_a_file_that_is_loaded_without_being_compiled_is_silent(lisp, tmp_path, monkeypatch):
    monkeypatch.setattr("sys.dont_write_bytecode", False)  # else nothing is kept, and each load compiles
    (tmp_path / "plan.lisp").write_text("(defun stop () (let ((unused 1)) 2))")
    assert lisp.said('(load "plan.lisp")').count("caught") == 1
    assert lisp.said('(load "plan.lisp")') == ""


def test_a_file_that_fails_shows_what_was_certain_before(lisp, tmp_path):
    (tmp_path / "plan.lisp").write_text("(defun stop () (let ((unused 1)) (later)))\n(car 5)\n(defun later ())")
    lisp('(ignore-errors (load "plan.lisp"))')
    assert re.findall("^;   (The|und.*|The .*)$", lisp.said(), re.M) == ["The variable UNUSED is defined but never used."]


def test_the_files_of_a_system_are_one_unit(lisp, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    (tmp_path / "robot.asd").write_text("""(defsystem robot :components ((:file "a") (:file "b" :depends-on ("a"))))""")
    (tmp_path / "a.lisp").write_text("(defun first-step () (second-step 1) (third-step))")
    (tmp_path / "b.lisp").write_text("(defun second-step () 2)")
    assert (
        lisp.said("(asdf:load-system :robot)")
        == """\
; caught STYLE-WARNING:
;   The function SECOND-STEP is called with one argument, but wants exactly zero.
;   at a.lisp:1:22
;     (defun first-step () (second-step 1) (third-step))
;                          ^
; caught STYLE-WARNING:
;   undefined function: COMMON-LISP-USER::THIRD-STEP
;   at a.lisp:1:38
;     (defun first-step () (second-step 1) (third-step))
;                                          ^
"""
    )


def test_at_the_prompt_warnings_come_before_the_form_runs(lisp):
    assert (
        lisp.said("(defun greet (name) (prnt nam) (greet 1 2))")
        == """\
; caught STYLE-WARNING:
;   The variable NAME is defined but never used.
;   at <repl 1>:1:15
;     (defun greet (name) (prnt nam) (greet 1 2))
;                   ^
; caught STYLE-WARNING:
;   undefined function: COMMON-LISP-USER::PRNT
;   at <repl 1>:1:21
;     (defun greet (name) (prnt nam) (greet 1 2))
;                         ^
;   Did you mean PRINT or PPRINT?
; caught WARNING:
;   undefined variable: COMMON-LISP-USER::NAM
;   at <repl 1>:1:27
;     (defun greet (name) (prnt nam) (greet 1 2))
;                               ^
;   Did you mean NAME?
; caught STYLE-WARNING:
;   The function GREET is called with two arguments, but wants exactly one.
;   at <repl 1>:1:32
;     (defun greet (name) (prnt nam) (greet 1 2))
;                                    ^
"""
    )


@pytest.mark.parametrize("form", ["(no-such-thing 1)", "(list no-such-thing)", "(car 1 2)", "no-such-thing"])
def test_what_the_form_itself_runs_into_is_told_by_the_error_alone(lisp, form):
    with pytest.raises((Condition, TypeError)):
        lisp(form)
    assert lisp.said() == ""


def test_a_variable_that_is_set_at_the_prompt_without_defvar(lisp):
    assert (
        lisp.said("(setq velocity 3)")
        == """\
; caught WARNING:
;   undefined variable: COMMON-LISP-USER::VELOCITY
;   at <repl 1>:1:7
;     (setq velocity 3)
;           ^
"""
    )
    assert printed(lisp("velocity")) == ["3"]


def test_a_symbol_is_found_where_it_stands_in_a_template(lisp):
    assert (
        lisp.said("(defmacro twice (form) `(progn ,form ,@fom))")
        == """\
; caught WARNING:
;   undefined variable: COMMON-LISP-USER::FOM
;   at <repl 1>:1:40
;     (defmacro twice (form) `(progn ,form ,@fom))
;                                            ^
;   Did you mean FORM?
"""
    )


def test_a_function_defined_twice_in_one_file(lisp, tmp_path):
    (tmp_path / "plan.lisp").write_text("(defun stop () 1)\n(defun go-on () 2)\n(defun stop () 3)")
    assert (
        lisp.said('(load "plan.lisp")')
        == """\
; caught WARNING:
;   Duplicate definition for STOP found in one file.
;   at plan.lisp:3:1
;     (defun stop () 3)
;     ^
;   also at plan.lisp:1:1
"""
    )


def test_local_functions_of_one_name_are_no_duplicates(lisp, tmp_path):
    (tmp_path / "local.lisp").write_text("""(defun one (x) (flet ((inner (y) (+ x y))) (inner 1)))
(defun two (x) (flet ((inner (y) (* x y))) (labels ((inner2 (z) (inner z))) (inner2 1))))
(defmethod three ((x integer)) 1) (defmethod three ((x symbol)) (call-next-method))""")
    lisp('(load "local.lisp")')
    assert lisp.said() == ""


def test_the_last_clause_of_case_is_no_duplicate_of_the_key_t(lisp):
    assert lisp.said("(defun which (x) (case x ((nil) 1) ((t) 2) (t 3)))") == ""
    assert lisp.said("(defun other (x) (case x ((t) 1) ((t) 2) (otherwise 3)))").startswith("; caught STYLE-WARNING:\n;   Duplicate key T")


def test_compile_returns_whether_there_were_warnings(lisp):
    def flags(form):
        return printed(lisp(f"(cdr (multiple-value-list (compile nil '{form})))"))[0]

    assert flags("(lambda (x) x)") == "(NIL NIL)"
    assert flags("(lambda (x) 1)") == "(T NIL)"
    assert flags("(lambda () (car 1 2))") == "(T T)"
    assert flags("(lambda () undefined)") == "(T T)"
    assert flags("(lambda () (undefined))") == "(NIL NIL)"  # as in SBCL: known only at the end of the unit
    assert printed(
        lisp("(handler-bind ((warning #'muffle-warning)) (cdr (multiple-value-list (compile nil '(lambda () (car 1 2))))))")
    ) == ["(NIL NIL)"]
    assert printed(lisp("(multiple-value-list (compile 'three '(lambda () 3)))")) == ["(THREE NIL NIL)"]
    assert printed(lisp("(list (three) (multiple-value-list (compile 'three)))")) == ["(3 (THREE NIL NIL))"]


def test_a_compilation_unit_waits_for_its_end(lisp):
    assert lisp.said("(with-compilation-unit () (compile nil '(lambda () (to-come))) (eval '(defun to-come ())))") == ""
    assert (
        "undefined function: COMMON-LISP-USER::NEVER-TO-COME"
        in lisp.said('(with-compilation-unit () (compile nil \'(lambda () (never-to-come))) (princ "x" *error-output*))').split("x", 1)[1]
    )
    assert lisp.said("""(with-compilation-unit ()
        (with-compilation-unit (:override t) (compile nil '(lambda () (come)))) (terpri *error-output*)
        (eval '(defun come ())))""").startswith("; caught STYLE-WARNING:\n;   undefined function: COMMON-LISP-USER::COME\n")


def test_warnings_can_be_muffled_by_declarations(lisp):
    assert lisp.said("(defun f (x) (declare (sb-ext:muffle-conditions style-warning)) 1)") == ""
    assert lisp.said("(defun f2 (x) (let ((y 1)) (declare (sb-ext:muffle-conditions style-warning)) 1) x)") == ""
    assert "undefined variable" in lisp.said("(defun f3 (x) (declare (sb-ext:muffle-conditions style-warning)) (list y))")
    lisp("(declaim (sb-ext:muffle-conditions warning))")
    assert lisp.said("(defun f4 (x) (list y))") == ""
    lisp("(declaim (sb-ext:unmuffle-conditions warning))")
    assert lisp.said("(defun f5 (x) (list y))").count("caught") == 2


def test_a_declaration_can_be_made_known(lisp):
    assert "unrecognized declaration (BEAUTIFUL X)" in lisp.said("(defun f (x) (declare (beautiful x)) x)")
    assert lisp.said("(progn (declaim (declaration beautiful)) (defun g (x) (declare (beautiful x)) x))") == ""


def test_a_handler_around_load_sees_the_warnings(lisp, tmp_path):
    (tmp_path / "plan.lisp").write_text("(defun stop (x) (nowhere))")
    assert printed(
        lisp("""(let ((seen '()))
      (handler-bind ((style-warning (lambda (c) (push (format nil "~a" c) seen) (muffle-warning c))))
        (load "plan.lisp"))
      (format nil "~{~a~^; ~}" (reverse seen)))""")
    ) == ['"The variable X is defined but never used.; undefined function: COMMON-LISP-USER::NOWHERE"']
    assert lisp.said() == ""


def test_the_answers_of_cramhy_eval_have_them_apart_from_the_output(lisp):
    assert json_lines.evaluate(lisp.session, "(defun stop (x) 1)") == {
        "output": "",
        "values": ["STOP"],
        "error": None,
        "warnings": [
            {"type": "SB-INT::SIMPLE-STYLE-WARNING", "message": "The variable X is defined but never used.", "where": "<repl 1>:1:14"}
        ],
    }


@pytest.mark.soak
def test_a_type_that_nobody_defines(lisp):
    assert re.findall(
        "caught (.*)|;   (und.*)", lisp.said("(defun f (x) (handler-case (typep x 'no-such-type) (no-such-error () 1)))")
    ) == [
        ("STYLE-WARNING:", ""),
        ("", "undefined type: COMMON-LISP-USER::NO-SUCH-ERROR"),
        ("STYLE-WARNING:", ""),
        ("", "undefined type: COMMON-LISP-USER::NO-SUCH-TYPE"),
    ]
    assert printed(lisp('(handler-case (handler-case (error "x") (no-such-error () 1)) (error () 2))')) == ["2"]  # it fits nothing


@pytest.mark.parametrize(
    ("type_", "undefined"),
    [
        ("(or simple-error type-error)", []),
        ("(and error (not type-error))", []),
        ("(or simple-error (not no-such-error))", ["NO-SUCH-ERROR"]),
    ],
)
@pytest.mark.parametrize("form", ["(handler-case x (%s () 1))", "(handler-bind ((%s (lambda (c) c))) x)"])
def test_the_types_in_a_compound_type_of_a_handler(lisp, form, type_, undefined):
    said = lisp.said(f"(defun f (x) {form % type_})")
    assert re.findall("undefined type: (.*)", said) == [f"COMMON-LISP-USER::{name}" for name in undefined]


def test_a_function_that_becomes_a_macro(lisp):
    lisp("(defun changing-kind (x) x)")
    assert printed(
        lisp("""(let ((seen nil))
      (handler-bind ((style-warning (lambda (c) (push (princ-to-string c) seen) (muffle-warning c))))
        (eval '(defmacro changing-kind (x) (list 'list x)))
        (eval '(defmacro changing-kind (x) (list 'list x x))))
      (list seen (eval '(changing-kind 1)) (handler-case (funcall 'changing-kind 1) (undefined-function () :gone))))""")
    ) == ['(("CHANGING-KIND is being redefined as a macro when it was previously defined to be a function.")\n (1 1) :GONE)']


def test_a_failure_that_its_handler_ignores_is_not_warned_of(lisp):
    assert (
        lisp.said("""(defun quiet ()
      (cpl:with-failure-handling ((error (failure) (declare (ignore failure)) (return 1))) 2))""")
        == ""
    )


def test_a_local_function_that_nobody_calls_is_looked_at_though_it_is_not_made(lisp):
    assert "undefined function: COMMON-LISP-USER::PRNT" in lisp.said("(defun unmade () (flet ((show () (prnt 1))) 2))")
    (function,) = lisp("#'unmade")
    assert function() == 2
    assert not [const for const in function.__code__.co_consts if hasattr(const, "co_code")]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("((lambda (x) x))", "function called with zero arguments, but wants exactly one"),
        ("(funcall #'(lambda (x &optional y) (list x y)) 1 2 3)", "function called with three arguments, but wants at most two"),
        ("(funcall (lambda (x y &rest r) (list x y r)) 1)", "function called with one argument, but wants at least two"),
        ("((lambda (x &key a) (list x a)) 1 :b 2)", "function called with unknown argument keyword :B"),
        ("((lambda (x &key a) (list x a)) 1 :b 2 :c 3)", "function called with unknown argument keywords :B, :C"),
        ("(funcall (lambda (x &key a) (list x a)) 1 :a)", "function called with odd number of arguments in keyword portion"),
        ("((lambda (x &key a &allow-other-keys) (list x a)) 1 :b 2)", None),
        ("((lambda (x &rest r) (list x r)) 1 2 3)", None),
    ],
)
def test_a_wrong_call_of_a_lambda_expression(lisp, call, said):
    shown = lisp.said(f"(defun f () {call})")
    assert (f";   {said}\n" in shown and "caught WARNING" in shown) if said else shown == ""


def test_declarations_of_variables_behind_aux(lisp):
    """They are bound behind the other parameters, with the declarations at the head of the body."""
    assert lisp.said("(defun f (x &aux (y x) (z 1) (w 2)) (declare (ignore y) (type fixnum z) (string w)) (list x z w))") == ""
    assert "IGNORE declaration for an unknown variable: V" in lisp.said("(defun g (x &aux (y x)) (declare (ignore v)) (list x y))")
    assert "The variable Y is defined but never used." in lisp.said("(defun h (x &aux (y 1)) x)")


def test_the_keywords_of_a_generic_function_are_those_of_its_methods(lisp):
    text = """(defgeneric convert (token tree &key))
      (defmethod convert ((token (eql :a)) tree &key (greedyp t)) (list token tree greedyp))
      (defun call-it (x) (convert :a x :greedyp nil))
      (defun call-it-later (x) (convert :b x :of-a-method-to-come nil))"""
    assert lisp.said(text) == ""
    assert "called with one argument" in lisp.said("(defun call-wrongly (x) (convert x))")
