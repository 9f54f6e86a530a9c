"""The plans that ended: the newest, and the newest of each name. The room ``episodes`` makes episodes of them on demand.

A plan that ends leaves its task here, with the tree of what ran, until the next one ends; that costs two assignments. When the plan
of a name runs again, it clears and reuses its tree, so the earlier run keeps the codes that were in it.

``observers`` follow plans while they run. They are objects with functions ``begins(task, name)``, ``beside(task)`` for the root of tasks
that run beside a plan, ``made(task)`` for a task that is made long before it is executed, and ``ended(task, name)``. At first there are
none. ``chronicle/plans.py`` shows how to follow each task of a plan.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell, per_image

observers = Cell((), fresh=True)
by_name = per_image({})
"""Name → the root task of the plan of that name that ended last. ``None`` stands for plans without a name."""
newest = Cell(None, fresh=True)


def observe(observer):
    """Tell ``observer`` of all plans from now on."""
    if observer not in observers.value:
        observers.value = (*observers.value, observer)


def observe_no_more(observer):
    """Stop telling ``observer``."""
    observers.value = tuple(other for other in observers.value if other is not observer)


def made(task):
    """Tell the observers that ``task`` was made. It may be executed later."""
    for observer in observers.value:
        observer.made(task)


def begins(task, name):
    """Tell the observers that the plan with the root ``task`` is about to run."""
    if name is not None:
        task.plan_name = name
    for observer in observers.value:
        observer.begins(task, name)


def beside(task):
    """Tell the observers that ``task`` is about to run, the root of a tree of tasks that is not a plan but runs beside one."""
    for observer in observers.value:
        observer.beside(task)


def ended(task, name):
    """Keep the plan with the root ``task``, and tell the observers that it is over."""
    newest.value = by_name[name] = task
    for observer in observers.value:
        observer.ended(task, name)


def forget():
    """Forget all plans that ended."""
    newest.value = None
    by_name.clear()
