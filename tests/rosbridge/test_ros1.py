"""A session joined to a robot that has the manners of ROS 1's rosbridge_suite 0.11.17 (`ros1_peer.py`), over a network that stalls."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cramhy_runtime import kernel, rosbridge
from cramhy_runtime.lisp_core.condition_types import Condition
from stalling_proxy import StallingProxy

pytest.importorskip("roslibpy")
pytest.importorskip("websockets")

PEER = Path(__file__).with_name("ros1_peer.py")
CMD, POSE = "/turtle1/cmd_vel", "/turtle1/pose"
TOLD = 3.0  # s until a stall is told
ATTEMPTS = 3  # of which one must keep that time, since the machine may have been busy with other things


class Robot:
    """The process of a robot, its address, and its commands."""

    def __init__(self, *words, program=sys.executable):
        self.process = subprocess.Popen([program, str(PEER), *words], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.address = json.loads(self.process.stdout.readline())
        self.port = int(self.address.rpartition(":")[2])

    def __getattr__(self, name):
        def command(*words):
            def talk():
                self.process.stdin.write(json.dumps([name, *words]) + "\n")
                self.process.stdin.flush()
                return json.loads(self.process.stdout.readline())

            return kernel.run_blocking(talk) if kernel.active() is not None else talk()

        return command

    def heard(self, op, **wanted):
        """The operations of this kind that have come, with the times."""
        return [(when, each) for when, each in self.ops() if each["op"] == op and wanted.items() <= each.items()]

    def signal(self, number):
        self.process.send_signal(number)

    def end(self):
        self.signal(signal.SIGCONT)
        self.process.kill()
        self.process.wait()


@pytest.fixture
def robot():
    found = Robot()
    yield found
    found.end()


@pytest.fixture
def proxy(robot):
    found = StallingProxy(robot.port)
    yield found
    found.close()


@pytest.fixture
def join(robot, proxy):
    """A function that joins a session to the robot through the proxy: (evaluate, link)."""
    from cramhy_runtime.repl.session import Session

    links = []

    def start(node=True):
        session = Session(time="wall")
        session.package = "CRAM-USER"
        links.append(rosbridge.attach(f"ws://127.0.0.1:{proxy.port}"))
        if node:
            session.evaluate_text('(roslisp:start-ros-node "lisp")')
        return session.evaluate_text, links[-1]

    yield start
    proxy.resume()
    for link in links:
        link.close()
    kernel.stop()


def until(condition, what, seconds=30):
    """Wait until ``condition()``; its value."""
    end = kernel.now() + seconds
    while not (found := condition()):
        assert kernel.now() < end, f"{what} does not come about"
        kernel.sleep(0.02)
    return found


def failure(work, *arguments):
    """The text of the error that ``work(...)`` signals."""
    with pytest.raises(Condition) as caught:
        work(*arguments)
    return caught.value


# ------------------------------------------------------------------------------------------------------------------- types


@pytest.mark.parametrize("form, text, advice", [
    ('(roslisp:advertise "/turtle1/cmd_vel" "std_msgs/String")',
     "The topic /turtle1/cmd_vel has messages of the type geometry_msgs/Twist at {there}, not std_msgs/String, so no message would arrive.",
     'Try (advertise "/turtle1/cmd_vel" "geometry_msgs/Twist"), or another topic.'),
    ('(roslisp:subscribe "/turtle1/pose" "geometry_msgs/Pose" (lambda (m) m))',
     "The topic /turtle1/pose has messages of the type turtlesim/Pose at {there}, not geometry_msgs/Pose, so no message would arrive.",
     'Try (subscribe "/turtle1/pose" "turtlesim/Pose" callback), or another topic.'),
])  # fmt: skip
def test_another_type_than_the_robots_is_an_error_where_it_is_asked_for(robot, join, form, text, advice):
    evaluate, link = join()
    problem = failure(evaluate, form)
    assert problem.report() == text.format(there=link.shown)
    assert str(problem.hint).startswith(advice)
    link.look()
    assert robot.heard("advertise") == robot.heard("subscribe") == [] and robot.wrong() == []


@pytest.mark.soak
def test_the_robots_type_and_topics_that_are_new_are_taken(robot, join):
    evaluate, _ = join()
    evaluate("""(roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist") (roslisp:advertise "/mine" "std_msgs/String")
                (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (m) m))""")
    until(lambda: len(robot.heard("advertise")) == 2 and robot.heard("subscribe"), "what was advertised")
    assert robot.wrong() == []


def test_a_type_that_is_the_same_on_the_wire_goes_under_the_robots_name(robot, join):
    evaluate, _ = join()
    robot.define("/tf", "tf2_msgs/TFMessage")
    evaluate('(roslisp:advertise "/tf" "tf/tfMessage")')
    assert until(lambda: robot.heard("advertise"), "the topic")[0][1]["type"] == "tf2_msgs/TFMessage"


@pytest.mark.soak
def test_a_type_that_differs_after_the_return_is_logged(robot, proxy, join, capsys):
    evaluate, link = join()
    evaluate('(roslisp:advertise "/news" "std_msgs/String")')
    robot.define("/news", "std_msgs/Int32")
    proxy.cut()
    until(lambda: not link.connected, "the loss")
    until(lambda: link.connected, "the return")
    text = f"/news has messages of the type std_msgs/Int32 at {link.shown}, not std_msgs/String, so none of them arrives."
    until(lambda: text in capsys.readouterr().out, "the line")


# ---------------------------------------------------------------------------------------------------------------- services


def test_joining_is_over_when_the_services_are_known(robot, join):
    robot.late(0.4)
    evaluate, _ = join()
    robot.late(0)
    evaluate('(roslisp:call-service "/clear" "std_srvs/Empty")')
    evaluate("""(roslisp:call-service "/turtle1/teleport_absolute" 'turtlesim-srv:TeleportAbsolute :x 1 :y 2 :theta 0)""")
    assert robot.pose()["x"] == 1


@pytest.mark.soak
def test_services_whose_types_nobody_tells_are_named_and_do_not_keep_the_session_out(robot, join, monkeypatch, capsys):
    from cramhy_runtime.rosbridge import attachment

    monkeypatch.setattr(attachment, "PATIENCE", 1.0)
    robot.mute("/clear")
    evaluate, link = join()
    assert (
        f"{link.shown} has not told the types of these services within 1 s: /clear. They can be called as soon as it does."
        in capsys.readouterr().out
    )
    evaluate("""(roslisp:call-service "/turtle1/teleport_absolute" 'turtlesim-srv:TeleportAbsolute :x 1 :y 2 :theta 0)""")


@pytest.mark.soak
def test_a_robot_that_does_not_answer_while_the_session_joins_is_told_as_that(robot, proxy, join):
    from cramhy_runtime.rosbridge.server import ServerError

    robot.late(3600)
    kernel.start(clock="wall")
    outcome = []

    def stall():
        until(lambda: robot.heard("call_service"), "the first question")
        proxy.stall()

    kernel.spawn(stall)
    try:
        rosbridge.attach(f"ws://127.0.0.1:{proxy.port}")
    except ServerError as problem:
        outcome.append(str(problem))
    kernel.stop()
    there = f"ws://127.0.0.1:{proxy.port}"
    assert outcome == [
        f"{there} cannot be joined, since /rosapi/topics cannot be asked there: the connection to {there} was lost: nothing "
        "has come from there for 2 s. Does the node rosapi run there, and does the network carry?"
    ]


@pytest.mark.soak
def test_while_the_connection_is_lost_a_missing_service_says_so(robot, proxy, join):
    evaluate, link = join()
    proxy.stall()
    proxy.cut()
    until(lambda: not link.connected, "the loss")
    problem = failure(evaluate, '(roslisp:call-service "/clear" "std_srvs/Empty")')
    assert re.fullmatch(
        r"ros-rpc call \(lookupService /clear\) to .* failed with code -1, message no provider: the connection to "
        + re.escape(link.shown)
        + r" is lost since \d\d:\d\d:\d\d, and is tried again, values ",
        problem.report(),
    )
    assert problem.hint == '(wait-for-service "/clear") waits until the service is there again.'
    proxy.resume()
    assert evaluate('(roslisp:wait-for-service "/clear" 30)') == [True]
    evaluate('(roslisp:call-service "/clear" "std_srvs/Empty")')
    problem = failure(evaluate, '(roslisp:call-service "/nowhere" "std_srvs/Empty")')
    assert problem.hint.startswith("No node offers this service.")


OFFER = """(roslisp:def-service-callback roscpp_tutorials-srv:TwoInts (a b)
             (cond ((= a 0) (error "no zero")) ((= a 1) (sleep 1000)))
             (roslisp:make-response :sum (+ a b)))
           (roslisp:register-service "/sum" roscpp_tutorials-srv:TwoInts)"""


def offered(robot, evaluate):
    evaluate(OFFER)
    until(lambda: "/sum" in robot.services(), "the service")


@pytest.mark.soak
def test_the_robot_calls_a_service_of_the_plan(robot, join):
    evaluate, _ = join()
    offered(robot, evaluate)
    robot.call("/sum", {"a": 20, "b": 22})
    assert until(lambda: robot.calls()[0], "the answer") == [True, {"sum": 42}]


@pytest.mark.soak
def test_a_failure_of_a_service_of_the_plan_reaches_its_caller_and_the_service_stays(robot, join):
    evaluate, _ = join()
    offered(robot, evaluate)
    robot.call("/sum", {"a": 0, "b": 0})
    assert until(lambda: robot.calls()[0], "the failure")[0] is False
    until(lambda: len(robot.heard("advertise_service")) == 2 and "/sum" in robot.services(), "the service")
    robot.call("/sum", {"a": 20, "b": 22})
    assert until(lambda: robot.calls()[1], "the answer") == [True, {"sum": 42}]


@pytest.mark.soak
def test_callers_of_a_connection_that_was_lost_are_told_and_a_late_answer_reaches_nobody_else(robot, proxy, join):
    evaluate, link = join()
    offered(robot, evaluate)
    robot.call("/sum", {"a": 1, "b": 1})  # it is served for ever
    until(lambda: link.offering.calls, "the call")
    proxy.cut()
    until(lambda: not link.connected, "the loss")
    until(lambda: link.connected, "the return")
    assert until(lambda: robot.calls()[0], "the failure")[0] is False
    until(lambda: "/sum" in robot.services(), "the service")
    assert link.offering.calls == {}


@pytest.mark.soak
@pytest.mark.parametrize("end", ["close", "stop", "shutdown"])
def test_services_and_topics_are_withdrawn_at_an_orderly_end_and_callers_are_told(robot, join, end):
    evaluate, link = join()
    offered(robot, evaluate)
    evaluate("""(roslisp:advertise "/mine" "std_msgs/String")
                (roslisp:subscribe "/turtle1/pose" "turtlesim/Pose" (lambda (m) m))""")
    for _ in range(2):
        robot.call("/sum", {"a": 1, "b": 1})  # the first is being served for ever, the second one waits
    until(lambda: len(link.offering.calls) == 2, "the calls")
    if end == "close":
        link.close()
    elif end == "stop":
        kernel.stop()
    else:
        evaluate("(roslisp:shutdown-ros-node)")
        until(lambda: "/sum" not in robot.services(), "the withdrawal")
        link.close()
    assert "/sum" not in robot.services()
    deadline = time.monotonic() + 30
    while not all(robot.calls()) and time.monotonic() < deadline:
        pass
    assert [outcome[0] for outcome in robot.calls()] == [False, False]
    assert {each["topic"] for _, each in robot.heard("unadvertise")} == {"/mine"}
    assert {each["topic"] for _, each in robot.heard("unsubscribe")} == {POSE}
    assert len(robot.heard("unadvertise_service")) == 1


# ------------------------------------------------------------------------------------------------- a network that stalls


def stalls(robot, proxy, how):
    """Two functions: one makes the network carry nothing, one makes it carry again."""
    if how == "network":
        return proxy.stall, proxy.resume
    return lambda: robot.signal(signal.SIGSTOP), lambda: robot.signal(signal.SIGCONT)


pytestmark_posix = pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no process can be stopped here")
HOW = pytest.mark.parametrize("how", ["network", pytest.param("process", marks=pytestmark_posix)])


@pytest.mark.soak(only=("process",))
@HOW
def test_a_stall_is_told_within_three_seconds_and_what_waits_fails_with_that_reason(robot, proxy, join, capsys, how):
    evaluate, link = join()
    stall, resume = stalls(robot, proxy, how)
    times = []
    for _ in range(ATTEMPTS):
        outcome = []
        kernel.spawn(lambda: outcome.append(failure(evaluate, '(roslisp:call-service "/slow" "std_srvs/Empty")')))
        until(lambda: any("/slow" in number for number in link._waiting), "the call")
        kernel.sleep(0.3)
        capsys.readouterr()
        stall()
        begun = kernel.now()
        until(lambda: outcome, "the failure")
        times.append(kernel.now() - begun)
        assert outcome[0].report().endswith(f"the connection to {link.shown} was lost: nothing has come from there for 2 s")
        said = capsys.readouterr().out
        assert f"The connection to {link.shown} is lost: nothing has come from there for 2 s. It is tried again and again." in said
        resume()
        until(lambda: link.connected, "the return")
        assert f"The connection to {link.shown} is there again." in capsys.readouterr().out
        evaluate('(roslisp:call-service "/clear" "std_srvs/Empty")')
        if times[-1] < TOLD:
            return
    pytest.fail(f"It was told after {times} s.")


@pytest.mark.soak
@HOW
def test_commands_of_a_stall_are_dropped_but_the_last_one_and_that_is_told(robot, proxy, join, capsys, how):
    evaluate, link = join()
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    stall, resume = stalls(robot, proxy, how)
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 0.0)")
    until(lambda: robot.heard("publish"), "the first command")
    kernel.sleep(0.3)
    stall()
    for number in range(1, 61):
        evaluate(f"(roslisp:publish-msg *cmd* (:x :linear) {number}.0)")
        kernel.sleep(0.05)
    until(lambda: not link.connected, "the loss")
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 0.5)")  # what the cleanup of the plan sends
    kernel.sleep(0.7)
    resume()
    until(lambda: link.connected, "the return")
    sent = until(
        lambda: (
            [each["msg"]["linear"]["x"] for _, each in robot.heard("publish")][-1] == 0.5
            and [each["msg"]["linear"]["x"] for _, each in robot.heard("publish")]
        ),
        "the last command",
    )
    assert sent[-1] == 0.5 and len(sent) < 30, sent
    assert not [number for number in sent if 20 < number < 60], sent  # those of the middle are stale
    assert robot.heard("advertise")[-1][0] < robot.heard("publish")[-1][0]
    said = capsys.readouterr().out
    told = re.search(
        rf"(\d+) messages that would have come to {re.escape(link.shown)} more than 0.5 s late were dropped "
        rf"\(\1 on {CMD}\). The last one of each topic was delivered.",
        said,
    )
    doubtful = re.search(r"again and again. (\d+) of the messages that were under way may be lost.", said)
    assert told and int(told[1]) + int(doubtful[1] if doubtful else 0) + len(sent) >= 61, said


@pytest.mark.soak
def test_a_stop_command_that_was_under_way_when_the_network_went_arrives_when_it_is_back(robot, proxy, join):
    evaluate, link = join()
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    until(lambda: robot.heard("advertise"), "the topic")
    kernel.sleep(0.3)
    proxy.stall()
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 7.0)")
    until(lambda: not link.connected, "the loss")
    proxy.cut()
    proxy.resume()
    until(lambda: link.connected, "the return")
    until(lambda: [each for _, each in robot.heard("publish") if each["msg"]["linear"]["x"] == 7.0], "the command")


@pytest.mark.soak
def test_a_hiccup_of_the_network_costs_no_message(robot, proxy, join):
    evaluate, link = join()
    evaluate('(defparameter *chat* (roslisp:advertise "/chat" "std_msgs/String"))')
    until(lambda: robot.heard("advertise"), "the topic")
    for _ in range(ATTEMPTS):
        before = len(robot.heard("publish"))
        proxy.stall()
        until(lambda: link.uplink.quiet or not link.connected, "the silence")
        for number in range(5):
            evaluate(f'(roslisp:publish-msg *chat* :data "{number}")')
        proxy.resume()
        until(lambda: link.connected and not link.outflow.held, "the flow")
        until(lambda: [each for _, each in robot.heard("publish")][before:][-1:] != [], "the messages")
        until(lambda: robot.heard("publish")[-1][1]["msg"]["data"] == "4", "the last message")
        sent = [each["msg"]["data"] for _, each in robot.heard("publish")][before:]
        if sent == list("01234"):
            return
    pytest.fail(f"Of five messages came {sent}")


@pytest.mark.soak
def test_a_session_that_was_stopped_itself_takes_nothing_for_a_stall(robot, proxy, tmp_path):
    if not hasattr(signal, "SIGSTOP"):
        pytest.skip("no process can be stopped here")
    child = subprocess.Popen(
        [sys.executable, "-m", "cramhy_runtime.cli", "repl", "--ros", robot.address],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        child.stdin.write('(roslisp:start-ros-node "x")\n')
        child.stdin.flush()
        while "Node startup complete" not in child.stdout.readline():
            pass
        for _ in range(2):
            child.send_signal(signal.SIGSTOP)
            time.sleep(3)
            child.send_signal(signal.SIGCONT)
            time.sleep(0.5)
        rest, _ = child.communicate('(roslisp:call-service "/clear" "std_srvs/Empty")\n', timeout=60)
        assert "is lost" not in rest and child.returncode == 0
    finally:
        child.kill()


@pytest.mark.soak
def test_the_stop_command_of_a_plan_that_ends_in_a_stall_waits_for_the_network(robot, proxy, join):
    evaluate, link = join()
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    until(lambda: robot.heard("advertise"), "the topic")
    proxy.stall()
    until(lambda: link.uplink.quiet or not link.connected, "the silence")
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 9.0)")
    import threading

    threading.Timer(1.0, proxy.resume).start()
    kernel.stop()
    assert [each for _, each in robot.heard("publish") if each["msg"]["linear"]["x"] == 9.0]


def test_the_last_message_of_an_orderly_end_comes_once(robot, join):
    evaluate, link = join()
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    evaluate("(dotimes (i 10) (roslisp:publish-msg *cmd* (:x :linear) (float i)))")
    link.close()
    assert [each["msg"]["linear"]["x"] for _, each in robot.heard("publish")] == [float(number) for number in range(10)]


@pytest.mark.soak
def test_a_last_message_that_nobody_confirms_is_told(robot, proxy, join, capsys):
    evaluate, link = join()
    evaluate(f'(defparameter *cmd* (roslisp:advertise "{CMD}" "geometry_msgs/Twist"))')
    until(lambda: robot.heard("advertise"), "the topic")
    proxy.stall()
    until(lambda: not link.connected, "the loss")
    evaluate("(roslisp:publish-msg *cmd* (:x :linear) 9.0)")
    link.close()
    assert (
        f"{link.shown} has not confirmed the last messages on {CMD} before the session left. If one of them was to stop the robot, "
        "stop it there."
    ) in capsys.readouterr().out


# --------------------------------------------------------------------------------------------------------------- the course


@pytest.mark.soak
def test_the_plan_of_the_course_drives_the_robot_before_and_after_a_cut(robot, proxy, join):
    from cramhy_runtime.session import Image

    with Image(as_now=True):
        evaluate, link = join(node=False)
        evaluate('(asdf:load-system "cram-my-beginner-tutorial")')
        evaluate("(in-package :tut)")
        evaluate('(start-ros-node "turtle1")')
        evaluate('(init-ros-turtle "turtle1")')
        evaluate("(top-level (wait-for *turtle-pose*))")
        arrive(robot, lambda: evaluate("(top-level (move-to (make-3d-vector 7 6 0)))"), 7, 6)
        proxy.cut()
        until(lambda: not link.connected, "the loss")
        until(lambda: link.connected, "the return")
        arrive(robot, lambda: evaluate("(top-level (move-to (make-3d-vector 5 5 0)))"), 5, 5)


def arrive(robot, drive, x, y):
    for _ in range(ATTEMPTS):
        drive()
        pose = robot.pose()
        if abs(pose["x"] - x) < 0.5 and abs(pose["y"] - y) < 0.5:
            return
    pytest.fail(f"It drove to {pose}, not to {x}, {y}.")
