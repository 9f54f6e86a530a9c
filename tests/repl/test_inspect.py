"""``inspect``, ``break`` and the variables of the debugger, at the prompt."""

from __future__ import annotations

import io
import sys


def inspected(type_in, monkeypatch, form, commands):
    """What is shown after ``form`` was typed and ``commands`` given to the inspector."""
    monkeypatch.setattr(sys, "stdin", io.StringIO(commands))
    return type_in(form).partition(form + "\n")[2].partition("; No value")[0]


def test_going_into_parts_and_back(type_in, monkeypatch):
    shown = inspected(type_in, monkeypatch, "(inspect (list 1 '(a . b) #(7 8)))", "1\nu\n2\n0\nu\nu\nu\n9\nr\nq\n")
    top = "\nThe object is a proper list of length 3.\n0. 0: 1\n1. 1: (A . B)\n2. 2: #(7 8)\n> "
    assert shown == (
        top
        + "\nThe object is a CONS.\n0. CAR: A\n1. CDR: B\n> "
        + top
        + "\nThe object is a VECTOR of length 2.\n0. 7\n1. 8\n> "
        + "\nThe object is an ATOM:\n  7\n> "
        + "\nThe object is a VECTOR of length 2.\n0. 7\n1. 8\n> "
        + top
        + "\nThe object is the top one.\n> "
        + "\nEnter a valid index (:0-2).\n> "
        + top
        + "\n"
    )


def test_instances_symbols_and_help(type_in, monkeypatch):
    text = '(defclass robot () ((name :initform "R2") (speed)))\n(inspect (make-instance \'robot))'
    monkeypatch.setattr(sys, "stdin", io.StringIO("1\n?\nq\n"))
    shown = type_in(text)
    assert 'The object is a STANDARD-OBJECT of type ROBOT.\n0. NAME: "R2"\n1. SPEED: "unbound"\n> \nThat slot is unbound.\n> ' in shown
    assert "  U           -  Move upward/backward to previous inspected object.\n" in shown
    shown = inspected(type_in, monkeypatch, "(inspect 'car)", "q\n")
    assert 'The object is a SYMBOL.\n0. Name: "CAR"\n1. Package: #<PACKAGE "COMMON-LISP">\n2. Value: "unbound"\n' in shown


def test_forms_are_evaluated_and_their_errors_do_not_end_it(type_in, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO("(length\n  sb-ext:*inspected*)\n(car 5)\n(+ 1 1)\nq\n"))
    shown = type_in("(inspect (list 1 2))\n0\n(+ 2 3)")
    assert "> \n2\n> " in shown
    assert "0: [ABORT] Return to the inspector." in shown
    assert shown.endswith("> \n2\n> \n; No value\nCPL-USER> (+ 2 3)\n5\n")


def test_the_end_of_the_input_leaves_it(type_in, monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.StringIO(""))
    assert type_in("(inspect 1)\n(+ 2 3)").endswith("; No value\nCPL-USER> (+ 2 3)\n5\n")


def test_break_and_its_variables(type_in):
    shown = type_in('(let ((*break-on-signals* \'error)) (ignore-errors (error "boo")))\n0\n(break "stop ~a" 3)\n0\n(list 1)')
    assert (
        """\
debugger invoked on a SIMPLE-CONDITION:
  boo
  BREAK was entered because of *BREAK-ON-SIGNALS* (now rebound to NIL).
"""
        in shown
    )
    assert (
        """\
  0: [CONTINUE] Return from BREAK.
  1: [RESET   ] Set *BREAK-ON-SIGNALS* to NIL and continue.
  2: [REASSIGN] Return from BREAK and assign a new value to *BREAK-ON-SIGNALS*.
"""
        in shown
    )
    assert "debugger invoked on a SIMPLE-CONDITION:\n  stop 3\n" in shown
    assert shown.endswith("(list 1)\n(1)\n")


def test_a_type_that_is_none_in_break_on_signals_opens_no_debugger(type_in):
    shown = type_in('(setf *break-on-signals* \'no-such-type)\n(nth-value 1 (ignore-errors (error "x")))\n(setf *break-on-signals* nil)')
    assert "#<SIMPLE-ERROR " in shown and "debugger" not in shown


def test_the_debugger_hook(type_in):
    shown = type_in("""(let ((*debugger-hook* (lambda (c hook) (format t "hooked ~a ~a~%" c (functionp hook)) (invoke-restart 'abort))))
  (error "boo"))
(restart-case (invoke-debugger (make-condition 'simple-error :format-control "xx")) (foo () :report "Foo it" 5))
0""")
    assert "hooked boo T\n" in shown
    assert "  0: [FOO  ] Foo it\n" in shown
    assert shown.rstrip().endswith("5")


def test_room(type_in):
    assert "bytes at most so far.\nGarbage collection is currently enabled.\n; No value\n" in type_in("(room)")


def test_dribble_records_what_is_typed_and_shown(cramhy, tmp_path):
    path = tmp_path / "dribble.txt"
    cramhy("repl", "--time", "virtual", input=f'(dribble "{path}")\n(+ 1\n 2)\n(format t "hello~%")\n(dribble)\n(+ 3 4)\n')
    assert (
        path.read_text()
        == """\
NIL
CL-USER> (+ 1
 2)
3
CL-USER> (format t "hello~%")
hello
NIL
CL-USER> (dribble)
"""
    )
