"""What a student sees who does things in the wrong order or misspells them: what, where, and what to try.

The lines that tell what the runtime was about (``while process module ...``) are those of other rooms and tested there.
"""

from __future__ import annotations

import subprocess
import sys

import pytest

from .course import BACKENDS
from .course import ROOT, environment

SOURCE = "tutorials/cram_my_beginner_tutorial/src"


def session(folder, *lines, backend="threads"):
    """The answers to lines that are typed into a fresh REPL with the course's package."""
    command = [
        sys.executable,
        "-m",
        "cramhy_runtime.cli",
        "repl",
        "--time",
        "virtual",
        "--backend",
        backend,
        "--load",
        "cram-my-beginner-tutorial",
        "--package",
        "tut",
    ]
    typed = "\n".join([*lines, ""])
    done = subprocess.run(command, input=typed, cwd=folder, env=environment(), capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    return [answer.strip() for answer in done.stdout.replace(f"{ROOT}/", "").split("TUT> ")[1:]]


def without_log(answer):
    """What the debugger says, without the circumstances."""
    told = answer[answer.index("debugger invoked") : answer.index("\n\nrestarts")].splitlines()
    return "\n".join(line for line in told if not line.startswith("  while "))


@pytest.mark.soak
@pytest.mark.parametrize("backend", BACKENDS)
def test_driving_before_the_node_is_there(backend, tmp_path):
    drive, move, wipe, pen = session(
        tmp_path,
        "(drive 3 8)",
        "0",
        "(move-simple 3 3)",
        "0",
        "(call-clear-background)",
        "1",
        '(progn (start-ros-node "a") (call-set-pen 1 2 3 4 0))',
        "0",
        backend=backend,
    )[:4]
    assert (
        without_log(drive)
        == f"""\
debugger invoked on a SB-PCL::NO-PRIMARY-METHOD-ERROR:
  There is no primary method for the generic function
    #<STANDARD-GENERIC-FUNCTION ROSLISP:PUBLISH (3)>
  when called with arguments
    (NIL #<GEOMETRY_MSGS-MSG:TWIST {{1001000043}}>).
  See also:
  The ANSI Standard, Section 7.6.6.2
  at {SOURCE}/control-turtlesim.hy:42:3
      (publish *cmd-vel-pub*
      ^
  What (advertise topic type) returns is published on, or the name of an advertised topic. Has the function been called that advertises?"""
    )
    assert (
        without_log(move)
        == f"""\
debugger invoked on a SB-PCL::MISSING-SLOT:
  When attempting to read the slot's value (slot-value), the slot COMMON-LISP::X
  is missing from the object NIL.
  at {SOURCE}/simple-plans.hy:6:3
      (with-fields (x y theta) msg
      ^
  No message is there yet: a fluent is NIL until the first one comes. Has its topic been subscribed to, and does somebody publish on it?"""
    )
    assert (
        without_log(wipe)
        == f"""\
debugger invoked on a SIMPLE-ERROR:
  Node status is SHUTDOWN
  at {SOURCE}/control-turtlesim.hy:61:3
      (call-service "/clear" 'std_srvs-srv:Empty))
      ^
  No ROS node runs here. (start-ros-node "name") starts one."""
    )
    assert (
        without_log(pen)
        == f"""\
debugger invoked on a SB-PCL::NO-APPLICABLE-METHOD-ERROR:
  There is no applicable method for the generic function
    #<STANDARD-GENERIC-FUNCTION ROSLISP:CALL-SERVICE (2)>
  when called with arguments
    (NIL TURTLESIM-SRV:SETPEN :R 1 :G 2 :B 3 :WIDTH 4 :OFF 0).
  See also:
  The ANSI Standard, Section 7.6.6
  at {SOURCE}/control-turtlesim.hy:52:3
      (call-service *pen-srv* 'turtlesim-srv:SetPen
      ^
  A service is named by a string, such as "/clear". Has the variable been set that holds it?"""
    )


@pytest.mark.soak
@pytest.mark.parametrize("backend", BACKENDS)
def test_after_a_mistake_the_session_goes_on(backend, tmp_path):
    """Law 8: bad input costs nothing."""
    answers = session(
        tmp_path,
        "(drive 3 8)",
        "0",
        "(perform-draw-house)",
        "0",
        "(init)",
        "(perform-some-motion (desig:a motion (type flying)))",
        "0",
        "(goto-location :up :left)",
        "0",
        "(top-level (with-process-modules-running (turtlesim-pen-control) (navigate '(3 3 0))))",
        "0",
        "(move-simple 3 3)",
        "(< (v-dist (make-3d-vector 3 3 0) (translation (pose-msg->transform (value *turtle-pose*)))) 0.13)",
        "(get-running-process-module 'turtlesim-navigation)",
        backend=backend,
    )
    assert "No matching process module found for #<A MOTION\n      (TYPE FLYING)>" in answers[3]
    assert "Wanted one of (:LEFT :CENTER :RIGHT)." in answers[4]
    assert "No matching process module found for #<A MOTION\n      (TYPE MOVING)" in answers[5]
    assert answers[6].endswith("\nT") and answers[7:9] == ["T", "NIL"]
