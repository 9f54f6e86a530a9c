"""What the simulator of a submission's process hears, noted tick by tick for `Replay`, and the troubles that happen to its turtle."""

from __future__ import annotations

from cramhy_runtime.turtlesim.node import each_simulator, expect_no_more

from .troubles import Troubles, put

MOST_HEARD = 100_000


class TooMuch(Exception):
    """A plan sent more commands than a run may."""


class Recording:
    """The record of the first simulator that starts after `watch`. start: (x, y, heading) of turtle1. troubles, seed: as of `Troubles`.

    ``heard``: [tick, kind, turtle, values...] in the order of arrival. ``ticks``: how many have passed. ``begin``: that at which the plan
    began.
    """

    def __init__(self, start, troubles, seed):
        self.start, self.troubles = start, Troubles(troubles, seed)
        self.heard = []
        self.ticks = 0
        self.simulator = None

    def watch(self):
        """Record the first simulator: at once if it runs already, and then it must be as it begins."""
        each_simulator(self._meet)

    def end(self):
        """Leave the simulator alone."""
        expect_no_more(self._meet)
        if self.simulator is not None:
            self.simulator.listener = None
            self.simulator.unobserve(self._see)

    def _meet(self, simulator):
        if self.simulator is not None:
            return
        self.simulator = simulator
        put(simulator.turtles["turtle1"], self.start)
        simulator.listener = self._hear
        simulator.observe(self._see)

    def begin(self):
        """The plan begins now."""
        self.troubles.begin = self.ticks
        if self.simulator is not None:
            self.troubles.act(self.ticks, self.simulator.turtles)

    def _hear(self, kind, turtle, values):
        if len(self.heard) >= MOST_HEARD:
            raise TooMuch(f"The plan has sent more than {MOST_HEARD} commands.")
        self.heard.append([self.ticks, kind, turtle, *values])
        return self.troubles.command(self.ticks, turtle, values) if kind == "command" else None

    def _see(self, simulator, strokes):
        self.ticks += 1
        self.troubles.act(self.ticks, simulator.turtles)
