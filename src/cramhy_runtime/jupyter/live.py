"""What a notebook shows while a cell runs: the turtle's paper, the tree of the plan's tasks, and the fluents that are watched.

The kernel calls us at the ends of instants (`Kernel.watch_instants`), as it calls the line of progress of the prompt: what a plan does, and
when, is the same with the pictures and without them. A cell that takes less than `SOON` shows its pictures at its end only.

The pictures are updated in their places (``update_display_data``). They are shown where somebody looks on: a front end that can be asked
for input. ``jupyter nbconvert --execute`` cannot, so its notebooks show the same each time.
"""

from __future__ import annotations

import time
from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.session.session import Interruption

from . import outlines

SOON = 0.5
"""Seconds of the wall's clock from which on a cell is shown while it runs."""
OFTEN = 0.25
"""Seconds of the wall's clock from one picture to the next."""
ENDED, FAILED, INTERRUPTED = ", which has ended", ", which failed", ", which was interrupted"


class Displays:
    """The displays of one cell. say: sends a message of a kind and a content. number: a text that no other cell has."""

    def __init__(self, say, number):
        self._say, self._number = say, number
        self._shown = {}

    def show(self, name, bundle):
        """Show a mime bundle in the place ``name`` of this cell. If it is what is shown there, do nothing."""
        if self._shown.get(name) == bundle:
            return
        kind = "update_display_data" if name in self._shown else "display_data"
        self._shown[name] = bundle
        self._say(kind, {"data": bundle, "metadata": {}, "transient": {"display_id": f"{self._number}-{name}"}})

    @property
    def names(self):
        """The places that show something."""
        return list(self._shown)


class Live:
    """Shows one cell while it runs.

    watcher: the `pictures.Watcher`; watched: the `plots.Watched`; tasks: the `plans.Plans`; also: a function of no arguments that is called
    at each look; clock: the wall's, in seconds.
    """

    def __init__(self, displays, watcher, watched, tasks, also=lambda: None, clock=time.monotonic):
        self._displays, self._watcher, self._watched, self._plans = displays, watcher, watched, tasks
        self._also, self._clock = also, clock

    @contextmanager
    def during(self, looked_at):
        """While the block runs, the pictures are updated; at its end they show how it has ended. To be entered in a task of the session.

        looked_at: whether somebody looks on. Else only the end is shown.
        """
        active = kernel.active()
        self._watcher.begin()
        self._plans.forget()
        self._due = self._clock() + SOON
        if looked_at:
            active.watch_instants(self.look)
        end = ENDED
        try:
            yield
        except (Interruption, kernel.Cancelled, kernel.Interrupted, kernel.Abandoned):
            end = INTERRUPTED
            raise
        except BaseException:  # a condition, too
            end = FAILED
            raise
        finally:
            active.unwatch_instants(self.look)
            self._end(end)

    def look(self):
        """Show what is different now, if it is time for that. Called in the scheduler."""
        now = self._clock()
        if now < self._due:
            return
        try:
            self._draw(self._watcher.papers())
            if self._plans.roots:
                self._show_plans(" open", "")
        except Exception:  # an object of the user's that cannot be printed: the plan shall not suffer from it
            self._due = float("inf")
            return
        self._due = self._clock() + max(OFTEN, 4 * (self._clock() - now))

    def _draw(self, pictures):
        self._also()
        for name, bundle in pictures:
            self._displays.show(name, bundle)
        if self._watched.changed:
            self._displays.show("fluents", self._watched.picture())

    def _end(self, end):
        self._watched.take()
        self._draw(self._watcher.pictures())
        self._watched.changed = False
        if "plan" in self._displays.names or end is not ENDED and self._plans.tasks:
            self._show_plans("" if end is ENDED else " open", end)

    def _show_plans(self, folded, what):
        lines = self._plans.lines()
        told = f"plan at {kernel.now():.1f} s{what}"
        shown = f"<details{folded}><summary>{told}</summary><div>{outlines.of_tasks(lines)}</div></details>"
        self._displays.show("plan", {"text/html": shown, "text/plain": told})
