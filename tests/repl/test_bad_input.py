"""Bad input costs nothing: one message that says what, where and what to try, and the REPL goes on (law 8)."""

from __future__ import annotations

import re

import pytest

MISSING_CAR = "debugger invoked on a TYPE-ERROR:\n  The value\n    {}\n  is not of type\n    LIST\n  when binding LIST\n"


def message(transcript):
    """What the first debugger of a transcript says, down to its restarts."""
    return transcript.split("\ndebugger invoked on a ", 1)[1].split("\n\nrestarts", 1)[0] + "\n"


def goes_on(transcript):
    return transcript.endswith("CPL-USER> (list 'still 'here)\n(STILL HERE)\n")


@pytest.fixture
def tried(type_in):
    """``tried(form)``: the message of its error, after which the REPL answers as before."""

    def tried(form, before=(), **options):
        transcript = type_in("\n".join([*before, form, ":abort", "(list 'still 'here)"]), **options)
        assert goes_on(transcript), transcript
        return message(transcript)

    return tried


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "(defun a ()\n  (list 1 2)\n\n(defun b () 1)\n",
            """\
END-OF-FILE:
  end of file on #<SB-SYS:FD-STREAM {{address}}>
  at {file}:1:1
  (defun a ()
  ^
  The ( at line 1, column 1 is never closed. Perhaps its ) is missing before line 4, where a new form begins.
""",
        ),
        (
            '1\n(princ "abc)\n',
            """\
END-OF-FILE:
  end of file on #<SB-SYS:FD-STREAM {{address}}>
  at {file}:2:1
  (princ "abc)
  ^
  The ( at line 2, column 1 is never closed. 2 are open at the end; the innermost begins at line 2, column 8.
""",
        ),
        (
            "(in-package :no-such-package)",
            """\
SB-EXT:PACKAGE-DOES-NOT-EXIST:
  The name "NO-SUCH-PACKAGE" does not designate any package.
  at {file}:1:1
    (in-package :no-such-package)
    ^
  Is the system that defines it loaded?
""",
        ),
        (
            "(defun a ()\n  (design:a motion (type x)))",
            """\
SB-INT:SIMPLE-READER-PACKAGE-ERROR:
  Package DESIGN does not exist.
  at {file}:2:4
    (design:a motion (type x)))
     ^
  There is no package DESIGN. Did you mean DESIG?
""",
        ),
        (
            "(desig:no-such 1)",
            """\
SB-INT:SIMPLE-READER-PACKAGE-ERROR:
  Symbol "NO-SUCH" not found in the CRAM-DESIGNATORS package.
  at {file}:1:2
  (desig:no-such 1)
   ^
  CRAM-DESIGNATORS exports no symbol NO-SUCH.
""",
        ),
        (
            "(list 1 #<foo>)",
            """\
SB-INT:SIMPLE-READER-ERROR:
  illegal sharp macro character: #\\<
  at {file}:1:9
  (list 1 #<foo>)
          ^
  What prints as #<...> cannot be read back.
""",
        ),
        (
            "(list 1\n  (no-such-operator 1))",
            """\
UNDEFINED-FUNCTION:
  The function CRAM-USER::NO-SUCH-OPERATOR is undefined.
  at {file}:2:3
      (no-such-operator 1))
      ^
""",
        ),
        (
            "(list 1\n  turtle-pose)",
            """\
UNBOUND-VARIABLE:
  The variable TURTLE-POSE is unbound.
  at {file}:2:3
      turtle-pose)
      ^
""",
        ),
        (
            "(labels ((f (x) x))\n  (list (f 1 2)))",
            """\
SB-INT:SIMPLE-PROGRAM-ERROR:
  invalid number of arguments: 2
  at {file}:2:9
      (list (f 1 2)))
            ^
  The function F takes 1 argument.
""",
        ),
        (
            '(ros-load:load-system "no-such-system")',
            """\
ASDF:MISSING-COMPONENT:
  Component "no-such-system" not found
  at {file}:1:1
    (ros-load:load-system "no-such-system")
    ^
""",
        ),
    ],
)
def test_a_broken_file(tried, tmp_path, monkeypatch, text, expected):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.lisp").write_text(text)
    said = tried('(load "plan.lisp")')
    said = re.sub(r"\{[0-9A-F]{10}\}", "{address}", said)
    if "no-such-system" in text:
        said = re.sub(r"  There is no file no-such-system.asd below .*\n", "", said)
    assert said == expected.format(file="plan.lisp")


def test_a_motion_that_cannot_be_resolved(tried):
    said = tried("(desig:reference (desig:a motion (type no-such-motion)))")
    assert (
        said
        == """\
CRAM-DESIGNATORS:DESIGNATOR-ERROR:
  Cannot resolve motion designator #<A MOTION
      (TYPE NO-SUCH-MOTION)>.
  at <repl 1>:1:1
    (desig:reference (desig:a motion (type no-such-motion)))
    ^
  There is no clause of motion-grounding that could resolve it. Define one in a fact group that lists desig:motion-grounding, \
and load the file.
"""
    )


NODE = ['(roslisp:start-ros-node "bad_input")']
PUBLISHER = [*NODE, '(defparameter *pub* (roslisp:advertise "/bad" "geometry_msgs/Twist"))']


class TestMessages:
    def test_a_field_that_does_not_exist(self, tried):
        assert (
            tried('(roslisp:make-message "turtlesim/Color" :nosuch 1)')
            == """\
SIMPLE-ERROR:
  Could not find field NOSUCH in (COLOR (R . 0) (G . 0) (B . 0))
  at <repl 1>:1:1
    (roslisp:make-message "turtlesim/Color" :nosuch 1)
    ^
  turtlesim/Color has the fields r g b.
"""
        )
        assert "Could not find field NOSUCH in (VECTOR3" in tried("(roslisp:publish-msg *pub* (:nosuch :linear) 1)", before=PUBLISHER)

    def test_a_type_that_does_not_exist(self, tried):
        assert "Can't find package NO_MSGS-MSG\n  at <repl 1>:1:1\n" in tried('(roslisp:make-message "no_msgs/Thing")')
        assert "Can't find class for std_msgs/Thing\n  at <repl 1>:1:1\n" in tried('(roslisp:make-message "std_msgs/Thing")')

    def test_a_service_that_nobody_offers(self, tried):
        assert (
            tried('(roslisp:call-service "/nobody" \'std_srvs-srv:Empty)', before=NODE)
            == """\
ROSLISP::ROS-RPC-ERROR:
  ros-rpc call (lookupService /nobody) to #S(URI :ADDRESS 127.0.0.1 :PORT 11311) failed with code -1, message no provider, values 
  at <repl 2>:1:1
    (roslisp:call-service "/nobody" 'std_srvs-srv:Empty)
    ^
  No node offers this service. rosservice list, typed at the prompt, shows those that there are; (wait-for-service name) waits for one.
"""
        )  # noqa: W291  (the text of the original ends in a blank)

    def test_garbage_is_not_published(self, tried):
        listening = [*PUBLISHER, '(progn (roslisp:subscribe "/bad" "geometry_msgs/Twist" #\'identity) 1)']
        assert '"garbage"\n  is not of type\n    REAL\n' in tried('(roslisp:publish-msg *pub* (:x :linear) "garbage")', before=listening)
        assert "    (5).\n" in tried("(roslisp:publish *pub* 5)", before=listening)

    def test_a_subscription_with_another_type(self, tried):
        listening = [*NODE, '(progn (roslisp:subscribe "/typed" "std_msgs/String" #\'identity) 1)']
        assert "Asserted topic type std_msgs/Bool for new subscription to /typed did not match existing type std_msgs/String\n" in tried(
            '(roslisp:subscribe "/typed" "std_msgs/Bool" #\'identity)', before=listening
        )

    def test_a_callback_that_fails_is_told_and_the_next_message_comes(self, type_in, backend):
        transcript = type_in(
            "\n".join(
                [
                    *PUBLISHER,
                    "(defparameter *seen* 0)",
                    '(progn (roslisp:subscribe "/bad" "geometry_msgs/Twist" (lambda (m) (incf *seen*) (car m))) 1)',
                    "(roslisp:publish-msg *pub*)",
                    "(roslisp:publish-msg *pub*)",
                    "*seen*",
                    "(list 'still 'here)",
                ]
            ),
            backend=backend,
        )
        assert transcript.count("Error during subscriber callback: 'The value") == 2
        assert "CPL-USER> *seen*\n2\n" in transcript and goes_on(transcript)

    def test_a_callback_that_never_ends_stops_nobody_else(self, type_in, backend):
        transcript = type_in(
            "\n".join(
                [
                    *PUBLISHER,
                    '(progn (roslisp:subscribe "/bad" "geometry_msgs/Twist" (lambda (m) (loop))) 1)',
                    "(roslisp:publish-msg *pub*)",
                    "(sleep 0.5)",
                    "(list 'still 'here)",
                ]
            ),
            backend=backend,
        )
        assert goes_on(transcript)


class TestPlans:
    def test_an_error_in_a_branch(self, tried, backend):
        said = tried("(top-level (par (sleep 1) (car 8)))", backend=backend)
        assert (
            said
            == MISSING_CAR.format(8).removeprefix("debugger invoked on a ")
            + """\
  at <repl 1>:1:27
    (top-level (par (sleep 1) (car 8)))
                              ^
"""
        )

    def test_an_error_in_a_process_module(self, tried, backend):
        said = tried(
            "(top-level (cpm:with-process-modules-running (clumsy) (cpm:pm-execute 'clumsy (desig:a motion (type any)))))",
            before=["(cpm:def-process-module clumsy (motion)\n  (car 5))"],
            backend=backend,
        )
        assert (
            said.endswith("  at <repl 1>:2:3\n      (car 5))\n      ^\n  while process module CLUMSY executed #<A MOTION (TYPE ANY)>\n")
            and "\n    5\n" in said
        )

    def test_a_process_module_that_nobody_defined(self, tried):
        said = tried("(top-level (cpm:with-process-modules-running (nobody) 1))")
        assert said.startswith("CRAM-PROCESS-MODULES::UNKNOWN-PROCESS-MODULE:\n  Unknown process module: NOBODY \n  at <repl 1>:1:12\n")

    def test_an_error_in_a_cleanup_form_takes_the_place_of_the_failure(self, tried, backend):
        said = tried('(top-level (unwind-protect (par (sleep 1) (fail "body")) (car 6)))', backend=backend)
        assert said.endswith(
            '  at <repl 1>:1:58\n    (top-level (unwind-protect (par (sleep 1) (fail "body")) (car 6)))\n' + " " * 61 + "^\n"
        )

    def test_a_branch_that_tries_to_leave_a_form_around_it(self, tried, backend):
        said = tried("(top-level (block nil (par (return 1) (sleep 1))))", backend=backend)
        assert "A branch of a plan tried to leave a form around it" in said
