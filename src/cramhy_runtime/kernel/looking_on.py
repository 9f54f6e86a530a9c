"""Who only looks on at a program must not change what the program prints.

Addresses, and numbers in names of tasks, are given in the order in which they are asked for. So what is printed for somebody who only
looks on, such as a recorder, gets none: an object that has none yet shows as ``#<POINT {?}>``. Other tasks print as ever.
"""

from __future__ import annotations

from .active import active, current


class _Onlooker:
    """The task that looks on now, if one does."""

    def __init__(self) -> None:
        self.task: object = _NOBODY


_NOBODY = object()
_onlooker = _Onlooker()


class looking_on:  # noqa: N801 (reads as a statement)
    """``with looking_on():`` While the block runs, what this task prints gets no addresses and no numbers."""

    __slots__ = ("_before",)

    def __enter__(self) -> None:
        self._before, _onlooker.task = _onlooker.task, _this_task()

    def __exit__(self, *exception: object) -> None:
        _onlooker.task = self._before


def _this_task() -> object:
    return None if active() is None else current()


def only_looked_at() -> bool:
    """Whether what is printed now is for somebody who only looks on."""
    return _onlooker.task is not _NOBODY and _onlooker.task is _this_task()
