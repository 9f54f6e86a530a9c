"""Every way out is one way out: plans end through their cleanup forms, what serves them is closed, the terminal is as before.

Real processes get real signals, in pipes and in pseudo-terminals that are closed under them. The exit status is the signal's, 128 and
its number, as a shell says it.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import termios
import time

import pytest
from systems import SOAK

from .conftest import environment
from .terminal import PATIENCE, Terminal

SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT]
ENDING = SIGNALS[1:]
CLOCKS = ["virtual", "wall"]
BACKENDS = ["threads", "greenlet"]

SESSIONS = (
    [(clock, backend, number) for clock in CLOCKS for backend in BACKENDS for number in ENDING]
    if SOAK
    else [
        ("virtual", "threads", signal.SIGTERM),
        ("virtual", "greenlet", signal.SIGHUP),
        ("wall", "threads", signal.SIGQUIT),
        ("wall", "greenlet", signal.SIGTERM),
    ]
)
"""Each clock with each back end; with every signal in the soak."""


def named(value):
    return getattr(value, "name", None) or str(value)


PLAN = """
(in-package :cram-user)
(roslisp:start-ros-node "test")
(defparameter *velocity* (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"))
(defun send (speed) (roslisp:publish *velocity* (roslisp:make-msg "geometry_msgs/Twist" (:x :linear) speed)))
(defun note (word)
  (with-open-file (out "log" :direction :output :if-exists :append :if-does-not-exist :create) (format out "~a~%" word)))
(defun drive (waits)
  (top-level
    (unwind-protect
         (par (unwind-protect (progn (send 1.0) (note "driving") (funcall waits))
                (sleep 0.05) (send 0.0) (note "stopped"))
              (wait-for (make-fluent)))
      (note "cleaned"))))
"""
WAITS = {
    "that sleeps": "(lambda () (sleep 1000000))",
    "that computes": "(lambda () (loop))",
    "that steps": "(lambda () (loop (sleep 0.01)))",
}


@pytest.fixture
def folder(tmp_path, private):
    (tmp_path / "plan.lisp").write_text(PLAN)
    return tmp_path


class Process:
    """``cramhy`` with ``arguments``, in the package of the plan, in ``folder``, with pipes; a context manager."""

    def __init__(self, folder, *arguments, **options):
        self.log = folder / "log"
        self.process = subprocess.Popen(
            [sys.executable, "-m", "cramhy_runtime.cli", *arguments, "--package", "cram-user"],
            cwd=folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**environment(), "XDG_RUNTIME_DIR": os.environ["XDG_RUNTIME_DIR"]},
            **options,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def until(self, condition):
        until = time.monotonic() + PATIENCE
        while not condition():
            assert self.process.poll() is None, self.process.communicate()
            assert time.monotonic() < until, "it never came"
            time.sleep(0.01)

    def until_noted(self, word):
        self.until(lambda: word in noted(self.log))

    def type(self, *lines):
        self.process.stdin.write("".join(f"{line}\n" for line in lines))
        self.process.stdin.flush()

    def send(self, number):
        self.process.send_signal(number)

    def end(self):
        """(status, output, complaints) of the process that ends now."""
        output, complaints = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, output, complaints


def noted(log):
    return log.read_text().split() if log.exists() else []


def commands(recording):
    """The velocities in a recording, which must be a whole one."""
    from mcap.reader import make_reader

    with open(recording, "rb") as file:
        reader = make_reader(file)
        assert reader.get_summary() is not None
        return [json.loads(message.data)["linear"]["x"] for _, _, message in reader.iter_messages(topics=["/turtle1/cmd_vel"])]


def sessions():
    """The files of sessions that are announced."""
    folder = os.path.join(os.environ["XDG_RUNTIME_DIR"], f"cramhy-{os.getuid()}")
    return os.listdir(folder) if os.path.isdir(folder) else []


STOPPED = ["driving", "stopped", "cleaned"]


def check(process, folder, status, *, recorded=True):
    found, output, complaints = process.end()
    assert (noted(process.log), found) == (STOPPED, status), (output, complaints)
    assert "Traceback" not in output + complaints
    if recorded:
        assert commands(folder / "run.mcap") == [1.0, 0.0]
    assert sessions() == []
    return output, complaints


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("number", SIGNALS, ids=lambda number: number.name)
@pytest.mark.parametrize(
    ("clock", "backend", "waits"),
    [
        ("virtual", "threads", "that computes"),
        ("virtual", "greenlet", "that computes"),
        ("wall", "threads", "that sleeps"),
        ("wall", "greenlet", "that steps"),
        ("wall", "threads", "that computes"),
        ("wall", "greenlet", "that sleeps"),
    ],
)
def test_a_signal_ends_a_program_through_its_cleanup(folder, number, clock, backend, waits):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    with Process(
        folder,
        "run",
        "plan.lisp",
        "--time",
        clock,
        "--backend",
        backend,
        "--serve",
        "--record",
        "run.mcap",
        "--eval",
        f"(drive {WAITS[waits]})",
    ) as process:
        process.until_noted("driving")
        assert sessions() != []
        process.send(number)
        check(process, folder, 128 + number)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("command", ["repl", "eval"])
@pytest.mark.parametrize(("clock", "backend", "number"), SESSIONS, ids=named)
def test_a_signal_ends_a_session_that_runs_a_plan(folder, number, command, backend, clock):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    form = f"(drive {WAITS['that computes']})"
    with Process(folder, command, "--time", clock, "--backend", backend, "--load", "plan.lisp", "--record", "run.mcap") as process:
        process.type(form if command == "repl" else json.dumps({"form": form}))
        process.until_noted("driving")
        process.send(number)
        check(process, folder, 128 + number)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("options", [(), ("--serve",)], ids=["alone", "serving"])
@pytest.mark.parametrize("command", ["repl", "eval"])
@pytest.mark.parametrize(("clock", "backend", "number"), SESSIONS, ids=named)
def test_a_signal_ends_a_session_that_waits_for_a_line(folder, number, command, backend, clock, options):
    pytest.importorskip(backend if backend == "greenlet" else "websockets")
    with Process(folder, command, "--time", clock, "--backend", backend, "--load", "plan.lisp", *options) as process:
        process.type('(note "ready")' if command == "repl" else json.dumps({"form": '(note "ready")'}))
        process.until_noted("ready")
        process.send(number)
        status, output, complaints = process.end()
        assert status == 128 + number and "Traceback" not in output + complaints and sessions() == []


LEAVING = {
    "the end of input": ((), 0),
    "exit": (("(sb-ext:exit :code 3)",), 3),
    "quit": (("(sb-ext:quit)",), 0),
    "sys.exit": (("(py:import sys)", "(sys:exit 4)"), 4),
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("way", LEAVING)
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_a_session_is_left_and_what_runs_beside_the_prompt_is_cleaned_up(folder, way, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    lines, status = LEAVING[way]
    beside = (
        '(cut:spawn-thread "beside" (lambda () (unwind-protect (progn (send 1.0) (note "driving")'
        ' (sleep 1000000)) (sleep 0.05) (send 0.0) (note "stopped") (note "cleaned"))))'
    )
    with Process(
        folder, "repl", "--time", clock, "--backend", backend, "--load", "plan.lisp", "--serve", "--record", "run.mcap"
    ) as process:
        process.type(beside)
        process.until_noted("driving")
        process.type(*lines)
        check(process, folder, status)


IN_A_PLAN = {"exit": ("(sb-ext:exit :code 3)", 3), "sys.exit": ("(py-exit)", 4), "an error": ('(error "lost")', 1)}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("way", IN_A_PLAN)
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_a_plan_itself_ends_the_program(folder, way, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    form, status = IN_A_PLAN[way]
    (folder / "leave.lisp").write_text(f"""(py:import sys)
(in-package :cram-user)
(defun py-exit () (sys:exit 4))
(top-level
  (unwind-protect
       (par (unwind-protect (progn (send 1.0) (note "driving") (wait-for (make-fluent))) (sleep 0.05) (send 0.0) (note "stopped"))
            (seq (sleep 0.1) {form}))
    (note "cleaned")))
""")
    with Process(
        folder, "run", "leave.lisp", "--time", clock, "--backend", backend, "--load", "plan.lisp", "--record", "run.mcap"
    ) as process:
        process.process.wait(PATIENCE)
        check(process, folder, status)


SCRIPT = """
import sys
from cramhy_runtime import chronicle, cpl, kernel
from cramhy_runtime.ros import graph

kernel.start(clock={clock!r}, backend={backend!r})
chronicle.record("run.mcap")
node = graph.active().node("test")
velocity = node.advertise("/turtle1/cmd_vel", "geometry_msgs/Twist")

def note(word):
    with open("log", "a") as file:
        print(word, file=file)

def send(speed):
    velocity.publish({{"linear": {{"x": speed}}}})

def drive():
    try:
        note("driving")
        while True:
            kernel.sleep(0.01)
    finally:
        with kernel.cleanup():
            kernel.sleep(0.05)
            note("stopped")
            note("cleaned")

kernel.spawn(drive)
kernel.sleep(0.1)
{end}
"""
ENDS = {
    "it just ends": ("", 0),
    "sys.exit": ("sys.exit(5)", 5),
    "an error": ("1 / 0", 1),
    "an endless main program": ("kernel.park()", None),
    "a main program that knows no kernel": ("import time\ntime.sleep(100)", None),
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("number", SIGNALS, ids=lambda number: number.name)
@pytest.mark.parametrize("end", [end for end, (_, status) in ENDS.items() if status is None])
@pytest.mark.parametrize("backend", BACKENDS)
def test_a_signal_ends_a_python_script(folder, number, end, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    found = script(folder, ENDS[end][0], "wall", backend, number)
    assert found == (-signal.SIGINT if number == signal.SIGINT else 128 + number)  # Python itself ends by SIGINT


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("end", [end for end, (_, status) in ENDS.items() if status is not None])
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_a_python_script_ends(folder, end, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    assert script(folder, ENDS[end][0], clock, backend) == ENDS[end][1]


def script(folder, end, clock, backend, number=None):
    """The exit status of a script without ``kernel.stop()``, after it was checked that its task was cleaned up and recorded."""
    (folder / "script.py").write_text(SCRIPT.format(clock=clock, backend=backend, end=end))
    process = subprocess.Popen([sys.executable, "script.py"], cwd=folder, env=environment(), stderr=subprocess.PIPE, text=True)
    try:
        if number is not None:
            until = time.monotonic() + PATIENCE
            while "driving" not in noted(folder / "log"):
                assert time.monotonic() < until and process.poll() is None, process.communicate()
                time.sleep(0.01)
            process.send_signal(number)
        _, complaints = process.communicate(timeout=PATIENCE)
        assert noted(folder / "log") == STOPPED, complaints
        from mcap.reader import make_reader

        with open(folder / "run.mcap", "rb") as file:
            assert make_reader(file).get_summary() is not None
        return process.returncode
    finally:
        process.kill()
        process.wait()


# ---------------------------------------------------------------------------------------------------------------- terminals


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("editor", [False, True], ids=["plain", "edited"])
@pytest.mark.parametrize("where", ["at the prompt", "in a plan", "in the debugger"])
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_a_closed_terminal_ends_the_session(folder, where, clock, backend, editor, monkeypatch):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    monkeypatch.chdir(folder)
    with Terminal(
        "repl",
        "--time",
        clock,
        "--backend",
        backend,
        "--load",
        "plan.lisp",
        "--package",
        "cram-user",
        "--record",
        "run.mcap",
        editor=editor,
        variables={"TERM": "xterm" if editor else "dumb"},
    ) as terminal:
        terminal.expect("CPL-USER> ")
        waits = '(lambda () (error "stuck"))' if where == "in the debugger" else WAITS["that steps"]
        if where != "at the prompt":
            terminal.type(f"(drive {waits})")
            wait_for(lambda: "driving" in noted(folder / "log"))
        if where == "in the debugger":
            terminal.expect(r"0\] ")
        terminal.hang_up()
        assert terminal.status() == 128 + signal.SIGHUP
    assert noted(folder / "log") == ([] if where == "at the prompt" else STOPPED)
    assert commands(folder / "run.mcap") == ([] if where == "at the prompt" else [1.0, 0.0])


def wait_for(condition, pause=0.01):
    until = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < until, "it never came"
        time.sleep(pause)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("editor", [False, True], ids=["plain", "edited"])
@pytest.mark.parametrize("way", ["exit", "signal", "end of input"])
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_the_terminal_is_as_it_was(folder, way, editor, clock, backend):
    if backend == "greenlet":
        pytest.importorskip("greenlet")
    with Terminal(
        "repl",
        "--time",
        clock,
        "--backend",
        backend,
        "--package",
        "cram-user",
        editor=editor,
        wrapped=True,
        variables={"TERM": "xterm" if editor else "dumb"},
    ) as terminal:
        before = termios.tcgetattr(terminal.slave)
        terminal.begin()
        terminal.expect("CPL-USER> ")
        terminal.type("(+ 1 2)")
        terminal.expect("CPL-USER> ")
        if way == "exit":
            terminal.type("(sb-ext:exit)")
        elif way == "signal":
            os.kill(terminal.pid, signal.SIGTERM)
        else:  # again, since a terminal forgets the key when its modes change in this moment
            wait_for(lambda: os.write(terminal.master, b"\x04") and terminal.process.poll() is not None, pause=0.2)
        assert terminal.status() == (128 + signal.SIGTERM if way == "signal" else 0)
        assert termios.tcgetattr(terminal.slave) == before


# ---------------------------------------------------------------------------------------------------------------- stuck cleanup

STUCK = """
(in-package :cram-user)
(defun stuck (how)
  (top-level
    (par (unwind-protect (progn (note "driving") (wait-for (make-fluent)))
           (note "cleaning")
           (funcall how))
         (sleep 1000000))))
"""


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(("clock", "backend"), [("virtual", "threads"), ("wall", "greenlet"), ("wall", "threads")])
def test_a_second_signal_gives_cleanup_up_and_says_whose(folder, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    (folder / "stuck.lisp").write_text(STUCK)
    with Process(
        folder,
        "run",
        "stuck.lisp",
        "--time",
        clock,
        "--backend",
        backend,
        "--load",
        "plan.lisp",
        "--cleanup-limit",
        "1000000",
        "--eval",
        '(cut:spawn-thread "ticks" (lambda () (loop (sleep 1))))' if clock == "virtual" else "nil",
        "--eval",
        "(stuck (lambda () (loop)))",
    ) as process:
        process.until_noted("driving")
        process.send(signal.SIGTERM)
        process.until_noted("cleaning")
        process.send(signal.SIGTERM)
        status, output, complaints = process.end()
    assert status == 128 + signal.SIGTERM
    assert complaints.startswith("cramhy: The cleanup of ") and "[PAR-CHILD-#1/2]" in complaints and "Traceback" not in complaints


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("how", ["(loop)", "(loop (sleep 0.1))", "(wait-for (make-fluent))", "(py-sleep 100)"])
@pytest.mark.parametrize(("clock", "backend"), [("virtual", "threads"), ("wall", "greenlet"), ("wall", "threads")])
def test_cleanup_has_a_limit(folder, how, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    (folder / "stuck.lisp").write_text("(py:import time)\n" + STUCK + "(defun py-sleep (seconds) (time:sleep seconds))")
    with Process(
        folder,
        "run",
        "stuck.lisp",
        "--time",
        clock,
        "--backend",
        backend,
        "--load",
        "plan.lisp",
        "--cleanup-limit",
        "0.5",
        "--record",
        "run.mcap",
        "--serve",
        "--eval",
        f"(stuck (lambda () {how}))",
    ) as process:
        process.until_noted("driving")
        process.send(signal.SIGTERM)
        status, output, complaints = process.end()
    assert status == 128 + signal.SIGTERM and noted(folder / "log") == ["driving", "cleaning"]
    assert "Traceback" not in complaints and sessions() == []
    assert commands(folder / "run.mcap") == []


@pytest.mark.soak
def test_a_process_that_does_not_listen_is_ended_by_force(folder):
    (folder / "deaf.py").write_text("def compute():\n    while True:\n        pass\n")
    (folder / "deaf.lisp").write_text(
        '(py:import deaf)\n(in-package :cram-user)\n(note "driving")\n(top-level (par (deaf::compute) (sleep 10)))'
    )
    with Process(
        folder, "run", "deaf.lisp", "--time", "wall", "--load", "plan.lisp", "--cleanup-limit", "0.5", "--serve", "--record", "run.mcap"
    ) as process:
        process.until_noted("driving")
        process.send(signal.SIGTERM)
        status, output, complaints = process.end()
    assert status == 128 + signal.SIGTERM and sessions() == []
    assert "Traceback" not in complaints
    assert commands(folder / "run.mcap") == []


# ---------------------------------------------------------------------------------------------------------------- nobody reads


@pytest.mark.soak
@pytest.mark.parametrize(("clock", "backend"), [("virtual", "threads"), ("wall", "greenlet")])
def test_output_that_nobody_reads_any_more_does_not_cost_the_cleanup(folder, clock, backend):
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    form = """(top-level
  (unwind-protect
       (par (unwind-protect (progn (send 1.0) (note "driving") (loop (print :on) (finish-output) (sleep 0.01)))
              (print :stopping) (finish-output) (send 0.0) (note "stopped"))
            (wait-for (make-fluent)))
    (print :cleaned)
    (note "cleaned")))"""
    with Process(folder, "run", "plan.lisp", "--time", clock, "--backend", backend, "--record", "run.mcap", "--eval", form) as process:
        process.until_noted("driving")
        process.process.stdout.close()
        process.process.wait(PATIENCE)
        complaints = process.process.stderr.read()
        assert noted(folder / "log") == STOPPED, complaints
        assert process.process.returncode == 1 and "Traceback" not in complaints
    assert commands(folder / "run.mcap") == [1.0, 0.0]


# ---------------------------------------------------------------------------------------------------------------- requests, keys


@pytest.mark.soak
@pytest.mark.parametrize("options", [(), ("--serve",)], ids=["alone", "serving"])
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("clock", CLOCKS)
def test_interrupts_do_not_end_a_program_that_answers_requests(folder, clock, backend, options):
    """Two at a time, while it waits and while it answers: each request gets one answer."""
    pytest.importorskip(backend if backend == "greenlet" else "mcap")
    with Process(folder, "eval", "--time", clock, "--backend", backend, *options) as process:

        def answer(form):
            process.type(json.dumps({"form": form}))
            return json.loads(process.process.stdout.readline())

        answer("nil")
        for number in range(30):
            process.send(signal.SIGINT)
            process.send(signal.SIGINT)
            if number % 3 == 0:
                process.type(json.dumps({"form": "(loop repeat 20000 collect 1)"}))
                process.send(signal.SIGINT)
                assert set(json.loads(process.process.stdout.readline())) >= {"output", "values", "error"}
        for _ in range(100):
            if answer("(+ 1 2)")["values"] == ["3"]:
                break
        else:
            pytest.fail("it is interrupted without end")
        assert process.end()[0] == 0


@pytest.mark.soak
@pytest.mark.parametrize("editor", [False, True], ids=["plain", "edited"])
def test_the_key_that_ends_the_input_ends_one_read(folder, editor):
    with Terminal(
        "repl", "--time", "virtual", "--package", "cram-user", editor=editor, variables={"TERM": "xterm" if editor else "dumb"}
    ) as terminal:
        terminal.expect("CPL-USER> ")
        for _ in range(2):
            terminal.type("(list :read (read-line *standard-input* nil :eof))")
            wait_for(lambda: terminal._more(0.1) or "eof))\n" in terminal.text[terminal.seen :])
            time.sleep(0.3)  # the editor gives the terminal back
            os.write(terminal.master, b"\x04")
            terminal.expect(r"\(:READ :EOF\)\nCPL-USER> ")
        terminal.type("(list :read (read-line))")
        time.sleep(0.3)
        terminal.type("hello")
        terminal.expect(r'\(:READ "hello"\)\nCPL-USER> ')
