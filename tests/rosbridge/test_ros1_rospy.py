"""A session joined to a real roscore with a turtle of rospy's, through the peer of `test_ros1`; skipped where rospy is not installed."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sysconfig
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from cramhy_runtime import kernel, rosbridge
from test_ros1 import CMD, OFFER, Robot, arrive, failure, until

PYTHON = next(
    (
        each
        for each in ("/usr/bin/python3", shutil.which("python3"))
        if each and shutil.which("roscore") and not subprocess.run([each, "-c", "import rospy, rosservice"], capture_output=True).returncode
    ),
    None,
)
pytestmark = pytest.mark.skipif(PYTHON is None, reason="rospy is not installed")
LIBRARIES = sysconfig.get_path("purelib")


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as found:
        return found.getsockname()[1]


@pytest.fixture(scope="module")
def ros():
    """The environment of a roscore with a turtle, and the file in which the turtle writes what it is told."""
    with ExitStack() as closings:
        port = free_port()
        folder = Path(os.environ.get("TMPDIR", "/tmp")) / f"cramhy-rospy-{os.getpid()}"
        folder.mkdir(exist_ok=True)
        closings.callback(shutil.rmtree, folder, True)
        environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_HOSTNAME": "127.0.0.1", "ROS_HOME": str(folder)}
        for variable in ("PYTHONPATH", "VIRTUAL_ENV"):
            environment.pop(variable, None)

        def start(*words):
            process = subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            closings.callback(process.wait)
            closings.callback(process.terminate)

        start("roscore", "-p", str(port))
        log = folder / "turtle.log"
        start(PYTHON, str(Path(__file__).with_name("ros1_rospy.py")), str(log))
        deadline = time.monotonic() + 60
        while "/clear" not in subprocess.run(["rosservice", "list"], env=environment, capture_output=True, text=True).stdout:
            assert time.monotonic() < deadline, "the turtle does not come"
        yield environment, log


@pytest.fixture
def robot(ros, monkeypatch):
    for name, value in ros[0].items():
        monkeypatch.setenv(name, value)
    found = Robot("--rospy", "--libraries", LIBRARIES, program=PYTHON)
    yield found
    found.end()


@pytest.fixture
def session(robot):
    """(evaluate, link), joined, without a node."""
    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.session import Image

    with Image(as_now=True):
        made = Session(time="wall")
        made.package = "CRAM-USER"
        link = rosbridge.attach(robot.address)
        yield made.evaluate_text, link
        link.close()


def commands(log):
    """(seconds since 1970, linear, angular) of what the turtle was told."""
    return [json.loads(line) for line in log.read_text().splitlines()]


def test_the_course_drives_a_turtle_of_rospy(robot, session):
    evaluate, link = session
    evaluate('(asdf:load-system "cram-my-beginner-tutorial")')
    evaluate("(in-package :tut)")
    evaluate("(init)")
    evaluate("(top-level (wait-for *turtle-pose*))")
    assert evaluate('(get-param "/turtlesim/background_b")') == [255]
    arrive(robot, lambda: evaluate("(top-level (move-to (make-3d-vector 7 6 0)))"), 7, 6)
    evaluate("(drive 1 1)")
    arrive(
        robot,
        lambda: evaluate("(top-level (with-process-modules-running (turtlesim-navigation turtlesim-pen-control) (navigate '(5 5 0))))"),
        5,
        5,
    )
    problem = failure(evaluate, '(advertise "/turtle1/cmd_vel" "std_msgs/String")')
    assert problem.report() == (
        f"The topic {CMD} has messages of the type geometry_msgs/Twist at {link.shown}, not std_msgs/String, so no message would arrive."
    )


def test_rosservice_calls_a_service_of_the_plan_and_is_told_when_the_session_leaves(ros, robot, session):
    evaluate, link = session
    evaluate('(roslisp:start-ros-node "lisp")')
    evaluate(
        OFFER.replace("roscpp_tutorials-srv:TwoInts (a b)", "std_srvs-srv:SetBool (data)")
        .replace("((= a 0)", "((not data)")
        .replace("((= a 1)", "(data")
        .replace("(roslisp:make-response :sum (+ a b))", "(roslisp:make-response)")
        .replace("roscpp_tutorials-srv:TwoInts", "std_srvs-srv:SetBool")
    )
    until(lambda: "/sum" in robot.services(), "the service")

    def call(value):
        return subprocess.Popen(
            ["rosservice", "call", "/sum", value], env=ros[0], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    refused = call("false")
    until(lambda: refused.poll() is not None, "the end of rosservice")
    assert "ERROR: service [/sum]" in refused.communicate()[0]
    until(lambda: "/sum" in robot.services() and len(robot.heard("advertise_service")) == 2, "the service again")
    waiting = call("true")
    until(lambda: link.offering.calls, "the call")
    kernel.stop()
    text, _ = waiting.communicate(timeout=30)
    assert "ERROR" in text
    listed = subprocess.run(["rosservice", "list"], env=ros[0], capture_output=True, text=True).stdout
    assert "/sum" not in listed and "/clear" in listed


def test_after_a_stall_the_turtle_gets_no_burst_and_the_stop(ros, robot, session):
    evaluate, link = session
    evaluate('(roslisp:start-ros-node "lisp")')
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    until(lambda: (evaluate("(roslisp:publish-msg *cmd* (:x :linear) 0.0)"), kernel.sleep(0.1), commands(ros[1]))[2], "the first command")
    before = len(commands(ros[1]))
    robot.signal(signal.SIGSTOP)
    for _ in range(60):
        evaluate("(roslisp:publish-msg *cmd* (:x :linear) 2.0)")
        kernel.sleep(0.05)
    until(lambda: not link.connected, "the loss")
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 0.25)")
    kernel.sleep(0.6)
    robot.signal(signal.SIGCONT)
    until(lambda: link.connected, "the return")
    until(lambda: commands(ros[1])[-1][1] == 0.25, "the last command")
    assert len(commands(ros[1])) - before < 30
