"""Orderings: which step of ``partial-order`` waits for which (cpl.md 6.7).

An ordering (before, after) makes the task ``after`` start its body only when ``before`` is dead, in any way. If ``before`` is a value
fluent, it must have been pulsed. Steps that wait for each other in a ring would wait for ever, as they do in the original. Here such
orderings are an error, and then none of them is in force. Some mistakes cannot be seen beforehand, such as a step that waits for the
step it is a part of, or for a fluent that never pulses: the kernel reports them as a deadlock when they happen.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error, handler_bind, type_error
from ..fluents.operators import fl_pulsed
from ..fluents.fluents import ValueFluent
from ..statuses import CREATED, DEAD
from ..tasks.task_readers import task_dead
from ..tasks.tasks import AbstractTask

HOW_TO_NAME = "In (:ORDER before after) a step is a task: the name of a tag in the WITH-TAGS around, (task path) or (sub-task path)."


def apply_orderings(orderings):
    """Put ``orderings`` in force: a list of pairs (before, after), or a function that returns one. After an error none is in force."""
    if callable(orderings):
        orderings = handler_bind([(types.UnboundVariable, _advise)], orderings)
    for before, after in orderings:
        _check(before, after)
    _refuse_rings(orderings)
    for before, after in orderings:
        if after.status is not CREATED:
            continue  # too late: it has looked what it must wait for
        if after.constraints is None:
            after.constraints = []
        if isinstance(before, AbstractTask):
            after.constraints.append(task_dead(before))
            after.predecessors = [*after.predecessors, before]
        else:
            after.constraints.append(fl_pulsed(before))


def awaited_by(task):
    """The living tasks that ``task`` waits for before it starts its body."""
    return [before for before in task.predecessors if before.status not in DEAD]


def _advise(condition):
    condition.hint = HOW_TO_NAME


def _check(before, after):
    if not isinstance(after, AbstractTask):
        return type_error(after, "TASK", f"\n({HOW_TO_NAME})")
    if not isinstance(before, AbstractTask) and before.__class__ is not ValueFluent:
        return type_error(before, "(OR TASK VALUE-FLUENT)", f"\n({HOW_TO_NAME} The first may be a value fluent.)")
    return None


def _refuse_rings(orderings):
    """Signal an error when with ``orderings`` a task would wait for itself, through others or at once."""
    waits_for = {}
    for before, after in orderings:
        if isinstance(before, AbstractTask) and after.status is CREATED:
            waits_for.setdefault(after, awaited_by(after)).append(before)
    for start in waits_for:
        ring = _way_back(start, waits_for)
        if ring:
            names = [step_name(task) for task in ring]
            waits = ", ".join(
                f"{name} waits for {other if other != name else 'itself'}" for name, other in zip(names, [*names[1:], names[0]])
            )
            error(
                types.SimpleError("The orderings of PARTIAL-ORDER form a ring, so none of its steps could ever start: ~A.", waits),
                hint="Take one of these orderings away.",
            )


def _way_back(start, waits_for):
    """The tasks of a ring through ``start``, each before one that it waits for; ``None`` if there is none."""
    came_from, waiting = {start: None}, [start]
    while waiting:
        task = waiting.pop(0)
        for before in waits_for.get(task) or awaited_by(task):
            if before is start:
                ring = [task]
                while (task := came_from[task]) is not None:
                    ring.insert(0, task)
                return ring
            if before not in came_from:
                came_from[before] = task
                waiting.append(before)
    return None


def step_name(task):
    """The user's name of a step: the name of its tag or plan function, or else of its task."""
    part = task.path.car if task.path is not None else None
    if part is None:
        return task.name
    name = part.cdr.car if part.cdr is not None and getattr(part.car, "name", None) == "TAGGED" else part.car
    return getattr(name, "name", None) or task.name
