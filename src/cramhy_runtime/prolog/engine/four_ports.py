"""The four ports of a goal: it is called, it exits with a solution, it is asked again, it fails.

This is Byrd's box model. The watchers of a proof, the tracer and the explainer, put goals into boxes and are told when the proof passes
a port. `enter` puts a goal into a box and leaves a choice point below those of the goal: when the proof comes back to it, the goal has
no (further) solution. A goal that exits without choice points of its own removes that one, so a watched proof keeps no more choice
points than others. A goal whose choice points are cut away passes no port any more.
"""

from __future__ import annotations

from .machine import fail, give_up


class Box:
    """A goal that is watched. A watcher overrides the methods for the ports that it needs. ``m`` is the machine, with its bindings."""

    __slots__ = ()

    def exited(self, m, last):
        """There is a solution. ``last`` is true if it is known to be the last one."""

    def redone(self, m):
        """Another solution is asked for."""

    def failed(self, m):
        """There is no (further) solution. The bindings are those of the call again."""


def enter(m, box, k):
    """Watch a goal that is about to be proved with the continuation ``k``. Returns the continuation to use instead."""
    height = len(m.choices)
    m.choices.append((_failed, None, len(m.trail), box))
    return (_exited, k, box, height)


def _exited(m, step):
    _, k, box, height = step
    choices = m.choices
    while len(choices) > height + 1 and choices[-1][0] is give_up:
        choices.pop()
    last = len(choices) <= height + 1
    if last:
        del choices[height:]
    else:
        choices.append((_redone, None, len(m.trail), box))
    box.exited(m, last)
    return k


def _redone(m, step):
    m.choices.pop()
    step[3].redone(m)
    return fail(m)


def _failed(m, step):
    m.choices.pop()
    step[3].failed(m)
    return fail(m)
