"""The error of a proof that goes deeper and deeper.

A proof does not use Python's stack, so a left recursion would go on until memory is full. From time to time the machine counts the goals
that wait. If they are more than ``*prolog-depth-limit*``, the proof ends in the error of this module. It shows the clauses of the
innermost of these goals. If they repeat, it shows the clauses of one turn.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import StorageCondition, error
from cramhy_runtime.lisp_core.source_places import describe
from .goal_text import show

_SHOWN = 1000
"""The number of continuations that are searched for clauses that repeat."""
_LINES = 6


def too_deep(m, step, limit):
    """Signal the error of a proof that is deeper than ``limit``, with the clauses whose goals wait, the innermost first."""
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
    """The length of the shortest cycle with which ``items`` begins, if it has three turns at least; otherwise the length of all."""
    for length in range(1, len(items) // 3 + 1):
        if all(items[i] is items[i + length] for i in range(2 * length)):
            return length
    return len(items)


def _place(clause):
    place = describe(getattr(clause, "position", None))
    return f" at {place}" if place else ""


def _goals(clause):
    return "".join(f" {show(goal)}" for goal in clause.goals or ())
