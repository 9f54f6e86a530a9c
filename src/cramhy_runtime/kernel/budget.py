"""What is left to the task that runs: checkpoints until others get a turn, and room on its stack.

Erlang counts reductions, we count checkpoints. The count, and never the wall clock, decides when a busy task is
preempted, so the order of a run depends on the program alone (law 5). There is one counter for the process, because
one task runs at a time (law 4); whoever gets the baton gets a full slice.

`budget.left = 0` ends the slice at the next checkpoint. That is one store, so a signal handler may do it.
"""

import sys
from functools import partial

SLICE = 1000  # checkpoints; a Lisp loop passes one in 0.1 to 5 us, so a slice lasts at most some milliseconds


class Budget:
    """The checkpoints that are left to the task that runs."""

    __slots__ = ("left",)

    def __init__(self):
        self.left = SLICE


budget = Budget()

HEADROOM = 100  # levels that a hand-over and modest callbacks need
_STAIRS = int
for _ in range(HEADROOM):
    _STAIRS = (_STAIRS,)

need_headroom = partial(isinstance, None, _STAIRS)
"""Raise RecursionError now if a hand-over would: a task that is out of stack must learn of it before it touches the queue, for a
half-done hand-over is a lost task. `isinstance` goes down one level of Python's limit for each level of its tuple, in a few nanoseconds."""

if sys.version_info >= (3, 12):  # where calls of C functions and frames of Python are counted apart
    _down_the_stairs = need_headroom

    def need_headroom(levels=sys.getrecursionlimit, frame=sys._getframe):
        _down_the_stairs()
        try:
            frame(levels() - HEADROOM)
        except ValueError:  # "call stack is not deep enough", and so there is room
            return
        raise RecursionError("maximum recursion depth exceeded")
