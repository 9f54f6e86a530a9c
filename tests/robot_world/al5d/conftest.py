"""The simulated arm AL5D, a node that speaks to it, and the way of its wrist to a place."""

from __future__ import annotations

from math import acos, atan2, hypot, pi, sqrt

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph, services
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact

PACKAGE = "lynxmotion_al5d_description"
HOME = (0.0, pi / 2, -pi / 2, 0.0, 0.0, 0.03175)
BASE, UPPER, FORE, HAND = 0.070, 0.146, 0.187, 0.086  # metres, as the course's package has them
OPEN, CLOSED = 0.03, 0.0


class Table:
    """The simulator as programs see it: messages and services, and what the node says."""

    def __init__(self, simulator, said):
        self.simulator, self.said = simulator, said
        self.node = graph.active().node("student")
        self.command_type = message_class_exact("std_msgs/Float64MultiArray")
        self.commands = self.node.advertise("/lynxmotion_al5d/joints_positions/command", self.command_type)

    def listen(self, topic, kind):
        """The list that gets all messages of a topic below the arm's name."""
        heard = []
        self.node.subscribe(f"/lynxmotion_al5d/{topic}", message_class_exact(kind), heard.append)
        return heard

    def states(self):
        return self.listen("joint_states", "sensor_msgs/JointState")

    def send(self, *numbers, wait=3.0):
        self.commands.publish(self.command_type(data=list(numbers)))
        kernel.sleep(wait)

    def joints(self):
        """Where the joints are, as the next message says."""
        heard = self.states()
        kernel.sleep(0.0201)
        self.node.unsubscribe("/lynxmotion_al5d/joint_states")
        return [float(value) for value in heard[-1].position]

    def call(self, service, kind, /, **fields):
        """The response of a service, or the text of its refusal."""
        found = graph.active().services[f"/lynxmotion_al5d/{service}"]
        answer = services.exchange(found, service_type_exact(kind).request(**fields))
        return answer.response if answer.failure is None else answer.failure

    def pose(self, x=0.0, y=0.0, z=0.0, roll=0.0, pitch=0.0, yaw=0.0):
        pose = message_class_exact(f"{PACKAGE}/Pose")()
        pose.position.x, pose.position.y, pose.position.z = x, y, z
        pose.orientation.roll, pose.orientation.pitch, pose.orientation.yaw = roll, pitch, yaw
        return pose

    def spawn(self, x=0.0, y=0.17, z=0.0, yaw=0.0, colour="red", name="", settle=1.0):
        """Put a brick down; its name, or the text of the refusal."""
        answer = self.call("spawn_brick", f"{PACKAGE}/SpawnBrick", color=colour, name=name, pose=self.pose(x, y, z, yaw=yaw))
        kernel.sleep(settle)
        return answer if isinstance(answer, str) else answer.name

    def kill(self, name):
        return self.call("kill_brick", f"{PACKAGE}/KillBrick", name=name)

    def teleport(self, name, how, *place):
        answer = self.call(f"{name}/teleport_{how}", f"{PACKAGE}/Teleport{how.capitalize()}", pose=self.pose(*place))
        kernel.sleep(1.0)
        return answer

    def brick(self, name="brick1"):
        """x, y, z and yaw of a brick, as its topic says."""
        heard = self.listen(f"{name}/pose", f"{PACKAGE}/Pose")
        kernel.sleep(0.1001)
        self.node.unsubscribe(f"/lynxmotion_al5d/{name}/pose")
        return (*(float(value) for value in heard[-1].position.values()), float(heard[-1].orientation.yaw))

    def reach(self, x, y, z, yaw, opening, wait=3.0):
        """Bring the fingers, which point down, to a place, across something that is turned by yaw."""
        self.send(*wrist_down(x, y, z + HAND, yaw), opening, wait=wait)

    def pick(self, x, y, yaw, closed=CLOSED):
        """Take what is there by the plan of the course: from above, 5 mm over the table, and 20 mm up again."""
        for height, opening in ((0.025, OPEN), (0.005, OPEN), (0.005, closed), (0.025, closed)):
            self.reach(x, y, height, yaw, opening)

    def place(self, x, y, yaw, closed=CLOSED):
        """Put it there by the plan of the course."""
        for height, opening in ((0.025, closed), (0.005, closed), (0.005, OPEN), (0.025, OPEN), (0.025, CLOSED)):
            self.reach(x, y, height, yaw, opening)


def wrist_down(x, y, z, yaw):
    """The angles with which the wrist is at a place and the hand points down, across something that is turned by yaw."""
    base, away, height = atan2(x, y), hypot(x, y), z - BASE
    far = away * away + height * height
    shoulder = atan2(height, away) + acos((UPPER**2 - FORE**2 + far) / (2 * UPPER * sqrt(far)))
    elbow = -acos((far - UPPER**2 - FORE**2) / (2 * UPPER * FORE))
    turn = pi / 2 - yaw - base
    return base, shoulder, elbow, -pi / 2 - elbow - shoulder, (turn + pi) % (2 * pi) - pi


@pytest.fixture
def table():
    """The simulator in a kernel with virtual time, and a student's node."""
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    from cramhy_runtime.robot_world.al5d.node import Simulator

    kernel.start(clock="virtual")
    said = []
    yield Table(Simulator(echo=said.append), said)
    kernel.stop()
