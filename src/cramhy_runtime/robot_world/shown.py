"""The world that is shown, in a movie for one. And who wants to know when a world changes.

Worlds are copied to look ahead, and the copies come and go; the one that is shown is the one that a program calls its current one. Lisp's
``btr:*current-bullet-world*`` is one such place (`offer`), and `show` is for programs in Python. This module is loaded without MuJoCo,
so that others may ask for a world where there has never been one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cramhy_runtime.kernel.images import Cell, per_image

if TYPE_CHECKING:
    from collections.abc import Callable

    from .world import World

_chosen: Cell = Cell(None, fresh=True)
_offers: list[Callable[[], World | None]] = per_image([])
_watchers: list[Callable[[World], None]] = per_image([])


def current() -> World | None:
    """The world that is shown, or ``None``."""
    if _chosen.value is not None:
        return _chosen.value
    for offered in _offers:
        world = offered()
        if world:
            return world
    return None


def show(world: World | None) -> None:
    """Let this be the world that is shown, whatever others offer; ``None``: what others offer again."""
    _chosen.value = world


def offer(source: Callable[[], World | None]) -> None:
    """Let ``source()`` be asked for the world that is shown."""
    _offers.append(source)


def watch(watcher: Callable[[World], None]) -> None:
    """Call ``watcher(world)`` after each change of any world, also of those that are copies. It may change nothing."""
    _watchers.append(watcher)


def unwatch(watcher: Callable[[World], None]) -> None:
    """Call it no more."""
    if watcher in _watchers:
        _watchers.remove(watcher)


def changed(world: World) -> None:
    """A world has changed."""
    for watcher in tuple(_watchers):
        watcher(world)
