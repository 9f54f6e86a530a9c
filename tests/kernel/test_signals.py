"""Signals in scripts that use the kernel: at any moment, and whatever has the baton, cleanup runs and nothing is lost.

Each script is a process of its own, since signals are a matter of processes. What it logs is on standard output.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest
from systems import needs, needs_processes

pytestmark = needs_processes
PATIENCE = 30  # s; only a test that fails waits so long
BEGIN = """
import os, signal, sys, threading, time
from cramhy_runtime import kernel

def send(number, after):
    def later():
        time.sleep(after)
        os.kill(os.getpid(), number)
    threading.Thread(target=later, daemon=True).start()

def body():
    try:
        kernel.park("for ever")
    finally:
        with kernel.cleanup():
            kernel.sleep(0.01)
            print("cleaned up", flush=True)

k = kernel.start(clock="wall", backend={backend!r}, cleanup_limit={limit})
kernel.spawn(body)
kernel.yield_()
"""


def run(program, backend, limit=5.0):
    """(status, output, complaints) of a script."""
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    done = subprocess.run(
        [sys.executable, "-c", BEGIN.format(backend=backend, limit=limit) + program], capture_output=True, text=True, timeout=PATIENCE * 2
    )
    return done.returncode, done.stdout, done.stderr


CALLBACK = """
def long():
    time.sleep(1.5)
kernel.call_at(kernel.now() + 0.1, long)
send({number}, 0.2)
kernel.sleep(20)
"""


@pytest.mark.soak
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_callback_that_takes_long_does_not_cost_the_request(backend, number):
    status, output, _ = run(CALLBACK.format(number=int(number)), backend)
    assert output == "cleaned up\n" and status == (128 + number if number == signal.SIGTERM else -number)


@pytest.mark.soak
def test_two_interrupts_during_a_message_that_takes_long(backend):
    status, output, complaints = run(
        """
kernel.post(lambda: time.sleep(2))
os.kill(os.getpid(), signal.SIGINT)
send(signal.SIGINT, 1.5)
try:
    kernel.sleep(20)
except BaseException as asked:
    print(type(asked).__name__ in ("Interrupted", "Abandoned"), flush=True)
kernel.stop()
""",
        backend,
    )
    assert output.startswith("True\n") and "IndexError" not in complaints and status in (0, -signal.SIGINT)


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("seconds", [0.3, 1.6])
def test_what_serves_plans_is_closed_to_the_end_and_the_signal_is_not_lost(backend, seconds):
    status, output, complaints = run(
        f"""
def close():
    send(signal.SIGTERM, 0.1)
    time.sleep({seconds})
    print("closed", flush=True)
k.at_stop(close)
kernel.stop()
print("went on", flush=True)
""",
        backend,
    )
    assert (output, status) == ("cleaned up\nclosed\n", 128 + signal.SIGTERM), complaints


def test_a_signal_while_a_script_that_just_ends_stops(backend):
    status, output, complaints = run(
        """
def close():
    os.kill(os.getpid(), signal.SIGTERM)
    print("closed", flush=True)
k.at_stop(close)
""",
        backend,
    )
    assert (output, status, complaints) == ("cleaned up\nclosed\n", -signal.SIGTERM, "")


def test_what_runs_beside_a_plan_cleans_up_after_it_and_has_as_long(backend):
    status, output, complaints = run(
        """
def slow(name, seconds):
    try:
        kernel.park("for ever")
    finally:
        with kernel.cleanup():
            kernel.sleep(seconds)
            print(name, flush=True)
kernel.spawn(slow, "beside", 0.7)
plan = kernel.spawn(slow, "plan", 0.7)
send(signal.SIGTERM, 0.2)
try:
    with kernel.outside_source():
        plan.join()
finally:
    plan.cancel()
    with kernel.shield():
        plan.join()
""",
        backend,
        limit=1.0,
    )
    assert (status, complaints) == (128 + signal.SIGTERM, "")
    assert output.split("\n")[0] == "plan" and set(output.split("\n")) == {"plan", "beside", "cleaned up", ""}


@needs(os, "fork")
def test_a_forked_child_does_not_clean_up_for_its_parent(backend):
    status, output, _ = run(
        """
child = os.fork()
if not child:
    time.sleep(30)
time.sleep(0.3)
os.kill(child, signal.SIGTERM)
_, ended = os.waitpid(child, 0)
print(os.waitstatus_to_exitcode(ended), flush=True)
""",
        backend,
    )
    assert (output, status) == (f"{-signal.SIGTERM}\ncleaned up\n", 0)


@needs(signal, "SIGHUP")
def test_an_ignored_signal_and_one_that_somebody_handles_are_left_alone(backend):
    program = """
import signal
signal.signal(signal.SIGHUP, signal.SIG_IGN)
signal.signal(signal.SIGTERM, lambda *_: print("mine", flush=True))
"""
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            program
            + BEGIN.format(backend=backend, limit=5.0)
            + """
for number in (signal.SIGHUP, signal.SIGTERM):
    os.kill(os.getpid(), number)
kernel.sleep(0.05)
kernel.stop()
print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN, signal.getsignal(signal.SIGINT) is signal.default_int_handler)
""",
        ],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert (done.stdout, done.stderr, done.returncode) == ("mine\ncleaned up\nTrue True\n", "", 0)


def test_the_end_of_a_script_runs_cleanup_that_needs_blocking_calls(backend):
    """Python 3.12 starts no threads any more when the main program is over."""
    status, output, complaints = run(
        """
def blocking(name):
    try:
        kernel.park("for ever")
    finally:
        with kernel.cleanup():
            kernel.run_blocking(time.sleep, 0.01)
            print(name, flush=True)
for name in "abc":
    kernel.spawn(blocking, name)
kernel.yield_()
""",
        backend,
    )
    assert (status, sorted(output.split())) == (0, ["a", "b", "c", "cleaned", "up"]), complaints


@pytest.mark.soak
@needs(signal, "pthread_kill")  # a write that waits is broken off by a second signal to its thread
def test_output_that_nobody_reads_does_not_hold_up_the_end(tmp_path):
    """A full pipe, to which a branch prints and complaints go, too."""
    program = tmp_path / "print.lisp"
    program.write_text(
        "(cpl:top-level (unwind-protect (cpl:par (loop (print 1)) (cpl:sleep 1000)) "
        '(with-open-file (out "log" :direction :output) (print :cleaned out))))'
    )
    reader, writer = os.pipe()
    process = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "run", "print.lisp", "--time", "wall", "--cleanup-limit", "3"],
        cwd=tmp_path,
        stdout=writer,
        stderr=subprocess.STDOUT,
    )
    os.close(writer)
    try:
        assert os.read(reader, 1)
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until and process.poll() is None and not full(process):
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE) != 0
        assert ":CLEANED" in (tmp_path / "log").read_text()
    finally:
        process.kill()
        process.wait()
        os.close(reader)


def full(process):
    """Whether the program prints no more: two looks at the time that it has used."""

    def used():
        with open(f"/proc/{process.pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[11]

    try:
        first = used()
        time.sleep(0.5)
        return first == used()
    except OSError:  # no /proc here
        return True
