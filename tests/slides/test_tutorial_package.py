"""The tutorial package in Hy: the same answers from the REPL, from ``hy FILE.hy``, and from Python."""

from __future__ import annotations

import subprocess
import sys

import pytest
from systems import RUNS_HY_FILES, WHY_NO_HY_FILES

from .conftest import ROOT, environment, stable

DRIVEN = """\
[(TURTLE-PROCESS-MODULES) INFO] TIME: TurtleSim navigation invoked with motion designator `#<A MOTION
    (TYPE DRIVING)
    (SPEED 5)
    (ANGLE 2)>'."""


def lectures(*options):
    done = subprocess.run(
        [sys.executable, "tutorials/lectures.py", *options],
        cwd=ROOT,
        capture_output=True,
        text=True,
        env=environment(),
        stdin=subprocess.DEVNULL,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.soak
def test_both_lectures_give_the_same_bytes_twice_and_on_both_back_ends(tmp_path, backend):
    paper = tmp_path / "turtle.png"
    first = lectures("--png", str(paper), "--backend", backend)
    picture = paper.read_bytes()
    assert lectures("--png", str(paper), "--backend", backend) == first
    assert paper.read_bytes() == picture and picture.startswith(b"\x89PNG")
    assert lectures("--png", str(paper)) == first
    assert DRIVEN in stable(first)


@pytest.mark.soak
@pytest.mark.skipif(not RUNS_HY_FILES, reason=WHY_NO_HY_FILES)
def test_a_hy_file_runs_with_hy_itself(tmp_path):
    script = tmp_path / "drive.hy"
    script.write_text("""\
(require cramhy *)
(defpackage :my-plans (:use :cpl :roslisp))
(in-package :my-plans)

(defvar *poses* (make-fluent :name :poses) "the last pose")

(defun follow (msg)
  (setf (value *poses*) msg))

(start-ros-node "hy")
(turtlesim:start)
(subscribe "turtle1/pose" "turtlesim/Pose" #'follow)
(let ((publisher (advertise "turtle1/cmd_vel" "geometry_msgs/Twist")))
  (publish-msg publisher (:x :linear) 2)
  (sleep 2)
  (with-fields (x y) (value *poses*)
    (format t "~,3f ~,3f~%" x y)))
""")
    done = subprocess.run([sys.executable, "-m", "hy", str(script)], capture_output=True, text=True, env=environment(), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "7.560 5.544"


def test_the_tutorial_is_a_python_module(tmp_path):
    script = tmp_path / "test_drive.py"
    script.write_text("""\
import cram_my_beginner_tutorial as tut
from cramhy_runtime import kernel


def test_the_turtle_drives(capsys):
    tut.start_ros_node("pytest")
    tut.init_ros_turtle("turtle1")
    assert tut.drive(5, 2) == 1
    kernel.sleep(2)
    assert tut.value(tut.turtle_pose).angular_velocity == 0
    assert "(SPEED 5)" in capsys.readouterr().out
""")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "cramhy_runtime.pytest_plugin", str(script)]
    # loaded by name here, since this checkout may or may not be installed; an installed cramhy brings the plugin by itself
    alone = {**environment(), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(command, capture_output=True, text=True, env=alone, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.soak
def test_a_lisp_file_is_imported_like_a_python_file(tmp_path):
    (tmp_path / "my-greetings.lisp").write_text("""\
(defpackage :my-greetings (:use :cl))
(in-package :my-greetings)
(defvar *count* 0)
(defun greet (name &key (mark "!"))
  (incf *count*)
  (format nil "Hello ~a~a" name mark))
""")
    (tmp_path / "use.py").write_text("""\
import cramhy
import my_greetings
print(my_greetings.greet("turtle"), my_greetings.greet("you", mark="?"), my_greetings.count)
""")
    done = subprocess.run([sys.executable, "use.py"], capture_output=True, text=True, env=environment(), cwd=tmp_path)
    assert done.stdout == "Hello turtle! Hello you? 2\n", done.stderr
