"""``mimic``: one turtle copies another. Every pose of the leader becomes a command for the follower.

The speed in a pose is a magnitude, so if the leader drives backwards or sideways, the follower drives ahead. `Mimic` is the program.
On a command line, ``input:=turtle1 output:=turtle2`` name the leader and the follower. Source: turtlesim.md 12.
"""

from __future__ import annotations

from ..ros.messages import RosMessage, message_class
from ..ros.roscpp import Program
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..ros.signatures import Echo, Words


class Mimic(Program):
    """The node ``/turtle_mimic``. ``follower`` follows ``leader``: names of turtles, or the parts of topic names before ``/pose``.

    Other arguments: see `Program`.
    """

    name = "turtle_mimic"
    package = "turtlesim"

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
