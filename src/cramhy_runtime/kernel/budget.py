"""The budget of the task that runs: checkpoints until others get a turn, and room on its stack.

Erlang counts reductions, the kernel counts checkpoints. The count, and never the wall clock, decides when a busy task is
preempted, so the order of a run depends on the program alone (law 5). There is one counter for the process, because
one task runs at a time (law 4). A task that gets the baton gets a full slice, and the ticks that others left.

`budget.end()` ends the slice at the next checkpoint. It is short and may be called by a signal handler.

A compiled loop does not call `checkpoint` in each turn. In each turn it takes one of `budget.ticks`, an iterator, which costs Python
almost nothing, and calls `refill` when there are no more; then as many checkpoints count at once. Inner and outer loops share the
ticks, so many loops of a few turns count like one loop of many turns.
"""

import sys
from collections import deque
from functools import partial
from itertools import repeat
from operator import length_hint

SLICE = 1000  # checkpoints; a Lisp loop passes one in 0.1 to 5 us, so a slice lasts at most some milliseconds


TICKS = 50  # that are handed out at once


class Budget:
    """The checkpoints that are left to the task that runs. Loops take ``ticks``, which are counted already."""

    __slots__ = ("left", "ticks")

    def __init__(self):
        self.renew()

    def renew(self):
        """Begin a full slice."""
        self.left = SLICE
        self.ticks = repeat(None, TICKS)

    def end(self):
        """End the slice at the next checkpoint."""
        self.left = 0
        deque(self.ticks, maxlen=0)

    def refill(self):
        """Get new ticks if there are none. Returns whether the slice is over."""
        if not length_hint(self.ticks):  # else another loop has got new ones since this one did
            self.left -= TICKS
            self.ticks = repeat(None, TICKS)
        return self.left < 0


budget = Budget()

HEADROOM = 100  # levels that a hand-over and modest callbacks need
STEPS = 24  # levels that a hand-over needs when there is nothing to call
FEW_STEPS = 12  # and where it is known which task comes next


def room(levels):
    """A function that raises RecursionError if fewer than LEVELS levels are left.

    A task without room on its stack must find out before it touches the queue, since a half-done hand-over loses the task. `isinstance`
    uses one level of Python's limit for each level of its tuple, in some nanoseconds.
    """
    stairs = int
    for _ in range(levels):
        stairs = (stairs,)
    down_the_stairs = partial(isinstance, None, stairs)
    if sys.version_info < (3, 12):
        return down_the_stairs

    def also_for_frames(limit=sys.getrecursionlimit, frame=sys._getframe):  # calls of C functions and of Python's are counted apart
        down_the_stairs()
        try:
            frame(limit() - levels)
        except ValueError:  # "call stack is not deep enough", and so there is room
            return
        raise RecursionError("maximum recursion depth exceeded")

    return also_for_frames


need_headroom = room(HEADROOM)
need_steps = room(STEPS)
need_few_steps = room(FEW_STEPS)
