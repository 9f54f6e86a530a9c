"""Names of tasks that are the same in every run.

The plan language names a task when its name is first asked for, ``[PAR-CHILD-#1/2]-7``, and counts these names. A schedule or a fault must
mean the same task in every run, so tests use labels: the names without that number, from the top-level down,
``TOP-LEVEL/PAR-CHILD-#1/2``. Siblings of the same name are numbered in the order in which they started; the second is ``... (2)``.
"""

from __future__ import annotations

import re
from collections import Counter
from weakref import ref

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cramhy_runtime.kernel import Task
    from cramhy_runtime.kernel.reports import Named

_NUMBERED = re.compile(r"\[(.*)\]-\d+$")


class Births:
    """The tasks that one task has started, in order, and the labels that were asked for."""

    __slots__ = ("born", "known", "counts")

    def __init__(self) -> None:
        self.born: list[Any] = []  # weak references, or names of tasks that are gone
        self.known = 0
        self.counts: Counter[str] = Counter()

    def label_until(self, task: Task[object], prefix: str) -> None:
        """Label the tasks up to ``task`` in the order in which they started."""
        while True:
            entry = self.born[self.known]
            other = None if isinstance(entry, str) else entry()
            name = entry if isinstance(entry, str) else plain_name(other)
            self.born[self.known] = None
            self.known += 1
            self.counts[name] += 1
            count = self.counts[name]
            if other is not None:
                other.local.label = prefix + (name if count == 1 else f"{name} ({count})")
            if other is task:
                return


def plain_name(task: Named | None) -> str:
    """The own name of ``task``, without brackets and number."""
    name = "a task" if task is None else str(task.name)
    numbered = _NUMBERED.match(name)
    return numbered[1] if numbered else name.removeprefix("[").removesuffix("]")


def born(task: Task[object], parent: Task[object]) -> None:
    """Note that ``parent`` has started ``task``."""
    births = getattr(parent.local, "births", None)
    if births is None:
        births = parent.local.births = Births()
    task.local.siblings = births
    births.born.append(ref(task))


def label(task: Task[object]) -> str:
    """The label of a kernel's task."""
    known = getattr(task.local, "label", None)
    if known is not None:
        return known
    siblings = getattr(task.local, "siblings", None)
    if siblings is None:
        return str(task.name)
    parent = task.parent
    siblings.label_until(task, "" if parent is None or parent.parent is None else label(parent) + "/")
    return task.local.label
