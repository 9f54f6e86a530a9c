"""A kernel in virtual time, a simulator, and a probe that listens to it."""

import json
from pathlib import Path

import pytest

from cramhy_runtime import kernel
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
