"""What is typed at a ``hy`` prompt after ``(in-package ...)``: each complete form is answered, as ``roslisp_repl`` answers it."""

from __future__ import annotations

import pytest

from .conftest import REQUIRE, stable

TYPED = {
    "a number that is printed": "(print 7)",
    "a list of a double float": "(list 1 2.0d0)",
    "nil": "nil",
    "no value": "(values)",
    "two values": "(values 1 'two)",
    "a string with quotes": '"a \\"quoted\\" word"',
    "a character": "#\\a",
    "a function, which begins as a comment of Python does": "#'car",
    "a feature": "#+sbcl 1 #-sbcl 2",
    "output that ends in the middle of a line": '(princ "left")',
    "output to a fresh line": '(format t "~&a~%b~&")',
    "three forms in one line": "(print 1) (values) (list 2 3)",
    "two forms, of which the first says how the second is read": "(defpackage :door (:use :cl)) (list (find-package :door) 'door::inner)",
    "a form over several lines": "(list 1\n  2\n  3)",
    "a string over several lines": '(length "a\nb")',
    "a symbol over several lines": "'|a\nb|",
    "a comment over several lines, and a form": "#| what\nis this |# (list 4)",
    "a closing parenthesis too many": "(list 1))",
    "nothing but a closing parenthesis": ")",
    "a warning": "(defun door () (no-such-function))",
    "a macro and its use": "(progn (defmacro twice (x) `(* 2 ,x)) (twice 4))",
    "a package, and back": "(in-package :cl-user) (list 1) (in-package :cram-user)",
    "the last values": "(list * ** /)",
    "a plan": "(top-level (par 1 (sleep 1)))",
    "a fluent": "(make-fluent :name 'door :value 1)",
}


@pytest.fixture(scope="module")
def answers(request):
    """The answers of ``hy`` and of ``roslisp_repl`` to all that is `TYPED`, one after the other in the same two terminals."""
    from .conftest import HY, Door

    with Door(program=[str(HY)]) as hy, Door("repl") as roslisp:
        roslisp.expect("> $")
        roslisp.ask("(in-package :cram-user)")
        assert hy.begin_lisp(":cram-user") == '#<PACKAGE "CRAM-USER">\nCPL-USER> '
        return {name: (stable(hy.ask(text)), stable(roslisp.ask(text))) for name, text in TYPED.items()}


@pytest.mark.parametrize("name", TYPED)
def test_it_is_answered_as_roslisp_repl_answers(answers, name):
    answer, expected = answers[name]
    assert answer == expected
    assert answer.strip() != "CPL-USER>", "it is answered"


@pytest.mark.soak
def test_some_answers_as_they_stand_there(answers):
    assert answers["a number that is printed"][0] == "\n7 \n7\nCPL-USER> "
    assert answers["a list of a double float"][0] == "(1 2.0d0)\nCPL-USER> "
    assert answers["no value"][0] == "; No value\nCPL-USER> "
    assert answers["two values"][0] == "1\nTWO\nCPL-USER> "
    assert answers["a string with quotes"][0] == '"a \\"quoted\\" word"\nCPL-USER> '
    assert answers["three forms in one line"][0] == "\n1 \n1\n; No value\n(2 3)\nCPL-USER> "


MISTAKES = {
    "a package that is not there": ["nowhere:name", "5"],
    "a function that is not there": ["(prnt 7)", "4"],
    "a variable that is not there": ["nothing", "(+ 1 2)", "7", ":abort"],
    "a type that is wrong": ["(car 1)", "(car 2)", "0", "0"],
    "a malformed form": ["(let)", ":abort"],
    "a failure": ['(top-level (par (sleep 1) (fail "Lost.")))', ":abort"],
    "a choice that gives a value": ["(list (no-function 1))", "2", "'(mine)"],
    "a dot": ["(1 . )", ":abort"],
}


@pytest.mark.soak
def test_mistakes_open_the_debugger_as_in_roslisp_repl(hy_terminal, roslisp_terminal):
    with hy_terminal() as hy, roslisp_terminal() as roslisp:
        roslisp.expect("> $")
        roslisp.ask("(in-package :cram-user)")
        hy.begin_lisp(":cram-user")
        for name, texts in MISTAKES.items():
            for text in texts:
                answer, expected = stable(hy.ask(text)), stable(roslisp.ask(text))
                assert answer == expected, (name, text)
            assert hy.ask("(+ 1 2)") == roslisp.ask("(+ 1 2)") == "3\nCPL-USER> ", name


@pytest.mark.soak
def test_mistakes_in_a_pipe_are_told_as_by_roslisp_repl(hy, roslisp):
    text = "(in-package :cram-user)\n" + "\n".join(text for texts in MISTAKES.values() for text in texts) + "\n(list 1\n"
    answered, expected = hy(input=f"{REQUIRE}\n{text}"), roslisp(text)
    assert stable(answered.stdout) == stable(expected.stdout)
    assert answered.stderr == expected.stderr == ""


@pytest.mark.soak
def test_read_line_in_a_pipe_reads_the_next_line(hy):
    done = hy(input=f"{REQUIRE}\n(in-package :cl-user)\n(list (read-line))\nwords of the user\n(+ 1 2)\n")
    assert done.stdout == 'CL-USER> #<PACKAGE "COMMON-LISP-USER">\nCL-USER> ("words of the user")\nCL-USER> 3\nCL-USER> '


@pytest.mark.soak
def test_a_package_that_is_not_there_leaves_the_prompt_in_hy(hy_terminal):
    with hy_terminal() as hy:
        answer = hy.begin_lisp(":nowhere")
        assert 'The name "NOWHERE" does not designate any package.' in answer and answer.endswith("\n0] ")
        assert hy.ask("3") == "=> "
        assert hy.ask("[1 2]") == "[1 2]\n=> "
        assert hy.ask("(in-package :cl-user) (list 1)").endswith('#<PACKAGE "COMMON-LISP-USER">\n(1)\nCL-USER> ')


@pytest.mark.soak
def test_a_package_that_is_defined_at_the_prompt(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_hy()
        assert hy.ask("(defpackage :door (:use :cl))").endswith('#<PACKAGE "DOOR">\n=> ')
        assert hy.ask("(in-package :door)").endswith('#<PACKAGE "DOOR">\nDOOR> ')
        assert hy.ask("'inner") == "INNER\nDOOR> "


@pytest.mark.soak
def test_the_rest_of_the_line_is_lisp_and_may_go_on_in_the_next(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_hy()
        assert hy.ask("(in-package :cl-user) (print 1) (list 'a\n 'b)") == '#<PACKAGE "COMMON-LISP-USER">\n\n1 \n1\n(A B)\nCL-USER> '


@pytest.mark.soak
def test_back_to_hy_and_to_lisp_again(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        assert hy.ask("(defvar *mine* 4)") == "*MINE*\nCL-USER> "
        assert hy.ask("(in-hy)") == "=> "
        assert hy.ask("(setv x [1 2])") == "=> "
        assert hy.ask("x") == "[1 2]\n=> "
        assert hy.ask('(get {"a" 5} "a")') == "5\n=> "
        assert hy.ask("(in-package :cl-user)") == '#<PACKAGE "COMMON-LISP-USER">\nCL-USER> '
        assert hy.ask("*mine*") == "4\nCL-USER> "
        assert hy.ask("(list 1) (in-hy) (+ 1 (len x))") == "(1)\n3\n=> "
        assert hy.ask("(in-hy)") == "=> "


@pytest.mark.soak
def test_a_pipe_back_to_hy_and_to_lisp_again(hy):
    lines = [REQUIRE, "(in-package :cl-user)", "(list 1)", "(in-hy) (setv x 5)", "(print x)", "(in-package :cram-user)", "(list 2)"]
    done = hy(input="\n".join(lines) + "\n")
    assert done.stdout == (
        'CL-USER> #<PACKAGE "COMMON-LISP-USER">\nCL-USER> (1)\nCL-USER> 5\nCL-USER> #<PACKAGE "CRAM-USER">\nCPL-USER> (2)\nCPL-USER> '
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.soak
def test_a_macro_of_the_user_may_lead_to_lisp(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_hy()
        hy.ask("(defmacro lisp [] '(in-package :cl-user))")
        assert hy.ask("(lisp) (list 1)") == '#<PACKAGE "COMMON-LISP-USER">\n(1)\nCL-USER> '


@pytest.mark.soak
def test_warnings_are_where_they_were_after_the_way_back(hy):
    form = '(hy.I.cramhy_runtime/languages/commonlisp/streams/streams.ERROR-OUTPUT.value.write "warned")'
    assert hy("-i", input=f"{REQUIRE}\n(in-package :cl-user)\n(in-hy)\n{form}\n").stderr.count("warned") == 1


@pytest.mark.soak
def test_a_kernel_that_is_stopped_at_the_prompt(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_hy()
        hy.ask("(hy.I.cramhy_runtime/kernel.stop)")
        assert hy.ask("(+ 1 2)").endswith("3\n=> ")


SUBSCRIBE = (
    '(roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (pose) (declare (ignore pose)) (format t "~&a pose~%") (finish-output)))'
)


@pytest.mark.soak
def test_the_turtle_goes_on_while_the_prompt_waits_in_wall_time(hy_terminal):
    with hy_terminal(time="wall") as hy:
        hy.begin_lisp(":cram-user")
        hy.ask('(roslisp:start-ros-node "door")')
        hy.type(SUBSCRIBE)
        for _ in range(3):  # nothing is typed meanwhile
            hy.expect("a pose\n")


PASTED = "(list 1\n 2)\n(read-line)\nhello you\n(list 3)\n(car 1)\n0\n(in-hy)\n[1 2]\n(in-package :cl-user)\n'the-end"


@pytest.mark.soak
def test_many_lines_that_are_pasted_are_all_answered(hy_terminal):
    with hy_terminal() as hy:
        hy.begin_lisp()
        hy.type(PASTED)
        for answer in (
            r"\(1 2\)\n",
            '"hello you"\nNIL\n',
            r"\(3\)\n",
            "debugger invoked on a TYPE-ERROR",
            r"\[1 2\]\n",
            "#<PACKAGE",
            "THE-END\n",
        ):
            hy.expect(answer)
        assert hy.expect("> $") == "CL-USER> "


SHOWN = {
    "(make-fluent :name 'door)": "#<FLUENT DOOR [NIL]>",
    "(lisp drive)": "DRIVE",
    '(lisp (1 (drive) "a"))': '(1 (DRIVE) "a")',
    "(make-3d-vector 1 2 3)": "#<3D-VECTOR (1.0 2.0 3.0)>",
    '(make-msg "std_msgs/String" :data "a")': '[STD_MSGS-MSG:STRING\n   DATA:\n     "a"]',
    "(reference (a motion (type halving)))": '("half" Half())',
    "(lisp-package :door)": None,
    '[1 2.5 "a" True None]': '[1 2.5 "a" True None]',
    "'(drive [x])": "'(drive [x])",
}


HALVING = """(def-fact-group halving [motion-grounding] (<- (motion-grounding ?desig ["half" ?number])
  (desig-prop ?desig (type halving)) (lisp-fun Half ?number))) None"""


@pytest.mark.soak
def test_values_of_plans_print_in_hy_as_lisp_prints_them_and_others_as_hy_does(hy_terminal):
    with hy_terminal() as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        hy.ask('(defclass Half [] (defn __repr__ [self] "Half()"))')
        hy.ask(" ".join(HALVING.split()))
        for text, shown in SHOWN.items():
            assert hy.ask(text) == ("=> " if shown is None else f"{shown}\n=> "), text
        assert hy.ask("None") == hy.ask("(setv door 5)") == "=> "


@pytest.mark.soak
def test_who_has_chosen_how_values_are_shown_keeps_it(hy):
    assert (
        hy("--repl-output-fn", "repr", "-i", input=f'{REQUIRE}\n(make-msg "std_msgs/String" :data "a")\n').stdout
        == "=> => String(data='a')\n=> "
    )


TOGETHER = {
    "(+ 1 2) (+ 3 4)": "3\n7\n=> ",
    "(setv door 5) door (* door door)": "5\n25\n=> ",
    '#_ (+ 1 2) \'a "b" ; and a comment': '\'a\n"b"\n=> ',
    "(print 1) (+ 1\n 2)": "1\n3\n=> ",
    "(defreader door 5) #door": "5\n=> ",
    "(+ 1 2) (top-level (par-loop 1 2)) (+ 3 4) door": "; Not evaluated: (+ 3 4) door\n=> ",
    '(top-level (fail "Lost.")) (+ 3 4)': "; Not evaluated: (+ 3 4)\n=> ",
    "(+ 1 2) (in-package :cl-user) (list 1)": '3\n#<PACKAGE "COMMON-LISP-USER">\n(1)\nCL-USER> ',
    "(list 1) (in-hy) (+ 1 2) (+ 3 4)": "(1)\n3\n7\n=> ",
    "(+ 1 2) (in-package :cl-user) (list '|a\nb|)": '3\n#<PACKAGE "COMMON-LISP-USER">\n(|a\nb|)\nCL-USER> ',
}


@pytest.mark.soak
def test_each_of_several_forms_that_are_entered_at_once_is_answered(hy_terminal):
    with hy_terminal() as hy:
        hy.expect("=> $")
        hy.ask(REQUIRE)
        for text, answer in TOGETHER.items():
            assert hy.ask(text).endswith(answer), text


@pytest.mark.soak
@pytest.mark.parametrize("beginning, define", [(REQUIRE, "(defn f [x]\n  (+ x 1))"), ("(in-package :cl-user)", "(defun f (x)\n  (+ x 1))")])
def test_each_form_is_answered_that_a_terminal_marks_as_pasted(hy_terminal, beginning, define):
    with hy_terminal(variables={"TERM": "xterm"}) as hy:
        hy.expect("=> $")
        for text in dict.fromkeys((REQUIRE, beginning)):
            hy.type(text)
            hy.expect(r"\n\S*> $")
        hy.press(f"\x1b[200~{define}\n(f 1)\n(f 5)\n\x1b[201~\n")
        hy.expect(r"\n2\n6\n\S*> $")


def test_what_stands_behind_a_form_that_failed_is_not_left_away_in_silence(roslisp):
    answered = roslisp("(car 1) (print 2) (print\n 3)\n0\n(list nowhere:x) (list 4)\n:abort\n(car 1))\n0\n(list 5)\n").stdout
    assert answered.count("; Not evaluated") == 2
    assert "returning to top level.\n; Not evaluated so far: (print 2) (print 3)\n0] CL-USER> " in answered
    assert "0] ; Not evaluated: (list 4)\nCL-USER> " in answered
    assert answered.endswith("0] CL-USER> (5)\nCL-USER> ")


BACK_IN_HY = {
    "a bracket too many": ("(print 1))", "cramhy: SYNTAX-ERROR\n  There is a ) too many", "\n  at <stdin>:4:10\n    (print 1))\n"),
    "an operator of another shape": ("(top-level (par-loop 1 2))", "cramhy: SYNTAX-ERROR\n", "\n  at <stdin>:4:12\n"),
    "an exception of Python's": ("(/ 1 0)", 'Traceback (most recent call last):\n  File "<stdin>", line 4, in <module>\n    (/ 1 0)\n', ""),
    "a plan that fails": (
        '(top-level (fail "Lost."))',
        "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n",
        "\n  at <stdin>:4:12\n",
    ),
}


@pytest.mark.soak
@pytest.mark.parametrize("what", BACK_IN_HY)
def test_an_error_in_a_pipe_that_is_back_in_hy_has_its_place(hy, what):
    text, begins, place = BACK_IN_HY[what]
    done = hy(input=f"{REQUIRE}\n(in-package :cl-user)\n(list 1)  (in-hy)\n{text}\n")
    assert done.stderr.startswith(begins) and place in done.stderr and "runtime" not in done.stderr
    assert done.returncode == 1
