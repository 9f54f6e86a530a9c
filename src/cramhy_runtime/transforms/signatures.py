"""What geometry is made of, by name. Only type checkers read this module: nothing imports it when a program runs."""

from __future__ import annotations

from typing import Any, Protocol

from .poses import Pose, Transform
from .quaternions import Quaternion
from .vectors import Vector3

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
Numbers = list[float] | list[int]
Place = Vector3 | Numbers
"""A vector, or its three components in a list."""
Rotation = Quaternion | Numbers | float
"""A quaternion, its four components, or a number r for (0 0 0 r)."""
PoseOrTransform = Pose | Transform


class Component(Protocol):
    """A component of a vector or quaternion, as an attribute."""

    def __get__(self, thing: Any, kind: Any = None) -> float: ...
    def __set__(self, thing: Any, value: float) -> None: ...
