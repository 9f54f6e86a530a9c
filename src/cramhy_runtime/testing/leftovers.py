"""Leftovers: tasks, observers, timers and threads, none of which may be left when a plan has ended.

`assert_nothing_left` looks at a whole kernel, `assert_all_dead` and `assert_tree` at the tasks of one plan, by their labels
(``TOP-LEVEL/PAR-CHILD-#1/2``) or their names in the task tree.
"""

from __future__ import annotations

import gc
from fnmatch import fnmatchcase

from .. import kernel
from cramhy_runtime.cpl.tree import finished_plans
from cramhy_runtime.cpl.fluents.fluents import ValueFluent
from cramhy_runtime.cpl.tree.task_tree import flatten_task_tree
from .labels import label, plain_name
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from cramhy_runtime.cpl.tasks.tasks import AbstractTask
    from cramhy_runtime.cpl.tree.task_tree import TaskTreeNode
    from .watched import WatchedKernel


def leftovers(watched: WatchedKernel) -> list[str]:
    """Texts about everything that is left on a kernel of `virtual_time`."""
    finished_plans.forget()  # the task tree of the last plan is kept on purpose, for whoever asks for its episode
    found = [
        f"task {label(task)} is alive ({task.state}, waits for {task.describe_why() or 'nothing'})"
        for task in watched.tasks
        if task is not watched.main and (task.carrier is not None or not task.cancelled)
    ]
    alive = len(found)
    if len(watched.tasks) > 1 + alive:
        watched.settle()  # those that were ended before their first step are only waiting to be forgotten
    when = watched.next_timer()
    if when is not None:
        found.append(f"a timer for {when:g} s is left")
    if watched.main.shielded:
        found.append("the main task is still shielded")
    threads = watched.threads_kept() - alive
    if threads > 0:
        found.append(f"{threads} threads more than before are in use")
    for generation in range(3):  # a net and its formula may hold each other; the youngest generation is collected in no time
        if not _observed(watched):
            return found
        gc.collect(generation)
    return found + _observed(watched)


def _observed(watched: WatchedKernel) -> list[str]:
    """Texts about the waiters, callbacks and nets of fluents that are still in use."""
    found = []
    for fluent in watched.living_fluents():
        if fluent.waiters:
            found.append(f"fluent {fluent!r} has waiters: {', '.join(label(task) for task in fluent.waiters)}")
        if fluent.callbacks:
            found.append(f"fluent {fluent!r} has callbacks: {', '.join(map(str, fluent.callbacks))}")
        if fluent.living_nets():
            found.append(f"fluent {fluent!r} has nets: {', '.join(map(repr, fluent.living_nets()))}")
        elif fluent.__class__ is not ValueFluent:
            found.append(f"the net {fluent!r} is still held by somebody")
    return found


def assert_nothing_left(watched: WatchedKernel | None = None, allowed: Iterable[str] = ()) -> None:
    """Assert that the kernel has no task but the main one, no timer, no thread, and no waiter, callback or net on a fluent made since
    `watch_fluents`.

    watched: a kernel of `virtual_time`, by default the active one. allowed: patterns of texts about leftovers that are allowed.
    Raises AssertionError.
    """
    complain([text for text in leftovers(watched or kernel.active()) if not any(fnmatchcase(text, pattern) for pattern in allowed)])


def complain(found: Sequence[str]) -> None:
    """Raise an AssertionError with the texts ``found``, if there are any."""
    if found:
        raise AssertionError("Something is left:\n" + "\n".join(f"  {text}" for text in found))


def assert_all_dead(tree_or_tasks: TaskTreeNode | Sequence[AbstractTask[object]]) -> None:
    """Assert that all tasks of a task tree, or of a list, are dead. Raises AssertionError."""
    alive = [task for _, task in _tasks(tree_or_tasks) if task.alive]
    if alive:
        raise AssertionError("Alive: " + ", ".join(f"{plain_name_of(task)} {task.status.name.lower()}" for task in alive))


def assert_tree(tree: TaskTreeNode, expected: Mapping[str, str]) -> None:
    """Assert that the tasks of a task tree have the statuses in ``expected``, a dict {pattern of a path: status}.

    A path is written from the top, ``"drive-home/tagged-grasp"``, with its parts in lower case; a pattern may use ``*``. Every pattern
    must fit a task, and all tasks that it fits must have its status, such as ``"succeeded"``, ``"failed"`` or ``"evaporated"``.
    Raises AssertionError.
    """
    statuses = {path: task.status.name.lower() for path, task in _tasks(tree)}
    wrong = []
    for pattern, status in expected.items():
        fitting = {path: actual for path, actual in statuses.items() if fnmatchcase(path, pattern)}
        if not fitting:
            wrong.append(f"no task at {pattern}")
        wrong += [f"{path} {actual}, not {status}" for path, actual in fitting.items() if actual != status]
    if wrong:
        tree_text = "\n".join(f"  {path or '(top)'}: {status}" for path, status in statuses.items()) or "  (no tasks)"
        raise AssertionError("; ".join(wrong) + ".\nThe tree:\n" + tree_text)


def _tasks(tree_or_tasks: TaskTreeNode | Sequence[AbstractTask[object]]) -> list[tuple[str, AbstractTask[object]]]:
    if isinstance(tree_or_tasks, list | tuple):
        return [(plain_name_of(task), task) for task in tree_or_tasks]
    nodes = [node for node in flatten_task_tree(tree_or_tasks) or () if node.code is not None and node.code.task is not None]
    return [(written(node.path), node.code.task) for node in reversed(nodes)]


def written(path: Iterable[Any] | None) -> str:
    """A path of the task tree as text, from the top: ``drive-home/tagged-grasp``."""
    return "/".join("-".join(_word(word) for word in part) for part in reversed(list(path or ())))


def _word(word: object) -> str:
    return str(getattr(word, "name", word)).lower()


def plain_name_of(task: AbstractTask[object]) -> str:
    """The label of a task of a plan, or if it is not started its name without brackets and number."""
    return label(task.kernel_task) if task.kernel_task is not None else plain_name(task)
