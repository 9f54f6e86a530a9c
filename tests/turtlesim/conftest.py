"""A kernel in virtual time, a simulator, and a probe that listens to it."""

import json
import re
from pathlib import Path

import pytest
from systems import ONE_BACKEND
from lisp_text import LispText

from cramhy_runtime import kernel
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact
from cramhy_runtime.turtlesim.node import start_turtlesim

SHARED = Path(__file__).resolve().parents[3] / "shared"


class Probe:
    """A node that watches one turtle and sends it commands."""

    def __init__(self, simulator, turtle="turtle1"):
        self.simulator, self.turtle = simulator, turtle
        self.node = graph.active().node("probe")
        self.poses, self.colours = [], []
        self.node.subscribe(f"/{turtle}/pose", message_class_exact("turtlesim/Pose"), self.poses.append)
        self.node.subscribe(f"/{turtle}/color_sensor", message_class_exact("turtlesim/Color"), self.colours.append)
        self.twist = message_class_exact("geometry_msgs/Twist")
        self.commands = self.node.advertise(f"/{turtle}/cmd_vel", self.twist)

    def drive(self, forward=0.0, turn=0.0, sideways=0.0):
        """One command."""
        message = self.twist()
        message.linear.x, message.linear.y, message.angular.z = forward, sideways, turn
        return self.commands.publish(message)

    def call(self, service_name, kind, /, **fields):
        """Call a service and return the response; a refusal is raised as `services.Refusal`."""
        service = graph.active().services[service_name]
        request = service_type_exact(kind).request(**fields)
        answer = services.exchange(service, request)
        if answer.failure is not None:
            raise services.Refusal(answer.failure)
        return answer.response

    def teleport(self, x, y, theta=0.0):
        self.call(f"/{self.turtle}/teleport_absolute", "turtlesim/TeleportAbsolute", x=x, y=y, theta=theta)
        kernel.sleep(0.04)

    def set_pen(self, r=0, g=0, b=0, width=0, off=0):
        self.call(f"/{self.turtle}/set_pen", "turtlesim/SetPen", r=r, g=g, b=b, width=width, off=off)

    @property
    def pose(self):
        """(x, y, theta, linear velocity, angular velocity) as last published."""
        return tuple(float(value) for value in self.poses[-1].values())

    @property
    def colour(self):
        return tuple(self.colours[-1].values())

    def log(self):
        """The texts of the simulator's log, without level and time."""
        return [line.split("]: ", 1)[1] for line in self.simulator.lines]


@pytest.fixture
def simulator():
    kernel.start(clock="virtual")
    yield start_turtlesim()
    kernel.stop()


@pytest.fixture
def watch():
    """Makes further probes."""
    return Probe


@pytest.fixture
def turtle(simulator):
    probe = Probe(simulator)
    kernel.sleep(0.1)
    return probe


@pytest.fixture
def facts():
    """What the C++ turtlesim did: (time, x, y, theta, linear, angular) per run."""
    path = SHARED / "golden" / "turtle-facts.json"
    if not path.exists():
        pytest.skip("the recorded facts are not here")
    runs = json.loads(path.read_text())
    return {name.split(".")[0]: samples for name, samples in runs.items()}


class Typing(LispText):
    """A student in front of a REPL, in virtual time: forms go in, printed values come out.

    ``pose``, ``colour``, ``heard`` and so on are Lisp variables and functions of the package, made by `PRELUDE`.
    """

    name = "<repl>"

    def __init__(self, session, backend):
        super().__init__(session, PRELUDE)
        self.backend = backend

    def __call__(self, text):
        """The values of the last form of ``text`` as the REPL prints them, on several lines if need be."""
        return " ".join(map(prin1_to_string, self.values(text)))

    def number(self, text):
        """The value of the last form, a number, as Python's."""
        return float(self.value(text))

    def pose(self, turtle="turtle1"):
        """(x, y, theta, linear velocity, angular velocity), as last heard on the topic."""
        text = self(f'(pose-of "{turtle}")')
        return tuple(float(word.replace("d", "e")) for word in text.strip("()").split())

    def colour(self, turtle="turtle1"):
        """(r, g, b), as last heard from the sensor."""
        return tuple(int(word) for word in self(f'(colour-of "{turtle}")').strip("()").split())

    def log(self):
        """The simulator's log, without times, and take it away."""
        from cramhy_runtime.turtlesim.node import running_simulator

        lines = running_simulator().lines
        texts = [re.sub(r"^\[ ?(\w+)\] \[[\d.]+\]: ", r"\1 ", line) for line in lines]
        lines.clear()
        return texts

    @property
    def paper(self):
        from cramhy_runtime.turtlesim.node import running_simulator

        return running_simulator().canvas


PRELUDE = """
(defpackage :turtle-laws (:use :cpl :roslisp)) (in-package :turtle-laws)
(defvar *poses* (make-hash-table :test #'equal))
(defvar *colours* (make-hash-table :test #'equal))
(defun watch (turtle)
  (subscribe (format nil "~a/pose" turtle) "turtlesim/Pose" (lambda (message) (push message (gethash turtle *poses*))))
  (subscribe (format nil "~a/color_sensor" turtle) "turtlesim/Color" (lambda (message) (push message (gethash turtle *colours*)))))
(defun pose-of (turtle)
  (with-fields (x y theta linear_velocity angular_velocity) (first (gethash turtle *poses*))
    (list x y theta linear_velocity angular_velocity)))
(defun colour-of (turtle) (with-fields (r g b) (first (gethash turtle *colours*)) (list r g b)))
(defvar *drivers* (make-hash-table :test #'equal))
(defun drive (linear angular &key (turtle "turtle1") (sideways 0))
  (publish (or (gethash turtle *drivers*)
               (setf (gethash turtle *drivers*) (advertise (format nil "~a/cmd_vel" turtle) "geometry_msgs/Twist")))
           (make-message "geometry_msgs/Twist" (:x :linear) linear (:y :linear) sideways (:z :angular) angular)))
(start-ros-node "laws")
(watch "turtle1")
(sleep 0.1)
"""


@pytest.fixture(params=ONE_BACKEND)
def typed(request):
    """A `Typing` in a package that uses CPL and ROSLISP, with a node and the turtle; ``/turtle1`` is watched."""
    from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, delete_package, find_package
    from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
    from cramhy_runtime.languages.commonlisp.streams.streams import STANDARD_OUTPUT, StringOutputStream
    from cramhy_runtime.repl.session import Session
    from cramhy_runtime.ros.roslisp import utilities

    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    saved, STANDARD_OUTPUT.value = STANDARD_OUTPUT.value, StringOutputStream()
    made = Session(time="virtual", backend=request.param)
    typing = Typing(made, request.param)
    yield typing
    kernel.stop()
    utilities.forget_registrations()
    STANDARD_OUTPUT.value = saved
    PACKAGE.value = COMMON_LISP_USER
    if find_package("TURTLE-LAWS"):
        delete_package(find_package("TURTLE-LAWS"))
