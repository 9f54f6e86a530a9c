"""What is said of a proof that goes deeper and deeper.

A proof needs no stack of Python, so a left recursion would go on until memory is gone. The machine counts the goals that wait, now
and then, and where they are more than ``*prolog-depth-limit*`` the proof ends in an error, which is made here. It shows the clauses
that the innermost of these goals belong to: those of one turn of the circle, if they go round in one.
"""

from __future__ import annotations

from cramhy_runtime.ground.conditions import StorageCondition, error
from cramhy_runtime.ground.source_places import describe
from .goal_text import show

_SHOWN = 1000
"""Continuations that are looked at for the clauses that come again and again."""
_LINES = 6


def too_deep(m, step, limit):
    """The error of a proof that is deeper than ``limit``, with the clauses whose goals wait, the innermost first."""
    waiting, k = [], step
    while k is not None and len(waiting) < _SHOWN:
        clause = getattr(k[0], "clause", None)
        if clause is not None:
            waiting.append(clause)
        k = k[1]
    m.choices.clear()  # there is nothing more to be had from this proof
    m.trail.clear()
    return error(
        StorageCondition(
            "A proof is more than ~:d goals deep and goes on, perhaps without end.~a~%Put a goal that ends the recursion before the one "
            "that goes on, or raise CRAM-PROLOG:*PROLOG-DEPTH-LIMIT*.",
            limit,
            _told(waiting),
        )
    )


def _told(waiting):
    """Lines about the clauses in the cycle at the end of ``waiting``."""
    cycle = list(dict.fromkeys(waiting[: _cycle(waiting)]))
    if not cycle:
        return ""
    lines = [f"\n  (<- {show(clause.head)}{_goals(clause)}) of {show(clause.group)}{_place(clause)}" for clause in cycle[:_LINES]]
    if len(cycle) > _LINES:
        lines.append(f"\n  and {len(cycle) - _LINES} more")
    return (
        "\nThe goals that wait are of"
        + ("" if len(cycle) == 1 else " these clauses, again and again, the innermost first")
        + (":" if len(cycle) > 1 else " this clause, again and again:")
        + "".join(lines)
    )


def _cycle(items):
    """The length of the shortest cycle with which ``items`` begins, of which there are three turns at least; else of all."""
    for length in range(1, len(items) // 3 + 1):
        if all(items[i] is items[i + length] for i in range(2 * length)):
            return length
    return len(items)


def _place(clause):
    place = describe(getattr(clause, "position", None))
    return f" at {place}" if place else ""


def _goals(clause):
    return "".join(f" {show(goal)}" for goal in clause.goals or ())
