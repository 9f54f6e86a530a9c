"""Tasks that wait for a change: code that changes something wakes them, and they test a condition themselves.

Waiting tasks are in no order, and nothing is handed to them; the lines of ``utilities/wait_queue.py`` do that.
"""

from __future__ import annotations

from .active import current, park, unpark
from .typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Why
    from .tasks import Task


class Waiting:
    """The tasks that wait for one thing. `wait` parks until a condition holds; `changed` lets all of them look again."""

    def __init__(self) -> None:
        self._tasks: list[Task[object]] = []

    def changed(self) -> None:
        """Let the waiting tasks look again."""
        for task in self._tasks:
            unpark(task)

    def wait(self, condition: Callable[[], object], why: Why, until: float | None = None) -> bool:
        """Park the current task until ``condition()`` is true (True), or until the kernel's time ``until``, in seconds (False).

        why: a text for reports that says what it waits for, or a function that makes it.
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
