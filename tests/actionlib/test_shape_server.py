"""``rosrun turtle_actionlib shape_server``: what the turtle draws, and what clients are told."""

import math

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.actionlib import goals
from cramhy_runtime.actionlib.shape_server import Polygon, ShapeClient, ShapeServer
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.session import boot
from cramhy_runtime.turtlesim.node import start_turtlesim

boot()
SUCCEEDED, PREEMPTED, ABORTED = goals.SUCCEEDED, goals.PREEMPTED, goals.ABORTED


class Asking:
    """A client that only knows the topics, as one on another machine does. ``results``: what has come, newest last."""

    def __init__(self, action="/turtle_shape"):
        self.node = graph.active().node("asking")
        self.goal_type = message_class_exact("turtle_actionlib/ShapeActionGoal")
        self.cancel_type = message_class_exact("actionlib_msgs/GoalID")
        self.goal = self.node.advertise(f"{action}/goal", self.goal_type)
        self.cancelling = self.node.advertise(f"{action}/cancel", self.cancel_type)
        self.results, self.poses = [], []
        self.node.subscribe(f"{action}/result", message_class_exact("turtle_actionlib/ShapeActionResult"), self.results.append)
        self.node.subscribe("/turtle1/pose", message_class_exact("turtlesim/Pose"), self.poses.append)

    def ask(self, edges, radius, name=""):
        message = self.goal_type()
        message.goal_id.id, message.goal.edges, message.goal.radius = name, edges, radius
        self.goal.publish(message)

    def cancel(self):
        self.cancelling.publish(self.cancel_type())

    def wait(self, seconds=60.0):
        """Wait for one more result; (state, text, result) of it, or ``None``."""
        there, until = len(self.results), kernel.now() + seconds
        while len(self.results) == there and kernel.now() < until:
            kernel.sleep(0.1)
        return self.told() if len(self.results) > there else None

    def told(self):
        newest = self.results[-1]
        return newest.status.status, newest.status.text, newest.result

    def place(self):
        return tuple(map(float, self.poses[-1].values()[:3]))


@pytest.fixture
def simulator():
    kernel.start(clock="virtual")
    yield start_turtlesim()
    kernel.stop()


@pytest.fixture
def server(simulator):
    return ShapeServer()


@pytest.fixture
def asking(server):
    made = Asking()
    kernel.sleep(0.1)
    return made


def corners(poses, edges):
    """The places at which the turtle stood still and turned, in order, without repetitions."""
    found = []
    for pose in poses:
        x, y, _, speed, turn = map(float, pose.values())
        if abs(turn) > 0.01 and speed == 0 and (not found or math.dist(found[-1], (x, y)) > 0.01):
            found.append((x, y))
    return found


def texts(program):
    return [line.split("]: ", 1)[1] for line in program.lines]


@pytest.mark.parametrize(("edges", "radius"), [(3, 2.0), (4, 1.0), (5, 1.3), (7, 0.5)])
def test_the_turtle_draws_the_polygon_and_is_back_where_it_began(asking, server, edges, radius):
    x, y, heading = asking.place()
    asking.ask(edges, radius)
    state, _, result = asking.wait()
    assert state == SUCCEEDED
    assert result.interior_angle == pytest.approx((edges - 2) * math.pi / edges)
    assert result.apothem == pytest.approx(radius * math.cos(math.pi / edges))
    drawn = corners(asking.poses, edges)
    side = 2 * radius * math.sin(math.pi / edges)
    assert len(drawn) == edges
    assert [math.dist(a, b) for a, b in zip(drawn, drawn[1:])] == pytest.approx([side] * (edges - 1), abs=1e-3)
    assert asking.place()[:2] == pytest.approx((x, y), abs=1e-3)
    assert math.remainder(asking.place()[2] - heading, 2 * math.pi) == pytest.approx(0, abs=1e-3)
    assert texts(server) == ["/turtle_shape: Succeeded"]


def test_two_edges_are_a_line_there_and_back(asking):
    x, y, _ = asking.place()
    asking.ask(2, 2.0)
    state, _, result = asking.wait()
    assert (state, result.interior_angle) == (SUCCEEDED, 0.0)
    assert max(float(pose.x) for pose in asking.poses) == pytest.approx(x + 4, abs=1e-3)
    assert asking.place()[:2] == pytest.approx((x, y), abs=1e-3)


def test_a_newer_goal_takes_the_place_of_the_one_that_is_drawn(asking, server):
    asking.ask(5, 2.0, "first")
    kernel.sleep(3)
    asking.ask(3, 0.5, "second")
    assert (asking.results[-1].status.goal_id.id, asking.told()[0]) == ("first", PREEMPTED)
    assert asking.wait()[0] == SUCCEEDED and asking.results[-1].status.goal_id.id == "second"
    assert texts(server) == ["/turtle_shape: Preempted", "/turtle_shape: Succeeded"]


def test_a_cancelled_goal_is_preempted_and_the_turtle_comes_to_rest(asking, server):
    asking.ask(5, 2.0)
    kernel.sleep(2)
    asking.cancel()
    assert asking.told()[0] == PREEMPTED
    kernel.sleep(1.5)
    place = asking.place()
    kernel.sleep(3)
    assert asking.place() == place and len(asking.results) == 1


@pytest.mark.parametrize(("edges", "radius"), [(0, 1.0), (-3, 1.0), (3, math.nan), (3, math.inf)])
def test_a_goal_that_is_no_polygon_is_aborted_and_says_why(asking, server, edges, radius):
    from cramhy_runtime.ros.wire import lisp_float

    place = asking.place()
    asking.ask(edges, lisp_float(radius))
    state, text, _ = asking.told()
    assert state == ABORTED
    assert text == f"A shape has at least one edge and a radius in metres, not {edges} edges and the radius {radius:g}."
    kernel.sleep(1)
    assert asking.place() == place
    asking.ask(3, 0.5)
    assert asking.wait()[0] == SUCCEEDED


def test_the_action_has_the_name_of_the_node(simulator):
    ShapeServer(arguments=["__name:=shape", "__ns:=/left"])
    asking = Asking("/left/shape")
    kernel.sleep(0.1)
    asking.ask(1, 1.0)
    assert asking.wait(5)[0] == SUCCEEDED


def test_two_servers_draw_under_two_names(simulator):
    ShapeServer()
    ShapeServer(arguments="__name:=other")
    one, other = Asking(), Asking("/other")
    kernel.sleep(0.1)
    other.ask(3, 0.5)
    assert other.wait()[0] == SUCCEEDED and one.results == []


def test_the_states_are_told_while_it_draws_and_no_more_when_the_node_has_ended(asking, server):
    states = []
    asking.node.subscribe(
        "/turtle_shape/status",
        message_class_exact("actionlib_msgs/GoalStatusArray"),
        lambda heard: states.append([status.status for status in heard.status_list]),
    )
    asking.ask(3, 1.0)
    kernel.sleep(1)
    assert [goals.ACTIVE] in states and len(states) >= 4
    server.shutdown()
    count = len(states)
    kernel.sleep(2)
    assert len(states) == count and "/turtle_shape" not in graph.active().nodes


def test_the_client_draws_a_pentagon_and_ends(server):
    client = ShapeClient()
    kernel.sleep(30)
    assert texts(client) == ["Waiting for action server to start.", "Action server started, sending goal.", "Action finished: SUCCEEDED"]
    assert not client.alive


def test_the_client_waits_for_the_server_and_gives_up_after_40_s(simulator):
    client = ShapeClient()
    kernel.sleep(60)
    assert client.alive
    server = ShapeServer()
    kernel.sleep(1)
    simulator.shutdown()  # nobody draws any more
    kernel.sleep(60)
    assert texts(client)[-1] == "Action did not finish before the time out." and not client.alive
    assert server.polygon is not None


def test_lisp_draws_with_the_client_of_the_tutorial(simulator):
    from cramhy_runtime.repl.session import Session
    from lisp_text import LispText

    kernel.stop()
    session = Session(time="virtual", turtlesim=True, time_limit=3600)
    lisp = LispText(session, "(defpackage :shape-client (:use :cl :roslisp)) (in-package :shape-client)")
    lisp.values('(start-ros-node "shape_client")')
    ShapeServer(arguments="__name:=shape")
    told = lisp.values(
        """(let ((client (actionlib:make-action-client "shape" "turtle_actionlib/ShapeAction")))
             (actionlib:wait-for-server client)
             (multiple-value-bind (result status)
                 (actionlib:call-goal client (actionlib:make-action-goal client :edges 4 :radius 1))
               (with-fields (apothem) result (list status (< 0.70 apothem 0.71)))))"""
    )
    assert repr(told) == "[(:SUCCEEDED True)]"


@pytest.mark.parametrize("edges", [1, 2, 3, 12, 1000])
def test_a_polygon_closes_whatever_the_size_of_a_step(edges):
    polygon, x, y, heading = Polygon(edges, 1.0), 3.0, 4.0, 1.0
    for _ in range(400 * edges):
        speed, turn = polygon.command(x, y, heading)
        x, y, heading = x + 0.05 * speed * math.cos(heading), y + 0.05 * speed * math.sin(heading), heading + 0.05 * turn
        if polygon.done == edges:
            break
    assert polygon.done == edges and (x, y) == pytest.approx((3.0, 4.0), abs=0.01 * max(1, edges / 10))
