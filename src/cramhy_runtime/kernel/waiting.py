"""Tasks that wait for a change of something: those who change it tell, and those who wait look for themselves.

Waiters are kept in no order, and nothing is handed to them; for that there are the lines of ``utilities/wait_queue.py``.
"""

from __future__ import annotations

from .active import current, park, unpark
from .typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Why
    from .tasks import Task


class Waiting:
    """The tasks that wait for one thing. `wait` parks until a condition holds; `changed` has all of them look again."""

    def __init__(self) -> None:
        self._tasks: list[Task[object]] = []

    def changed(self) -> None:
        """Have those who wait look again."""
        for task in self._tasks:
            unpark(task)

    def wait(self, condition: Callable[[], object], why: Why, until: float | None = None) -> bool:
        """Park the current task until ``condition()`` is true: True; or until the kernel's time ``until``: False.

        why: what it waits for, for reports; a text, or a function that gives it.
        """
        task = current()
        self._tasks.append(task)
        try:
            while not condition():
                if not park(why, until) and not condition():
                    return False
            return True
        finally:
            self._tasks.remove(task)
