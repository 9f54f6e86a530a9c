"""Predicates about tasks during an episode: the nodes of its task tree, their outcomes and times.

A bound task is used as it is; an unbound one ranges over all tasks of the episode, parents before children. Most answers do not need
tracing. Only the time when a task was made, and the statuses between its start and its end, come from the trace of its status fluent.
Source: projection-and-events.md B4.

Repaired: ``error-type`` of an unbound variable warns once and fails. ``task-next-sibling`` works. Times and outcomes are known without
tracing, too.
"""

from __future__ import annotations

from cramhy_runtime.cpl.failures.failure_types import PlanFailure, opened
from ..cpl.statuses import CREATED, DEAD, FAILED, RUNNING
from cramhy_runtime.cpl.tree.task_tree import TaskTreeNode, goal_task_tree_node_goal, goal_task_tree_node_p, task_tree_node_result
from ..episodes.knowledge import stamp
from ..episodes.queries import episode_knowledge_max_time, fluent_durations
from ..episodes.trees import nodes_of
from cramhy_runtime.lisp_core.conditions import Condition, SimpleWarning, warn
from cramhy_runtime.lisp_core.data import MultipleValues, lisp_list, one
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group
from cramhy_runtime.prolog.builtins.native_predicates import deref, predicate, test
from cramhy_runtime.prolog.terms.terms import Var
from .current_episode import asked_episode, asked_nodes
from .occasions import HOLDS
from .symbols import sym
from .time_terms import included

GROUP = "CRAM-OCCASIONS-EVENTS::TASKS"
_TASK, _STATUS, _TIME = sym("CRAM-OCCASIONS-EVENTS::?TASK"), sym("CRAM-OCCASIONS-EVENTS::?STATUS"), sym("CRAM-OCCASIONS-EVENTS::?TIME")

define_fact_group(
    sym(GROUP),
    [HOLDS],
    [
        lisp_list(
            lisp_list(HOLDS, lisp_list(sym("CRAM-OCCASIONS-EVENTS::TASK-STATUS"), _TASK, _STATUS), _TIME),
            lisp_list(sym("CRAM-OCCASIONS-EVENTS::TASK-STATUS-AT"), _TASK, _STATUS, _TIME),
        )
    ],
)


def _nodes(term, functor):
    """The nodes that ``term`` may stand for."""
    found = deref(term)
    if found.__class__ is Var:
        return asked_nodes(functor)
    return [found] if isinstance(found, TaskTreeNode) and asked_episode(functor) is not None else []


def _of_each_node(functor, answer):
    """Define ``(functor task value)``: the value is ``answer(node)`` for each task, unless that is `NOTHING`."""

    @predicate(functor, group=GROUP)
    def ask(m, task, value):
        for node in _nodes(task, functor):
            found = answer(node)
            if found is not NOTHING and m.unify(task, node, value, found):
                yield

    return ask


NOTHING = object()


@predicate("CPL-IMPL::TOP-LEVEL", group=GROUP)
def top_level(m, task):
    """``(top-level task)``: the root of the task tree."""
    for node in asked_nodes("CPL-IMPL::TOP-LEVEL")[:1]:
        if m.unify(task, node):
            yield


@predicate("CPL-IMPL::TASK", group=GROUP)
def task(m, node):
    """``(task task)``: all nodes that unify with the argument."""
    for found in asked_nodes("CPL-IMPL::TASK"):
        if m.unify(node, found):
            yield


@predicate("CRAM-OCCASIONS-EVENTS::GOAL-TASK", group=GROUP)
def goal_task(m, node):
    """``(goal-task task)``: the nodes of goals."""
    for found in _nodes(node, "CRAM-OCCASIONS-EVENTS::GOAL-TASK"):
        if goal_task_tree_node_p(found) and m.unify(node, found):
            yield


_of_each_node("CPL-IMPL::TASK-PATH", lambda node: node.path)
_of_each_node(
    "CRAM-OCCASIONS-EVENTS::TASK-RESULT", lambda node: NOTHING if _task_of(node) is None else one(_plain(task_tree_node_result(node)))
)
_of_each_node(
    "CRAM-OCCASIONS-EVENTS::TASK-STATUS-FLUENT", lambda node: NOTHING if _task_of(node) is None else _task_of(node).status_fluent.name
)
_of_each_node("CRAM-OCCASIONS-EVENTS::TASK-GOAL", lambda node: goal_task_tree_node_goal(node) if goal_task_tree_node_p(node) else NOTHING)
_of_each_node(
    "CRAM-OCCASIONS-EVENTS::TASK-OUTCOME",
    lambda node: _task_of(node).status if _task_of(node) and _task_of(node).status in DEAD else NOTHING,
)
_of_each_node("CRAM-OCCASIONS-EVENTS::TASK-ERROR", lambda node: _error(_task_of(node)))
_of_each_node("CRAM-OCCASIONS-EVENTS::TASK-CREATED-AT", lambda node: _first_time(node, (CREATED,), None))
_of_each_node("CRAM-OCCASIONS-EVENTS::TASK-STARTED-AT", lambda node: _first_time(node, (RUNNING,), "started_at"))
_of_each_node("CRAM-OCCASIONS-EVENTS::TASK-ENDED-AT", lambda node: _first_time(node, DEAD, "ended_at"))


def _task_of(node):
    return node.code.task if node.code is not None else None


def _plain(result):
    """The first value of a task's values; a list of all of them if it has several."""
    return lisp_list(*result) if isinstance(result, MultipleValues) and len(result) > 1 else result


def _error(of):
    if of is None or of.status is not FAILED:
        return NOTHING
    return opened(of.result) if isinstance(of.result, PlanFailure) else of.result


def _traced(node):
    """The durations of the statuses of ``node`` that were traced."""
    of, episode = _task_of(node), asked_episode("CPL-IMPL::TASK")
    if of is None or episode is None or not episode.traces:
        return []
    return fluent_durations(of.status_fluent.name, episode)


def _first_time(node, statuses, attribute):
    for status, start, _ in _traced(node):
        if status in statuses:
            return start
    of = _task_of(node)
    time = getattr(of, attribute) if of is not None and attribute is not None else None
    return NOTHING if time is None else stamp(of, time)


@predicate("CRAM-OCCASIONS-EVENTS::TASK-STATUS-AT", group=GROUP)
def task_status_at(m, node, status, time):
    """The statuses of tasks whose durations include ``time``, from the trace, or from the start and end of the task."""
    for found in _nodes(node, "CRAM-OCCASIONS-EVENTS::TASK-STATUS"):
        for was, start, end in _traced(found) or _known_statuses(found):
            fit = included(m, start, end, time)
            if fit is not None and m.unify(node, found, status, was, *fit):
                yield


def _known_statuses(node):
    of, episode = _task_of(node), asked_episode("CRAM-OCCASIONS-EVENTS::TASK-STATUS")
    if of is None or of.started_at is None:
        return
    start, last = stamp(of, of.started_at), episode_knowledge_max_time(episode)
    end = stamp(of, of.ended_at)
    yield RUNNING if end is not None else of.status, start, last if end is None else end
    if end is not None:
        yield of.status, end, last


@test("CRAM-OCCASIONS-EVENTS::ERROR-TYPE", group=GROUP)
def error_type(m, condition, type_):
    """``(error-type e type)``: the type of a condition. An unbound condition is a warning, and the goal fails."""
    found = deref(condition)
    if found.__class__ is Var:
        warn(SimpleWarning("[PROLOG WARNING] Trying to call ERROR-TYPE on unbound variable."))
        return False
    return isinstance(found, Condition | Exception) and m.unify(type_, class_name(type(found)))


# ------------------------------------------------------------------------------------------------------------ who is below whom


def _relation(functor, down, up):
    """Define ``(functor task other)``. ``down(node)`` lists the others for a task, ``up(node)`` the tasks for an other."""

    @predicate(functor, group=GROUP)
    def ask(m, first, second):
        if deref(first).__class__ is Var and deref(second).__class__ is not Var:
            for other in _nodes(second, functor):
                for node in up(other):
                    if m.unify(first, node):
                        yield
            return
        for node in _nodes(first, functor):
            for other in down(node):
                if m.unify(first, node, second, other):
                    yield

    return ask


def _children(node):
    return list(reversed(node.children.values()))


def _parents(node):
    return [] if node.parent is None else [node.parent]


def _above(node):
    found = []
    while node.parent is not None:
        node = node.parent
        found.append(node)
    return found


def _siblings(node):
    return [] if node.parent is None else [other for other in _children(node.parent) if other is not node]


def _beside(node, step):
    if node.parent is None:
        return []
    row = list(node.parent.children.values())
    place = row.index(node) + step
    return [row[place]] if 0 <= place < len(row) else []


_relation("CRAM-OCCASIONS-EVENTS::SUBTASK", _children, _parents)
_relation("CRAM-OCCASIONS-EVENTS::SUBTASK+", lambda node: nodes_of(node)[1:], _above)
_relation("CRAM-OCCASIONS-EVENTS::TASK-SIBLING", _siblings, _siblings)
_relation("CRAM-OCCASIONS-EVENTS::TASK-NEXT-SIBLING", lambda node: _beside(node, 1), lambda node: _beside(node, -1))
