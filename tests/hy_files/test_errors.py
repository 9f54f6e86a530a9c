"""An error that ends a program is told by ``hy FILE`` as by ``cramhy run FILE``: what, where, why, what to try, and no internal frame."""

import re

import pytest

PLAIN = "(require cramhy *)\n(import cramhy_runtime.cpl *)\n"
LISP = "(require cramhy *)\n(in-package :cram-user)\n"

TOLD = {
    "a plan in Hy that fails": (
        PLAIN + '(defn drive [x]\n  (fail "Nobody drives."))\n(print 1)\n(top-level (par (sleep 1) (drive 5)))\n',
        "1\n",
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n"
        "  Nobody drives.\n"
        "  at plan.hy:4:3\n"
        '      (fail "Nobody drives."))\n'
        "      ^\n",
    ),
    "a plan in Common Lisp that fails": (
        LISP + '(defun drive (x)\n  (fail "Nobody drives ~a." x))\n(print 1)\n(top-level (par (sleep 1) (drive 5)))\n',
        "\n1 \n",
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n"
        "  Nobody drives 5.\n"
        "  at plan.hy:4:3\n"
        '      (fail "Nobody drives ~a." x))\n'
        "      ^\n",
    ),
    "an exception of Python's in Hy": (
        PLAIN + '(defn find [x]\n  (get {} x))\n(top-level (par (sleep 1) (find "k")))\n',
        "",
        "Traceback (most recent call last):\n"
        '  File "{folder}/plan.hy", line 5, in <module>\n'
        '    (top-level (par (sleep 1) (find "k")))\n'
        '  File "{folder}/plan.hy", line 5, in <lambda>\n'
        '    (top-level (par (sleep 1) (find "k")))\n'
        '  File "{folder}/plan.hy", line 5, in <lambda>\n'
        '    (top-level (par (sleep 1) (find "k")))\n'
        '  File "{folder}/plan.hy", line 4, in find\n'
        "    (get {} x))\n"
        "KeyError: 'k'\n",
    ),
    "an exception of Python's in Common Lisp": (
        LISP + '(defun find-it (x)\n  (py:call "int" x))\n(find-it "k")\n',
        "",
        "cramhy: PYTHON:VALUE-ERROR\n"
        "  invalid literal for int() with base 10: 'k'\n"
        "  at plan.hy:4:3\n"
        '      (py:call "int" x))\n'
        "      ^\n",
    ),
    "a misspelt operator in Hy": (
        PLAIN + "(top-level (purse (sleep 1)))\n",
        "",
        "Traceback (most recent call last):\n"
        '  File "{folder}/plan.hy", line 3, in <module>\n'
        "    (top-level (purse (sleep 1)))\n"
        '  File "{folder}/plan.hy", line 3, in <lambda>\n'
        "    (top-level (purse (sleep 1)))\n"
        "NameError: name 'purse' is not defined\n"
        "  Did you mean pursue or pulse?\n",
    ),
    "a malformed form of Hy's": (
        PLAIN + "(print 1)\n(defn drive []\n  (let ((x 1)) x))\n",
        "",
        "cramhy: SYNTAX-ERROR\n"
        "  The let form is malformed: a part of it has another shape; expected: List (i.e., `[ … ]`).\n"
        "  at plan.hy:5:8\n"
        "      (let ((x 1)) x))\n"
        "           ^\n"
        "  It is written (let [name value ...] form...).\n",
    ),
    "a malformed operator in Common Lisp": (
        LISP + "(print 1)\n(defun drive ()\n  (with-task-suspended))\n(print 2)\n",
        "\n1 \n",
        "cramhy: CRAMHY::COMPILE-ERROR\n"
        "  The WITH-TASK-SUSPENDED form (CRAM-LANGUAGE-IMPLEMENTATION:WITH-TASK-SUSPENDED) is malformed: "
        "it has the wrong number of parts, or a part is not a list.\n"
        "  at plan.hy:5:3\n"
        "      (with-task-suspended))\n"
        "      ^\n"
        "  It is written (with-task-suspended (task [:reason text]) form...).\n",
    ),
    "a macro of the user's that fails": (
        PLAIN + '(defmacro twice [form]\n  (get {} "k"))\n(defn drive []\n  (twice 4))\n',
        "",
        "cramhy: SYNTAX-ERROR\n"
        "  The twice form cannot be compiled: KeyError: 'k'\n"
        "  at plan.hy:6:3\n"
        "      (twice 4))\n"
        "      ^\n"
        "  in the macro at plan.hy:4:3\n"
        '      (get {} "k"))\n'
        "      ^\n",
    ),
    "a form of Hy that is never closed": (
        PLAIN + "(print 1)\n(top-level\n  (par (sleep 1)\n",
        "",
        "cramhy: SYNTAX-ERROR\n"
        "  The text ends inside of a form.\n"
        "  at plan.hy:4:1\n"
        "    (top-level\n"
        "    ^\n"
        "  The ( at line 4, column 1 is never closed. 2 are open at the end; the innermost begins at line 5, column 3.\n",
    ),
    "a bracket too many in Hy": (
        PLAIN + "(print 1))\n",
        "",
        "cramhy: SYNTAX-ERROR\n"
        "  There is a ) too many, or one that does not fit the bracket that is open.\n"
        "  at plan.hy:3:10\n"
        "    (print 1))\n"
        "             ^\n",
    ),
    "a form of Common Lisp that is never closed": (
        LISP + "(print 1)\n(top-level\n  (par (sleep 1)\n",
        "\n1 \n",
        "cramhy: END-OF-FILE\n"
        "  end of file on #<SB-SYS:FD-STREAM {1001000043}>\n"
        "  at plan.hy:4:1\n"
        "  (top-level\n"
        "  ^\n"
        "  The ( at line 4, column 1 is never closed. 2 are open at the end; the innermost begins at line 5, column 3.\n",
    ),
    "a form of Common Lisp in a Hy file": (
        PLAIN + "(print 1)\n(defun drive (x) x)\n",
        "1\n",
        "Traceback (most recent call last):\n"
        '  File "{folder}/plan.hy", line 4, in <module>\n'
        "    (defun drive (x) x)\n"
        "NameError: name 'defun' is not defined\n"
        "  defun is Common Lisp. In Hy it is written (defn name [parameter ...] form...). Common Lisp begins after (in-package name).\n",
    ),
    "a package that is not there": (
        "(require cramhy *)\n(in-package :nowhere)\n(print 1)\n",
        "",
        "cramhy: SB-EXT:PACKAGE-DOES-NOT-EXIST\n"
        '  The name "NOWHERE" does not designate any package.\n'
        "  at plan.hy:2:1\n"
        "    (in-package :nowhere)\n"
        "    ^\n"
        "  Is the system that defines it loaded?\n",
    ),
    "a macro that is required and not there": (
        "(require cramhy *)\n(require nothing-there [x])\n",
        "",
        "cramhy: SYNTAX-ERROR\n  No module named 'nothing_there'\n  at plan.hy:2:1\n    (require nothing-there [x])\n    ^\n",
    ),
}


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
@pytest.mark.parametrize("what", TOLD)
def test_it_is_told(write, program, tmp_path, what, way):
    text, printed, told = TOLD[what]
    write("plan.hy", text)
    done = program(way, "plan.hy")
    shown = re.sub(r"^ +[~^]+\n", "", done.stderr, flags=re.M) if told.startswith("Traceback") else done.stderr  # Pythons differ in these
    shown = re.sub(r"(name '\w+' is not defined)\. Did you mean: '\w+'\?", r"\1", shown)  # from Python 3.13 on; the next line is ours
    shown, told = (re.sub(r", in (<lambda>|_hy_anon_\d+)\n", ", in a branch\n", each) for each in (shown, told))
    assert (done.returncode, done.stdout, shown) == (1, printed, told.replace("{folder}", str(tmp_path)))


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_form_of_hy_in_common_lisp_is_taken_for_a_call(write, program, way):
    write("plan.hy", LISP + "(print 1)\n(defn drive [x] x)\n")
    done = program(way, "plan.hy")
    assert done.stdout == "\n1 \n"
    ahead = "; caught STYLE-WARNING:\n;   undefined function: CRAM-USER::DEFN\n;   at plan.hy:4:1\n;     (defn drive [x] x)\n;     ^\n;   defn is Hy. In Common Lisp it is written (defun"
    error = "cramhy: UNBOUND-VARIABLE\n  The variable CRAM-USER::DRIVE is unbound.\n  at plan.hy:4:7\n    (defn drive [x] x)\n          ^\n"
    if way == "hy":  # all forms are compiled before the first one runs
        assert done.stderr.startswith(ahead) and done.stderr.endswith(error) and done.stderr.count("caught") == 1
    else:
        called = "  Nobody has defined defn here, so (defn ...) is taken for a call, whose arguments are evaluated.\n"
        assert done.stderr.startswith(f"{error}{called}  defn is Hy. In Common Lisp it is written (defun") and "caught" not in done.stderr


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_the_error_of_an_imported_module_has_its_place_there(write, program, way):
    write("broken.hy", "(require cramhy *)\n(defn drive []\n  (with-task-suspended 5))\n")
    write("plan.hy", "(print 1)\n(import broken)\n")
    done = program(way, "plan.hy")
    assert (done.returncode, done.stdout) == (1, "1\n")
    assert done.stderr.startswith("cramhy: SYNTAX-ERROR\n  The form (with-task-suspended 5) is malformed: ")
    assert "\n  at broken.hy:3:3\n      (with-task-suspended 5))\n      ^\n" in done.stderr


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_the_exceptions_behind_one_are_shown_as_python_shows_them(write, program, way):
    write(
        "plan.hy",
        PLAIN
        + '(defn drive []\n  (try (/ 1 0)\n    (except [e ZeroDivisionError] (raise (ValueError "way") :from e))))\n(top-level (drive))\n',
    )
    told = program(way, "plan.hy").stderr
    assert told.index("ZeroDivisionError: division by zero\n\nThe above exception was the direct cause") < told.index("ValueError: way\n")
    assert "cramhy_runtime" not in told and "runpy" not in told


@pytest.mark.soak
@pytest.mark.parametrize(("word", "shown"), [("lisp", "calls, the innermost last:"), ("1", "Python frames:"), ("none", None), ("", None)])
@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_variable_asks_for_the_calls(write, program, way, word, shown):
    write("plan.hy", TOLD["a plan in Common Lisp that fails"][0])
    told = program(way, "plan.hy", CRAMHY_BACKTRACE=word).stderr
    assert (shown in told) if shown else told == TOLD["a plan in Common Lisp that fails"][2]
    assert program("run", "plan.hy", "--backtrace", "none", CRAMHY_BACKTRACE=word).stderr == TOLD["a plan in Common Lisp that fails"][2]


@pytest.mark.soak
def test_all_frames_are_shown_when_they_are_asked_for(write, program):
    write("plan.hy", TOLD["an exception of Python's in Hy"][0])
    assert "cpl/failures/python_exceptions.py" in program("hy", "plan.hy", CRAMHY_BACKTRACE="python").stderr


@pytest.mark.soak
def test_a_program_with_a_hook_of_its_own_keeps_it(write, program):
    write(
        "plan.hy",
        '(import sys)\n(setv sys.excepthook (fn [#* problem] (print "mine:" (get problem 1))))\n' + PLAIN + '(top-level (fail "Lost."))\n',
    )
    done = program("hy", "plan.hy")
    assert (done.returncode, done.stdout, done.stderr) == (1, "mine: Lost.\n", "")


@pytest.mark.soak
def test_what_python_does_not_call_an_error_has_its_own_status(write, program):
    write("plan.hy", PLAIN + "(import sys)\n(sys.exit 7)\n")
    assert [program(way, "plan.hy").returncode for way in ("hy", "run")] == [7, 7]


IN_HY = [
    "a plan in Hy that fails",
    "an exception of Python's in Hy",
    "a misspelt operator in Hy",
    "a malformed form of Hy's",
    "a macro of the user's that fails",
    "a form of Hy that is never closed",
    "a bracket too many in Hy",
]


@pytest.mark.soak
@pytest.mark.parametrize("what", IN_HY)
def test_what_is_piped_and_what_stands_in_the_command_line_is_told_as_a_file_is(python, tmp_path, what):
    """What follows ``(in-package ...)`` in a pipe is answered as by ``roslisp_repl``: see tests/hy_door."""
    text, printed, told = TOLD[what]
    for name, done in {"<stdin>": python("-m", "hy", input=text), "<string>": python("-m", "hy", "-c", text)}.items():
        shown = re.sub(r"^ +[~^]+\n", "", done.stderr, flags=re.M) if told.startswith("Traceback") else done.stderr
        shown = re.sub(r", in (<lambda>|_hy_anon_\d+)\n", ", in <lambda>\n", shown)
        expected = told.replace("{folder}/plan.hy", name).replace("plan.hy", name)
        assert (done.returncode, done.stdout, shown) == (1, printed, expected)


@pytest.mark.soak
def test_common_lisp_in_the_command_line_shows_the_line_of_its_error(python):
    done = python("-m", "hy", "-c", "(require cramhy *) (in-package :cram-user) (print 1) (car 2)")
    assert (done.returncode, done.stdout) == (1, "\n1 \n")
    assert "at <string>:1:54\n    (require cramhy *) (in-package :cram-user) (print 1) (car 2)\n" in done.stderr


@pytest.mark.soak
def test_a_function_of_a_lisp_package_is_named_with_its_module(write, program):
    write("parts.lisp", "(defpackage :parts (:use :cl))\n(in-package :parts)\n(defun drive-on (x) x)\n(defvar *speed* 1)\n")
    write("plan.hy", "(require cramhy *)\n(import cramhy)\n(import parts)\n(print (parts.drive-on 5))\n(drive-on 5)\n")
    done = program("hy", "plan.hy")
    assert done.stdout == "5\n"
    assert done.stderr.splitlines()[-2:] == ["NameError: name 'drive-on' is not defined", "  drive-on is a name of parts: parts.drive-on"]
    write("other.hy", "(require cramhy *)\n(import parts [drive-on :as go])\n(go 5)\n(drive-on 5)\n")
    assert program("hy", "other.hy").stderr.splitlines()[-1] == (
        "  drive-on is a function of the Lisp package PARTS. In Hy it is called by its module: (import parts), then (parts.drive-on ...)."
    )


@pytest.mark.soak
@pytest.mark.parametrize(
    "text, told",
    [
        ("(retry)", "  (retry) stands inside (with-failure-handling [clause...] form...), in a clause or among the forms."),
        ("(leave 3)", "  (leave value) stands inside (with-failure-handling [clause...] form...), in a clause."),
        ('(make-msg "geometry_msgs/Vector3" :x 1)\n(print x)', "NameError: name 'x' is not defined"),
        ("(defn go [?where] ?where)\n(go)", "  The function GO takes 1 argument."),
    ],
)
def test_a_name_of_hy_is_told_in_words_of_hy(write, program, text, told):
    write("plan.hy", f"(require cramhy *)\n{text}\n")
    shown = program("hy", "plan.hy").stderr
    assert shown.splitlines()[-1] == told and "hyx_" not in shown


@pytest.mark.soak
@pytest.mark.parametrize(
    "text, operator",
    [
        ("(par (print 1) (print 2))\n", "par"),
        ("(defn drive [] (seq 1 2))\n(drive)\n", "seq"),
        ("(def-cram-function drive [] 1)\n", "def-cram-function"),
        ("(with-failure-handling [(simple-plan-failure [e] (print e) (return))] 1)\n", "with-failure-handling"),
        ("(print 1)\n(top-level (par 1))\n", "top-level"),
        ("(require cramhy [par])\n(pursue (par 1) (par 2))\n", "pursue"),
    ],
)
def test_an_operator_that_was_not_required_is_told_of(write, program, text, operator):
    write("plan.hy", text)
    assert program("run", "plan.hy").stderr.splitlines()[-1] == (
        f"  {operator} is an operator of cramhy. Begin the file with (require cramhy *)."
    )


@pytest.mark.soak
@pytest.mark.parametrize("text", ["(require cramhy *)\n(print par)\n", "(print unknown-word)\n", "(defn f [] (return 1))\n(return)\n"])
def test_other_names_are_not_told_to_be_required(write, program, text):
    write("plan.hy", text)
    shown = program("run", "plan.hy").stderr
    assert "Error" in shown and "Begin the file" not in shown
