"""The plans that ended: the newest, and the newest of each name. Episodes are made of these when somebody asks (room ``episodes``).

A plan that ends leaves its task here, with the tree of what ran, until the next one ends; that costs two assignments. When the plan
of a name runs again, it clears and reuses its tree, so the earlier run keeps the codes that were in it.

``observers`` are for whoever wants to follow plans while they run: objects with functions ``begins(task, name)``, ``beside(task)`` for
the root of tasks that run beside a plan, ``made(task)`` for a task that is made long before it is executed, and ``ended(task, name)``.
Nobody observes unless asked to. How each task of a plan is heard of stands in ``chronicle/plans.py``.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell, per_image

observers = Cell((), fresh=True)
by_name = per_image({})
"""Name → the task at the root of the plan of that name that ended last; ``None`` → of a plan without a name."""
newest = Cell(None, fresh=True)


def observe(observer):
    """Tell ``observer`` of all plans from now on."""
    if observer not in observers.value:
        observers.value = (*observers.value, observer)


def observe_no_more(observer):
    """Do not tell ``observer`` any more."""
    observers.value = tuple(other for other in observers.value if other is not observer)


def made(task):
    """``task`` was made; it may be executed later."""
    for observer in observers.value:
        observer.made(task)


def begins(task, name):
    """The plan at whose root ``task`` is is about to run."""
    if name is not None:
        task.plan_name = name
    for observer in observers.value:
        observer.begins(task, name)


def beside(task):
    """The root ``task`` of a tree of tasks that is no plan, but runs beside one, is about to run."""
    for observer in observers.value:
        observer.beside(task)


def ended(task, name):
    """The plan at whose root ``task`` is is over."""
    newest.value = by_name[name] = task
    for observer in observers.value:
        observer.ended(task, name)


def forget():
    """Let go of all plans that ended."""
    newest.value = None
    by_name.clear()
