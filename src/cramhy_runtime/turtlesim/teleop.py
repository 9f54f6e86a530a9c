"""The arrow keys: ``turtle_teleop_key``. Each key that counts publishes one command, and nothing stops the turtle but time.

Keys are recognised by the last byte of what the terminal sends, so the capitals A to D work too. The scales are read once,
from ``/scale_linear`` and ``/scale_angular``. `Teleop` is the program; a terminal prints `BANNER` and hands `Teleop.feed` the bytes that
are typed, in any portions. Source: turtlesim.md 10.
"""

from __future__ import annotations

from ..ros.messages import message_class
from .roscpp import Program
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .signatures import Echo, Words


BANNER = "Reading from keyboard\n---------------------------\nUse arrow keys to move the turtle. 'q' to quit.\n"
KEYS = {"A": (1, 0), "B": (-1, 0), "C": (0, -1), "D": (0, 1)}
NAMED_KEYS = {"up": "A", "down": "B", "right": "C", "left": "D"}


class Teleop(Program):
    """The node ``/teleop_turtle``, which drives ``turtle``; its command line may send it to another (``turtle1/cmd_vel:=x/cmd_vel``)."""

    name = "teleop_turtle"

    def __init__(self, turtle: str = "turtle1", name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.turtle = turtle
        self.twist = message_class("geometry_msgs/Twist")
        self.publication = self.node.advertise(f"{turtle}/cmd_vel", self.twist)
        self.linear = self.number("scale_linear", 2.0)
        self.angular = self.number("scale_angular", 2.0)

    def press(self, key: str) -> bool:
        """One key: ``"up"``, ``"down"``, ``"left"``, ``"right"``, ``"q"``, or the byte it ends in. True when it moved the turtle."""
        key = NAMED_KEYS.get(key, key)
        if key == "q":
            self.shutdown()
            return False
        if key not in KEYS or not self.alive:
            return False
        forward, turn = KEYS[key]
        message = self.twist()
        message.linear.x, message.angular.z = forward * self.linear, turn * self.angular
        self.publication.publish(message)
        return True

    def feed(self, data: bytes) -> bool:
        """Bytes as the terminal sends them, escape sequences included. Whether the program still runs: ``q`` ends it."""
        for byte in data:
            self.press(chr(byte))
            if not self.alive:
                return False
        return True
