"""The demonstration of tf with turtles: where each turtle is, as a frame, and a second turtle that follows the first one.

``turtle_tf_broadcaster`` tells where the frame of a turtle is in the frame ``world``, at each of its poses. ``turtle_tf_listener`` spawns
``turtle2`` as soon as there is a simulator, and ten times a second lets it drive towards ``turtle1``, as far as it is away and with the
turn that its direction asks for. The packages turtle_tf and turtle_tf2 have both, in Python and in C++: the names of those in Python end in
``.py``. Source: wiki.ros.org/turtle_tf, wiki.ros.org/tf/Tutorials.
"""

from __future__ import annotations

import math

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from ...ros import rosout, wire
from ...ros.messages import message_class
from ...ros.roscpp import Program, plain_words
from ...ros.services import start_call
from ...transforms.poses import Transform
from ...transforms.quaternions import euler_to_quaternion
from ...transforms.vectors import make_3d_vector, point
from ..stamped import TransformStamped
from .frames import Listener, Sender
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ...ros.messages import RosMessage
    from ...ros.services import Call
    from ...ros.signatures import Echo, Words

PERIOD = 0.1
"""Seconds between two commands for the follower."""
AHEAD, TURN = 0.5, 4.0
"""m/s per metre of distance, and rad/s per radian of the direction."""
PLACE = 4.0, 2.0, 0.0
"""Where the follower is spawned: x, y (m), heading (rad)."""


class Broadcaster(Program):
    """The node ``/turtle_tf_broadcaster``: publishes where ``turtle`` is in the frame ``world``. Other arguments: see `Program`.

    turtle: if it is not given, the parameter ``~turtle`` says it, as for the program in Python, or the first word of the command line, as
    for the one in C++. Without any it is a simple error.
    """

    name = "turtle_tf_broadcaster"
    package = "turtle_tf"

    def __init__(self, turtle: str | None = None, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.turtle = turtle or self._turtle(plain_words(arguments))
        self.sender = Sender(self.node)
        self.node.subscribe(f"/{self.turtle}/pose", message_class("turtlesim/Pose"), self._tell, queue=10)

    def _turtle(self, words: list[str]) -> str:
        parameter = self.node.resolve("~turtle")
        if self.graph.parameters.has(parameter):
            return str(self.graph.parameters.get(parameter)).strip("/")
        if words:
            return words[0].strip("/")
        self.shutdown()
        return conditions.error(
            SimpleError("~a", f"{self.node.name} does not know of which turtle it shall tell: the parameter {parameter} is not set."),
            hint=f"Say it: rosrun {self.package} {self.name}.py _turtle:=turtle1, or in the <node> of a launch file "
            '<param name="turtle" value="turtle1"/>.',
        )

    def _tell(self, pose: RosMessage) -> None:
        x, y, heading = (wire.as_float(value) for value in pose.values()[:3])
        if math.isfinite(x + y + heading):
            transform = Transform(make_3d_vector(x, y, 0.0), euler_to_quaternion(az=float(heading)))
            self.sender.send("world", self.turtle, self.graph.now(), transform)


class Follower(Program):
    """The node ``/turtle_tf_listener``: spawns ``turtle2`` and lets it drive towards ``turtle1``. Arguments: see `Program`.

    ``follower``: the name of the second turtle. If there is one of that name already, the node says so and drives it.
    """

    name = "turtle_tf_listener"
    package = "turtle_tf"
    leader = "turtle1"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.listener = Listener(self)
        self.follower = self.name_of_follower()
        self.twist = message_class("geometry_msgs/Twist")
        self.publication = self.node.advertise(f"{self.follower}/cmd_vel", self.twist)
        self.spawned = False
        self.node.on_shutdown.append(kernel.call_every(PERIOD, self.follow).cancel)

    def name_of_follower(self) -> str:
        """The name of the turtle that follows."""
        return "turtle2"

    def _spawn(self) -> None:
        spawn = self.graph.services.get(self.node.resolve("spawn"))
        if spawn is not None:
            self.spawned = True
            start_call(spawn, spawn.type.request(*PLACE, self.follower), self._told)

    def _told(self, call: Call) -> None:
        if call.failure is not None and self.alive:
            why = f" ({call.failure})" if call.failure else ""
            self.log(rosout.WARN, f"{self.follower} was not spawned{why}. If there is a turtle of that name already, it is driven.")
        self.spawned = not call.lost

    def follow(self) -> None:
        """Send one command if it is known where both turtles are. The timer calls it ten times a second."""
        if not self.spawned:
            self._spawn()
            return
        found = self.listener.lookup(self.follower, self.leader)
        if isinstance(found, TransformStamped):
            x, y, _ = point(found.translation)
            message = self.twist()
            message.linear.x, message.angular.z = AHEAD * math.hypot(x, y), TURN * math.atan2(y, x)
            self.publication.publish(message)


class Tf2Broadcaster(Broadcaster):
    """The node ``/turtle_tf2_broadcaster``, which does the same."""

    name = "turtle_tf2_broadcaster"
    package = "turtle_tf2"


class Tf2Follower(Follower):
    """The node ``/turtle_tf2_listener``, which does the same for the turtle that the parameter ``turtle`` names."""

    name = "turtle_tf2_listener"
    package = "turtle_tf2"

    def name_of_follower(self) -> str:
        parameter = self.node.resolve("turtle")
        return str(self.graph.parameters.get(parameter)).strip("/") if self.graph.parameters.has(parameter) else "turtle2"
