"""A listener of the simulator hears all that reaches it, and decides which commands count."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.repl.session import Session
from cramhy_runtime.turtlesim.node import running_simulator

BEGINNING = """
(roslisp:start-ros-node "listening")
(defparameter *velocity* (roslisp:advertise "turtle1/cmd_vel" "geometry_msgs/Twist"))
(defun drive (speed turn)
  (roslisp:publish *velocity*
    (roslisp:make-message "geometry_msgs/Twist" (:x :linear) speed (:z :angular) turn))
  (sleep 1.5))
"""


@pytest.fixture
def session():
    made = Session(time="virtual")
    made.evaluate_text(BEGINNING)
    yield made
    kernel.stop()


def heard(session, text, answer=lambda kind, turtle, values: values):
    found = []

    def listener(kind, turtle, values):
        found.append((kind, turtle, values))
        return answer(kind, turtle, values)

    running_simulator().listener = listener
    session.evaluate_text(text)
    return found


def test_it_hears_commands_and_services_in_their_order(session):
    found = heard(
        session,
        """(drive 2 0.5)
        (roslisp:call-service "turtle1/set_pen" "turtlesim/SetPen" :r 1 :g 2 :b 3 :width 4 :off 0)
        (roslisp:call-service "turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x 1 :y 2 :theta 3)
        (roslisp:call-service "turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear 1 :angular 2)
        (roslisp:call-service "spawn" "turtlesim/Spawn" :x 4 :y 5 :theta 0)
        (roslisp:call-service "kill" "turtlesim/Kill" :name "turtle2")
        (roslisp:call-service "clear" "std_srvs/Empty")
        (roslisp:call-service "reset" "std_srvs/Empty")""",
    )
    assert found == [
        ("command", "turtle1", (2.0, 0.0, 0.5)),
        ("set_pen", "turtle1", (1, 2, 3, 4, 0)),
        ("teleport_absolute", "turtle1", (1.0, 2.0, 3.0)),
        ("teleport_relative", "turtle1", (1.0, 2.0)),
        ("spawn", "turtle2", (4.0, 5.0, 0.0)),
        ("kill", "turtle2", ()),
        ("clear", "", ()),
        ("reset", "", ()),
        ("spawn", "turtle1", pytest.approx((5.544444561, 5.544444561, 0.0))),
    ]


def test_a_command_that_it_loses_does_not_move_the_turtle(session):
    turtle = running_simulator().turtles["turtle1"]
    before = turtle.pose()
    heard(session, "(drive 2 0)", lambda *_: None)
    assert turtle.pose() == before


def test_a_command_that_it_changes_counts_as_changed(session):
    turtle = running_simulator().turtles["turtle1"]
    x = turtle.x
    heard(session, "(drive 2 0)", lambda kind, turtle, values: (values[0] / 2, 0.0, 0.0))
    assert turtle.x == pytest.approx(x + 1, abs=0.03)


def test_a_push_moves_the_turtle_without_a_line_and_not_through_a_wall(session):
    simulator = running_simulator()
    turtle, lines = simulator.turtles["turtle1"], simulator.canvas.strokes()
    x, y, heading = turtle.pose()[:3]
    turtle.push(1, 2, 0.5)
    assert turtle.pose()[:3] == pytest.approx((x + 1, y + 2, heading + 0.5))
    turtle.push(-100, 100, 6)
    assert turtle.pose()[:2] == pytest.approx((0, 11.0888891), abs=1e-6) and -3.15 < turtle.pose()[2] < 3.15
    session.evaluate_text("(sleep 0.1)")
    assert simulator.canvas.strokes() == lines
