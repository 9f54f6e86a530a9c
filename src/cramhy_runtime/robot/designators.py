"""The actions of the robot as classes, such as ``PickingUp(object=found, arm=kw.left)`` for ``(an action (type picking-up) ...)``."""

from __future__ import annotations

from typing import Any

from cramhy_runtime.designators import Action, Location, Motion, Object


class Going(Action):
    """Drive to a place."""

    target: Location


class Looking(Action):
    """Turn the camera to a place."""

    target: Location


class Detecting(Action):
    """Look for an object; the result is its designator, with name and pose."""

    object: Object


class PickingUp(Action, type="picking-up"):
    """Take an object that was detected. Without an arm or a grasp, rules choose them."""

    object: Object
    arm: Any = None
    grasp: Any = None


class Placing(Action):
    """Put down an object that is held, so that it stands at the target."""

    object: Object
    target: Location
    arm: Any = None


class MovingTorso(Motion, type="moving-torso"):
    """Raise or lower the torso to a height, in metres."""

    joint_angle: float
