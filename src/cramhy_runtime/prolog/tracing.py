"""``trace-prolog``: a line on ``*trace-output*`` for each port that a goal passes.

    0: CALL (GRANDPARENT ABE ?WHO)
      1: CALL (PARENT ABE ?Y)
      1: EXIT (PARENT ABE HOMER)   by clause 1 of FAMILY at family.lisp:2:3

A goal is called, exits with a solution, is asked for another (redo), and fails. A line also shows when an error or the end of its task
leaves a goal. A line has the depth of the goal, the goal with its present values, and the clause of the solution. It names the task,
except the main one. Tracing costs nothing while no goal is traced: a traced predicate has other code, and the code of its callers is
made anew when the trace begins and ends.

Any functor can be traced: a predicate of facts and rules, a built-in, a construct of control, or one that is not defined yet. The layout
is that of ``trace``, see ``languages/commonlisp/tools/tracing.py``.
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.catching import HandlerExit
from cramhy_runtime.lisp_core.conditions import Condition, error, warn
from cramhy_runtime.lisp_core.data import Cons, Keyword, list_from
from cramhy_runtime.lisp_core.output import trace_output

from .engine import database, four_ports as ports
from .explanations import failure_reasons as reasons
from .compiler.compiler import clause_functions
from .engine.database import arguments_of, functors, handled, traced, valid_functor
from .explanations.explaining import LISP_CALLS
from .engine.machine import Machine, call_again, fail
from .engine.goal_text import Names, clause_name, line, readable
from .engine.services import SERVICES
from .symbols import sym
from .terms.terms import import_term, undo, unify


class TracedGoal(ports.Box):
    """A traced goal. ``parent`` is the traced goal for which it is proved; ``clause`` is the clause that is tried now."""

    __slots__ = ("functor", "terms", "parent", "depth", "clause", "reason", "exits")

    def __init__(self, functor, terms, parent):
        self.functor, self.terms, self.parent = functor, terms, parent
        self.depth = 0 if parent is None else parent.depth + 1
        self.clause = self.reason = None
        self.exits = 0

    def called(self):
        """The goal is called."""
        _proofs()[-1].goal = self
        self.tell("CALL")

    def exited(self, m, last):
        self.exits += 1
        self.tell("EXIT", f"by {clause_name(self.clause, None)}" if self.clause is not None else None)
        _proofs()[-1].goal = self.parent

    def redone(self, m):
        _proofs()[-1].goal = self
        self.tell("REDO")

    def failed(self, m):
        reason = self.reason
        if reason is None and not self.exits:
            reason = reasons.why(m, Cons(self.functor, list_from(self.terms)))[0]
        self.tell("FAIL", None if self.exits else reason)
        _proofs()[-1].goal = self.parent

    def left(self, exception):
        """``exception`` leaves the goal, which has neither a solution nor failed."""
        if isinstance(exception, HandlerExit):
            exception = exception.condition
        if isinstance(exception, kernel.Cancelled):
            self.tell("LEFT", "its task was ended")
        elif isinstance(exception, Condition):
            self.tell("LEFT", " ".join(str(exception).split()))
        else:
            self.tell("LEFT", f"{type(exception).__name__}: {exception}" if isinstance(exception, Exception) else "by a non-local exit")

    def tell(self, port, more=None):
        """Write the line for ``port``, with ``more`` at its end."""
        if self.functor not in traced:
            return  # it was untraced while this goal was proved
        proofs = _proofs()
        if proofs[-1].printing:  # how something of the goal is printed asks Prolog in turn
            return
        proofs[-1].printing = True
        try:
            text = line(readable(Cons(self.functor, list_from(self.terms)), Names()))
            task = kernel.current()
            name = "" if task is kernel.active().main else f"{task.name}: "
            stream = trace_output()
            stream.fresh_line()
            stream.write(f"{name}{'  ' * (self.depth % 20)}  {self.depth}: {port} {text}{f'   {more}' if more else ''}\n")
        finally:
            proofs[-1].printing = False


# ----------------------------------------------------------------------------------------------------------- whose goals they are


class _Proof:
    """A proof that a task is doing: ``goal`` is the traced goal that it is in, ``outer`` the one for which the whole proof is made."""

    __slots__ = ("goal", "outer", "printing")

    def __init__(self, outer):
        self.goal = self.outer = outer
        self.printing = False


_proofs_of_tasks: dict = per_image({})


def _proofs():
    """The proofs that the current task is doing, the innermost last."""
    task = kernel.current()
    found = _proofs_of_tasks.get(task)
    if found is None:  # a proof that began before anything was traced
        found = _proofs_of_tasks[task] = [_Proof(None)]
    return found


def _watched_next_solution(m, next_solution):
    """`Machine.next_solution` while goals are traced: it notes the goal for which the proof is made, and the goals an exception leaves."""
    task = kernel.current()
    proofs = _proofs_of_tasks.setdefault(task, [])
    proof = _Proof(proofs[-1].goal if proofs else None)
    proof.printing = bool(proofs) and proofs[-1].printing
    proofs.append(proof)
    try:
        return next_solution(m)
    except BaseException as exception:
        goal = proof.goal
        while goal is not None and goal is not proof.outer:
            goal.left(exception)
            goal = goal.parent
        raise
    finally:
        proofs.remove(proof)
        if not proofs:
            _proofs_of_tasks.pop(task, None)


# ------------------------------------------------------------------------------------------------- the code of what is traced


def _watch_predicate(predicate, entry):
    """The call function of a traced predicate. ``entry`` is ``None`` for a predicate that is not defined."""
    functor = predicate.functor
    body = _watched_body(predicate, entry)

    def call(m, step):
        goal = TracedGoal(functor, step[2:], _proofs()[-1].goal)
        goal.called()
        return body(m, ports.enter(m, goal, step[1]), goal)

    return call


def _watched_body(predicate, entry):
    """``body(m, k, goal)``: the step that proves a goal, as the code of `Functor.code` does, noting the clause."""
    if entry is None:
        return lambda m, k, goal: database.undefined_step(m, Cons(goal.functor, list_from(goal.terms)), k)
    clauses = clause_functions(predicate, entry.clauses)
    built_in = entry.handler or entry.native and (entry.native.get(predicate.arity) or entry.native.get(None))
    if not built_in:
        return lambda m, k, goal: _try_clauses(m, k, goal, clauses, 0)

    def body(m, k, goal):
        if clauses:
            height = len(m.choices)
            m.choices.append((call_again, k, len(m.trail), _clauses_call, goal, clauses))
            if entry.handler:
                k = (handled, k, height)
        if built_in is LISP_CALLS.get(goal.functor):
            succeeded, goal.reason = reasons.call_lisp_goal(m, goal.functor, goal.terms)
            return k if succeeded else fail(m)
        return built_in(m, (built_in, k, *goal.terms))

    return body


def _clauses_call(m, step):
    _, k, goal, clauses = step
    return _try_clauses(m, k, goal, clauses, 0)


def _try_clauses(m, k, goal, clauses, i):
    """Try the clauses from number ``i`` on whose heads match the goal. A choice point is made only if there is another one."""
    matching = _next_match(m, goal, clauses, i)
    if matching is None:
        return fail(m)
    barrier = len(m.choices)
    following = _next_match(m, goal, clauses, matching + 1)
    if following is not None:
        m.choices.append((_following, k, len(m.trail), goal, clauses, following))
    goal.clause, function = clauses[matching]
    return function(m, k, barrier, *goal.terms)


def _following(m, step):
    _, k, _, goal, clauses, i = step
    m.choices.pop()
    return _try_clauses(m, k, goal, clauses, i)


def _next_match(m, goal, clauses, i):
    """The number of the first clause from ``i`` on whose head matches, or ``None``. Variables are unset again."""
    while i < len(clauses):
        height = len(m.trail)
        matches = unify(import_term(clauses[i][0].head.cdr, {}), list_from(goal.terms), m.trail)
        undo(m.trail, height)
        if matches:
            return i
        i += 1
    return None


def _watch_construct(functor, construct):
    """The control function of a construct that is traced."""

    def call(m, terms, k, b):
        goal = TracedGoal(functor, arguments_of(Cons(functor, terms)), _proofs()[-1].goal)
        goal.called()
        return construct(m, terms, ports.enter(m, goal, k), b)

    return call


SERVICES.install(watch_predicate=_watch_predicate, watch_construct=_watch_construct)


# -------------------------------------------------------------------------------------------------------------- on and off

_ALL = "ALL"


def trace_prolog(names=None):
    """``(trace-prolog functor...)``: show the goals of these functors; ``:all`` stands for all predicates. Returns the list of names.

    Without names, returns the list of the functors that are traced, with ``:all`` first if all are. A name that cannot be a functor is
    an error; a functor that is not defined is a warning.
    """
    if names is None:
        return list_from([*([sym(":ALL")] if traced.everything else []), *traced])
    names = list(names)
    for name in names:
        if not (_is_all(name) or valid_functor(name)):
            return error("TRACE-PROLOG takes the functors of goals, and :ALL: ~S is none.", name)
    for name in names:
        if _is_all(name):
            traced.everything = True
            continue
        if name not in traced.constructs and (name not in functors or not functors[name].defined):
            near = reasons.spelled_like(name, [known for known in functors if functors[known].defined])
            hint = f" Did you mean {' or '.join(line(symbol, 'DOWNCASE') for symbol in near)}?" if near else ""
            warn(f"Nobody has defined ~S yet; its goals will be shown all the same.{hint.replace('~', '~~')}", name)
        traced[name] = True
    _changed()
    return list_from(names)


def untrace_prolog(names=None):
    """``(untrace-prolog functor...)``: stop showing the goals of these functors, or of all without names. Returns ``t``."""
    for name in [*traced, sym(":ALL")] if names is None else names:
        if _is_all(name):
            traced.everything = False
        elif dict.__contains__(traced, name):
            del traced[name]
        else:
            warn("~S is not traced.", name)
    _changed()
    return True


def _is_all(name):
    return isinstance(name, Keyword) and name.name == _ALL


def _changed():
    if traced:
        Machine.watch(_watched_next_solution)
    else:
        Machine.watch(None)
        _proofs_of_tasks.clear()
    database.forget_all()


@contextmanager
def tracing(*functors):
    """``with tracing(...):`` shows the goals of ``functors`` within the block, or of all predicates if there are none.

    functors: symbols, or names such as ``"DESIG::MOTION-GROUNDING"``. Functors that were traced before stay traced.
    """
    names = [sym(name) if isinstance(name, str) else name for name in functors] or [sym(":ALL")]
    new = [name for name in names if not (traced.everything if _is_all(name) else dict.__contains__(traced, name))]
    trace_prolog(new)
    try:
        yield
    finally:
        untrace_prolog(new)
