"""``cramhy learn`` in a real terminal: the first lesson in both languages, Ctrl-C in a check, the end, and wrong options."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from systems import needs_terminals  # noqa: E402

pytestmark = needs_terminals
sys.path.insert(0, str(Path(__file__).parents[2]))

from cramhy_runtime.course import reading  # noqa: E402
from cramhy_runtime.course.steps import steps  # noqa: E402
from cramhy_runtime.course.parts import Code, Task  # noqa: E402

from .walking import solution  # noqa: E402


WIDE = (24, 200)
"""Rows and columns: a terminal that cannot move its cursor shows a longer line in pieces while it is typed."""


@pytest.fixture
def terminal(tmp_path, monkeypatch):
    from tests.repl.terminal import Terminal

    monkeypatch.chdir(tmp_path)

    def start(*words, editor=False, draws=False):
        variables = {"CRAMHY_HISTORY": str(tmp_path / "state"), "CRAMHY_VIEW": "no", **({"TERM": "xterm"} if draws else {})}
        return Terminal("learn", *words, editor=editor, size=WIDE, variables=variables)

    return start


READY = {"lisp": r"(?:[A-Z-]+> |\d\] )$", "hy": r"=> $"}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_the_first_lesson_is_typed_and_its_tasks_are_solved(terminal, language):
    with terminal("--language", language) as there:
        there.expect("Page 1, step 1 of ")
        there.expect(READY[language])

        def enter(text):
            """Type ``text``, form by form; what the last one shows."""
            lines = []
            for line in text.split("\n"):
                lines.append(line)
                there.type(line)
                if "\n".join(lines).count("(") <= "\n".join(lines).count(")"):
                    shown = there.expect(rf"{re.escape(line)}\n(?s:.*?){READY[language]}")
                    lines = []
            return shown

        for step in steps(reading.page("first-forms"), language):
            if isinstance(step.part, Code):
                for typed in getattr(step.part, language):
                    shown = enter(typed.form)
                    if "INFO" not in typed.answer and "debugger" not in typed.answer:
                        assert typed.answer in shown
            elif isinstance(step.part, Task):
                assert "Not yet." in enter(":check")
                assert "Hint 1" in enter(":hint")
                enter(solution(step.part.name, language).rstrip())
                assert "Well done" in enter(":check")
            there.type(":next")
            there.expect("--- Page ")
            there.expect(READY[language])
        assert "Page 2, step 1 of " in there.text
        assert "3 of 3 tasks solved" in enter(":pages")
        assert there.end() == 0


@pytest.mark.soak
def test_ctrl_c_ends_a_check_that_does_not_end_and_the_prompt_goes_on(terminal):
    with terminal("names-and-functions") as there:
        there.expect("CL-USER> $")
        there.type(":page 2 4")
        there.expect("Task: A rectangle")
        there.expect("CL-USER> $")
        there.type("(defun rectangle-around (width height) (print (list :drives width height)) (loop))")
        there.expect("RECTANGLE-AROUND\nCL-USER> ")
        there.type(":check")
        there.expect(r"\(:DRIVES \d")  # before that, the terminal throws away with Ctrl-C what was not read yet
        there.control_c()
        there.expect(r"; Interrupted.\n; The check has not come to its end.[^>]* lets it pass.\nCL-USER> ")
        there.type("(+ 40 2)")
        there.expect("\n42\nCL-USER> ")
        there.type("exit")
        assert there.status() == 0


@pytest.mark.soak
@pytest.mark.parametrize("language", ["lisp", "hy"])
def test_ctrl_c_ends_a_form_that_is_open_and_the_next_line_is_answered(terminal, language):
    prompt = {"lisp": "CL-USER> ", "hy": "=> "}[language]
    with terminal("--language", language, draws=True) as there:
        there.expect(f"{prompt}$")
        for line, begun in (("(max 1 2", "max 1> $"), ("(max 3\n  (min 4", "min 2> $")):
            there.type(line)
            there.expect(begun)
            there.control_c()
            there.expect(rf"\n{prompt}$")
            there.type("(+ 40 2)")
            there.expect(rf"\n42\n{prompt}$")


@pytest.mark.soak
def test_the_editor_of_the_prompt_is_there_and_recalls_commands(terminal):
    pytest.importorskip("prompt_toolkit")
    with terminal(editor=True) as there:
        there.expect("Page 1, step 1 of ")
        there.expect("CL-USER> ")
        there.press(":hint\r")
        there.expect("Only tasks have hints")
        there.expect("CL-USER> ")
        there.press("\x1b[A\r")
        there.expect("Only tasks have hints")


@pytest.mark.soak
@pytest.mark.parametrize(
    ("words", "told"),
    [(["nowhere"], "There is no page nowhere. There are first-forms, "), (["0"], "There is no page 0"), (["14"], "There is no page 14")],
)
def test_a_page_that_is_not_there_is_told(terminal, words, told):
    with terminal(*words) as there:
        there.expect(told)
        assert there.status() == 2
