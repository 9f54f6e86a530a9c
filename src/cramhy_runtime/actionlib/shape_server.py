"""``rosrun turtle_actionlib shape_server``: an action that lets ``turtle1`` draw a regular polygon.

The server steers from the poses of the turtle. It has two rules for an edge: drive, slower and slower, until the edge is as long as it
shall be, then turn, slower and slower, until the heading is that of the next edge. Both are near enough at a hundred-thousandth, so the
end of the last edge is where the first one began. A new goal takes the place of one that is drawn. The node gives the action its name.

`ShapeServer` is the program; `ShapeClient` is ``shape_client``, which asks for a pentagon. Source: wiki.ros.org/turtle_actionlib.
"""

from __future__ import annotations

import math

from .. import kernel
from ..ros import rosout, wire
from ..ros.messages import message_class
from ..ros.roscpp import Program
from . import goals
from .goal_server import GoalServer, ServerGoal
from .goals import ABORTED, PREEMPTED, SUCCEEDED, TERMINAL
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..ros.messages import RosMessage
    from ..ros.signatures import Echo, Words

ACTION = "turtle_actionlib/ShapeAction"
GAIN = 6.0
"""m/s per metre that the edge still lacks, and rad/s per radian that the heading does."""
NEAR = 0.00001
"""Metres or radians that do not matter."""


class Polygon:
    """How a turtle draws a regular polygon. edges: how many, at least 1; 2 is a line there and back. radius: to the corners, in metres."""

    def __init__(self, edges: int, radius: float):
        self.edges, self.done = edges, 0
        self.interior_angle = (edges - 2) * math.pi / edges
        self.apothem = radius * math.cos(math.pi / edges)
        self.side = 2 * self.apothem * math.tan(math.pi / edges)
        self.start: tuple[float, float, float] | None = None

    def command(self, x: float, y: float, heading: float) -> tuple[float, float]:
        """The speed (m/s) and the turn (rad/s) for a turtle that is there. ``done`` counts the edges that are drawn."""
        if self.start is None:
            self.start = x, y, heading
        start_x, start_y, start_heading = self.start
        lacks = self.side - math.hypot(start_x - x, start_y - y)
        turn = (math.pi - self.interior_angle - (heading - start_heading)) % (2 * math.pi)
        if lacks > NEAR:
            return GAIN * lacks, 0.0
        if turn > NEAR:
            return 0.0, GAIN * turn
        self.start = None
        self.done += 1
        return 0.0, 0.0


class ShapeServer(Program):
    """The node ``/turtle_shape``, with the action of that name. ``polygon``: what is drawn now, or ``None``. Arguments: see `Program`.

    A goal that no polygon answers to is aborted, and its status says why; the original reports success, with numbers that are none.
    """

    name = "turtle_shape"
    package = "turtle_actionlib"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.polygon: Polygon | None = None
        self.twist = message_class("geometry_msgs/Twist")
        self.publication = self.node.advertise("/turtle1/cmd_vel", self.twist)
        self.shapes = _Shapes(self)
        self.node.subscribe("/turtle1/pose", message_class("turtlesim/Pose"), self._steer, queue=1)

    def draw(self, goal: RosMessage) -> str | None:
        """Begin to draw what the ShapeGoal asks for; returns why that cannot be, or ``None``."""
        radius = wire.as_float(goal.radius)
        if goal.edges < 1 or not math.isfinite(radius):
            return f"A shape has at least one edge and a radius in metres, not {goal.edges} edges and the radius {radius:g}."
        self.polygon = Polygon(goal.edges, radius)
        return None

    def _steer(self, pose: RosMessage) -> None:
        polygon = self.polygon
        if polygon is None:
            return
        if polygon.done >= polygon.edges:
            self.polygon = None
            self.log(rosout.INFO, f"{self.node.name}: Succeeded")
            self.shapes.succeed(polygon)
            return
        message = self.twist()
        message.linear.x, message.angular.z = polygon.command(*map(wire.as_float, pose.values()[:3]))
        self.publication.publish(message)


class _Shapes(GoalServer):
    """The goals of a `ShapeServer`."""

    def __init__(self, program: ShapeServer):
        self.program = program
        super().__init__(program.node, program.node.name, ACTION)

    def begin_wanted(self) -> None:
        goal = self.accept()
        problem = self.program.draw(goal.message)
        if problem is not None:
            self.current = None
            self.program.log(rosout.ERROR, f"{self.name}: {problem}")
            self.end(goal, ABORTED, None, problem)

    def end_wanted(self, goal: ServerGoal) -> None:
        self.current = self.program.polygon = None
        self.program.log(rosout.INFO, f"{self.name}: Preempted")
        self.end(goal, PREEMPTED, None)

    def succeed(self, polygon: Polygon) -> None:
        """End the goal whose polygon is drawn."""
        goal, self.current = self.current, None
        self.end(goal, SUCCEEDED, self.action.result(interior_angle=polygon.interior_angle, apothem=polygon.apothem))


class ShapeClient(Program):
    """The node ``/test_shape``: it asks ``turtle_shape`` for a pentagon, tells how that ends, and ends. Arguments: see `Program`."""

    name = "test_shape"
    package = "turtle_actionlib"
    edges, radius, patience = 5, 1.3, 40.0

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.log(rosout.INFO, "Waiting for action server to start.")
        self.action = goals.Action(ACTION)
        self.goal_id: RosMessage | None = None
        self.publication = self.node.advertise("turtle_shape/goal", self.action.action_goal)
        self.node.subscribe("turtle_shape/status", message_class(goals.STATUS_ARRAY), self._server_is_there)
        self.node.subscribe("turtle_shape/result", self.action.action_result, self._over)

    def _server_is_there(self, status: RosMessage) -> None:
        if self.goal_id is None:
            self.log(rosout.INFO, "Action server started, sending goal.")
            self.goal_id = goals.new_goal_id(self.node.name, self.graph.now())
            self.node.on_shutdown.append(kernel.call_at(kernel.now() + self.patience, self._too_late).cancel)
            wanted = self.action.goal(edges=self.edges, radius=self.radius)
            self.publication.publish(self.action.action_goal(goal_id=self.goal_id, goal=wanted))

    def _over(self, result: RosMessage) -> None:
        if self.goal_id is not None and result.status.goal_id.id == self.goal_id.id and result.status.status in TERMINAL:
            self.log(rosout.INFO, f"Action finished: {goals.NAMES[result.status.status]}")
            self.shutdown()

    def _too_late(self) -> None:
        self.log(rosout.INFO, "Action did not finish before the time out.")
        self.shutdown()


PROGRAMS: dict[str, type[Program]] = {"shape_server": ShapeServer, "shape_client": ShapeClient}
"""The executables of the package turtle_actionlib."""
