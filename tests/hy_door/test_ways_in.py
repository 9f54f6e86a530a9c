"""All ways into Hy lead to Lisp, too: ``hy -c``, ``-i``, ``-m``, files, ``hy.REPL`` in a Python program, and ``cramhy repl --hy``."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from .conftest import REQUIRE, Door, environment

FILE = f"""\
{REQUIRE}
(print "begins in Hy")
(in-package :cram-user)
(defun twice (number) (* 2 number))
(print (twice 4))
(in-hy)
(setv words ["of" "Hy"])
(print "in Hy again" words)
(in-package :cram-user)
(defvar *end* (list (twice 5) 2.0d0))
"""
PRINTED = "begins in Hy\n\n8 in Hy again ['of', 'Hy']\n"


@pytest.fixture
def plan(tmp_path):
    path = tmp_path / "plan.hy"
    path.write_text(FILE)
    return str(path)


@pytest.mark.soak
def test_a_file_goes_to_lisp_and_back_and_to_lisp_again(hy, plan):
    for _ in range(2):  # the second time from the bytecode, for a module
        done = hy(plan)
        assert (done.stdout, done.stderr, done.returncode) == (PRINTED, "", 0)
        done = hy("-m", "plan")
        assert (done.stdout, done.stderr, done.returncode) == (PRINTED, "", 0)


@pytest.mark.soak
def test_cramhy_runs_the_same_file(plan, tmp_path):
    words = [sys.executable, "-m", "cramhy_runtime.cli", "run", plan]
    done = subprocess.run(words, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr, done.returncode) == (PRINTED, "", 0)


@pytest.mark.soak
def test_a_file_before_the_prompt_leaves_it_in_lisp(hy_terminal, plan):
    with hy_terminal("-i", plan) as hy:
        assert hy.expect("> $").startswith(PRINTED)
        assert hy.ask("(twice 21)") == "42\nCPL-USER> "
        assert hy.ask("*end*") == "(10 2.0d0)\nCPL-USER> "
        assert hy.ask("(in-hy)") == "=> "
        assert hy.ask("words") == '["of" "Hy"]\n=> '
        assert hy.ask("(in-package :cl-user)") == '#<PACKAGE "COMMON-LISP-USER">\nCL-USER> '


@pytest.mark.soak
def test_a_file_before_the_prompt_may_end_in_hy(hy_terminal, tmp_path):
    (tmp_path / "plan.hy").write_text(FILE + "(in-hy)\n(setv number 7)\n")
    with hy_terminal("-i", str(tmp_path / "plan.hy")) as hy:
        hy.expect("=> $")
        assert hy.ask("[number words]") == '[7 ["of" "Hy"]]\n=> '


@pytest.mark.soak
def test_a_file_that_fails_before_the_prompt_leaves_the_prompt_working(hy_terminal, tmp_path):
    (tmp_path / "plan.hy").write_text(f"{REQUIRE}\n(in-package :cram-user)\n(defvar *begun* 1)\n(car 1)\n(defvar *never* 1)\n")
    with hy_terminal("-i", str(tmp_path / "plan.hy")) as hy:
        hy.expect("> $")
        assert hy.ask("*begun*") == "1\nCPL-USER> "


@pytest.mark.soak
def test_the_last_value_of_a_file_before_the_prompt_prints_as_lisp_prints_it(hy_terminal, tmp_path):
    (tmp_path / "plan.hy").write_text(f'{REQUIRE}\n(in-package :cram-user)\n(list \'a "b" 2.0d0)\n')
    with hy_terminal("-i", str(tmp_path / "plan.hy")) as hy:
        assert hy.expect("> $").startswith('(A "b" 2.0d0)\n')


@pytest.mark.soak
def test_code_of_the_command_line(hy):
    code = f"{REQUIRE} (in-package :cram-user) (print (list 1 2.0d0)) (in-hy) (print [1 2])"
    done = hy("-c", code)
    assert (done.stdout, done.stderr, done.returncode) == ("\n(1 2.0d0) [1, 2]\n", "", 0)


@pytest.mark.soak
def test_code_of_the_command_line_before_the_prompt(hy_terminal):
    with hy_terminal("-i", "-c", f"{REQUIRE} (in-package :cram-user) (defvar *mine* 5)") as hy:
        hy.expect("CPL-USER> $")
        assert hy.ask("*mine*") == "5\nCPL-USER> "


@pytest.mark.soak
def test_a_pipe_with_prompts_of_hy(hy):
    done = hy("-i", input=f"{REQUIRE}\n(in-package :cl-user)\n(list 1\n2)\n(car 1)\n:abort\n(in-hy)\n[1 2]\n(in-package :cl-user)\n(list 3")
    shown = re.sub(r"\ndebugger invoked.*?\n0\] ", "<debugger>", done.stdout, flags=re.S)
    package = '#<PACKAGE "COMMON-LISP-USER">\n'
    assert shown == (
        f"=> => {package}CL-USER> ... (1 2)\nCL-USER> <debugger>CL-USER> => [1 2]\n=> {package}CL-USER> ... <debugger>CL-USER> "
    )


VIRTUAL = "(print (. (hy.I.cramhy_runtime/kernel.active) clock virtual))"


@pytest.mark.soak
def test_a_pipe_is_in_virtual_time(hy):
    text = f"{REQUIRE}\n(in-package :cl-user)\n(sleep 3600)\n(in-hy)\n{VIRTUAL}\n"
    assert hy(input=text).stdout.endswith("\nCL-USER> NIL\nCL-USER> True\n")


@pytest.mark.soak
@pytest.mark.parametrize("time, virtual", [(None, "False"), ("wall", "False"), ("virtual", "True")])
def test_a_prompt_is_in_wall_time_if_nothing_else_is_said(hy_terminal, time, virtual):
    with hy_terminal(time=time) as hy:
        hy.begin_hy()
        assert hy.ask(VIRTUAL) == f"{virtual}\n=> "
        assert hy.ask("(in-package :cl-user)") == '#<PACKAGE "COMMON-LISP-USER">\nCL-USER> '
        hy.ask("(in-hy)")
        assert hy.ask(VIRTUAL) == f"{virtual}\n=> "


@pytest.mark.soak
@pytest.mark.parametrize("words", ["hy.REPL(locals={**globals()}).run()", "(lambda: hy.REPL(locals={**globals(), **locals()}).run())()"])
def test_the_repl_of_hy_in_a_python_program(words):
    program = f"import hy\nx = 41\n{words}\nprint('goes on')"
    with Door(program=[sys.executable, "-c", program]) as repl:
        repl.begin_lisp()
        assert repl.ask("(list 1 2.0d0)") == "(1 2.0d0)\nCL-USER> "
        assert repl.ask("(in-hy)") == "=> "
        assert repl.ask("(+ x 1)") == "42\n=> "
        assert repl.ask("(in-package :cram-user)") == '#<PACKAGE "CRAM-USER">\nCPL-USER> '
        assert repl.end() == 0
        assert repl.text.endswith("goes on\n")


@pytest.mark.soak
def test_an_error_after_the_repl_in_a_python_program_opens_no_debugger():
    after = "from cramhy_runtime.lisp_core.conditions import error\ntry:\n    error('Lost.')\nexcept BaseException as problem:\n    print('told', problem)"
    program = f"import hy\nhy.REPL(locals={{**globals()}}).run()\n{after}"
    with Door(program=[sys.executable, "-c", program]) as repl:
        repl.begin_lisp()
        assert repl.end() == 0
        assert repl.text.endswith("told Lost.\n")


@pytest.mark.soak
def test_cramhy_repl_begins_in_hy():
    with Door("repl", "--hy", "--time", "virtual") as repl:
        repl.continuation = r"\n\.\.\. $"
        repl.expect("=> $")
        assert repl.ask("(top-level (par 1 2))") == "1\n=> "
        assert repl.ask("(in-package :cl-user)") == '#<PACKAGE "COMMON-LISP-USER">\nCL-USER> '
        assert repl.ask("(progn (sleep 3600)\n (list 1))") == "(1)\nCL-USER> "
        assert repl.ask("(in-hy)") == "=> "
        assert repl.end() == 0


@pytest.mark.parametrize(("options", "text"), [(["--hy"], "(import mine) mine.number\n"), ([], "(py:import mine) mine:number\n")])
def test_a_prompt_finds_modules_of_the_current_folder(tmp_path, options, text):
    (tmp_path / "mine.py").write_text("number = 42\n")
    (tmp_path / "random.py").write_text("raise SystemExit('Python has a module of that name')\n")
    words = [sys.executable, "-P", "-m", "cramhy_runtime.cli", "repl", *options]
    done = subprocess.run(words, input=text, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert "42\n" in done.stdout and done.returncode == 0, done.stdout + done.stderr


@pytest.mark.soak
def test_cramhy_repl_in_hy_from_a_pipe(tmp_path):
    words = [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--hy", "--eval", "(defvar cl-user::*mine* 5)"]
    text = "[1 2]\n(in-package :cl-user)\n*mine*\n(exit :code 4)\n"
    done = subprocess.run(words, input=text, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=60)
    assert done.stdout == '=> [1 2]\n=> #<PACKAGE "COMMON-LISP-USER">\nCL-USER> 5\nCL-USER> '
    assert done.returncode == 4
