"""``draw_square``: a turtle drives rough squares for ever.

The program looks at the pose every 16 ms. It has four states: drive until the goal is near, stop until the turtle stands, turn
until the goal's heading is near, stop again. Near means a tenth of a metre, or a hundredth of a radian by plain subtraction. The
check follows the command, so the sides are 1.9 m long and the square turns slowly to the right. `DrawSquare` is the program.
Source: turtlesim.md 11.
"""

from __future__ import annotations

import math

from .. import kernel
from ..ros import rosout, wire
from ..ros.messages import RosMessage, message_class
from ..ros.services import start_call
from ..ros.roscpp import Program
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..ros.signatures import Echo, Words


PERIOD = 0.016
PI = 3.141592
SIDE, SPEED, TURN = 2.0, 1.0, 0.4
FORWARD, STOP_FORWARD, TURNING, STOP_TURN = "forward", "stop forward", "turning", "stop turn"


class DrawSquare(Program):
    """The node ``/draw_square``: resets the simulator and drives ``turtle1`` of its namespace. ``state``: one of the four states.

    Arguments: see `Program`.
    """

    name = "draw_square"
    package = "turtlesim"

    def __init__(self, name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        node = self.node
        self.twist = message_class("geometry_msgs/Twist")
        self.pose: tuple[float, ...] | None = None
        self.goal: tuple[float, float, float] | None = None
        self.state = FORWARD
        node.subscribe("turtle1/pose", message_class("turtlesim/Pose"), self._see, queue=1)
        self.publication = node.advertise("turtle1/cmd_vel", self.twist)
        self._reset()
        timer = kernel.call_every(PERIOD, self.tick)
        node.on_shutdown.append(timer.cancel)

    def _reset(self) -> None:
        reset = self.graph.services.get(self.node.resolve("reset"))
        if reset is not None:  # without a simulator the original, too, goes on and waits for a pose
            start_call(reset, reset.type.request(), lambda call: None)

    def _see(self, pose: RosMessage) -> None:
        self.pose = tuple(value if math.isfinite(value) else math.nan for value in map(wire.as_float, pose.values()))

    def tick(self) -> None:
        """Send one command, and perhaps go to the next state. The timer calls it every 16 ms."""
        if self.pose is None:
            return
        x, y, heading, speed, turn = self.pose
        if self.goal is None:
            self._aim(x + math.cos(heading) * SIDE, y + math.sin(heading) * SIDE, heading)
        stands = turn < 0.0001 and speed < 0.0001
        if self.state == FORWARD:
            self._drive(SPEED, 0.0, STOP_FORWARD)
        elif self.state == TURNING:
            self._drive(0.0, TURN, STOP_TURN)
        else:
            self._command(0.0, 0.0)
            if stands:
                self.log(rosout.INFO, "Reached goal")
                if self.state == STOP_FORWARD:
                    self.state = TURNING
                    goal = math.fmod(heading + PI / 2.0, 2.0 * PI)
                    self._aim(x, y, goal - 2.0 * PI if goal >= PI else goal)
                else:
                    self.state = FORWARD
                    self._aim(x + math.cos(heading) * SIDE, y + math.sin(heading) * SIDE, heading)

    def _drive(self, speed: float, turn: float, when_there: str) -> None:
        x, y, heading = self.pose[:3]
        goal_x, goal_y, goal_heading = self.goal
        if abs(x - goal_x) < 0.1 and abs(y - goal_y) < 0.1 and abs(heading - goal_heading) < 0.01:
            self.state = when_there
            self._command(0.0, 0.0)
        else:
            self._command(speed, turn)

    def _aim(self, x: float, y: float, heading: float) -> None:
        self.goal = (x, y, heading)
        self.log(rosout.INFO, f"New goal [{x:f} {y:f}, {heading:f}]")

    def _command(self, speed: float, turn: float) -> None:
        message = self.twist()
        message.linear.x, message.angular.z = speed, turn
        self.publication.publish(message)
