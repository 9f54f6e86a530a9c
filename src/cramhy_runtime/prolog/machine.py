"""The machine: one proof in progress, with its trail and its choice points, and the loop that drives it.

A *step* is a tuple ``(function, continuation, *arguments)``; ``function(machine, step)`` does a piece of work and returns the
next step. A continuation is a step too: what to do when the goal has succeeded. So nothing recurses in Python however long
the proof is, and a last call leaves nothing behind. A choice point is a pair ``(trail height, step)``; to fail means to pop one,
unset the variables that were set since, and go on with its step. Cut forgets the choice points above a height.

A machine holds all state of its proof. A Lisp function called in the middle may park its task, or ask other queries: these
have machines of their own. The machine stops after each solution and goes on when the next one is wanted, so solutions are lazy.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.kernel.budget import budget

from .terms import UNSET, undo, unify

BUDGET = range(50)
"""Steps between two checkpoints of the kernel, which counts each of them."""


class Machine:
    """A proof. ``names`` maps symbols to the variables that they stand for in Lisp data."""

    __slots__ = ("trail", "choices", "names", "found", "start")

    def __init__(self, names=None):
        self.trail = []
        self.choices = []
        self.names = {} if names is None else names
        self.found = False
        self.start = None

    def prove(self, step):
        """Prepare to prove what ``step`` does; its continuation must be `SOLVED`."""
        self.start = step
        return self

    def nested(self, names):
        """A machine for a proof inside of this one, whose solutions are collected."""
        return Machine(names)

    def unify(self, *sides):
        """Make terms the same, two by two: ``unify(a, b, c, d)`` unifies a with b and c with d. All or nothing."""
        trail = self.trail
        height = len(trail)
        for index in range(0, len(sides), 2):
            if not unify(sides[index], sides[index + 1], trail):
                undo(trail, height)
                return False
        return True

    def next_solution(self):
        """Go on to the next solution: True, and variables have its values; False, and there is none."""
        step = self.start
        self.found = False
        budget.left -= 1
        if budget.left < 0:
            kernel.checkpoint()
        if step is not None:
            self.start = None
        else:
            step = fail(self)
            if step is None:
                return False
        while True:
            for _ in BUDGET:
                step = step[0](self, step)
                if step is None:
                    return self.found
            if not self.choices:
                self.trail.clear()
            budget.left -= len(BUDGET) - 1
            kernel.checkpoint()


def _solved(m, step):
    m.found = True
    return None


SOLVED = (_solved, None)
"""The continuation of a query: stop, there is a solution."""


def fail(m):
    """Go back to the newest choice point: its step, or ``None`` when there is none left."""
    if not m.choices:
        return None
    height, step = m.choices.pop()
    trail = m.trail
    while len(trail) > height:
        trail.pop().ref = UNSET
    return step


def _fail_step(m, step):
    return fail(m)


FAIL = (_fail_step, None)
"""A step that fails."""


def succeed(m, step):
    """The call function of a goal that does nothing."""
    return step[1]


def _resume(m, step):
    return retry_iterator(m, step[1], step[2])


def retry_iterator(m, k, iterator):
    """Go on with ``k`` for each item of ``iterator``, which sets variables; on backtracking the next item is asked for."""
    trail = m.trail
    height = len(trail)
    for _ in iterator:
        m.choices.append((height, (_resume, k, iterator)))
        return k
    undo(trail, height)
    return fail(m)
