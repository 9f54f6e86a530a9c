"""Lecture 34 as it stands on the slides: creating a package, controlling the turtle."""

from __future__ import annotations

import pytest

LOAD = ['(ros-load:load-system "cram_my_beginner_tutorial" :cram-my-beginner-tutorial)', "(in-package :tut)"]
NODE = """\
[(ROSLISP TOP) INFO] TIME: Node name is /cram_tutorial_client
[(ROSLISP TOP) INFO] TIME: Namespace is /
[(ROSLISP TOP) INFO] TIME: Params are NIL
[(ROSLISP TOP) INFO] TIME: Remappings are:
[(ROSLISP TOP) INFO] TIME: master URI is 127.0.0.1:11311
[(ROSLISP TOP) INFO] TIME: Node startup complete
0"""
POSE = """\
[TURTLESIM-MSG:POSE
   X:
     5.544444561004639d0
   Y:
     5.544444561004639d0
   THETA:
     0.0d0
   LINEAR_VELOCITY:
     0.0d0
   ANGULAR_VELOCITY:
     0.0d0]"""
COLOUR = """\
[TURTLESIM-MSG:COLOR
   R:
     69
   G:
     86
   B:
     255]"""


def create_package(workspace):
    workspace.shell("catkin_create_pkg", "cram_my_beginner_tutorial", "cram_language", where="src")


@pytest.mark.soak
def test_the_package_is_made_by_catkin_create_pkg(workspace):
    create_package(workspace)
    assert (workspace.package / "package.xml").is_file() and (workspace.package / "CMakeLists.txt").is_file()
    assert (workspace.package / "src").is_dir() and (workspace.package / "include").is_dir()
    assert "<exec_depend>cram_language</exec_depend>" in (workspace.package / "package.xml").read_text()
    assert "Nothing to build" in workspace.shell("catkin_make")
    assert workspace.shell("roscd").strip() == str(workspace.folder / "devel")
    assert "No master is needed" in workspace.shell("roscore")


@pytest.mark.soak
def test_the_empty_package_loads(workspace, backend):
    create_package(workspace)
    workspace.copy("lecture-34/1-create/cram-my-beginner-tutorial.asd")
    for name in ("package.lisp", "control-turtlesim.lisp"):
        workspace.copy(f"lecture-34/1-create/src/{name}", f"src/{name}")
    transcript = workspace.repl(*LOAD, backend=backend)
    assert transcript.prompts == ["CL-USER>", "CL-USER>", "TUT>"]


def control_package(workspace, control="control-turtlesim.lisp"):
    create_package(workspace)
    workspace.copy("lecture-34/2-control/cram-my-beginner-tutorial.asd")
    workspace.copy("lecture-34/2-control/src/package.lisp", "src/package.lisp")
    workspace.copy(f"lecture-34/2-control/src/{control}", "src/control-turtlesim.lisp")


@pytest.mark.soak(all_but=1)
def test_every_line_of_the_lecture_answers_as_the_slides_show(workspace, backend):
    control_package(workspace)
    transcript = workspace.repl(
        *LOAD,
        '(start-ros-node "cram_tutorial_client")',
        '(init-ros-turtle "turtle1")',
        "(value *turtle-pose*)",
        "(value *color-value*)",
        "(value turtle-pose)",
        "3",
        "(progn (turtlesim:press :left) (sleep 2) (turtlesim:press :left) (sleep 2) (turtlesim:press :up) (sleep 2))",
        "(value *turtle-pose*)",
        "(wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0))",
        "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
        "(call-set-pen 255 0 0 10 0)",
        "(dotimes (i 10) (send-vel-cmd 1 1) (sleep 1))",
        "(value *color-value*)",
        backend=backend,
    )
    answers = transcript.answers
    assert answers[2] == NODE
    assert answers[3] == '"/turtle1/set_pen"'
    assert answers[4] == POSE
    assert answers[5] == COLOUR
    assert "The variable TURTLE-POSE is unbound." in answers[6] and "[ABORT" in answers[6]
    assert "There is a variable *TURTLE-POSE*" in answers[6]
    assert transcript.prompts[7] == "0]" and transcript.prompts[8] == "TUT>"
    moved = answers[9].split()
    assert moved[:2] == ["[TURTLESIM-MSG:POSE", "X:"] and float(moved[2].removesuffix("d0")) < 5
    assert answers[10] == "T"
    assert answers[11] == "NIL" and answers[13] == "NIL"
    assert answers[12] == "[TURTLESIM-SRV:SETPEN-RESPONSE]"
    assert transcript.text.count("WARNING") == 0


@pytest.mark.soak
def test_a_wait_blocks_until_the_turtle_is_there(workspace, backend):
    control_package(workspace)
    transcript = workspace.repl(
        *LOAD,
        '(start-ros-node "cram_tutorial_client")',
        '(init-ros-turtle "turtle1")',
        "(top-level (par (wait-for (< (fl-funcall #'turtlesim-msg:x *turtle-pose*) 5.0)) (progn (sleep 3) (send-vel-cmd -1 0))))",
        backend=backend,
    )
    assert transcript.answers[4] == "T"


@pytest.mark.soak
def test_a_surplus_parenthesis_is_a_warning_with_its_place(workspace):
    control_package(workspace, "control-turtlesim-one-paren-too-many.lisp")
    transcript = workspace.repl(*LOAD, "*pen-srv*")
    assert "unmatched close parenthesis at" in transcript.text and "control-turtlesim.lisp:25:62" in transcript.text
    assert transcript.answers[2] == "NIL"


@pytest.mark.soak
def test_an_error_names_the_form_in_the_students_file(workspace):
    control_package(workspace)
    transcript = workspace.repl(
        *LOAD, '(start-ros-node "a")', '(init-ros-turtle "turtle1")', '(send-vel-cmd "fast" 1)', "0", "(send-vel-cmd 1)", "0"
    )
    wrong_value, wrong_count = transcript.answers[4], transcript.answers[6]
    assert 'The value\n    "fast"\n  is not of type\n    REAL' in wrong_value
    assert "at src/cram_my_beginner_tutorial/src/control-turtlesim.lisp:41:3\n      (publish *cmd-vel-pub*\n      ^" in wrong_value
    assert "invalid number of arguments: 1" in wrong_count and "SEND-VEL-CMD takes 2 arguments." in wrong_count
