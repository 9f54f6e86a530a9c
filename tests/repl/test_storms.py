"""Storms of Ctrl-C: the REPL answers afterwards, every plan that began has stopped, nothing is left over, and no typed line is lost.

200 interrupts for each combination of back end, clock, line editing and way to send them, 1 to 20 ms apart (`make soak`: 30 s of them, 1 to
50 ms apart). What is typed meanwhile is computed from a seed.
"""

from __future__ import annotations

import os
import random
import re
import signal
import time

import pytest
from systems import SOAK

from .terminal import PATIENCE, Terminal

SECONDS, LONGEST = (30, 0.05) if SOAK else (None, 0.02)
INTERRUPTS = 200

SETUP = """
(in-package :cram-user)
(py:import cramhy_runtime.kernel.backends.threads)
(defparameter *began* 0)
(defparameter *ended* 0)
(defun note (file word)
  (with-open-file (out file :direction :output :if-exists :append :if-does-not-exist :create) (format out "~a~%" word)))
(defun plan (waits)
  (top-level (par (unwind-protect (progn (incf *began*) (funcall waits)) (incf *ended*)) (wait-for (make-fluent)))))
(defun threads-left () (cramhy-runtime.kernel.backends.threads:threads-in-use))
(defun tasks-left () (length (cut:all-threads)))
"""
FORMS = [
    "(plan (lambda () (loop)))", "(plan (lambda () (sleep 1000000)))", "(plan (lambda () (loop (sleep 0.01))))",
    "(plan (lambda () (unwind-protect (loop) (loop for i below 20000))))", "(plan (lambda () (car 1)))", "(+ 1 2)",
    "(car 1)", "(list 1", ")",
    "(compile nil '(lambda (x) (loop for i below 10 collect (* i x))))", "(load \"setup.lisp\")", "(describe 'plan)",
    "(dotimes (i 30) (print i))",
    "(ros-load:load-system \"cram_my_beginner_tutorial\" :cram-my-beginner-tutorial)", "(break)", ":abort", "0",
]  # fmt: skip
COMBINATIONS = [
    (clock, backend, editor, way)
    for clock in ("virtual", "wall")
    for backend in ("threads", "greenlet")
    for editor in ("edited", "plain")
    for way in ("typed", "sent")
]


@pytest.fixture(params=COMBINATIONS, ids="-".join)
def storm(request, tmp_path, monkeypatch):
    clock, backend, editor, way = request.param
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    if editor == "edited":
        pytest.importorskip("prompt_toolkit")
    (tmp_path / "setup.lisp").write_text(SETUP)
    monkeypatch.chdir(tmp_path)
    with Terminal(
        "repl",
        "--time",
        clock,
        "--backend",
        backend,
        "--load",
        "setup.lisp",
        "--package",
        "cram-user",
        editor=editor == "edited",
        variables={"TERM": "xterm" if editor == "edited" else "dumb"},
    ) as terminal:
        terminal.expect("CPL-USER> ")
        terminal.way = way
        yield terminal


def interrupt(terminal):
    if terminal.way == "typed":
        os.write(terminal.master, b"\x03")
    else:
        os.kill(terminal.pid, signal.SIGINT)


def calm(terminal):
    """Bring the terminal back to the prompt of the top level, whatever it was in: the number that proves it."""
    until = time.monotonic() + PATIENCE
    for number in range(1_000_000, 2_000_000):
        assert time.monotonic() < until, f"it does not answer: {terminal.text[-3000:]!r}"
        interrupt(terminal)
        read(terminal, 0.1)
        terminal.type(":abort")
        read(terminal, 0.1)
        seen = len(terminal.text)
        terminal.type(f"(list :answer (1+ {number}))")
        answer = rf"\(:ANSWER {number + 1}\)\nCPL-USER> "
        for _ in range(30):
            read(terminal, 0.1)
            if re.search(answer, terminal.text[seen:]):
                terminal.seen = len(terminal.text)
                return
            if re.search(r"\d+\] $", terminal.text):
                break


def read(terminal, seconds):
    until = time.monotonic() + seconds
    while (left := until - time.monotonic()) > 0:
        terminal._more(left)


def value(terminal, form):
    terminal.type(f"(list :value {form})")
    return int(re.search(r"\(:VALUE (-?\d+)\)\nCPL-USER> $", terminal.expect(r"\(:VALUE (-?\d+)\)\nCPL-USER> ")).group(1))


@pytest.mark.soak(all_but=1)
def test_the_session_lives_through_a_storm(storm):
    lots = random.Random(storm.way)
    calm(storm)
    threads = value(storm, "(threads-left)")
    sent, end = 0, time.monotonic() + (SECONDS or 1e9)
    while sent < INTERRUPTS or SECONDS and time.monotonic() < end:
        if lots.random() < 0.3:
            storm.type(lots.choice(FORMS))
        interrupt(storm)
        sent += 1
        read(storm, lots.uniform(0.001, LONGEST))
    calm(storm)
    assert value(storm, "(tasks-left)") == 1
    assert value(storm, "(threads-left)") <= threads
    assert value(storm, "(- *began* *ended*)") == 0
    assert "Traceback" not in storm.text


@pytest.mark.soak(all_but=1)
def test_no_line_that_is_typed_is_lost(storm, tmp_path):
    """Ctrl-C before a line, or after it, or while a form runs and lines are typed ahead."""
    if storm.way == "sent":
        pytest.skip("a signal has no place among the keys")
    expected = []
    for number in range(10 if not SOAK else 100):
        before, after, ahead = (f"{word}{number}" for word in ("before", "after", "ahead"))
        os.write(storm.master, f'(unfinished\x03(note "log" "{before}")\n'.encode())
        expected.append(before)
        wait_for_words(storm, tmp_path, expected)
        storm.type('(progn (note "log" "busy") (unwind-protect (loop) (note "log" "cleaned")))')
        expected.append("busy")
        wait_for_words(storm, tmp_path, expected)
        os.write(storm.master, f'(note "log" "{ahead}")\n\x03(note "log" "{after}")\n'.encode())
        expected += ["cleaned", ahead, after]
        wait_for_words(storm, tmp_path, expected)
        storm.type(f"(list :ready {number})")
        storm.expect(rf"\(:READY {number}\)\nCPL-USER> ")
    assert "Traceback" not in storm.text


@pytest.mark.soak(all_but=1)
def test_ctrl_c_right_after_enter_interrupts_the_form(storm, tmp_path):
    for number in range(5 if not SOAK else 50):
        if storm.way == "typed":
            os.write(storm.master, b'(unwind-protect (loop) (note "log" "cleaned"))\n\x03')
        else:
            storm.type('(unwind-protect (progn (note "log" "busy") (loop)) (note "log" "cleaned"))')
            wait_for_words(storm, tmp_path, ["busy", "cleaned"] * number + ["busy"])
            interrupt(storm)
        storm.expect("; Interrupted.\nCPL-USER> ")


def wait_for_words(terminal, folder, expected):
    until = time.monotonic() + PATIENCE
    found = []
    while found != expected:
        read(terminal, 0.01)
        found = (folder / "log").read_text().split() if (folder / "log").exists() else []
        assert time.monotonic() < until and len(found) <= len(expected), (found[-5:], expected[-5:], terminal.text[-2000:])
