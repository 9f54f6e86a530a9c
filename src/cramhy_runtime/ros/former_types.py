"""Types of messages that ROS no longer has, and what takes their place: courses and answers on the web still name them."""

from __future__ import annotations

_FORMER = {
    "turtlesim/velocity": "turtlesim/Velocity was replaced by geometry_msgs/Twist: linear is its linear.x, angular its angular.z. "
    "The turtle takes it on the topic turtle1/cmd_vel, which was turtle1/command_velocity."
}


def successor(ros_type: str) -> str | None:
    """A sentence about the type ``"turtlesim/Velocity"``, in any case, if it is one that ROS no longer has, else ``None``."""
    return _FORMER.get(ros_type.lower())


def successor_of_symbol(package: str, name: str) -> str | None:
    """As `successor`, for the symbol ``name`` of the Lisp package ``TURTLESIM-MSG``; the class had the names Velocity and <Velocity>."""
    home, _, kind = package.rpartition("-")
    return successor(f"{home}/{name.strip('<>')}") if kind == "MSG" else None
