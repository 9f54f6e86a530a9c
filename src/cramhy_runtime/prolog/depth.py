"""How deep a proof is, and what is said of one that never stops going deeper.

A proof needs no stack of Python, so a left recursion would go on until memory is gone. Now and then the machine counts the goals
that wait, which are the continuations of the step that it does, one after the other, and its choice points. Where they are more than
``*prolog-depth-limit*`` the proof ends in an error that shows which clauses the goals at its end belong to. The count is made so
seldom that it costs a step no more than some nanoseconds.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import StorageCondition, error
from cramhy_runtime.lisp.dynamic import special
from cramhy_runtime.lisp.evaluation.places_in_source import describe
from .showing import show
from .symbols import PROLOG

DEFAULT = 3_000_000
"""A continuation needs 100 to 300 bytes, so this is half a gigabyte."""
DEPTH_LIMIT = special(PROLOG.intern("*PROLOG-DEPTH-LIMIT*"), DEFAULT)

_SHOWN = 1000
"""Continuations that are looked at for the clauses that come again and again."""
_LINES = 6


def check_depth(m, step):
    """The number of goals that wait for ``step``, or of choice points if these are more; an error if it is beyond the limit."""
    limit = DEPTH_LIMIT.value
    depth, k = 0, step[1]
    if limit is None:
        return 1_000_000
    while k is not None and depth <= limit:
        k = k[1]
        depth += 1
    depth = max(depth, len(m.choices))
    if depth > limit:
        too_deep(m, step, limit)
    return depth


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
    error(StorageCondition(
        "A proof is more than ~:d goals deep and goes on, perhaps without end.~a~%Put a goal that ends the recursion before the one that "
        "goes on, or raise CRAM-PROLOG:*PROLOG-DEPTH-LIMIT*.", limit, _told(waiting)))


def _told(waiting):
    """Lines about the clauses in the cycle at the end of ``waiting``."""
    cycle = list(dict.fromkeys(waiting[:_cycle(waiting)]))
    if not cycle:
        return ""
    lines = [f"\n  (<- {show(clause.head)}{_goals(clause)}) of {show(clause.group)}{_place(clause)}" for clause in cycle[:_LINES]]
    if len(cycle) > _LINES:
        lines.append(f"\n  and {len(cycle) - _LINES} more")
    return "\nThe goals that wait are of" + ("" if len(cycle) == 1 else " these clauses, again and again, the innermost first") \
        + (":" if len(cycle) > 1 else " this clause, again and again:") + "".join(lines)


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
