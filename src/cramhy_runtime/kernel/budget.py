"""The slice: how many checkpoints a task may pass before others get a turn.

Erlang counts reductions, we count checkpoints. The count, and never the wall clock, decides when a busy task is
preempted, so the order of a run depends on the program alone (law 5). There is one counter for the process, because
one task runs at a time (law 4); whoever gets the baton gets a full slice.

`budget.left = 0` ends the slice at the next checkpoint. That is one store, so a signal handler may do it.
"""

SLICE = 1000  # checkpoints; a Lisp loop passes one in 0.1 to 5 us, so a slice lasts at most some milliseconds


class Budget:
    """The checkpoints that are left to the task that runs."""

    __slots__ = ("left",)

    def __init__(self):
        self.left = SLICE


budget = Budget()
