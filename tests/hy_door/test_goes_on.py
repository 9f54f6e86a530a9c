"""A prompt of Hy ends when its user ends it, and not by an error, an interrupt, or a file that is run before it comes."""

from __future__ import annotations

import os
import re
import sys

import pytest

from cramhy_runtime.lisp_core.conditions import error, restart_case
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.repl.line_input import NoLines
from cramhy_runtime.repl.listener import Listener

from .conftest import REQUIRE, Door

pytestmark = pytest.mark.soak

ANSWERS = {
    "a plan that fails": (
        '(top-level (par (sleep 1) (fail "Lost.")))',
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n"
        "  Lost.\n"
        "  at {text}:1:27\n"
        '    (top-level (par (sleep 1) (fail "Lost.")))\n'
        "                              ^\n",
    ),
    "a plan form outside of a plan": (
        "(par 1 2)",
        "cramhy: SIMPLE-ERROR\n"
        "  'PAR' form not inside a plan.\n"
        "  at {text}:1:1\n"
        "    (par 1 2)\n"
        "    ^\n"
        "  Plan forms run inside of a plan: write (top-level (par ...)).\n",
    ),
    "a call of several lines": (
        '(top-level\n  (sleep\n    "x"))',
        'cramhy: TYPE-ERROR\n  The value\n    "x"\n  is not of type\n    REAL\n  at {text}:2:3\n      (sleep\n      ^\n',
    ),
    "an operator of several lines": (
        "(top-level\n  (with-process-modules-running\n    [nowhere] 1))",
        "cramhy: CRAM-PROCESS-MODULES::UNKNOWN-PROCESS-MODULE\n"
        "  Unknown process module: NOWHERE \n"
        "  at {text}:2:3\n"
        "      (with-process-modules-running\n"
        "      ^\n"
        "  Running now: none. Defined: none.\n",
    ),
    "an exception of Python's that is no failure": (
        "(top-level (/ 1 0))",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (top-level (/ 1 0))\n'
        '  File "{text}", line 1, in <lambda>\n    (top-level (/ 1 0))\nZeroDivisionError: division by zero\n',
    ),
    "a macro that fails as a plan does": (
        '(defmacro lost [] (top-level (fail "Lost."))) (lost)',
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  Lost.\n"
        "  at {text}:1:30\n"
        '    (defmacro lost [] (top-level (fail "Lost.")))\n'
        "                                 ^\n",
    ),
    "a misspelt operator": (
        "(top-level (purse 1))",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (top-level (purse 1))\n'
        '  File "{text}", line 1, in <lambda>\n    (top-level (purse 1))\n'
        "NameError: name 'purse' is not defined\n  Did you mean pursue or pulse?\n",
    ),
    "a misspelt operator with its package": (
        "(cpl:purse 1)",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (cpl:purse 1)\n'
        "NameError: name 'cpl:purse' is not defined\n  Did you mean cpl:pursue or cpl::pursue?\n",
    ),
    "a misspelt function of the user's": (
        "(defn pose-cb [] 1) (pose-cbb)",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (pose-cbb)\n'
        "NameError: name 'pose-cbb' is not defined\n  Did you mean pose-cb?\n",
    ),
    "a misspelt form of Hy": (
        "(defnn f [] 1)",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (defnn f [] 1)\n'
        "NameError: name 'defnn' is not defined\n  Did you mean defn?\n",
    ),
    "a variable of a designator that has no value": (
        "(a motion (type ?kind))",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (a motion (type ?kind))\n'
        "NameError: name '?kind' is not defined\n"
        "  In a designator ?kind is the value of a variable of Hy: (let [?kind value] form...).\n",
    ),
    "an operator of another shape": (
        "(top-level (par-loop 1 2))",
        "cramhy: SYNTAX-ERROR\n"
        "  The form (par-loop 1 2) is malformed: it has the wrong number of parts, or a part is not a list.\n"
        "  It is written (par-loop [variable list] form...).\n"
        "  at {text}:1:12\n"
        "    (top-level (par-loop 1 2))\n"
        "               ^\n",
    ),
    "a form of Hy's of another shape": (
        "(let ((x 1)) x)",
        "cramhy: SYNTAX-ERROR\n"
        "  The let form is malformed: a part of it has another shape; expected: List (i.e., `[ … ]`).\n"
        "  at {text}:1:6\n"
        "    (let ((x 1)) x)\n"
        "         ^\n"
        "  It is written (let [name value ...] form...).\n",
    ),
    "a bracket too many": (
        "(+ 1 2))",
        "3\n"
        "cramhy: SYNTAX-ERROR\n"
        "  There is a ) too many, or one that does not fit the bracket that is open.\n"
        "  at {text}:1:8\n"
        "    (+ 1 2))\n"
        "           ^\n",
    ),
    "a form of Common Lisp that Hy writes otherwise": (
        "(defun f (x) x)",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (defun f (x) x)\n'
        "NameError: name 'defun' is not defined\n"
        "  defun is Common Lisp. In Hy it is written (defn name [parameter ...] form...). Common Lisp begins after (in-package name).\n",
    ),
    "a form of Common Lisp that Hy does not have": (
        "(car [1 2])",
        'Traceback (most recent call last):\n  File "{text}", line 1, in <module>\n    (car [1 2])\n'
        "NameError: name 'car' is not defined\n"
        "  car is Common Lisp, and Hy has nothing of that name. Common Lisp begins after (in-package name).\n",
    ),
    "what Common Lisp's reader reads": (
        "#'car",
        "cramhy: SYNTAX-ERROR\n"
        "  reader macro '#'' is not defined\n"
        "  at {text}:1:2\n"
        "    #'car\n"
        "     ^\n"
        "  #' is Common Lisp, where Hy writes the name alone. Common Lisp begins after (in-package name).\n",
    ),
    "in-package without a name": (
        "(in-package)",
        "cramhy: SYNTAX-ERROR\n"
        "  The in-package form cannot be compiled: TypeError: in_package() missing 1 required positional argument: 'name'\n"
        "  at {text}:1:1\n"
        "    (in-package)\n"
        "    ^\n"
        "  It is written (in-package name).\n",
    ),
}


@pytest.fixture(scope="module")
def answers():
    """What one ``hy`` answers to all texts of `ANSWERS`, one after the other, and after each to (+ 1 2)."""
    from .conftest import HY

    if not HY.exists():
        pytest.skip("hy is not installed beside Python")
    with Door(program=[str(HY)]) as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        return {name: (hy.ask(text), hy.ask("(+ 1 2)")) for name, (text, _) in ANSWERS.items()}


@pytest.mark.parametrize("name", ANSWERS)
def test_an_error_at_the_prompt_is_told_and_the_prompt_goes_on(answers, name):
    answer, next_answer = answers[name]
    assert uniform(answer) == ANSWERS[name][1].replace("{text}", "<stdin>") + "=> "
    assert next_answer == "3\n=> "


def uniform(answer):
    """``answer`` without the numbers of the texts, and a traceback without what differs between releases of Python."""
    answer = re.sub(r"<stdin>-\d+", "<stdin>", answer)
    if answer.startswith("Traceback"):
        answer = re.sub(r"^ +[~^]*\n", "", answer, flags=re.M)
        answer = re.sub(r"(?<= is not defined)\. Did you mean: '\w+'\?", "", answer)  # Python's own guess, from 3.12 on
    return re.sub(r", in (<lambda>|_hy_anon_\d+)\n", ", in <lambda>\n", answer)


def test_a_second_ctrl_c_gives_the_cleanup_of_a_plan_in_hy_up(hy_terminal):
    with hy_terminal(time="wall") as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        hy.type('(top-level (try (print "running") (while True (sleep 0.01)) (finally (print "cleaning") (while True (sleep 0.01)))))')
        hy.expect(r"\nrunning\n")
        hy.control_c()
        hy.expect(r"cleaning\n")
        hy.control_c()
        assert "\nKeyboardInterrupt\n" in hy.expect("=> $")
        assert hy.ask("(+ 1 2)") == "3\n=> "


def test_ctrl_d_in_an_unfinished_form_of_hy_is_told(hy_terminal):
    with hy_terminal() as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        assert hy.ask("(print [1").endswith("... ")
        os.write(hy.master, b"\x04")
        assert "The ( at line 1, column 1 is never closed. 2 are open at the end" in hy.expect("=> $")
        assert hy.ask("(in-package :cl-user)").endswith("CL-USER> ")
        assert "The [ at line 1, column 1 is never closed." in hy.ask("(list 1) (in-hy) [1 2")
        assert hy.ask("(+ 1 2)") == "3\n=> "
        assert hy.end() == 0


LISP = f"{REQUIRE}\n(in-package :cram-user)\n"
FILES = {
    "a plan in Hy that fails": (
        f'{REQUIRE}\n(setv begun 1)\n(print "printed")\n(top-level (fail "Lost."))\n(setv never 1)\n',
        "begun",
        'SIMPLE-PLAN-FAILURE\n  Lost.\n  at plan.hy:4:12\n    (top-level (fail "Lost."))\n',
    ),
    "an exception of Python's": (f"{REQUIRE}\n(setv begun 1)\n(/ 1 0)\n", "begun", 'plan.hy", line 3, in <module>\n    (/ 1 0)\n'),
    "an interrupt": (f"{REQUIRE}\n(setv begun 1)\n(raise KeyboardInterrupt)\n", "begun", "\nKeyboardInterrupt\n"),
    "an operator of another shape": (
        f"{REQUIRE}\n(print 1)\n(top-level\n  (par-loop 1 2))\n",
        "(+ 0 1)",
        "\n  at plan.hy:4:3\n      (par-loop 1 2))\n      ^\n",
    ),
    "a form of Hy that is never closed": (
        f"{REQUIRE}\n(print 1)\n(top-level\n",
        "(+ 0 1)",
        "\n  at plan.hy:3:1\n    (top-level\n    ^\n  The ( at line 3, column 1 is never closed.\n",
    ),
    "a bracket too many": (f"{REQUIRE}\n(print 1))\n", "(+ 0 1)", "\n  at plan.hy:2:10\n    (print 1))\n"),
    "a plan in Common Lisp that fails": (
        f'{LISP}(defvar *begun* 1)\n(top-level (fail "Lost."))\n',
        "*begun*",
        'SIMPLE-PLAN-FAILURE\n  Lost.\n  at plan.hy:4:12\n    (top-level (fail "Lost."))\n',
    ),
    "an error of Common Lisp that could be mended": (
        f"{LISP}(defvar *begun* 1)\n(list (no-function 1))\n",
        "*begun*",
        "\n  The function CRAM-USER::NO-FUNCTION is undefined.\n  at plan.hy:4:7\n    (list (no-function 1))\n",
    ),
    "a form of Common Lisp that is never closed": (
        f"{LISP}(defvar *begun* 1)\n(list 1\n",
        "*begun*",
        "\n  at plan.hy:4:1\n  (list 1\n  ^\n  The ( at line 4, column 1 is never closed.\n",
    ),
    "a package that is not there": (
        f"{REQUIRE}\n(in-package :nowhere)\n(list 1)\n",
        "(+ 0 1)",
        '\n  The name "NOWHERE" does not designate any package.\n  at plan.hy:2:1\n    (in-package :nowhere)\n',
    ),
}


@pytest.mark.parametrize("what", FILES)
def test_the_prompt_comes_after_a_file_that_fails(hy, tmp_path, what):
    text, question, told = FILES[what]
    (tmp_path / "plan.hy").write_text(text)
    done = hy("-i", "plan.hy", input=f"{question}\n")
    assert told in done.stderr
    assert re.search(r"(=> |CPL-USER> )1\n\1\Z", done.stdout)
    assert "runtime" not in done.stderr and done.returncode == 0


@pytest.mark.parametrize("what", ["a plan in Hy that fails", "an error of Common Lisp that could be mended"])
def test_the_prompt_comes_on_a_terminal_after_a_file_that_fails(hy_terminal, tmp_path, what):
    text, question, told = FILES[what]
    (tmp_path / "plan.hy").write_text(text)
    with hy_terminal("-i", str(tmp_path / "plan.hy")) as hy:
        assert told.replace("plan.hy", f"{tmp_path}/plan.hy") in hy.expect("(=>|CPL-USER>) $")
        assert hy.ask(question).startswith("1\n")
        assert hy.end() == 0


def test_the_debugger_raises_the_error_at_the_end_of_input_where_nobody_can_go_on(session):
    """``0`` restarts RETRY; nobody has a restart ABORT."""
    told = []
    with pytest.raises(BaseException, match="Lost."), Listener(session, NoLines()).listening():
        restart_case([(sym("RETRY"), lambda: told.append(1), "Retry.")], lambda: error("Lost."))
    assert told == []


BREAKPOINT = f"""\
{REQUIRE}
(defn look [thing]
  (sleep 5)
  (.run (hy.REPL :locals {{#** (globals) #** (locals)}}))
  (sleep 3600)
  "looked")
(print (top-level (par (look "cup") (sleep 1))))
"""


@pytest.mark.parametrize("again", [False, True], ids=["with the macros of the file", "with macros required again"])
def test_a_failure_at_a_prompt_in_the_middle_of_a_plan_ends_neither(hy_terminal, tmp_path, again):
    (tmp_path / "plan.hy").write_text(BREAKPOINT)
    with hy_terminal(str(tmp_path / "plan.hy"), time=None) as hy:
        hy.expect("=> $")
        if again:
            hy.ask(REQUIRE)
        assert hy.ask("thing") == '"cup"\n=> '
        assert "PLAN-FAILURE\n  Lost.\n" in hy.ask('(fail "Lost.")')
        answer = hy.ask("(top-level 5)")
        assert "top-level calls cannot be nested." in answer and "runtime" not in answer
        assert hy.end() == 0  # the plan has kept its virtual time
        assert hy.text.endswith("now exiting REPL...\nlooked\n")


def test_a_prompt_of_another_module_and_a_second_one_go_on_too():
    program = "import hy, sys\nfor name in ('robot', '__main__'):\n    hy.REPL(locals={'__name__': name}).run()"
    with Door(program=[sys.executable, "-c", program]) as repl:
        for _ in range(2):
            repl.expect("=> $")
            repl.ask(REQUIRE)
            assert "PLAN-FAILURE\n  Lost.\n" in repl.ask('(top-level (fail "Lost."))')
            assert repl.ask("(+ 1 2)") == "3\n=> "
            os.write(repl.master, b"\x04")
        assert repl.status() == 0


def test_the_prompt_after_a_file_has_all_operators_and_loops_that_can_be_ended(hy, tmp_path):
    (tmp_path / "plan.hy").write_text(f"{REQUIRE}\n(defn go [] (while True))\n(print (top-level 1))\n")
    asked = "(top-level (pursue (go) (while True) (do (sleep 1) 4)))\n(prolog '(member ?x [2]))\n(with-failure-handling [] (lisp left))\n"
    done = hy("-i", "plan.hy", input=asked, CRAMHY_TIME="virtual")
    answers = [line.removeprefix("=> ") for line in done.stdout.splitlines() if line.startswith("=> ")]
    assert (answers[0], answers[1].strip(), answers[2]) == ("4", "(((?X . 2))", "LEFT")
    assert "Error" not in done.stderr
