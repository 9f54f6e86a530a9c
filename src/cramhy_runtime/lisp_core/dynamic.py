"""Special variables: one current value, kept apart per task.

Shallow binding: ``symbol.value`` is the current value, binding saves the old one and restores it on the way out. Because only
one task runs at a time (law 4), that is also right with many tasks: when the baton leaves a task, the kernel calls `leave`,
which puts the outer values back; when it returns, `enter` puts the task's own values in. A task without bindings pays nothing.

A new task starts with the global values. Ordinary specials are not inherited (cpl.md 3.13); task variables are bound anew by
``cpl`` when it starts a task.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.images import copied, part
from cramhy_runtime.kernel.typing_names import Any

from .data import UNBOUND, Symbol
from .packages import sym


def special(symbol, initial=None):
    """Proclaim ``symbol``, or the one that `packages.sym` finds, special; ``initial`` is its value if it has none. The symbol."""
    if isinstance(symbol, str):
        symbol = sym(symbol)
    symbol.special = True
    if symbol.value is UNBOUND:
        symbol.value = initial
    if symbol.__class__ is Symbol:  # else its value is computed
        _initial.setdefault(symbol, symbol.value)
    return symbol


_initial: dict = {}
"""The special variables of our own code, and what each was when it was made."""


@part
class _Values:
    """The values of our own special variables. Those of users' variables are in symbols that no other image sees."""

    @staticmethod
    def take():
        return {symbol: symbol.value for symbol in _initial}

    @staticmethod
    def put(state):
        for symbol, initial in _initial.items():
            symbol.value = state[symbol] if symbol in state else copied(initial)

    @staticmethod
    def copy(state):
        return {symbol: copied(value) for symbol, value in state.items()}


class Bindings:
    """The stack of a task's dynamic bindings: symbols, and the values that each hides."""

    __slots__ = ("stack",)

    def __init__(self) -> None:
        self.stack: list[list[Any]] = []

    def leave(self) -> None:
        for entry in reversed(self.stack):
            symbol = entry[0]
            symbol.value, entry[1] = entry[1], symbol.value

    def enter(self) -> None:
        for entry in self.stack:
            symbol = entry[0]
            symbol.value, entry[1] = entry[1], symbol.value


def bind(symbol, value):
    """Bind ``symbol`` dynamically in the current task; undone by `unbind`."""
    running = ACTIVE.value
    task = kernel.current() if running is None else running.current
    bindings = task.dynamic
    if bindings is None:
        bindings = task.dynamic = Bindings()
    bindings.stack.append([symbol, symbol.value])
    symbol.value = value


def unbind(count=1):
    """Undo the last ``count`` bindings of the current task."""
    stack = ACTIVE.value.current.dynamic.stack
    while count:
        symbol, old = stack.pop()
        symbol.value = old
        count -= 1


class binding:
    """``with binding(symbol, value, ...):`` binds specials for the extent of the block, as ``let`` does."""

    __slots__ = ("pairs", "count")

    def __init__(self, *pairs: Any):
        self.pairs = pairs
        self.count = len(pairs) // 2

    def __enter__(self) -> None:
        pairs = self.pairs
        for index in range(0, len(pairs), 2):
            bind(pairs[index], pairs[index + 1])

    def __exit__(self, *exc: object) -> None:
        if self.count:
            unbind(self.count)


def global_value(symbol):
    """The value of ``symbol`` outside all bindings of the current task."""
    bindings = kernel.current().dynamic
    if bindings is not None:
        for bound, old in bindings.stack:
            if bound is symbol:
                return old
    return symbol.value
