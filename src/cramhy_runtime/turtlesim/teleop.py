"""The arrow keys: ``turtle_teleop_key``. Each arrow key publishes one command. Only the end of the command's time stops the turtle.

The last byte from the terminal decides which key it is, so the capitals A to D work too. The scales are read once, from
``/scale_linear`` and ``/scale_angular``. `Teleop` is the program. A terminal prints `BANNER` and gives `Teleop.feed` the typed
bytes, in any portions. Source: turtlesim.md 10.
"""

from __future__ import annotations

from ..ros.messages import message_class
from ..ros.roscpp import Program
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..ros.signatures import Echo, Words


BANNER = "Reading from keyboard\n---------------------------\nUse arrow keys to move the turtle. 'q' to quit.\n"
KEYS = {"A": (1, 0), "B": (-1, 0), "C": (0, -1), "D": (0, 1)}
NAMED_KEYS = {"up": "A", "down": "B", "right": "C", "left": "D"}


class Teleop(Program):
    """The node ``/teleop_turtle``, which drives ``turtle``. Other arguments: see `Program`.

    The command line can choose another turtle (``turtle1/cmd_vel:=x/cmd_vel``).
    """

    name = "teleop_turtle"
    package = "turtlesim"

    def __init__(self, turtle: str = "turtle1", name: str | None = None, namespace: str = "/", arguments: Words = (), echo: Echo = None):
        super().__init__(name, namespace, arguments, echo=echo)
        self.turtle = turtle
        self.twist = message_class("geometry_msgs/Twist")
        self.publication = self.node.advertise(f"{turtle}/cmd_vel", self.twist)
        self.linear = self.number("scale_linear", 2.0)
        self.angular = self.number("scale_angular", 2.0)

    def press(self, key: str) -> bool:
        """Press one key: ``"up"``, ``"down"``, ``"left"``, ``"right"``, ``"q"``, or the last byte of the key.

        Returns whether the turtle got a command. ``"q"`` ends the program.
        """
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
        """Handle ``data``, bytes from the terminal with escape sequences. Returns whether the program still runs; ``q`` ends it."""
        for byte in data:
            self.press(chr(byte))
            if not self.alive:
                return False
        return True
