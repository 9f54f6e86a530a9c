"""The prompt of a tab, with what JavaScript would do for it: both languages, the debugger's choices, and programs that read lines."""

from __future__ import annotations

import json
import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.browser import tab
from cramhy_runtime.browser.desk import Desk
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.session.session import Session


class Host:
    """Types lines, and notes what the page is told: ``prompts`` and ``errors``. A line may be a pair of a text and its place, as JSON."""

    def __init__(self, lines):
        self.lines, self.prompts, self.errors = list(lines), [], []
        self.prompt, self.place = "", "null"

    @property
    def line(self):
        self.prompts.append(json.loads(self.prompt))
        self.place = "null"
        if self.lines and isinstance(self.lines[0], tuple):
            line, self.place = self.lines.pop(0)
            return line
        return (
            self.lines.pop(0)
            if self.lines
            else "(hy.I.sys.exit 3)"
            if self.prompts[-1].get("language") == "hy"
            else "(sb-ext:exit :code 3)"
        )

    def debug(self, text):
        self.errors.append(json.loads(text))

    def wake(self):
        pass


@pytest.fixture
def type_in(monkeypatch, capsys):
    """``type_in(lines)``: the `Host` after these lines. ``type_in.shown``: what was printed."""
    saved = streams.ERROR_OUTPUT.value, sys.stdin

    def type_in(*lines):
        host = Host(lines)
        monkeypatch.setattr(tab, "host", host)
        monkeypatch.setattr(tab, "wait_for", lambda line: line)
        sys.stdin = tab.PageInput()
        page_lines = tab.PageLines()

        def make():
            session = Session(time="virtual", turtlesim=False)
            page_lines.desk = Desk(session, lambda text: None)
            return session

        type_in.desk = lambda: page_lines.desk
        assert tab.TabConsole(make, page_lines).run() == 3
        type_in.shown = capsys.readouterr().out
        return host

    yield type_in
    streams.ERROR_OUTPUT.value, sys.stdin = saved
    conditions.install_debugger(None)
    kernel.stop()


def test_the_page_is_told_the_language_and_the_package_of_each_prompt(type_in):
    host = type_in("(defpackage :walks (:use :cl) (:nicknames :w))", "(in-package :walks)", "(in-hy)", "(in-package :cl-user)", "1")
    assert [(each["text"], each["language"], each["package"], each["virtual"]) for each in host.prompts] == [
        ("CL-USER> ", "lisp", ["COMMON-LISP-USER", "CL-USER"], True),
        ("CL-USER> ", "lisp", ["COMMON-LISP-USER", "CL-USER"], True),
        ("W> ", "lisp", ["WALKS", "W"], True),
        ("=> ", "hy", ["WALKS", "W"], True),
        ("CL-USER> ", "lisp", ["COMMON-LISP-USER", "CL-USER"], True),
        ("CL-USER> ", "lisp", ["COMMON-LISP-USER", "CL-USER"], True),
    ]


def test_hy_is_answered_and_lisp_comes_back_with_its_definitions(type_in):
    type_in("(defun legs () 4)", "(in-hy) (setv arms 2)", "(+ arms 1)", "(in-package :cl-user)", "(* 2 (legs))", "(in-hy)", "arms")
    assert type_in.shown.splitlines() == [
        "CL-USER> (defun legs () 4)",
        "LEGS",
        "CL-USER> (in-hy) (setv arms 2)",
        "=> (+ arms 1)",
        "3",
        "=> (in-package :cl-user)",
        '#<PACKAGE "COMMON-LISP-USER">',
        "CL-USER> (* 2 (legs))",
        "8",
        "CL-USER> (in-hy)",
        "=> arms",
        "2",
        "=> (hy.I.sys.exit 3)",
    ]


def test_a_text_of_many_lines_is_one_text(type_in):
    type_in("(defun many-legs ()\n  4)\n(many-legs)")
    assert type_in.shown.splitlines()[:5] == ["CL-USER> (defun many-legs ()", "  4)", "(many-legs)", "MANY-LEGS", "4"]


def test_the_debugger_offers_its_restarts_and_calls_and_takes_them_back(type_in):
    host = type_in("(defun walk (steps) (+ steps (car steps)))", "(walk 5)", "(walk 6)", "0", "0", "(walk 7)")
    first, second, back, none, third, left = host.errors
    assert (first["level"], first["type"]) == (0, "TYPE-ERROR")
    assert first["restarts"] == [{"name": "ABORT", "report": "Exit debugger, returning to top level."}]
    assert first["frames"][0]["call"] == "(WALK 5)" and first["frames"][0]["variables"] == [["STEPS", "5"]]
    assert second["level"] == 1 and [each["report"] for each in second["restarts"]] == [
        "Return to debugger level 0.",
        "Exit debugger, returning to top level.",
    ]
    assert (back, none, left) == (first, None, None) and third["frames"][0]["call"] == "(WALK 7)"


def test_an_error_of_lisp_opens_the_debugger_after_hy_too(type_in):
    host = type_in("(in-hy)", "(in-package :cl-user)", "(car 5)", "0")
    assert [each and each["type"] for each in host.errors] == ["TYPE-ERROR", None]


def test_a_program_reads_the_line_that_is_typed_next(type_in):
    host = type_in("(list (read-line) 2)", "a line", "(+ unbound 1)", "1", "41")
    assert '("a line" 2)' in type_in.shown.splitlines() and "42" in type_in.shown.splitlines()
    assert [bool(each.get("reads")) for each in host.prompts] == [False, True, False, False, True, False]


def test_values_that_cannot_be_printed_do_not_hide_the_error(type_in):
    host = type_in(
        "(defclass odd () ())",
        '(defmethod print-object ((it odd) stream) (error "no"))',
        "(defun walk (it) (list it (car 5)))",
        "(walk (make-instance 'odd))",
    )
    (error,) = [each for each in host.errors if each]
    assert error["type"] == "TYPE-ERROR" and error["frames"][0]["variables"][0][0] == "IT"


def test_an_error_in_a_form_of_the_editor_names_the_file_its_line_and_its_column(type_in, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plans.lisp").write_text("\n\n  (defun walk (steps)\n    (car steps))\n(list 1\n  (walk 5))\n")

    def sent(text, line, column):
        return text, json.dumps({"path": "plans.lisp", "line": line, "column": column})

    host = type_in(
        sent("(defun walk (steps)\n    (car steps))", 3, 3),
        sent("(list 1\n  (walk 5))", 5, 1),
        sent("(car 1)", 6, 20),  # in the debugger
        "1",
        "0",
        "(car 2)",  # by hand
        "0",
        "(in-hy)",
        "(in-package :cl-user)",
        sent("(car 3)", 8, 1),  # Lisp within Hy
        "0",
    )
    places = [[frame["place"] for frame in error["frames"]] for error in host.errors if error]
    assert places[0] == ["plans.lisp:4:5"] and type_in.shown.count("  at plans.lisp:4:5\n        (car steps))\n") == 1
    shown = [line.strip() for line in type_in.shown.splitlines() if line.startswith("  at ")]
    assert shown == ["at plans.lisp:4:5", "at plans.lisp:6:20", "at <repl 2>:1:1", "at plans.lisp:8:1"]


def test_what_is_typed_into_a_form_that_is_open_has_no_place_in_a_file(type_in, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    type_in("(list", ("(car 1))", json.dumps({"path": "plans.lisp", "line": 9, "column": 1})), "0")
    assert "at <repl 1>:2:1" in type_in.shown


def test_a_check_knows_what_was_typed_in_both_languages(type_in):
    host = type_in(
        "(defvar *side* 4) (defvar *around* 16)",
        '(course:check "around-a-square")',
        "(setf *around* (* 4 *side*))",
        '(course:check "around-a-square")',
        "(in-hy)",
        "(import cramhy-runtime.course.package [check])",
        "(setv side 4 around 16)",
        '(check "around-a-square" "hy")',
        "(setv around (* 4 side))",
        '(check "around-a-square" "hy")',
    )
    assert host.errors == []
    told = [line for line in type_in.shown.splitlines() if "Well done" in line or "would be wrong" in line]
    assert ["Well done" in line for line in told] == [False, True, False, True]
