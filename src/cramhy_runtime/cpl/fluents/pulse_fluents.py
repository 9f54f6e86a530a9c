"""Fluents that are true once after something happened: ``pulsed`` after a pulse, ``fl-value-changed`` after a change.

Reading one may change it: the read that sees a pulse or a change consumes it, so every consumer needs a fluent of its own. Peeking
consumes nothing. The mode of a pulse fluent says whether pulses before its creation count, and how often a pulse counts. Source:
cpl.md 2.8 and 2.9.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.data import one, truth
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from .fluents import Fluent, value
from .nets import Net, peekers

if TYPE_CHECKING:
    from collections.abc import Callable

NEVER, ONCE, ALWAYS = "NEVER", "ONCE", "ALWAYS"


class PulseFluent(Fluent[bool | None]):
    """True while there are pulses of its parent that have not been consumed; reading it consumes (cpl.md 2.8).

    ``missed`` says what becomes of pulses that were not read: NEVER forgets those before its creation, ONCE counts all as one,
    ALWAYS counts each.
    """

    __slots__ = ("parent", "missed", "seen", "processed")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::PULSE-FLUENT"
    prefix = "FN-PULSE-FLUENT"

    def __init__(self, parent: Fluent[object], missed: str = ONCE):
        self.parent = parent
        self.missed = missed
        self.seen = parent.pulses
        self.processed = parent.pulses if missed == NEVER else 0
        super().__init__()
        parent.attach(self)

    def read(self) -> bool | None:
        if self.processed >= self.seen:
            return None
        if peekers and kernel.current() in peekers:
            return True
        if self.missed == ALWAYS:
            self.processed += 1
        else:
            self.processed = self.seen
        return True

    def peek(self) -> bool | None:
        return True if self.processed < self.seen else None

    def input_pulsed(self) -> None:
        self.seen = self.parent.pulses
        self.pulses += 1
        if self.nets or self.callbacks:
            self._notify(True if self.processed < self.seen else None)
        elif self.processed < self.seen:
            for task in self.waiters:
                task.kernel.unpark(task)

    def pulse(self) -> None:
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(True if self.processed < self.seen else None)


class ChangeFluent(Net[bool | None]):
    """True when its parent's value has changed since the last reading (``fl-value-changed``)."""

    __slots__ = ("parent", "test", "key", "remembered")

    def __init__(self, parent: Fluent[object], test: Callable[..., object], key: Callable[..., object]):
        self.parent, self.test, self.key = parent, test, key
        self.remembered = one(key(value(parent)))
        super().__init__("FL-UPDATED", self._look, (parent,), careful=True)

    def _look(self) -> bool | None:
        current = one(self.key(value(self.parent)))
        if truth(one(self.test(current, self.remembered))):
            return None
        if kernel.current() not in peekers:
            self.remembered = current
        return True
