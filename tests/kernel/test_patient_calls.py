"""`time.sleep` and `input` in a session: the other tasks run meanwhile, and who is asked to end is not kept."""

from __future__ import annotations

import io
import os
import sys
import threading
import time

import pytest
from systems import needs_threads, posix

from cramhy_runtime import kernel
from cramhy_runtime.kernel import patient_calls, standard_input

pytestmark = needs_threads


@pytest.fixture(params=["virtual", "wall"])
def running(request, backend):
    kernel.start(clock=request.param, backend=backend)
    yield
    kernel.stop()


def test_a_task_that_sleeps_is_ended_at_once_and_the_others_run(running):
    heard = []

    def sleeper():
        try:
            patient_calls.sleep(100_000)
        finally:
            heard.append("cleaned up")

    task = kernel.spawn(sleeper)
    kernel.spawn(lambda: heard.append("another ran"))
    kernel.yield_()
    kernel.yield_()
    task.cancel()
    task.join()
    assert heard == ["another ran", "cleaned up"]


def test_the_main_task_that_sleeps_is_interrupted(running):
    kernel.spawn(kernel.interrupt)
    with pytest.raises(kernel.Interrupted):
        patient_calls.sleep(100_000)
    kernel.interrupt_over()


def test_virtual_time_stands_still_meanwhile():
    kernel.start(clock="virtual")
    late = []
    kernel.call_at(5.0, lambda: late.append(1))
    patient_calls.sleep(0.001)
    assert kernel.now() == 0 and late == []
    kernel.stop()


@pytest.mark.parametrize("seconds", [-1, "1", None, float("nan"), float("inf")])
def test_what_python_refuses_is_refused_as_python_does(running, seconds):
    with pytest.raises((ValueError, TypeError, OverflowError)) as ours:
        patient_calls.sleep(seconds)
    with pytest.raises(type(ours.value)) as its:
        patient_calls._sleep(seconds)
    assert str(ours.value) == str(its.value)


def test_other_threads_and_callbacks_and_programs_without_a_session_have_pythons_own(monkeypatch):
    slept = []
    monkeypatch.setattr(patient_calls, "_sleep", slept.append)
    kernel.start(clock="virtual")
    kernel.stop()
    patient_calls.sleep(100)
    kernel.start(clock="virtual")
    thread = threading.Thread(target=patient_calls.sleep, args=(200,))
    thread.start()
    kernel.run_blocking(thread.join)
    kernel.call_at(1.0, lambda: patient_calls.sleep(300))
    kernel.sleep(2.0)
    kernel.stop()
    assert slept == [100, 200, 300]


@posix
def test_input_is_interrupted_and_loses_no_line(running, monkeypatch):
    ours, theirs = os.pipe()
    with open(ours, encoding="utf-8") as file, open(theirs, "w", encoding="utf-8") as other:
        monkeypatch.setattr(sys, "stdin", standard_input.StandardInput(file))
        monkeypatch.setattr(sys, "stdout", io.StringIO())
        kernel.spawn(kernel.interrupt)
        with pytest.raises(kernel.Interrupted):
            patient_calls.ask("what? ")
        kernel.interrupt_over()
        other.write("this\nand that")
        other.flush()
        assert patient_calls.ask("what? ") == "this"
        other.close()
        assert patient_calls.ask() == "and that"
        with pytest.raises(EOFError, match="EOF when reading a line"):
            patient_calls.ask()
        assert sys.stdout.getvalue() == "what? what? "


def test_installing_twice_keeps_pythons_own(monkeypatch):
    monkeypatch.setattr(time, "sleep", time.sleep)
    monkeypatch.setattr("builtins.input", input)
    patient_calls.install()
    patient_calls.install()
    assert time.sleep is patient_calls.sleep and patient_calls._sleep is not patient_calls.sleep
