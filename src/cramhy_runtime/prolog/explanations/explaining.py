"""A machine that remembers its proof: the clauses that were tried for each goal, how far they got, and the values at that point.

It proves goals from the clauses as they are written, not from their compiled code. It uses the trail, the choice points and the control
constructs of every other machine, so it finds the same solutions in the same order and calls the same Lisp functions. Built-in
predicates run as they are. ``explanations.py`` reads the record.

Two things are different. The proof is given up after a number of goals, since endless proofs need an explanation most. And a *dry* proof
makes no calls that might change the world: such a goal stops its clause, and is marked.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, list_from
from cramhy_runtime.lisp_core.packages import is_symbol

from ..builtins import builtins, control  # noqa: F401  whose handlers are known here
from ..engine import four_ports as ports
from . import failure_reasons as reasons
from ..builtins.control import CONTROL
from ..engine.database import arguments_of, extended, functors, handled, valid_functor
from ..engine.machine import SOLVED, Machine, fail
from ..engine.goal_text import Names, readable
from ..symbols import sym
from cramhy_runtime.utilities.patterns import variable
from ..terms.terms import Var, deref, import_term, undo, unify, unset_variables

AND = sym("AND")
IF, SOFT_IF, FORALL, FAIL = (sym("CRAM-PROLOG::" + name) for name in ("->", "*->", "FORALL", "FAIL"))

_MOST_UNLIKE = 500
"""So many clauses whose heads do not match are remembered for a goal."""


class Attempt:
    """A clause that was tried for a goal, or the goals of a conjunction: how far the proof got in it.

    ``mismatch`` is (number of the argument from 1, the term of the clause, the term of the goal), ``(0, ...)`` if the numbers of
    arguments differ, and ``None`` if the head matched. ``boxes`` has for each goal of the body the boxes in which it was proved, and
    ``live`` has the box of each that is part of the proof now. ``reached`` counts the goals that succeeded at least once, before the
    first that never did.
    """

    __slots__ = ("clause", "goals", "variables", "mismatch", "boxes", "live", "reached")

    def __init__(self, clause, goals=()):
        self.clause, self.goals, self.variables = clause, goals, {}
        self.mismatch = None
        self.boxes, self.live, self.reached = [], [], -1

    @property
    def culprit(self):
        """The box in which the goal that never succeeded came furthest, or ``None`` if every goal succeeded."""
        if self.mismatch is not None or self.reached < 0:
            return None
        last = self.boxes[self.reached]
        return None if any(box.exits for box in last) else max(last, key=Goal.score)

    def score(self):
        """How far the proof got here, as a tuple to compare with other attempts."""
        if self.mismatch is not None:
            return (-1, self.mismatch[0])
        culprit = self.culprit
        if culprit is None:
            return (len(self.goals), 0)
        return (self.reached, *culprit.score()[:3], self.reached - len(self.goals))


class Goal(ports.Box):
    """The box of a goal that was called, with everything that was tried for it.

    ``shown`` is the goal as it was called, to be printed. ``values`` are pairs, the variables of its clause that had values then.
    ``attempts`` are the clauses tried, ``inner`` the boxes inside of a control construct, ``exits`` the number of its successes, and
    ``state`` is called, exited or failed. ``reason`` says why a built-in failed, and ``near``, from 0 to 1, how close it was to success.
    ``trouble`` is ``undefined``, ``empty`` if a predicate has no clauses, or ``dry`` for a goal that was not run. ``unlike`` counts the
    clauses whose heads do not match. If there are very many, only those are kept that agree in more arguments than before;
    ``furthest`` is the number of the argument that differs in the best of them.
    """

    __slots__ = (
        "term",
        "shown",
        "parent",
        "attempts",
        "inner",
        "exits",
        "state",
        "reason",
        "near",
        "trouble",
        "best",
        "values",
        "unlike",
        "furthest",
    )

    def __init__(self, term, parent):
        self.term, self.parent, self.shown = term, parent, readable(term, Names())
        self.attempts, self.inner, self.exits, self.state = [], [], 0, "called"
        self.reason, self.near, self.trouble, self.best, self.values = None, 0, None, None, ()
        self.unlike = self.furthest = 0

    @property
    def tried(self):
        """The number of clauses that were tried."""
        return self.unlike + sum(attempt.mismatch is None for attempt in self.attempts)

    @property
    def functor(self):
        return self.term.car if self.term.__class__ is Cons else None

    def exited(self, m, last):
        self.exits += 1
        self.state = "exited"
        m.box = self.parent

    def redone(self, m):
        self.state = "called"
        m.box = self
        parent = self.parent
        if parent is not None and parent.attempts:
            live = parent.attempts[-1].live
            if self in live:
                del live[live.index(self) + 1 :]

    def failed(self, m):
        self.state = "failed"
        m.box = self.parent
        if not self.exits and not self.attempts and self.trouble is None and self.reason is None and self.culprit is None:
            self.reason, self.near = reasons.why(m, self.term)
        self.score()  # now, while those of the goals inside are known, so that deep proofs need no deep recursion

    def score(self):
        """How far the proof of this goal got: (goals that succeeded in the best clause, ...)."""
        if self.best is None:
            if self.attempts:
                self.best = max(attempt.score() for attempt in self.attempts)
            else:
                culprit = self.culprit
                self.best = culprit.score() if culprit is not None else (self.near,)
        return self.best

    @property
    def culprit(self):
        """The box inside of a failed control construct that shows why it failed, or ``None``."""
        if self.functor is FORALL:  # it is proved as (not (and condition (not action)))
            return self.inner[0].attempts[-1].boxes[1][-1].inner[-1] if self.inner and self.inner[0].exits else None
        never = [box for box in self.inner if not box.exits and box.functor is not FAIL]
        if not never:
            return None
        if self.functor in (IF, SOFT_IF):
            return never[-1]
        return max(never, key=Goal.score)


class Explaining(Machine):
    """A machine whose proof is remembered in ``record``, a `Record`. ``box`` is the goal that it proves now."""

    __slots__ = ("record", "box")

    def __init__(self, record, names=None, box=None):
        super().__init__(names)
        self.record, self.box = record, box

    def nested(self, names):
        return Explaining(self.record, names, self.box)

    def next_solution(self):
        if not self.record.dry:
            return super().next_solution()
        # An error is being told, maybe of a task that is ended or of a kernel that has stopped: nothing else must run now.
        step, self.start, self.found = self.start or fail(self), None, False
        while step is not None:
            step = step[0](self, step)
        return self.found

    def solve(self, goal, k, b):
        return self.call(goal, k, b, None, 0)

    def call(self, goal, k, b, attempt, position):
        """The step that proves ``goal`` in a box; with ``attempt`` it is the goal at ``position`` of its body."""
        record = self.record
        record.count += 1
        if record.count > record.limit:
            record.stopped = record.stopped or self.box
            return None
        goal = goal if goal.__class__ is Cons else deref(goal)
        box = Goal(goal, self.box)
        if attempt is None:
            if self.box is not None:
                self.box.inner.append(box)
        else:
            _reached(attempt, position, box)
        if self.box is None and record.root is None:
            record.root = box
        k = ports.enter(self, box, k)
        self.box = record.latest = box
        if goal is not None and goal.__class__ is not Cons:
            return control.solve(self, goal, k, b)  # a type-error
        functor = None if goal is None else goal.car
        if functor is AND and not extended(AND):
            body = Attempt(None, arguments_of(goal))
            body.variables = {variable.written or variable.name: variable for variable in unset_variables(goal, {})}
            box.attempts.append(body)
            return (_body, k, body, 0, b)
        construct = CONTROL.get(functor) if is_symbol(functor) else None
        if construct is not None:
            if attempt is not None and attempt.clause is not None:
                construct = control.in_clause(functor)
            return construct(self, goal.cdr, k, b)
        return self.prove_goal(box, goal, functor, k)

    def prove_goal(self, box, goal, functor, k):
        entry = functors.get(functor) if is_symbol(functor) and valid_functor(functor) else None
        if entry is None or not entry.defined:
            box.trouble = "undefined"
            return fail(self)
        arguments = arguments_of(goal)
        built_in = entry.handler or entry.native and (entry.native.get(len(arguments)) or entry.native.get(None))
        if not built_in:
            if entry.clauses:
                return (_clauses, k, box, entry.clauses, 0, arguments)
            if entry.native:
                box.reason = reasons.other_count(functor, len(arguments), entry.native)
            else:
                box.trouble = "empty"
            return fail(self)
        if self.record.dry and not reasons.harmless(goal):
            box.trouble = "dry"
            return fail(self)
        if entry.clauses:
            self.choices.append((_more_clauses, k, len(self.trail), box, entry.clauses, 0, arguments))
            if entry.handler:  # the clauses are for when it has no solution
                k = (handled, k, len(self.choices) - 1)
        if built_in is LISP_CALLS.get(functor):
            succeeded, box.reason = reasons.call_lisp_goal(self, functor, arguments)
            return k if succeeded else fail(self)
        return built_in(self, (built_in, k, *arguments))


class Record:
    """The record of a proof. ``root`` is the box of its goal, and ``stopped`` the box in which it was given up, after ``limit`` goals."""

    def __init__(self, limit, dry):
        self.limit, self.dry = limit, dry
        self.count, self.root, self.latest, self.stopped = 0, None, None, None


LISP_CALLS = {functor: functors[functor].handler for functor in (reasons.LISP_FUN, reasons.LISP_PRED)}
"""The handlers of the calls of Lisp. Watchers of a proof make these calls themselves, to report the results."""


def start(goal, limit, dry=False):
    """A machine that proves ``goal`` (Lisp data), and the variables of the goal as a dict symbol → `Var`."""
    machine = Explaining(Record(limit, dry), {})
    term = import_term(goal, machine.names)
    variables = dict(machine.names)
    machine.prove((_start, SOLVED, term))
    return machine, variables


def _start(m, step):
    return m.solve(step[2], step[1], 0)


def _reached(attempt, position, box):
    """Note that the goal at ``position`` of a body is called."""
    attempt.boxes[position].append(box)
    attempt.live[position:] = [box]
    if position >= attempt.reached:
        attempt.reached = position
        names = Names()
        box.values = [
            (name, readable(variable, names))
            for name, variable in attempt.variables.items()
            if name is not None and deref(variable).__class__ is not Var
        ]


def _clauses(m, step):
    """Try the clauses from a number on, one after the other."""
    _, k, box, clauses, i, arguments = step
    b = len(m.choices)
    m.box = box
    while i < len(clauses):
        attempt = Attempt(clauses[i])
        i += 1
        height, table = len(m.trail), {}
        attempt.mismatch = _other_constant(attempt.clause.head.cdr, arguments)
        if attempt.mismatch is None:
            attempt.mismatch = _match(import_term(attempt.clause.head.cdr, table), arguments, m.trail)
        if attempt.mismatch is not None:
            undo(m.trail, height)
            box.unlike += 1
            if not box.unlike % 100:
                m.record.count += 1  # a table of facts takes its time, too
            if box.unlike <= _MOST_UNLIKE or attempt.mismatch[0] > box.furthest:
                box.furthest = max(box.furthest, attempt.mismatch[0])
                box.attempts.append(attempt)
            continue
        box.attempts.append(attempt)
        attempt.goals = [import_term(goal, table) for goal in flat(attempt.clause.goals)]
        for symbol, var in table.items():
            var.written, var.name = symbol, None
        attempt.variables = table
        if i < len(clauses):
            m.choices.append((_more_clauses, k, height, box, clauses, i, arguments))
        return (_body, k, attempt, 0, b)
    return fail(m)


def _more_clauses(m, step):
    m.choices.pop()
    return _clauses(m, (_clauses, step[1], *step[3:]))


_ATOMS = frozenset([Symbol, Keyword, int, str])


def _other_constant(patterns, arguments):
    """The mismatch of a head and a goal whose first arguments are different constants, found without unifying."""
    if patterns.__class__ is not Cons or not arguments:
        return None
    wanted, given = patterns.car, deref(arguments[0])
    if (
        wanted.__class__ in _ATOMS
        and given.__class__ in _ATOMS
        and wanted != given
        and not variable(wanted)
        and _proper_length(patterns) == len(arguments)
    ):
        return (1, wanted, given)
    return None


def _proper_length(cell):
    """The length of a proper list; -1 for a dotted one."""
    count = 0
    while cell.__class__ is Cons:
        cell, count = cell.cdr, count + 1
    return count if cell is None else -1


def _match(patterns, arguments, trail):
    """Unify the arguments of a clause's head with those of the goal. Returns ``None``, or the first mismatch (see `Attempt`)."""
    given = len(arguments)
    cell, number = patterns, 0
    while cell.__class__ is Cons and number <= given:
        cell, number = cell.cdr, number + 1
    if number > given or (cell is None and number < given):
        return (0, number, given)
    number, names = 0, Names()
    while patterns.__class__ is Cons:
        height = len(trail)
        if not unify(patterns.car, arguments[number], trail):
            undo(trail, height)
            return (number + 1, readable(patterns.car, names), readable(arguments[number], names))
        patterns, number = patterns.cdr, number + 1
    if patterns is not None:
        if not unify(patterns, list_from(arguments[number:]), trail):
            return (number + 1, readable(patterns, names), readable(list_from(arguments[number:]), names))
    return None


def flat(goals):
    """The goals of a body, conjunctions in it flattened."""
    for goal in goals or ():
        if goal.__class__ is Cons and goal.car is AND and not extended(AND):
            yield from flat(goal.cdr)
        else:
            yield goal


def _body(m, step):
    """Prove the goals of a body from a number on."""
    _, k, attempt, i, b = step
    goals = attempt.goals
    if i == len(goals):
        return k
    if not attempt.boxes:
        attempt.boxes = [[] for _ in goals]
    return m.call(goals[i], k if i + 1 == len(goals) else (_body, k, attempt, i + 1, b), b, attempt, i)
