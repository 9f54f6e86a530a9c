"""The way of servos to where they are sent: at limited speed, each for itself, with a soft start and a soft end.

A servo of this arm hears where it is to be and goes there. A new goal counts at once, whatever it was doing; so a program may send goals
fifty times a second and lead the arm along a line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence


class Servos:
    """Where the servos of some joints want to be. It is followed as a `Trajectory` is.

    joints: their names. start: where they are. speeds, accelerations: the most of each, in its unit a second, and a second squared.
    """

    passed = 0.0

    def __init__(self, joints: Sequence[str], start: np.ndarray, speeds: np.ndarray, accelerations: np.ndarray) -> None:
        self.joints = tuple(joints)
        self.now, self.goal = np.array(start, float), np.array(start, float)
        self._speed = np.zeros(len(self.joints))
        self._fastest, self._soft = np.asarray(speeds, float), np.asarray(accelerations, float)

    @property
    def done(self) -> bool:
        """Whether they are there."""
        return bool((self.now == self.goal).all())

    def after(self, seconds: float) -> np.ndarray:
        """Let so much time pass, less than a hundredth of a second; where they are to be then."""
        left = self.goal - self.now
        step = self._soft * seconds
        braking = np.sqrt(2 * self._soft * np.abs(left) + (step / 2) ** 2) - step / 2  # so fast that it can still stop there
        wanted = np.sign(left) * np.minimum(self._fastest, braking)
        self._speed = np.clip(wanted, self._speed - step, self._speed + step)
        way = self._speed * seconds
        there = (np.abs(left) <= np.abs(way) + 1e-7) & (np.abs(self._speed) <= 2 * step)
        self.now = np.where(there, self.goal, self.now + way)
        self._speed[there] = 0.0
        return self.now
