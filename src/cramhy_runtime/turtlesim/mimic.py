"""``mimic``: one turtle does what another does. Every pose of the leader becomes a command for the follower.

The speed of a pose is a magnitude, so a leader that drives backwards or sideways is followed by one that drives ahead.
`Mimic` is the program; on a command line ``input:=turtle1 output:=turtle2`` say who leads and who follows. Source: turtlesim.md 12.
"""

from __future__ import annotations

from ..ros.messages import RosMessage, message_class
from .roscpp import Program
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .signatures import Echo, Words


class Mimic(Program):
    """The node ``/turtle_mimic``, which follows ``leader`` with ``follower``, names of turtles (or what stands before ``/pose``)."""

    name = "turtle_mimic"

    def __init__(
        self,
        leader: str = "input",
        follower: str = "output",
        name: str | None = None,
        namespace: str = "/",
        arguments: Words = (),
        echo: Echo = None,
    ):
        super().__init__(name, namespace, arguments, echo=echo)
        self.twist = message_class("geometry_msgs/Twist")
        node = self.node
        # The original makes a node handle of each name, so the handle's name is remapped and then the topic's.
        self.publication = node.advertise(f"{node.resolve(follower)}/cmd_vel", self.twist)
        node.subscribe(f"{node.resolve(leader)}/pose", message_class("turtlesim/Pose"), self._follow, queue=1)

    def _follow(self, pose: RosMessage) -> None:
        message = self.twist()
        message.linear.x, message.angular.z = pose.linear_velocity, pose.angular_velocity
        self.publication.publish(message)
