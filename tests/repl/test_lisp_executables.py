"""``rosrun`` of Lisp programs that a package of the user's names with ``add_lisp_executable``: talker and listener in two terminals."""

from __future__ import annotations

import errno
import os
import re
import signal

import pytest

from cramhy_runtime.cli.lisp_executables import LispExecutable, lisp_executables

from .terminal import Terminal

PACKAGE = "<package><name>tin_talk</name></package>"
LINES = """cmake_minimum_required(VERSION 2.8.3)
project(tin_talk)
# add_lisp_executable(old tin-talk tin-talk:old)
add_lisp_executable(talker
  tin-talk tin-talk:talker)  # says foo
add_lisp_executable(listener tin-talk "tin-talk::listener")
add_compiled_lisp_executable(wrong tin-talk tin-talk:wrong a_target)
rosbuild_add_lisp_executable(gone no-such-system no-such:thing)
"""
SYSTEM = '(defsystem tin-talk :depends-on (roslisp std_msgs-msg) :components ((:module "src" :components ((:file "talk")))))'
TALK = """
(defpackage tin-talk (:use :cl :roslisp) (:export #:talker #:wrong))
(in-package :tin-talk)
(defun talker ()
  "Say foo until somebody ends it."
  (with-ros-node ("talker")
    (let ((i 0) (pub (advertise "chatter" "std_msgs/String")))
      (loop-at-most-every .05 (publish-msg pub :data (format nil "foo ~a" (incf i)))))))
(defun listener ()
  "Print what is said, three times."
  (with-ros-node ("listener")
    (let ((heard 0))
      (subscribe "chatter" "std_msgs/String" (lambda (message) (incf heard) (format t "I heard ~a~%" (std_msgs-msg:data message))))
      (loop until (>= heard 3) do (sleep 0.02))
      (format t "~a ~a ~a~%" (get-param "~volume" :none) (if (member :roslisp-standalone-executable *features*) :alone :not-alone) heard))))
(defun wrong () (error "No tin here."))
"""


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    folder = tmp_path / "tin_talk"
    (folder / "src").mkdir(parents=True)
    for name, text in (("package.xml", PACKAGE), ("CMakeLists.txt", LINES), ("tin-talk.asd", SYSTEM), ("src/talk.lisp", TALK)):
        (folder / name).write_text(text)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    return folder


@pytest.mark.soak
def test_the_lines_of_a_cmake_file(workspace):
    assert lisp_executables(workspace) == {
        "talker": LispExecutable("tin-talk", "tin-talk:talker"),
        "listener": LispExecutable("tin-talk", "tin-talk::listener"),
        "wrong": LispExecutable("tin-talk", "tin-talk:wrong"),
        "gone": LispExecutable("no-such-system", "no-such:thing"),
    }
    assert lisp_executables(workspace / "src") == lisp_executables(None) == {}


@pytest.mark.soak
def test_a_talker_and_a_listener_in_two_terminals(private, workspace):
    """The first is a session, which the second joins. Ctrl-C ends the one, the other returns."""
    pytest.importorskip("uvicorn")
    pytest.importorskip("websockets")
    with Terminal("ros", "rosrun", "tin_talk", "talker") as talker:
        talker.expect("Node startup complete")
        with Terminal("ros", "rosrun", "tin_talk", "listener", "__name:=hearer", "_volume:=11") as listener:
            listener.expect("Node name is /hearer\n")
            listener.expect(r"I heard foo \d+\n")
            listener.expect(r"11 ALONE [3-9]\n")
            assert listener.status() == 0
        talker.control_c()
        assert talker.status() == 0


@pytest.mark.parametrize(
    ("executable", "status", "said"),
    [("wrong", 1, "No tin here."), ("walker", 3, "[rosrun] tin_talk has the executables gone, listener, talker, wrong.")],
)
def test_what_cannot_run_says_why(private, workspace, tool, executable, status, said):
    output, errors, ended = tool("rosrun", "tin_talk", executable)
    assert said in errors and ended == status


LAUNCHES = {
    "talk.launch": """<launch>
  <node pkg="tin_talk" type="talker" name="says" ns="tin"/>
  <node pkg="tin_talk" type="wrong" name="bad"/>
  <node pkg="tin_talk" type="walker" name="none"/>
</launch>""",
    "hear.launch": """<launch>
  <node pkg="tin_talk" type="listener" name="hearer"><param name="volume" value="11"/><remap from="chatter" to="/tin/chatter"/></node>
</launch>""",
}


@pytest.mark.soak
def test_launch_files_start_lisp_programs(private, workspace):
    """The first file's terminal is a session, which its programs join, and those of the second terminal. What cannot run says why."""
    pytest.importorskip("uvicorn")
    pytest.importorskip("websockets")
    for name, text in LAUNCHES.items():
        (workspace / name).write_text(text)
    with Terminal("ros", "roslaunch", "tin_talk", "talk.launch") as talker:
        talker.expect(r"process\[tin/says-1\]: started with pid \[(\d+)\]")
        says = int(re.search(r"says-1\]: started with pid \[(\d+)\]", talker.text).group(1))
        talker.expect(
            r"ERROR: cannot launch node of type \[tin_talk/walker\]: tin_talk has the executables gone, listener, talker, wrong.\n"
        )
        died = r"No tin here[\s\S]*\[bad-2\] process has died \[pid \d+, exit code 1\]\n"
        talker.expect(rf"(?=[\s\S]*Node name is /tin/says\n)(?=[\s\S]*{died})")  # in any order
        with Terminal("ros", "roslaunch", "tin_talk", "hear.launch") as listener:
            listener.expect(r"I heard foo \d+\n")
            listener.expect(r"11 ALONE [3-9]\n")
            listener.expect(r"\[hearer-1\] process has finished cleanly\n")
            assert listener.status() == 0
        talker.control_c()
        talker.expect(r"\[tin/says-1\] killing on exit\n")
        assert talker.status() == 0
    with pytest.raises(ProcessLookupError):
        os.kill(says, 0)


@pytest.mark.soak
def test_lisp_programs_end_with_a_launcher_that_is_killed(private, workspace):
    """By SIGKILL, of which roslaunch hears nothing itself. They leave as when their terminal is closed: the node, too."""
    pytest.importorskip("uvicorn")
    pytest.importorskip("websockets")
    (workspace / "says.launch").write_text('<launch><node pkg="tin_talk" type="talker" name="says"/></launch>')
    with Terminal("ros", "roslaunch", "tin_talk", "says.launch") as launcher:
        launcher.expect("Node startup complete")
        os.kill(launcher.pid, signal.SIGKILL)
        launcher.expect(rf"\[rosrun\] roslaunch \[pid {launcher.pid}\] is gone, so the programs that it started end\.\n")
        assert launcher.status() == -signal.SIGKILL
        os.set_blocking(launcher.master, False)
        with pytest.raises(OSError) as problem:  # nobody has the terminal any more
            os.read(launcher.master, 1)
        assert problem.value.errno == errno.EIO
