"""Height and orientation generators: how high a drawn place is, and how it is turned.

A height generator is a function of x and y that returns a list of heights. An orientation generator is a function of x, y and the
orientations so far, and returns orientations. Source: mobile-manipulation.md section 9.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from cramhy_runtime.transforms.quaternions import Quaternion


def turned(angle: float) -> Quaternion:
    """The orientation of ``angle`` radians around z."""
    return Quaternion(0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))


def fan(angle: float, samples: int, step: float) -> list[float]:
    """``samples`` angles around ``angle``: itself, one ``step`` to the left, one to the right, two to the left, and so on."""
    return [angle + step * ((index + 1) // 2) * (1 if index % 2 else -1) for index in range(samples)]


def towards(x: float, y: float) -> Callable[[float, float], float]:
    """A function of a place that gives the direction from there to (``x`` ``y``), in radians."""
    return lambda from_x, from_y: math.atan2(y - from_y, x - from_x)


def orientations(main_direction: Callable[[Any, Any], Any], samples: int = 1, step: float = 0.1) -> Callable[[Any, Any, Any], Any]:
    """A generator that keeps the orientations that it gets, if any, and else gives a `fan` around ``main_direction(x, y)``."""

    def generate(x: Any, y: Any, previous: Any) -> Any:
        return previous or [turned(angle) for angle in fan(float(main_direction(x, y)), samples, step)]

    return generate
