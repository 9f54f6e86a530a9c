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
        self._moments: list[float] = [0.0, *np.cumsum(lengths).tolist()]
        self._steps = np.diff(self.postures, axis=0)
        self._straight = self._moments[-1]
        self.seconds = self._straight + min(SOFT, self._straight)
        self.passed = 0.0
        self._targets: list[tuple[float, np.ndarray]] = []
        self._step = 0

    @property
    def done(self) -> bool:
        return self.passed >= self.seconds

    @property
    def goal(self) -> np.ndarray:
        """The last posture."""
        return self.postures[-1]

    def after(self, seconds: float) -> np.ndarray:
        """Let one step pass, of so much time; all steps are equally long. Where the joints are to be then."""
        if self._step == len(self._targets):
            if self._targets or self.done:
                return self.postures[-1]
            self._targets = self._after_each(seconds)
        self.passed, target = self._targets[self._step]
        self._step += 1
        return target

    def _after_each(self, seconds: float) -> list[tuple[float, np.ndarray]]:
        """(the time that has passed, the posture then) after each step. They are computed at once: between steps of MuJoCo, which leave
        nothing in the processor's caches, a little of Python takes long."""
        times = np.cumsum(np.full(int(self.seconds / seconds) + 2, seconds))
        times = np.minimum(times[: int(np.searchsorted(times, self.seconds)) + 1], self.seconds)
        ways, moments = self._ways(times), np.array(self._moments)
        numbers = np.minimum(np.searchsorted(moments, ways, side="right"), len(moments) - 1)
        before, lengths = moments[numbers - 1], np.diff(moments)[numbers - 1]
        parts = np.divide(ways - before, lengths, out=np.ones_like(ways), where=lengths > 0)
        targets = self.postures[numbers - 1] + parts[:, None] * self._steps[numbers - 1]
        targets[-1] = self.postures[-1]
        return list(zip(times.tolist(), targets, strict=True))

    def _ways(self, times: np.ndarray) -> np.ndarray:
        """The part of the straight time that has been covered: speed grows evenly at first and falls evenly at last."""
        soft = min(SOFT, self.seconds / 2)
        full = self._straight / (self.seconds - soft)
        left = self.seconds - times
        begun, ended = full * times * times / (2 * soft), self._straight - full * left * left / (2 * soft)
        return np.where(times < soft, begun, np.where(left < soft, ended, full * (times - soft / 2)))
