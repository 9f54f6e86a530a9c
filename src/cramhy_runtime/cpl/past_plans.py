"""The plans that ended: the newest, and the newest of each name. Episodes are made of these when somebody asks (room ``episodes``).

A plan that ends leaves its task here, with the tree of what ran, until the next one ends; that costs two assignments. When the plan
of a name runs again, it clears and reuses its tree, so the earlier run keeps the codes that were in it.

``observer`` is for whoever wants to follow plans while they run: an object with functions ``begins(task, name)``, ``made(task)`` for a task
that is made long before it is executed, and ``ended(task, name)``. Nobody observes unless asked to.
"""

from __future__ import annotations

observer = None
by_name = {}
"""Name → the task at the root of the plan of that name that ended last; ``None`` → of a plan without a name."""
newest = None


def begins(task, name):
    """The plan at whose root ``task`` is is about to run."""
    if name is not None:
        task.plan_name = name
    if observer is not None:
        observer.begins(task, name)


def ended(task, name):
    """The plan at whose root ``task`` is is over."""
    global newest
    newest = by_name[name] = task
    if observer is not None:
        observer.ended(task, name)


def forget():
    """Let go of all plans that ended."""
    global newest
    newest = None
    by_name.clear()
