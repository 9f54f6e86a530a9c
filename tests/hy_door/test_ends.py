"""How things end at a ``hy`` prompt: a plan by Ctrl-C, the session by Ctrl-D, a signal, or a terminal that is closed."""

from __future__ import annotations

import os
import re
import signal
import subprocess

import pytest

from .conftest import HY, REQUIRE, environment

PLAN = "(top-level (unwind-protect (par (progn (print :running) (loop (sleep 0.01))) (wait-for (make-fluent))) {cleanup}))"
PRINTS = PLAN.format(cleanup="(print :cleaned)")
BUSY = "(top-level (unwind-protect (par (progn (print :running) (loop)) (sleep 1000000)) (print :cleaned)))"
HY_PLAN = '(top-level (try (print "running") (while True (sleep 0.01)) (finally (print "cleaned"))))'
HY_PLANS = {
    "waiting": HY_PLAN,
    "busy": HY_PLAN.replace("(sleep 0.01)", "1").replace("(finally", "(finally (sleep 0.01)"),
    "a busy branch": '(top-level (try (par (do (print "running") (for-ever)) (sleep 1000)) (finally (print "cleaned"))))',
    "no plan": '(try (print "running") (for-ever) (finally (print "cleaned")))',
}


def interrupted(hy, plan, begun, prompt):
    """What is printed after Ctrl-C, up to the next prompt, of a plan that has begun when it has printed ``begun``."""
    hy.type(plan)
    hy.expect(begun)
    hy.control_c()
    return hy.expect(prompt).removeprefix("^C")


@pytest.mark.soak
@pytest.mark.parametrize("clock", ["virtual", "wall"])
@pytest.mark.parametrize("plan", [PRINTS, BUSY], ids=["waiting", "busy"])
def test_ctrl_c_ends_a_plan_through_its_cleanup(hy_terminal, clock, plan):
    with hy_terminal(time=clock) as hy:
        hy.begin_lisp(":cram-user")
        for _ in range(3):
            assert interrupted(hy, plan, r"\n:RUNNING ", "> $") == "\n:CLEANED \n; Interrupted.\nCPL-USER> "
            assert hy.ask("(+ 1 2)") == "3\nCPL-USER> "


@pytest.mark.soak
@pytest.mark.parametrize("plan", HY_PLANS)
@pytest.mark.parametrize("lisp_before", [False, True])
def test_ctrl_c_ends_a_plan_in_hy_through_its_cleanup(hy_terminal, lisp_before, plan):
    with hy_terminal(time="wall") as hy:
        if lisp_before:
            hy.begin_lisp()
            hy.ask("(in-hy)")
        else:
            hy.begin_hy()
        hy.ask("(import cramhy_runtime.cpl *)")
        hy.ask("(defn for-ever [] (for [i (range 100000000000)] 1))")
        for _ in range(3):
            assert interrupted(hy, HY_PLANS[plan], r"\nrunning\n", "=> $") == "cleaned\n\nKeyboardInterrupt\n=> "
            assert hy.ask("(+ 1 2)") == "3\n=> "


@pytest.mark.soak
def test_a_second_ctrl_c_gives_the_cleanup_up(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp(":cram-user")
        plan = "(top-level (par (unwind-protect (progn (print :running) (loop)) (print :cleaning) (loop)) (sleep 1000000)))"
        interrupted(hy, plan, r"\n:RUNNING ", r"\n:CLEANING ")
        hy.control_c()
        answer = hy.expect("> $")
        assert re.search(r"The cleanup of these \d tasks was given up\.", answer)
        assert answer.endswith("\n; Interrupted.\nCPL-USER> ")
        assert hy.ask("(+ 1 2)") == "3\nCPL-USER> "


@pytest.mark.soak
@pytest.mark.parametrize("clock", ["virtual", "wall"])
def test_ctrl_c_is_heard_as_soon_as_the_prompt_is_there(hy_terminal, clock):
    """Python's readline missed one of ten when the key was a signal, which came before it waited for keys."""
    with hy_terminal(time=clock) as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        for prompt in ("=> ", "CL-USER> "):
            for _ in range(50):
                hy.control_c()
                assert hy.expect(f"{prompt}$") == f"^C\n{prompt}"
                assert hy.ask("(+ 1 2)") == f"3\n{prompt}"
            hy.ask("(in-package :cl-user)")


@pytest.mark.soak
def test_ctrl_c_forgets_the_line_and_the_form_that_are_typed(hy_terminal):
    with hy_terminal() as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        for prompt in ("=> ", "CL-USER> "):
            assert hy.ask("(+ 3 4)") == f"7\n{prompt}"
            os.write(hy.master, b"(print 1)\x03")
            assert hy.expect(rf"\n{prompt}$").endswith(f"(print 1)^C\n{prompt}")
            os.write(hy.master, b"\x10\n")  # the line before, which is not the one that was thrown away
            assert hy.expect(f"7\n{prompt}$")
            assert hy.ask("(list 1") == "... "
            hy.control_c()
            assert hy.expect(f"{prompt}$") == f"^C\n{prompt}"
            assert hy.ask("(+ 1 2)") == f"3\n{prompt}"
            hy.ask("(in-package :cl-user)")


@pytest.mark.soak
@pytest.mark.parametrize("typed", [b"", b"(list 1", b"(list 1\x1b"], ids=["nothing", "in insert mode", "in command mode"])
def test_ctrl_c_with_the_keys_of_vi(hy_terminal, tmp_path, typed):
    (tmp_path / "inputrc").write_text("set editing-mode vi\n")
    with hy_terminal(variables={"INPUTRC": str(tmp_path / "inputrc")}) as hy:
        hy.begin_lisp()
        os.write(hy.master, typed + b"\x03")
        hy.expect("\nCL-USER> $")
        assert hy.ask("(+ 1 2)") == "3\nCL-USER> "


@pytest.mark.soak
def test_ctrl_c_in_the_debugger_stays_there(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        assert hy.ask("(car 1)").endswith("\n0] ")
        hy.control_c()
        assert hy.expect(r"\] $") == "^C\n0] "
        assert hy.ask("(+ 1 2)") == "3\n0] "
        assert hy.ask("0") == "CL-USER> "


@pytest.mark.soak
def test_ctrl_c_in_the_debugger_of_a_plans_task_ends_the_plan(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp(":cram-user")
        assert hy.ask('(top-level (par (progn (break "here") 1) (sleep 9)))').endswith("\n0] ")
        assert hy.ask("(+ 1 2)") == "3\n0] "
        hy.control_c()
        assert "; Interrupted." in hy.expect("CPL-USER> $")
        assert hy.ask("(+ 1 2)") == "3\nCPL-USER> "


@pytest.mark.soak
def test_ctrl_d_leaves(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        assert hy.end() == 0
        assert hy.text.endswith("CL-USER> \nnow exiting REPL...\n")


@pytest.mark.soak
def test_ctrl_d_in_an_unfinished_form_is_told(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        hy.ask("(list 1")
        os.write(hy.master, b"\x04")
        assert "The ( at line 1, column 1 is never closed." in hy.expect(r"0\] $")
        os.write(hy.master, b"\x04")
        hy.expect("CL-USER> $")
        assert hy.ask("(+ 1 2)") == "3\nCL-USER> "
        assert hy.end() == 0


@pytest.mark.soak
def test_exit_gives_the_status(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        hy.type("(exit :code 7)")
        assert hy.status() == 7


@pytest.mark.soak
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP], ids=["SIGTERM", "SIGHUP"])
def test_a_signal_ends_a_plan_through_its_cleanup(hy_terminal, number):
    with hy_terminal() as hy:
        hy.begin_lisp(":cram-user")
        hy.type(PRINTS)
        hy.expect(r"\n:RUNNING ")
        os.kill(hy.pid, number)
        assert hy.status() == 128 + number
        assert hy.text.rstrip().endswith("\n:CLEANED")


@pytest.mark.soak
@pytest.mark.parametrize("running", [False, True])
def test_a_closed_terminal_ends_the_session_through_the_cleanup_of_its_plans(hy_terminal, tmp_path, running):
    note = tmp_path / "note"
    cleanup = f'(with-open-file (note "{note}" :direction :output) (princ :cleaned note))'
    with hy_terminal() as hy:
        hy.begin_lisp(":cram-user")
        if running:
            hy.type(PLAN.format(cleanup=cleanup))
            hy.expect(r"\n:RUNNING ")
        hy.hang_up()
        assert hy.status() == 128 + signal.SIGHUP
    assert not running or note.read_text() == "CLEANED"


@pytest.mark.soak
def test_a_signal_ends_a_piped_plan_through_its_cleanup(tmp_path):
    program = subprocess.Popen([str(HY)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment(), cwd=tmp_path, text=True)
    program.stdin.write(f"{REQUIRE}\n(in-package :cram-user)\n{PRINTS.replace('(print :running)', '(print :running) (finish-output)')}\n")
    program.stdin.close()
    printed = ""
    while ":RUNNING" not in printed:
        printed += program.stdout.read(1)
    program.send_signal(signal.SIGTERM)
    assert program.stdout.read().endswith("\n:CLEANED ")
    assert program.wait(30) == 128 + signal.SIGTERM
