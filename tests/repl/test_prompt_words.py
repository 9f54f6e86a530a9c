"""``help``, ``exit``, ``backtrace``: what people type at a prompt, in Lisp or not, at the top level and in the debugger."""

from __future__ import annotations

import re

import pytest

from cramhy_runtime.languages.commonlisp.tools import backtrace


def answers(transcript):
    """What came after each prompt and the line typed there."""
    return re.split(r"^(?:[A-Z-]+> |\d+\] ).*\n", transcript, flags=re.M)[1:]


class TestLeaving:
    @pytest.mark.parametrize(
        "text", ["exit", "quit", "bye", "EXIT", ":exit", ":quit", "(exit)", "(quit)", "(bye)", " ( exit ) ", "1 (quit)"]
    )
    def test_it_ends_the_session_in_every_package(self, type_in, text):
        for package in ":cpl-user", ":cl-user":
            shown = type_in(f"(in-package {package})\n{text}\n(print :never)")
            assert type_in.status == 0 and "NEVER" not in shown and "debugger" not in shown

    def test_it_takes_the_status(self, type_in):
        type_in("(exit :code 3)\n5")
        assert type_in.status == 3

    @pytest.mark.parametrize(
        ("before", "text", "value"),
        [
            ("(defun exit (&optional (way 0)) (list :door way))", "(exit 2)", "(:DOOR 2)"),
            ("(defun quit () :stays)", "(quit)", ":STAYS"),
            ("(defparameter exit :west)", "exit", ":WEST"),
            ("(defmacro help () :aid)", "(help)", ":AID"),
            ("(define-symbol-macro quit (list 5))", "quit", "(5)"),
        ],
    )
    def test_what_the_user_has_defined_is_lisp(self, type_in, before, text, value):
        package = re.sub(r"[\W\d]", "", before)
        shown = type_in(f"(defpackage :{package} (:use :cpl))\n(in-package :{package})\n{before}\n{text}\n:still-here")
        assert answers(shown)[3] == f"{value}\n" and shown.endswith(":STILL-HERE\n")

    def test_other_words_are_lisp(self, type_in):
        assert "The variable EXITS is unbound." in type_in("exits")
        assert "The variable EXIT is unbound." in type_in("(list exit)")
        assert type_in.status == 0

    def test_in_the_debugger_the_word_leads_to_the_prompt_and_the_call_out(self, type_in):
        for out in "exit", "quit", ":quit", "q", ":q":
            shown = type_in(f"(car 1)\n(car 2)\n(car 3)\n{out}\n:here")
            assert shown.endswith(f"2] {out}\nCPL-USER> :here\n:HERE\n")
        for one in "a", ":a", "abort", ":abort":
            assert type_in(f"(car 1)\n(car 2)\n{one}\n:here").endswith(f"1] {one}\n0] :here\n:HERE\n")
        shown = type_in("(car 1)\n(exit :code 5)\n:here")
        assert type_in.status == 5 and ":HERE" not in shown

    def test_a_key_of_the_debugger_typed_at_the_prompt_is_no_error(self, type_in):
        shown = type_in("(car 1)\nq\nq\n:here")
        assert "; This is the prompt: no debugger is open." in shown and shown.count("debugger invoked") == 1 and shown.endswith(":HERE\n")
        assert answers(type_in("(defvar q 42)\nq"))[-1] == "42\n"

    def test_in_the_debugger_of_a_task_it_ends_the_plan_through_its_cleanup(self, type_in, backend):
        plan = "(top-level (par (unwind-protect (progn (break) 1) (print :cleaned)) (sleep 5)))"
        shown = type_in(f"{plan}\n(exit :code 7)\n:here", backend=backend)
        assert type_in.status == 7 and shown.endswith("\n:CLEANED ")


class TestHelp:
    def test_it_tells_what_can_be_typed(self, type_in):
        for text in "help", "?", ":help", "(help)", "HELP":
            shown = type_in(f"{text}\n(list 'still 'here)")
            assert '(load "plan.lisp")' in shown and "(exit), or Ctrl-D" in shown and shown.endswith("(STILL HERE)\n")
            assert all(len(line) <= 100 for line in shown.splitlines())

    def test_what_it_tells_to_type_can_be_typed(self, type_in):
        from cramhy_runtime.repl.prompt_words import help_text

        forms = [form for form in re.findall(r"^  (\(.*?\))  ", help_text(True, 0), re.M) if "plan.lisp" not in form and ":tut" not in form]
        assert len(forms) >= 2
        for form in forms:
            assert "debugger" not in type_in(form), form

    @pytest.mark.soak(all_but=4)
    @pytest.mark.parametrize("form", ["(help par)", "(help 'par)", "(help #'par)", "(help cpl:par)"])
    @pytest.mark.parametrize("package", [":cpl-user", ":cl-user"])
    def test_with_a_name_it_tells_what_that_means(self, type_in, form, package):
        assert "PAR names a macro:\n  Written: (par form...)\n" in type_in(f"(in-package {package})\n{form}")

    def test_in_the_debugger_it_tells_what_can_be_typed_there(self, type_in):
        shown = type_in("(car 1)\n?\nq\n:here")
        assert "0] ?\nThe debugger waits where the error arose." in shown and shown.endswith(":HERE\n")


CALLS = """\
(defun wheel-speed (x) (car x))
(defun drive (x)
  (list (funcall (lambda (y)
                   (wheel-speed y)) x)))
(drive 5)"""


class TestBacktrace:
    @pytest.mark.parametrize("word", ["backtrace", ":backtrace", "bt", ":bt", "BT"])
    def test_it_shows_the_calls_of_the_user_with_their_places(self, type_in, word):
        shown = answers(type_in(f"{CALLS}\n{word}"))
        assert shown[-1] == (
            "calls, the innermost last:\n"
            "  the form at <repl 3>:1:1  (drive 5)\n"
            "  DRIVE at <repl 2>:2:9  (funcall (lambda (y)\n"
            "  (LAMBDA ...) at <repl 2>:3:20  (wheel-speed y)\n"
            "  WHEEL-SPEED at <repl 1>:1:24  (car x)\n"
        )

    def test_the_calls_of_a_level_are_those_of_its_form(self, type_in):
        shown = answers(type_in(f"{CALLS}\n(wheel-speed 7)\nbt\na\nbt"))
        assert shown[-3] == (
            "calls, the innermost last:\n  the form at <repl 4>:1:1  (wheel-speed 7)\n  WHEEL-SPEED at <repl 1>:1:24  (car x)\n"
        )
        assert shown[-1].count("\n") == 5 and "(wheel-speed 7)" not in shown[-1]

    def test_of_an_error_in_a_branch_it_shows_those_of_the_branch(self, type_in, backend):
        shown = answers(type_in(f"{CALLS.rpartition('(')[0]}(top-level (par (sleep 1) (drive 5)))\nbt", backend=backend))[-1]
        assert "  DRIVE at <repl 2>:2:9" in shown and shown.endswith("  WHEEL-SPEED at <repl 1>:1:24  (car x)\n")

    def test_of_an_exception_of_python_too(self, type_in):
        shown = answers(type_in("(py:import math)\n(defun root (x) (math:sqrt x))\n(root -1)\nbt"))[-1]
        assert shown.endswith("  ROOT at <repl 2>:1:17  (math:sqrt x)\n")

    def test_many_are_cut(self, type_in):
        shown = answers(type_in("(defun deep (n) (if (= n 0) (car 1) (1+ (deep (1- n)))))\n(deep 200)\nbt"))[-1].splitlines()
        assert shown[1] == f"  ({202 - backtrace._MOST} more)" and len(shown) == backtrace._MOST + 2

    def test_without_an_error_there_are_none(self, type_in):
        assert answers(type_in("bt"))[-1] == "There is no error here. In the debugger, backtrace shows the calls that led to it.\n"

    def test_a_variable_of_that_name_is_lisp(self, type_in):
        assert type_in("(defvar bt 6)\n(car bt)\nbt").endswith("0] bt\n6\n")
