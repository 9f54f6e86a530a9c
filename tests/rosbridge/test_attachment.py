"""A session joined to another process's graph through its rosbridge server, as it would be joined to a real robot's."""

from __future__ import annotations

import contextlib
import json
import os
import re
import socket
import subprocess
import sys
import threading

import pytest
from cramhy_runtime.session import Image

from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.repl.commands import run_line
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.rosbridge.addresses import shown

pytest.importorskip("roslibpy")

ROBOT = """
import json, sys
from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.session import boot
from cramhy_runtime.turtlesim.node import start_turtlesim, running_simulator

kernel.start(clock="wall")
boot()
start_turtlesim()
token = None

def serve(port):
    server = rosbridge.start(port=port)
    print(json.dumps([server.port, server.address]), flush=True)
    return server

server = serve(0)
while True:
    line = kernel.run_blocking(sys.stdin.readline).strip()
    if line == "pose":
        print(json.dumps(running_simulator().turtles["turtle1"].pose()), flush=True)
    elif line == "drop":
        server.hand_out(lambda: [each.end(1001, "test") for each in server.connections])
        print("dropped", flush=True)
    elif not line:
        break
kernel.stop()
"""


class Robot:
    """Another process, with a turtle and a server."""

    def __init__(self, folder):
        self.process = subprocess.Popen(
            [sys.executable, "-c", ROBOT],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "XDG_RUNTIME_DIR": str(folder)},
        )
        self.port, self.address = json.loads(self.process.stdout.readline())
        self.shown = f"ws://127.0.0.1:{self.port}/..."

    def ask(self, word):
        def talk():
            self.process.stdin.write(word + "\n")
            self.process.stdin.flush()
            return self.process.stdout.readline()

        return kernel.run_blocking(talk)


@pytest.fixture
def robot(tmp_path):
    found = Robot(tmp_path)
    yield found
    found.process.kill()
    found.process.wait()


@pytest.fixture
def joined(robot):
    """(evaluate, link) of a session in wall time that is joined to the robot; its own turtle would start, were it not joined."""
    from cramhy_runtime.repl.session import Session

    with Image(as_now=True):
        session = Session(time="wall")
        session.package = "CRAM-USER"
        link = rosbridge.attach(robot.address)
        yield session.evaluate_text, link
        link.close()


@pytest.mark.soak
def test_the_plan_of_the_course_drives_the_turtle_of_the_other_process(robot, joined):
    drive_by_the_plan_of_the_course(robot, *joined)


def drive_by_the_plan_of_the_course(robot, evaluate, link):
    evaluate('(asdf:load-system "cram-my-beginner-tutorial")')
    evaluate("(in-package :tut)")
    evaluate('(start-ros-node "turtle1")')
    evaluate('(init-ros-turtle "turtle1")')
    assert "/turtlesim" not in link.graph.nodes
    evaluate("(top-level (wait-for *turtle-pose*))")  # the first one has come over the bridge
    arrive(robot, lambda: evaluate("(top-level (move-to (make-3d-vector 7 6 0)))"), 7, 6)
    arrive(
        robot,
        lambda: evaluate("(top-level (with-process-modules-running (turtlesim-navigation turtlesim-pen-control) (navigate '(5 5 0))))"),
        5,
        5,
    )


def arrive(robot, drive, x, y):
    """The turtle is there after ``drive()``; a machine that is busy with other things brakes late, so it has three attempts."""
    for _ in range(3):
        drive()
        pose = json.loads(robot.ask("pose"))
        if pose[:2] == [pytest.approx(x, abs=0.5), pytest.approx(y, abs=0.5)]:
            return
    pytest.fail(f"It drove to {pose}, not to {x}, {y}.")


@pytest.mark.soak
def test_the_connection_ends_with_the_session_and_after_the_cleanup_of_its_plans(robot, joined):
    evaluate, link = joined
    evaluate('(roslisp:start-ros-node "lisp")')
    kernel.spawn(
        evaluate,
        """(top-level (unwind-protect (sleep 1000)
        (roslisp:call-service "/turtle1/teleport_absolute" 'turtlesim-srv:TeleportAbsolute :x 3 :y 4 :theta 0)))""",
    )
    kernel.sleep(0.1)
    kernel.stop()
    assert link.closed and not link.ros.is_connected
    kernel.start(clock="wall")
    assert json.loads(robot.ask("pose"))[:2] == [3.0, 4.0]


@pytest.mark.soak
def test_services_and_parameters_are_the_robots(robot, joined):
    evaluate, _ = joined
    evaluate('(roslisp:start-ros-node "lisp")')
    assert evaluate('(roslisp:wait-for-service "/spawn" 10)') == [True]
    evaluate("""(roslisp:call-service "/turtle1/teleport_absolute" 'turtlesim-srv:TeleportAbsolute :x 1 :y 2 :theta 0)""")
    assert json.loads(robot.ask("pose"))[:2] == [1.0, 2.0]
    assert evaluate('(roslisp:msg-slot-value (roslisp:call-service "/spawn" "turtlesim/Spawn" :x 1 :y 1 :name "anna") :name)') == ["anna"]
    assert evaluate('(roslisp:get-param "/turtlesim/background_b")') == [255]
    evaluate('(roslisp:set-param "/mine" (list 1 2))')
    assert evaluate('(roslisp:has-param "/mine")') == [True]
    assert str(evaluate('(roslisp:get-param "/mine")')[0]) == "(1 2)"
    evaluate('(roslisp:delete-param "/mine")')
    assert evaluate('(roslisp:has-param "/mine")') == [None]
    assert evaluate('(roslisp:get-param "/nothing" 7)') == [7]
    shown = []
    run_line("rosservice call /kill nope", shown.append)
    assert shown == ["ERROR: service [/kill] responded with an error: b''\n"]


@pytest.mark.soak
def test_the_robot_calls_a_service_of_the_plan(robot, joined, beside):
    from bridge_clients import Wire

    evaluate, _ = joined
    evaluate('(roslisp:start-ros-node "lisp")')
    evaluate("""(roslisp:def-service-callback roscpp_tutorials-srv:TwoInts (a b) (roslisp:make-response :sum (+ a b)))
                (roslisp:register-service "/sum" roscpp_tutorials-srv:TwoInts)""")

    def client():
        with Wire(robot.address) as wire:
            while "/sum" not in wire.call("/rosapi/services")["values"]["services"]:
                pass
            assert wire.call("/sum", a=20, b=22)["values"] == {"sum": 42}

    beside(client)()


@pytest.mark.soak
def test_each_message_arrives_once(robot, joined):
    evaluate, _ = joined
    evaluate("""(roslisp:start-ros-node "lisp")
                (defparameter *heard* nil)
                (defparameter *pub* (roslisp:advertise "/chatter" "std_msgs/String"))
                (roslisp:subscribe "/chatter" "std_msgs/String" (lambda (m) (push (std_msgs-msg:data m) *heard*)))""")
    for _ in range(100):
        evaluate('(unless *heard* (roslisp:publish-msg *pub* :data "first"))')
        kernel.sleep(0.1)
        if evaluate("*heard*") != [None]:
            break
    evaluate("(setf *heard* nil)")
    kernel.sleep(0.3)
    evaluate("(setf *heard* nil)")
    evaluate('(dotimes (i 5) (roslisp:publish-msg *pub* :data (format nil "~a" i)))')
    for _ in range(100):
        kernel.sleep(0.05)
        if evaluate("(length *heard*)") == [5]:
            break
    kernel.sleep(0.2)
    assert str(evaluate("(reverse *heard*)")[0]) == "('0' '1' '2' '3' '4')"


@pytest.mark.soak
def test_a_lost_connection_fails_what_waits_and_comes_back(robot, joined):
    from cramhy_runtime.lisp_core.condition_types import Condition

    evaluate, link = joined
    evaluate('(roslisp:start-ros-node "lisp")')
    assert evaluate('(roslisp:wait-for-service "/clear" 10)') == [True]
    robot.ask("drop")
    while link.connected:
        kernel.sleep(0.02)
    with pytest.raises(Condition) as caught:
        evaluate('(roslisp:call-service "/clear" "std_srvs/Empty")')
    assert "no provider" in caught.value.report()
    assert evaluate('(roslisp:wait-for-service "/clear" 30)') == [True]
    evaluate('(roslisp:call-service "/clear" "std_srvs/Empty")')
    assert link.connected
    robot.process.kill()
    while link.connected:
        kernel.sleep(0.02)
    with pytest.raises(Condition) as caught:
        evaluate('(roslisp:get-param "/turtlesim/background_b")')
    assert re.fullmatch(
        f"/rosapi/has_param cannot be asked at {robot.shown}: the connection to {robot.shown} is lost since "
        r"\d\d:\d\d:\d\d, and is tried again",
        caught.value.report(),
    )
    lines = []
    run_line("rosparam list", lines.append)
    assert lines[0].startswith(f"ERROR: /rosapi/get_param_names cannot be asked at {robot.shown}: the connection to {robot.shown} is lost ")
    link.close()
    while link.ros.factory.continueTrying:  # so that it ends also where nobody is at the other end any more
        kernel.sleep(0.02)


@pytest.mark.soak
def test_virtual_time_cannot_join(serve):
    from cramhy_runtime.rosbridge.server import ServerError

    kernel.start(clock="virtual")
    with pytest.raises(ServerError) as caught:
        rosbridge.attach("ws://robot:9090")
    assert str(caught.value) == (
        "A session in virtual time cannot join ws://robot:9090: the robot there lives in wall time. Start it with --time wall."
    )


@pytest.mark.soak
def test_where_nobody_answers(serve):
    from cramhy_runtime.rosbridge.server import ServerError

    kernel.start(clock="wall")
    with pytest.raises(ServerError) as caught:
        rosbridge.attach("ws://127.0.0.1:1", patience=1)
    assert str(caught.value) == (
        "No rosbridge server answers at ws://127.0.0.1:1. Does it run there (roslaunch rosbridge_server rosbridge_websocket.launch, or "
        "ros2 launch rosbridge_server rosbridge_websocket_launch.xml), and can this machine reach it?"
    )
    kernel.stop()


@pytest.mark.soak
@pytest.mark.parametrize("address, text", [
    ("ws://127.0.0.1:{port}/wrong", "{shown} is refused: the server answered 403 Forbidden. If it is a session of cramhy, the token in "
     "this address is wrong. The session prints its address with the right one when it starts with --serve (docs/ros-bridge.md)."),
    ("ws://127.0.0.1:{port}", "{url} is refused: the token is missing in this address. The session prints its address with the right "
     "one when it starts with --serve (docs/ros-bridge.md)."),
    ("wss://127.0.0.1:{port}/x", "The server at {shown} does not speak TLS. Try ws://127.0.0.1:{port}/..."),
])  # fmt: skip
def test_a_refusal_is_told_in_one_line_and_no_library_writes_a_log(robot, capfd, monkeypatch, address, text):
    import logging

    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.rosbridge.server import ServerError

    Session(time="wall")
    url = address.format(port=robot.port)
    monkeypatch.setattr(logging.getLogger(), "handlers", [])  # pytest's own would take what a terminal gets
    capfd.readouterr()
    with pytest.raises(ServerError) as caught:
        rosbridge.attach(url)
    kernel.stop()
    assert str(caught.value) == text.format(url=url, shown=shown(url), port=robot.port)
    assert "".join(capfd.readouterr()) == ""


@pytest.mark.parametrize("answer, text", [
    ("401 Unauthorized", "{shown} is refused: the server answered 401 Unauthorized. If it is a session of cramhy, the token in this "
     "address is wrong. The session prints its address with the right one when it starts with --serve (docs/ros-bridge.md)."),
    ("404 Not Found", "{shown} is refused: the server answered 404 Not Found. Is it a rosbridge server, and is this its address?"),
    ("503", "{shown} is refused: the server answered 503. Is it a rosbridge server, and is this its address?"),
])  # fmt: skip
def test_what_another_server_answers_is_told(answer, text):
    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.rosbridge.server import ServerError

    Session(time="wall")
    with socket.create_server(("127.0.0.1", 0)) as server:

        def say_no():
            with contextlib.suppress(OSError):  # the test has ended
                while True:
                    client, _ = server.accept()
                    with client, client.makefile("rb") as request:
                        while request.readline().strip():
                            pass
                        client.sendall(f"HTTP/1.1 {answer}\r\nContent-Length: 0\r\n\r\n".encode())

        threading.Thread(target=say_no, daemon=True).start()
        url = f"ws://127.0.0.1:{server.getsockname()[1]}/x"
        with pytest.raises(ServerError) as caught:
            rosbridge.attach(url)
    kernel.stop()
    assert str(caught.value) == text.format(shown=shown(url))


@pytest.mark.soak
def test_an_answer_that_comes_too_late_is_waited_for_no_more(robot, joined, monkeypatch):
    from cramhy_runtime.lisp_core.condition_types import Condition
    from cramhy_runtime.rosbridge import attachment

    _, link = joined
    monkeypatch.setattr(attachment, "PATIENCE", 0.1)
    monkeypatch.setattr(link, "call", lambda name, values, done, failed: link._waiting.setdefault(7, (done, failed)) and 7)
    with pytest.raises(Condition) as caught:
        link.ask("/rosapi/topics")
    assert caught.value.report() == f"/rosapi/topics cannot be asked at {robot.shown}: no answer came within 0.1 s"
    assert 7 not in link._waiting


@pytest.mark.soak
def test_a_service_whose_type_is_not_known_here_is_asked_about_once(joined, monkeypatch):
    _, link = joined
    asked = []

    def call(name, values, done, failed):
        asked.append(values["service"])
        done({"type": "nowhere_msgs/Fly"})

    monkeypatch.setattr(link, "call", call)
    there = [name for name in link.graph.services if name in link.node.services]
    for names in (["/fly"], ["/fly"], [], ["/fly"]):
        link._services_are(there + names)
    assert asked == ["/fly", "/fly"]


@pytest.mark.soak
def test_what_the_other_side_complains_of_is_logged(robot, joined, capsys):
    evaluate, link = joined
    evaluate('(roslisp:start-ros-node "lisp")')
    link.graph.node("native").advertise("/turtle1/pose", message_class_exact("std_msgs/String"))
    said = ""
    while "complains" not in said:
        kernel.sleep(0.05)
        said += capsys.readouterr().out
    assert f"{robot.shown} complains: The topic /turtle1/pose has messages of the type turtlesim/Pose, not std_msgs/String." in said


def test_where_ros_2_is_a_parameter_stays_here_and_that_is_said_once(graph, capsys):
    from cramhy_runtime.ros.parameter_tree import ParameterTree
    from cramhy_runtime.rosbridge.attachment import NearParameters

    before = ParameterTree()
    before.set("/old", 1)
    parameters = NearParameters(before, "ws://robot:9090")
    parameters.set("/a/b", 2)
    parameters.set("/c", 3)
    assert capsys.readouterr().out.partition(": ")[2] == (
        "The parameter /a/b is set in this session only: at ws://robot:9090 is ROS 2, where each parameter belongs to one node. "
        "Set it there with: ros2 param set NODE NAME VALUE\n"
    )
    assert parameters.names() == ["/a/b", "/c", "/old"] and parameters.get("/a/b") == 2


@pytest.mark.soak
def test_ros_2_spells_times_and_headers_its_own_way():
    from cramhy_runtime.ros.message_json import to_json
    from cramhy_runtime.rosbridge.attachment import as_ros2

    stamped = message_class_exact("geometry_msgs/PoseStamped")
    header = message_class_exact("std_msgs/Header")(seq=3, stamp=1.5, frame_id="map")
    found = as_ros2(stamped, to_json(stamped(header=header)))
    assert found["header"] == {"stamp": {"sec": 1, "nanosec": 500000000}, "frame_id": "map"}
    assert found["pose"]["orientation"] == {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}
