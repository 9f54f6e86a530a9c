"""What is left to the task that runs: checkpoints until others get a turn, and room on its stack.

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

# A task that is out of stack must learn of it before it touches the queue, for a half-done hand-over is a lost task.
# `isinstance` goes down one level of Python's recursion limit for each level of its tuple, in a few nanoseconds.
HEADROOM = 100  # levels that a hand-over and modest callbacks need
STAIRS = int
for _ in range(HEADROOM):
    STAIRS = (STAIRS,)
