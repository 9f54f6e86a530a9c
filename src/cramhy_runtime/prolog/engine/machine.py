"""The machine: one proof in progress, with its trail and its choice points, and the loop that drives it.

A *step* is a tuple ``(function, continuation, *arguments)``; ``function(machine, step)`` does a piece of work and returns the
next step. A continuation is a step too: what to do when the goal has succeeded. So nothing recurses in Python however long
the proof is, and a last call leaves nothing behind.

A *choice point* is a step as well, ``(function, continuation, trail height, *arguments)``, on a stack. To fail means to unset the
variables that were set since the newest choice point was made, and to go on with it. Its function takes it off the stack when this is
its last alternative. Choice points that count through the rows of a table are lists instead of tuples, and change. Cut forgets the
choice points above a height.

A machine holds all state of its proof. A Lisp function called in the middle may park its task, or ask other queries, which have machines
of their own. The machine stops after each solution and goes on when the next one is asked for, so solutions are lazy. `drain` collects
all that are left without stopping.
"""

from __future__ import annotations

from itertools import islice
from weakref import ref

from cramhy_runtime import kernel
from cramhy_runtime.kernel.budget import budget
from cramhy_runtime.lisp_core.dynamic import special

from ..symbols import PROLOG
from ..terms.terms import UNSET, Var, undo, unify

BATCH = range(50)
"""The machine looks at the rest of the task's slice after so many steps. The kernel counts each step as a checkpoint."""
_TIDY = 5_000
"""A trail is tidied when it has so many entries."""
DEFAULT_DEPTH = 3_000_000
"""So many goals may wait for one another. A continuation needs 100 to 300 bytes, so this is half a gigabyte."""
DEPTH_LIMIT = special(PROLOG.intern("*PROLOG-DEPTH-LIMIT*"), DEFAULT_DEPTH)


class _Kept:
    """Stands among weak references for an entry of the trail that is not a plain variable. Such an entry stays."""

    __slots__ = ("entry",)

    def __init__(self, entry):
        self.entry = entry

    def __call__(self):
        return self.entry


class Warned(set[object]):
    """The warnings that a proof gave. ``causes`` are texts about the Lisp functions that signalled an error in it, which failed a goal."""

    def __init__(self) -> None:
        self.causes: dict[str, bool] = {}  # its keys


class Machine:
    """A proof. ``names`` maps symbols to the variables that they stand for in Lisp data."""

    __slots__ = ("trail", "choices", "names", "found", "start", "collect", "until_measured", "until_tidy", "warned", "goes_on")

    def __init__(self, names=None):
        self.trail = []
        self.choices = []
        self.names = {} if names is None else names
        self.found = False
        self.start = self.collect = None
        self.until_measured = 200  # batches
        self.until_tidy = _TIDY  # length of the trail
        self.warned = None
        self.goes_on = None  # the continuation of the newest goal that called Lisp, or that nobody has defined: for messages

    def prove(self, step):
        """Prepare a proof that begins with ``step``, whose last continuation must be `SOLVED`. Returns the machine."""
        self.start = step
        return self

    def nested(self, names):
        """A machine for a proof inside of this one, whose solutions are collected."""
        machine = Machine(names)
        machine.warned = self.warned_of()
        return machine

    def warned_of(self):
        """A set of the warnings given in this proof and those inside of it, so that none is repeated."""
        if self.warned is None:
            self.warned = Warned()
        return self.warned

    def unify(self, *sides):
        """Make terms the same, two by two: ``unify(a, b, c, d)`` unifies a with b and c with d.

        Returns whether that is possible. If not, no variable is set.
        """
        trail = self.trail
        height = len(trail)
        for index in range(0, len(sides), 2):
            if not unify(sides[index], sides[index + 1], trail):
                undo(trail, height)
                return False
        return True

    def next_solution(self):
        """Go on to the next solution. Returns True if there is one; then the variables have its values."""
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
            for _ in BATCH:
                step = step[0](self, step)
                if step is None:
                    return self.found
            self._rest(step)

    @staticmethod
    def watch(around):
        """Let all machines call ``around(machine, next_solution)`` in place of `next_solution` from now on.

        ``None`` puts the method itself back, so that tracing costs nothing while no goal is traced.
        """
        Machine.next_solution = _next_solution if around is None else lambda machine: around(machine, _next_solution)

    def drain(self, collect):
        """Find all solutions that are left, and call ``collect`` at each, with the variables set."""
        self.collect = collect
        try:
            self.next_solution()
        finally:
            self.collect = None

    def _rest(self, step):
        """From time to time between two steps: let other tasks run, tidy the trail, look how deep the proof is."""
        if not self.choices:
            self.trail.clear()
        elif len(self.trail) > self.until_tidy:
            self._tidy()
        self.until_measured -= 1
        if self.until_measured < 0:
            self.until_measured = 200 + 2 * self._depth(step) // len(BATCH)
        budget.left -= len(BATCH)
        if budget.left < 0:
            kernel.checkpoint()

    def rest(self):
        """From time to time in a loop that builds a list: let other tasks run, tidy the trail."""
        if len(self.trail) > self.until_tidy and self.choices:
            self._tidy()
        if budget.left < 0:
            kernel.checkpoint()

    def _depth(self, step):
        """The number of goals that wait for ``step``, or of choice points if these are more. Beyond the limit it is an error.

        A goal waits as a continuation of the step. They are counted so seldom that a step costs only some nanoseconds more.
        """
        limit = DEPTH_LIMIT.value
        if limit is None:
            return 1_000_000
        depth, k = 0, step[1]
        while k is not None and depth <= limit:
            k = k[1]
            depth += 1
        depth = max(depth, len(self.choices))
        if depth <= limit:
            return depth
        from .depth_limit import too_deep  # which knows clauses, and these the machine

        return too_deep(self, step, limit)

    def _tidy(self):
        """Forget trail entries, above the newest choice point, for variables that only the trail refers to: they cannot be seen any more.

        The trail drops its references for a moment. The variables that live on are referred to elsewhere.
        """
        trail, height = self.trail, self.choices[-1][2]
        watched = [ref(entry) if entry.__class__ is Var else _Kept(entry) for entry in islice(trail, height, None)]
        del trail[height:]
        trail += [entry for entry in [known() for known in watched] if entry is not None]
        self.until_tidy = 2 * len(trail) + _TIDY


_next_solution = Machine.next_solution


def _solved(m, step):
    collect = m.collect
    if collect is None:
        m.found = True
        return None
    collect()
    choices = m.choices  # what `fail` does, without a call
    if not choices:
        return None
    step = choices[-1]
    height = step[2]
    trail = m.trail
    while len(trail) > height:
        trail.pop().ref = UNSET
    return step


SOLVED = (_solved, None)
"""The continuation of a query: stop, there is a solution."""


def fail(m):
    """Go back to the newest choice point. Returns its step, or ``None`` if there is none left."""
    choices = m.choices
    if not choices:
        return None
    step = choices[-1]
    height = step[2]
    trail = m.trail
    while len(trail) > height:
        trail.pop().ref = UNSET
    return step


def give_up(m, step):
    """The function of a choice point without alternatives."""
    m.choices.pop()
    return fail(m)


def proceed(m, step):
    """The function of a choice point that goes on with its continuation, when everything tried after it has failed."""
    m.choices.pop()
    return step[1]


def call_again(m, step):
    """The function of a choice point ``(call_again, k, height, call, *arguments)`` that calls a goal."""
    m.choices.pop()
    return step[3](m, (step[3], step[1], *step[4:]))


def again(m, step):
    """The function of a choice point ``[again, k, height, solutions, predicate]``. The generator ``solutions`` sets variables.

    It yields ``None`` for a solution. If it yields arguments, the predicate goes on with these.
    """
    k, solutions, collect = step[1], step[3], m.collect
    if k is SOLVED and collect is not None:
        for given in solutions:
            if given is not None:
                break
            collect()
            budget.left -= 1
            if budget.left < 0:
                kernel.checkpoint()
        else:
            given = None
    else:
        for given in solutions:
            if given is None:
                return k
            break
        else:
            given = None
    choices = m.choices
    if choices and choices[-1] is step:
        choices.pop()
    return fail(m) if given is None else (step[4].call, k, *given)


def settle(m, height):
    """Take the alternatives from the choice point at ``height``. Later choice points stay."""
    choices = m.choices
    if len(choices) == height + 1:
        choices.pop()
    elif height < len(choices):
        choices[height] = (give_up, None, choices[height][2])


def _fail_step(m, step):
    return fail(m)


FAIL = (_fail_step, None)
"""A step that fails."""


def _resume(m, step):
    _, k, height, iterator = step
    for _ in iterator:
        return k
    m.choices.pop()
    undo(m.trail, height)
    return fail(m)


def retry_iterator(m, k, iterator):
    """Go on with ``k`` for each item of ``iterator``, which sets variables. Backtracking asks for the next item."""
    trail = m.trail
    height = len(trail)
    for _ in iterator:
        m.choices.append((_resume, k, height, iterator))
        return k
    undo(trail, height)
    return fail(m)
