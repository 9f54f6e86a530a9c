"""The line that tells how far a plan has come: when it comes, what it says, and that nothing is ever mixed with it."""

from __future__ import annotations

import io
import re
import sys
from itertools import count

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.repl import progress
from cramhy_runtime.repl.progress import Progress, fitting
from cramhy_runtime.repl.session import Session

DRAWN = re.compile(r"\x1bD\x1bM\x1b7\x1b\[1B\r(.*?)\x1b\[K\x1b8(\x1b\[J)?")


class Paper(io.StringIO):
    """A terminal that keeps what is written to it."""

    def isatty(self):
        return True


@pytest.fixture
def run(monkeypatch):
    """``run(form)``: (what a terminal shows of it without the line, the lines that were drawn). Each look at the wall's clock takes time."""

    def run(form, clock="virtual", seconds=0.3, terminal=Paper, before=0.0):
        session = Session(time=clock, turtlesim=False)
        session.package = "CRAM-USER"
        paper = run.paper = terminal()
        ticks = count(1)
        with monkeypatch.context() as patch:
            patch.setenv("TERM", "xterm")
            patch.setenv("COLUMNS", "60")
            patch.setenv("LINES", "24")
            patch.setattr(sys, "stdout", paper)
            shown = Progress(lambda: next(ticks) * seconds)
            try:
                with shown.during():
                    session.evaluate_text(form)
            finally:
                assert "write" not in vars(paper)
                kernel.stop()
                streams.CONSOLE_OUTPUT.column = 0  # for what is written to another terminal
        return DRAWN.sub("", paper.getvalue()), DRAWN.findall(paper.getvalue())

    return run


def test_it_tells_the_time_reached_and_what_is_waited_for(run):
    text, drawn = run("(dotimes (i 10) (sleep 2))")
    assert text == ""
    assert drawn[0][0] == "; 6.0 s, waits for the time 8 s (sleep 2)"
    assert drawn[-1][0] == "; 18.0 s, waits for the time 20 s (sleep 2)"


def test_of_a_plan_it_names_what_its_innermost_tasks_wait_for(run):
    _, drawn = run(
        "(top-level (let ((x (make-fluent :name :speed :value 0))) (pursue (par (wait-for (> x 3)) (sleep 90)) (dotimes (i 10) (sleep 1)))))"
    )
    assert "the branches" not in drawn[-1][0]
    assert drawn[-1][0].startswith("; 9.0 s, waits for the time 10 s (sleep 1), the fluent #<F")
    assert len(drawn[-1][0]) == 59


def test_a_plan_that_is_done_within_a_second_is_left_alone(run):
    assert run("(progn (sleep 1) (princ 1))", seconds=0.1) == ("1", [])


def test_in_the_walls_time_there_is_no_line(run):
    assert run("(progn (sleep 0.01) (sleep 0.01) (sleep 0.01) (princ 1))", clock="wall", seconds=10) == ("1", [])


def test_on_what_is_no_terminal_there_is_no_line(run):
    assert run("(dotimes (i 10) (sleep 2) (princ i))", terminal=Pipe) == ("0123456789", [])


class Pipe(Paper):
    def isatty(self):
        return False


def test_whatever_is_printed_is_printed_as_if_there_were_no_line(run):
    form = """(dotimes (i 12) (sleep 1) (format t "~a" i) (py:exec "import sys; print('p', end=''); print('e', file=sys.stdout)"))"""
    text, drawn = run(form)
    plain, none = run(form, seconds=0)
    assert text == plain and none == []
    assert len(drawn) > 3


def test_the_line_is_gone_before_anything_else_is_written(run):
    """Each drawing is followed by an erasing, and by nothing else."""
    for form in ("(dotimes (i 12) (sleep 1) (princ i))", "(dotimes (i 12) (sleep 1))"):
        assert {erased for _, erased in run(form)[1]} == {"\x1b[J"}


def test_it_is_gone_when_the_plan_fails(run):
    with pytest.raises(Condition):
        run('(progn (dotimes (i 12) (sleep 1)) (error "over"))')
    shown = run.paper.getvalue()
    assert DRAWN.findall(shown)
    assert DRAWN.sub("", shown) == ""


def test_an_object_that_cannot_be_shown_costs_the_line_and_not_the_plan(run, monkeypatch):
    def broken(active):
        raise ValueError

    monkeypatch.setattr(progress, "line", broken)
    assert run("(progn (dotimes (i 12) (sleep 1)) (princ 1))") == ("1", [])


def test_what_is_watched_changes_nothing_of_the_plan(run):
    """The same order, with the line and without it."""
    form = '(top-level (par (dotimes (i 9) (sleep 1) (princ "a")) (dotimes (i 5) (sleep 2) (princ "b")) (dotimes (i 4) (sleep 2) (princ "c"))))'
    assert run(form)[0] == run(form, seconds=0)[0]


@pytest.mark.parametrize(
    "text, columns, shown",
    [
        ("abcdef", 4, "abcd"),
        ("a\n b\t c", 9, "a b c"),
        ("\x1b[2Jx", 9, "?[2Jx"),
        ("日本語", 5, "日本"),
        ("e\u0301e", 2, "e\u0301e"),
        ("x", 0, ""),
    ],
)
def test_it_fits_into_a_line_of_the_terminal(text, columns, shown):
    assert fitting(text, columns) == shown


@pytest.mark.soak
@pytest.mark.parametrize("arguments", [["repl"], ["repl", "--hy"]], ids=["lisp", "hy"])
def test_at_a_terminal_it_comes_and_ctrl_c_leaves_nothing_of_it(arguments):
    pytest.importorskip("termios", reason="a pseudo-terminal needs termios, which this system lacks")
    pytest.importorskip("readline")
    from .terminal import Terminal

    with Terminal(*arguments, "--time", "virtual", variables={"TERM": "xterm"}) as terminal:
        terminal.expect("> ")
        terminal.type("(top-level (loop (sleep 1)))" if arguments == ["repl"] else "(while True (hy.I.cramhy_runtime/kernel.sleep 1))")
        terminal.expect(r"; \d+\.\d s, (waits for the time|computes)")
        terminal.control_c()
        terminal.expect("Interrupted" if arguments == ["repl"] else "KeyboardInterrupt")
        terminal.expect("> ")
        drawn = DRAWN.findall(terminal.raw.decode())
        assert drawn
        assert terminal.raw.decode().rpartition("\x1b8")[2].count("\x1b[J") >= 1
        terminal.type("(+ 40 2)")
        terminal.expect(r"\n42\n")
        assert len(DRAWN.findall(terminal.raw.decode())) == len(drawn)


def test_a_dumb_terminal_gets_no_line(monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    session = Session(time="virtual", turtlesim=False)
    paper, ticks = Paper(), count(1)
    monkeypatch.setattr(sys, "stdout", paper)
    with Progress(lambda: next(ticks)).during():
        session.evaluate_text("(dotimes (i 10) (sleep 2))")
    kernel.stop()
    assert paper.getvalue() == ""
