"""``mimic``: one turtle does what another does. Every pose of the leader becomes a command for the follower.

The speed of a pose is a magnitude, so a leader that drives backwards or sideways is followed by one that drives ahead.
`Mimic` is the program; on a command line ``input:=turtle1 output:=turtle2`` say who leads and who follows. Source: turtlesim.md 12.
"""

from __future__ import annotations

from ..ros.messages import message_class_exact
from .roscpp import Program


class Mimic(Program):
    """The node ``/turtle_mimic``, which follows ``leader`` with ``follower``, names of turtles (or what stands before ``/pose``)."""

    name = "turtle_mimic"

    def __init__(self, leader="input", follower="output", name=None, namespace="/", arguments=(), echo=None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.twist = message_class_exact("geometry_msgs/Twist")
        node = self.node
        # The original makes a node handle of each name, so the handle's name is remapped and then the topic's.
        self.publication = node.advertise(f"{node.resolve(follower)}/cmd_vel", self.twist)
        node.subscribe(f"{node.resolve(leader)}/pose", message_class_exact("turtlesim/Pose"), self._follow, queue=1)

    def _follow(self, pose):
        message = self.twist()
        message.linear.x, message.angular.z = pose.linear_velocity, pose.angular_velocity
        self.publication.publish(message)
