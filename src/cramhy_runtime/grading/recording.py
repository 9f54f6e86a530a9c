"""What the simulator of a submission's process hears, noted tick by tick for `Replay`, and the troubles that happen to its turtle."""

from __future__ import annotations

from cramhy_runtime.turtlesim.node import each_simulator, expect_no_more

from .schema import MOST_HEARD, PART
from .troubles import Troubles, put


class TooMuch(Exception):
    """A plan sent more commands than a run may."""


class Recording:
    """The record of the first simulator that starts after `watch`. start: (x, y, heading) of turtle1. troubles, seed: as of `Troubles`.

    ``heard``: [tick, kind, turtle, values...] in the order of arrival. ``ticks``: how many have passed. ``begin``, ``end``: those at which
    the plan began and ended, ``None`` before.
    """

    def __init__(self, start, troubles, seed):
        self.start, self.troubles = start, Troubles(troubles, seed)
        self.heard = []
        self.ticks = 0
        self.begin = self.end = None
        self.simulator = None

    def watch(self):
        """Record the first simulator: at once if it runs already, and then it must be as it begins."""
        each_simulator(self._meet)

    def stop(self):
        """Leave the simulator alone."""
        expect_no_more(self._meet)
        if self.simulator is not None:
            self.simulator.listener = None
            self.simulator.unobserve(self._see)

    def tell(self, tell):
        """Tell what was heard, in parts, and the ticks."""
        for place in range(0, len(self.heard), PART):
            tell("heard", entries=self.heard[place : place + PART])
        begin = self.ticks if self.begin is None else self.begin
        tell("run", ticks=self.ticks, begin=begin, end=self.ticks if self.end is None else self.end)

    def _meet(self, simulator):
        if self.simulator is not None:
            return
        self.simulator = simulator
        put(simulator.turtles["turtle1"], self.start)
        simulator.listener = self._hear
        simulator.observe(self._see)

    def plan_begins(self):
        """The plan begins now."""
        self.begin = self.troubles.begin = self.ticks
        if self.simulator is not None:
            self.troubles.act(self.ticks, self.simulator.turtles)

    def plan_ends(self):
        """The plan has ended now."""
        self.end = self.ticks

    def _hear(self, kind, turtle, values):
        if len(self.heard) >= MOST_HEARD:
            raise TooMuch(f"The plan has sent more than {MOST_HEARD} commands.")
        self.heard.append([self.ticks, kind, turtle, *values])
        return self.troubles.command(self.ticks, turtle, values) if kind == "command" else None

    def _see(self, simulator, strokes):
        self.ticks += 1
        self.troubles.act(self.ticks, simulator.turtles)
