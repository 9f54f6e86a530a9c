"""Nets: fluents that are computed from other fluents, their inputs.

``operators.py`` makes them. A net whose inputs are all cacheable keeps its value: it is computed when an input pulses, and pulses only
when its value changes. Other nets are computed whenever they are read. Source: cpl.md 2.7.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.equality import eql
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.lisp_core.source_places import circumstance
from .fluents import Fluent, ValueFluent, reads_slot

if TYPE_CHECKING:
    from collections.abc import Callable

T_co = TypeVar("T_co", covariant=True, default=Any)
A = TypeVar("A")


def _shown_net(net):
    """The name of a net and of what it is computed from, for the reports of errors."""
    names = [princ_to_string(fluent.name) for fluent in net.inputs]
    over = f" over the fluent{'s' * (len(names) > 1)} {' and '.join(names)}" if names else ""
    return f"the net {princ_to_string(net.name)}{over}"


class Net(Fluent[T_co]):
    """A fluent computed by ``formula()`` from ``inputs``, its fluents.

    ``careful`` says that the formula calls a function of the user, which may let other tasks run. Then no request to end arrives
    while the inputs tell this net of a pulse, and a value computed from old inputs is computed again.
    """

    __slots__ = ("formula", "inputs", "prefix", "careful")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-FLUENT"

    def __init__(self, operator: str, formula: Callable[[], T_co], inputs: tuple[Fluent[object], ...], careful: bool = False):
        self.prefix = "FN-" + operator
        self.formula = formula
        self.inputs = inputs
        self.careful = careful or any([fluent.foreign for fluent in inputs])
        super().__init__()
        self._begin()
        for fluent in inputs:
            fluent.attach(self)

    foreign = property(lambda self: self.careful)

    def _begin(self):
        pass

    @circumstance(lambda here: f"while {_shown_net(here['self'])} was computed")
    def read(self):
        return self.formula()

    @circumstance(lambda here: f"while {_shown_net(here['self'])} was computed")
    def peek(self):
        return peeking(self.formula)

    def input_pulsed(self) -> None:
        self.pulse()


class CachedNet(Net[T_co]):
    """A net whose inputs are all cacheable. It is computed when an input pulses, and it pulses only when its value changes."""

    __slots__ = ("cached", "turn")
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::FL-NET-CACHEABLE-FLUENT"
    foreign = False

    @circumstance(lambda here: f"while {_shown_net(here['self'])} was made: its first value is computed at once")
    def _begin(self):
        self.turn = 0
        if not self.careful:
            self.cached = self.formula()  # before the inputs hear of this net: if it fails, they never do
            return
        pulses = None
        while pulses != (now := [fluent.pulses for fluent in self.inputs]):  # until nobody assigned meanwhile
            pulses = now
            self.cached = self.formula()

    def read(self):
        return self.cached

    peek = read

    @circumstance(lambda here: None if "new" in here else f"while {_shown_net(here['self'])}, which keeps its old value, was computed anew")
    def pulse(self):
        if self.careful:
            self.turn = turn = self.turn + 1
            new = self.formula()
            if self.turn != turn:
                new = self._recomputed()
        else:
            new = self.formula()
        old = self.cached
        if old is new:
            return
        kind = type(new)
        if kind is type(old):
            if old == new if kind is int else eql(old, new):
                return
        elif (old is False or new is False) and eql(old, new):  # of two classes only False is nil
            return
        self.cached = new
        self.pulses += 1
        if self.waiters or self.nets or self.callbacks:
            self._notify(new)

    input_pulsed = pulse

    def _recomputed(self):
        """Inputs pulsed while the formula was computed, and what it read of them is out of date: compute until none does."""
        while True:
            turn = self.turn
            new = self.formula()
            if self.turn == turn:
                return new


reads_slot(CachedNet, "cached")

peekers: set[kernel.Task[object]] = set()
"""The tasks of the kernel that are reading without side effects."""


def peeking(thunk: Callable[[], A]) -> A:
    """Call ``thunk`` and return its value. Reading consumes nothing meanwhile, also in functions of the user."""
    me = kernel.current()
    if me in peekers:
        return thunk()
    peekers.add(me)
    try:
        return thunk()
    finally:
        peekers.discard(me)


def is_cacheable(fluent: object) -> bool:
    """Whether nets may keep a value computed from ``fluent``: reading it has no side effects, and it pulses when it changes."""
    return isinstance(fluent, (ValueFluent, CachedNet))
