"""How deep a proof is, and what is said of one that never stops going deeper.

A proof needs no stack of Python, so a left recursion would go on until memory is gone. Now and then the machine counts the goals
that wait, which are the continuations of the step that it does, one after the other, and its choice points. Where they are more than
``*prolog-depth-limit*`` the proof ends in an error that shows which clauses the goals at its end belong to. The count is made so
seldom that it costs a step no more than some nanoseconds.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import StorageCondition, error
from cramhy_runtime.lisp.dynamic import special
from .symbols import PROLOG

DEPTH_LIMIT = special(PROLOG.intern("*PROLOG-DEPTH-LIMIT*"))
DEFAULT = 3_000_000
"""A continuation needs 100 to 300 bytes, so this is half a gigabyte."""

DEPTH_LIMIT.value = DEFAULT

_SHOWN = 1000
"""Continuations that are looked at for the clauses that come again and again."""


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
    error(StorageCondition("too deep"))
