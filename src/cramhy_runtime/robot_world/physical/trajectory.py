"""The way of joints through time: from posture to posture at limited speed, with a soft start and a soft end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

SOFT = 0.25
"""How long the start takes until full speed, and the end from there, seconds."""


class Trajectory:
    """The way of some joints along postures.

    joints: their names. postures: n x joints, the first one where they are now. speeds: the most that each
    joint moves in a second; the slowest sets the pace.
    """

    def __init__(self, joints: Sequence[str], postures: Sequence[np.ndarray] | np.ndarray, speeds: np.ndarray) -> None:
        self.joints, self.postures = tuple(joints), np.asarray(postures, float)
        lengths = (np.abs(np.diff(self.postures, axis=0)) / speeds).max(axis=1)
        self._moments = np.concatenate([[0.0], np.cumsum(lengths)])
        self._straight = float(self._moments[-1])
        self.seconds = self._straight + min(SOFT, self._straight)
        self.passed = 0.0

    @property
    def done(self) -> bool:
        return self.passed >= self.seconds

    @property
    def goal(self) -> np.ndarray:
        """The last posture."""
        return self.postures[-1]

    def after(self, seconds: float) -> np.ndarray:
        """Let so much time pass; where the joints are to be then."""
        self.passed = min(self.passed + seconds, self.seconds)
        if self.done:
            return self.postures[-1]
        way = self._way(self.passed)
        number = min(int(np.searchsorted(self._moments, way, "right")), len(self._moments) - 1)
        before, next_ = self._moments[number - 1], self._moments[number]
        part = (way - before) / (next_ - before) if next_ > before else 1.0
        return self.postures[number - 1] + part * (self.postures[number] - self.postures[number - 1])

    def _way(self, time: float) -> float:
        """The part of the straight time that has been covered: speed grows evenly at first and falls evenly at last."""
        soft = min(SOFT, self.seconds / 2)
        full = self._straight / (self.seconds - soft)
        left = self.seconds - time
        if time < soft:
            return full * time * time / (2 * soft)
        if left < soft:
            return self._straight - full * left * left / (2 * soft)
        return full * (time - soft / 2)
