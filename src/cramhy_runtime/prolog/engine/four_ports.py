"""The four ports of a goal: it is called, it exits with a solution, it is asked again, it fails.

Byrd's box model: what watches a proof, the tracer and the explainer, puts goals into boxes and is told when the proof passes a port.
A box is entered with `enter`, which leaves a choice point below all of the goal's: to come back to it means that the goal has no
(further) solution. A goal that exits without choice points of its own takes that one away, so a watched proof keeps no more
than others; a goal whose choice points are cut away is not heard of again.
"""

from __future__ import annotations

from .machine import fail, give_up


class Box:
    """A goal that is watched. A watcher overrides what it wants to hear of; ``m`` is the machine, its bindings are those of now."""

    __slots__ = ()

    def exited(self, m, last):
        """There is a solution; ``last`` when it is known that there is no other."""

    def redone(self, m):
        """Another solution is asked for."""

    def failed(self, m):
        """There is no (further) solution; the bindings are those of the call again."""


def enter(m, box, k):
    """Watch a goal that is about to be proved: the continuation to prove it with, where its own would be ``k``."""
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
