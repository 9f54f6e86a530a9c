"""The arrow keys: ``turtle_teleop_key``. Each key that counts publishes one command, and nothing stops the turtle but time.

Keys are recognised by the last byte of what the terminal sends, so the capitals A to D work too. The scales are read once,
from ``/scale_linear`` and ``/scale_angular``. Source: turtlesim.md 10.
"""

from __future__ import annotations

from ..ros import graph
from ..ros.messages import message_class_exact

KEYS = {"A": (1, 0), "B": (-1, 0), "C": (0, -1), "D": (0, 1)}
NAMED_KEYS = {"up": "A", "down": "B", "right": "C", "left": "D"}


class Teleop:
    """The node ``/teleop_turtle``, which drives ``turtle``."""

    def __init__(self, turtle="turtle1", name="teleop_turtle", namespace="/"):
        here = graph.active()
        self.turtle = turtle
        self.node = here.node(name, namespace)
        self.node.teleop = self
        self.twist = message_class_exact("geometry_msgs/Twist")
        self.publication = self.node.advertise(f"{turtle}/cmd_vel", self.twist)
        self.linear = self._scale("scale_linear")
        self.angular = self._scale("scale_angular")
        self.running = True

    def _scale(self, parameter):
        tree, name = self.node.graph.parameters, self.node.resolve(parameter)
        return float(tree.get(name)) if tree.has(name) else 2.0

    def press(self, key):
        """One key: ``"up"``, ``"down"``, ``"left"``, ``"right"``, ``"q"``, or the byte it ends in. True when it moved the turtle."""
        key = NAMED_KEYS.get(key, key)
        if key == "q":
            self.quit()
            return False
        if key not in KEYS or not self.running:
            return False
        forward, turn = KEYS[key]
        message = self.twist()
        message.linear.x, message.angular.z = forward * self.linear, turn * self.angular
        self.publication.publish(message)
        return True

    def type(self, text):
        """Keys as the terminal sends them, escape sequences included."""
        for character in text:
            self.press(character)

    def quit(self):
        """Leave the graph."""
        self.running = False
        self.node.shutdown()
