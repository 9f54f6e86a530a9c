"""The console: prompts, values, and the debugger, as they are shown."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.session import Image

ABORT = """\
restarts (type a number to choose one, or a form to evaluate):
  0: [ABORT] Exit debugger, returning to top level.
"""


def shown(expected, transcript):
    """Addresses count on from one test to the next, so they are left out."""
    assert re.sub(r"\{[0-9A-F]{10}\}", "{address}", transcript).rstrip("\n") == expected.rstrip("\n")


def test_the_prompt_is_the_shortest_name_of_the_package(type_in):
    shown(
        """\
CPL-USER> (in-package :cl-user)
#<PACKAGE "COMMON-LISP-USER">
CL-USER> (defpackage :my-plans (:nicknames :mine) (:use :cpl))
#<PACKAGE "MY-PLANS">
CL-USER> (in-package :my-plans)
#<PACKAGE "MY-PLANS">
MINE>""",
        type_in("(in-package :cl-user)\n(defpackage :my-plans (:nicknames :mine) (:use :cpl))\n(in-package :my-plans)\n") + "MINE>",
    )


def test_values_come_one_a_line(type_in):
    shown(
        """\
CPL-USER> (values 1 "two" #\\3)
1
"two"
#\\3
CPL-USER> (values)
; No value
CPL-USER> (list cl:* 'nil)
(1 NIL)""",
        type_in('(values 1 "two" #\\3)\n(values)\n(list cl:* \'nil)\n'),
    )


@pytest.mark.parametrize(
    "form, told",
    [
        ("(lambda (x) x)", "(LAMBDA (X))"),
        ("(lambda (x &optional y) (list x y))", "(LAMBDA (X &OPTIONAL Y))"),
        ("(let ((y 3)) (lambda () y))", "(LAMBDA ())"),
        ("(lambda (x &key k) (list x k))", "(LAMBDA (X &KEY ...))"),
        ("(flet ((turn-left (x) x)) #'turn-left)", "(FLET TURN-LEFT)"),
        ("(progn (defun outer (x) (lambda (z) (list x z))) (outer 1))", "(LAMBDA (Z) :IN OUTER)"),
    ],
)
def test_a_function_without_a_name_is_shown_as_lisp_calls_it(type_in, form, told):
    assert re.search(r"^#<FUNCTION (.*) \{[0-9A-F]+\}>$", type_in(form), re.MULTILINE)[1] == told


def test_a_form_may_have_many_lines_and_comments(type_in):
    shown(
        """\
CPL-USER> (+ 1 ; one
   #| two
      (( |#
   2)
3
CPL-USER> ; nothing
CPL-USER> "a (
b"
"a (
b\"""",
        type_in('(+ 1 ; one\n   #| two\n      (( |#\n   2)\n; nothing\n"a (\nb"\n'),
    )


def test_several_forms_on_a_line_are_evaluated_in_turn(type_in):
    shown("CPL-USER> 1 (+ 1 1) :three\n1\n2\n:THREE", type_in("1 (+ 1 1) :three"))


def test_what_is_printed_and_warnings_stand_in_the_transcript(type_in):
    shown(
        """\
CPL-USER> (progn (format t "no newline") (warn "careful with ~a" 3) 5)
no newline
WARNING: careful with 3
5""",
        type_in('(progn (format t "no newline") (warn "careful with ~a" 3) 5)'),
    )


def test_an_unmatched_parenthesis_is_a_warning(type_in):
    shown(
        """\
CPL-USER> (+ 1 2))
3
STYLE-WARNING: unmatched close parenthesis at <repl 1>:1:8, ignored
  There is one ) too many here, or a ( is missing before it.
CPL-USER> 4
4""",
        type_in("(+ 1 2))\n4"),
    )


def test_an_error_opens_the_debugger_and_a_number_leaves_it(type_in):
    shown(
        f"""\
CPL-USER> (list 1 (car 2))

debugger invoked on a TYPE-ERROR:
  The value
    2
  is not of type
    LIST
  when binding LIST
  at <repl 1>:1:9
    (list 1 (car 2))
            ^

{ABORT}0] 1
There is no choice 1; they go from 0 to 0.
0] 0
CPL-USER> 5
5""",
        type_in("(list 1 (car 2))\n1\n0\n5"),
    )


def test_restarts_are_chosen_by_name_too(type_in):
    text = type_in(
        '(restart-case (error "stuck") (go-round (n) :report "Go round." :interactive (lambda () (list 9)) n))\n:go-round\n'
        '(cerror "Go on." "stopped")\n:continue\n(no-such-function)\n:return-nothing\n'
    )
    assert "  0: [GO-ROUND] Go round.\n  1: [ABORT   ] Exit debugger, returning to top level.\n0] :go-round\n9\n" in text
    assert "  0: [CONTINUE] Go on.\n" in text and "0] :continue\nNIL\n" in text
    assert text.endswith("0] :return-nothing\n; No value\n")


def test_forms_are_evaluated_in_the_debugger_and_errors_there_nest(type_in):
    text = type_in("(car 1)\n(+ 40 2)\n(car 2)\n:abort\n(list 'still 'here)\n0\n5")
    assert "0] (+ 40 2)\n42\n0] (car 2)\n" in text
    assert (
        "  0: [ABORT] Return to debugger level 0.\n  1: [ABORT] Exit debugger, returning to top level.\n1] :abort\n"
        "0] (list 'still 'here)\n(STILL HERE)\n0] 0\nCPL-USER> 5\n5\n"
    ) in text


@pytest.mark.parametrize("macro", ["(defun twice number (* 2 number))", "(let ((x 1 2)) x)", "(broken 1)"])
def test_what_is_typed_in_the_debugger_is_no_part_of_the_macro_call_that_opened_it(type_in, macro):
    text = type_in(f'(defmacro broken (x) (error "no ~a" x))\n(defun half (x) (/ x 2))\n{macro}\n(half)\n(car \'a)\nq\nq\nq\n')
    later = text[text.index("0] (half)") :]
    assert "HALF takes 1 argument." in later and "(car 'a)" in later
    assert "in the expansion of the macro call" not in later


@pytest.mark.parametrize(
    "bound, typed, shown",
    [
        ("(*read-suppress* t)", "(list 1 2)", "(1 2)"),
        ("(*read-base* 16)", "(list 10 20)", "(10 20)"),
        ("(*read-eval* nil)", "#.(+ 1 2)", "3"),
        ("(*print-readably* t)", "(find-package :keyword)", '#<PACKAGE "KEYWORD">'),
        ("(*readtable* (let ((r (copy-readtable nil))) (setf (readtable-case r) :preserve) r))", "(list 10 20)", "(10 20)"),
        ("(*readtable* (let ((r (copy-readtable nil))) (set-syntax-from-char #\\( #\\a r) r))", "(list 10 20)", "(10 20)"),
    ],
)
def test_the_debugger_can_be_used_whatever_the_program_has_bound(type_in, bound, typed, shown):
    text = type_in(f'(let ({bound}) (error "stop ~a" (find-package :cl)))\n{typed}\n0\n5')
    assert f"0] {typed}\n{shown}\n0] 0\nCPL-USER> 5\n5\n" in text


@pytest.mark.parametrize(
    "body",
    ["(case 1 (1 check-it))", "(cond (check-it 1))", "(let ((x check-it) (check-it)) (list x check-it))", "(flet ((f (check-it))) #'f)"],
)
def test_a_variable_of_a_method_may_be_called_as_a_macro_is(type_in, body):
    """Where ``(check-it)`` is no call, it is not an error that it would be none; a file with such a method could be loaded, not typed."""
    text = type_in(f"(defmacro check-it (name) name)\n(defmethod look-at ((check-it integer)) {body})\n(list 5)")
    assert "debugger invoked" not in text and text.endswith("(5)\n")


@pytest.mark.parametrize(
    "form",
    [
        "(cl:in-package :bare-of-lisp)\n(cl-utilities:split-sequence 1 '(2 1 3))\n(cl:in-package :cl-user)",
        '(let ((*read-base* 16)) (find-symbol "X" :lisp-unit))',
        '(let ((*readtable* (let ((r (copy-readtable nil))) (setf (readtable-case r) :preserve) r))) (find-symbol "X" :closer-mop))',
        '(let ((*read-suppress* t)) (find-symbol "X" :trivial-garbage))',
        '(let ((*package* (find-package :keyword))) (find-symbol "X" :trivial-gray-streams))',
    ],
)
def test_a_library_is_loaded_whatever_is_bound_where_its_package_is_named(type_in, form):
    with Image():
        text = type_in(f"(defpackage :bare-of-lisp (:use))\n{form}\n(list 5)")
    assert "debugger invoked" not in text and text.endswith("(5)\n")


def test_what_is_set_in_the_debugger_stays(type_in):
    assert type_in('(defvar *set-there* 1)\n(error "x")\n(setf *set-there* 3)\n0\n(list *set-there* :a)').endswith("(3 :A)\n")


def test_the_outermost_restart_leaves_all_levels(type_in):
    assert type_in("(car 1)\n(car 2)\n(car 3)\n2\n5").endswith("2] 2\nCPL-USER> 5\n5\n")


def test_the_debugger_runs_before_anything_unwinds(type_in):
    text = type_in('(defvar *n* 1)\n(unwind-protect (let ((*n* 2)) (error "stop")) (print :unwound))\n*n*\n0\n*n*')
    assert "0] *n*\n2\n0] 0\n\n:UNWOUND \nCPL-USER> *n*\n1\n" in text


def test_the_end_of_input_leaves_the_debugger_and_the_console(type_in):
    assert type_in("(car 1)\n(car 2)").endswith("  1: [ABORT] Exit debugger, returning to top level.\n")
    assert type_in.status == 0


def test_the_end_of_input_inside_a_form_is_an_error_with_its_place(type_in):
    shown(
        f"""\
CPL-USER> (list 1
  (list 2)

debugger invoked on a END-OF-FILE:
  end of file on #<SB-SYS:FD-STREAM {{address}}>
  at <repl 1>:1:1
  (list 1
  ^
  The ( at line 1, column 1 is never closed.

{ABORT}""",
        type_in("(list 1\n  (list 2)"),
    )


def test_a_failure_of_a_branch_is_shown_with_its_own_place(type_in, backend):
    shown(
        f"""\
CPL-USER> (top-level
  (par (sleep 1)
       (fail "No ~a." 'cup)))

debugger invoked on a CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE:
  No CUP.
  at <repl 1>:3:8
           (fail "No ~a." 'cup)))
           ^

{ABORT}0] 0""",
        type_in('(top-level\n  (par (sleep 1)\n       (fail "No ~a." \'cup)))\n0', backend=backend),
    )


@pytest.mark.parametrize(
    "defined, call",
    [
        ("(def-cram-function drive (x) x)", "(drive 1)"),
        ("(progn (declare-goal drive (x)) (def-goal (drive ?x) ?x))", "(drive 1)"),
        ("(def-cram-function drive (x) (par x x))", "(list (drive 1))"),
    ],
)
def test_a_plan_function_outside_of_a_plan_is_an_error_at_its_call(type_in, defined, call):
    column = 1 + call.index("(drive")
    text = type_in(f"{defined}\n{call}\n0")
    assert f"  at <repl 2>:1:{column}\n    {call}\n" in text


def test_a_plan_form_outside_of_a_plan_says_what_to_write(type_in):
    shown(
        f"""\
CPL-USER> (par 1)

debugger invoked on a SIMPLE-ERROR:
  'PAR' form not inside a plan.
  at <repl 1>:1:1
    (par 1)
    ^
  Plan forms run inside of a plan: write (top-level (par ...)).

{ABORT}0] 0""",
        type_in("(par 1)\n0"),
    )


def test_a_plan_that_waits_for_ever_says_what_it_waits_for(type_in, backend):
    text = type_in("(defvar *door* (make-fluent :name :door))\n(top-level (wait-for *door*))\n0\n5", backend=backend)
    assert "debugger invoked on a CRAMHY::DEADLOCK:" in text
    assert "waits for the fluent #<FLUENT DOOR [NIL]>\n        at <repl 2>:1:12\n" in text
    assert text.endswith("CPL-USER> 5\n5\n")


def test_quit_leaves_with_a_status(type_in):
    assert type_in("(cl-user::exit :code 3)\n5") == "CPL-USER> (cl-user::exit :code 3)\n"
    assert type_in.status == 3
    type_in("(in-package :cl-user)\n(quit)")
    assert type_in.status == 0


def test_the_same_seed_gives_the_same_random_numbers(type_in):
    first = type_in("(list (random 1000000) (random 1000000))", seed=5)
    assert type_in("(list (random 1000000) (random 1000000))", seed=5) == first
    assert type_in("(list (random 1000000) (random 1000000))", seed=6) != first


def test_a_condition_is_shown_by_its_method_of_print_object(type_in):
    shown = type_in(
        "(define-condition lost (error) ((at :initarg :at)))\n"
        "(defmethod print-object ((lost lost) stream)\n"
        '  (if *print-escape* (call-next-method) (format stream "Lost at ~A." (slot-value lost \'at))))\n'
        "(error 'lost :at 3)"
    )
    assert "Lost at 3." in shown and "was signalled" not in shown


def test_a_ros_command_that_would_go_on_for_ever_ends_after_some_virtual_time(type_in):
    answer = type_in('(roslisp:start-ros-node "a")\nrostopic hz /turtle1/pose\n(+ 1 2)\n', turtlesim=True)
    assert answer.count("average rate: ") == 4 and "OutOfTime" not in answer
    assert answer.endswith("window: 250\nCPL-USER> (+ 1 2)\n3\n")
