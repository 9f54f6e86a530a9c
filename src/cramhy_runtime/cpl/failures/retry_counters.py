"""Counters that say how often a plan may try again: ``with-retry-counters`` (cpl.md 4.6).

A counter is an object in a lexical variable that the user cannot name; ``do-retry``, ``get-counter`` and ``reset-counter`` find the
variable by the counter's name while they are expanded. So counters nest as variables do: an inner form sees the counters around
it, unless it hides one by a counter of the same name. Repaired: in the original an inner form hides all of them.
"""

from __future__ import annotations

import numbers

from cramhy_runtime.lisp_core.conditions import CompileError, error, type_error
from cramhy_runtime.lisp_core.data import Symbol, list_from, one
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

_variables: dict[object, Symbol] = {}  # name of a counter -> the variable that holds such counters


class RetryCounter:
    """One counter of ``with-retry-counters``; ``initial`` is a number, or the function of its initial-value form."""

    __slots__ = ("initial", "left")

    def __init__(self, initial: float | Callable[[], float]):
        self.initial: Callable[[], float] = initial if callable(initial) else lambda: initial
        self.reset()

    def use(self) -> bool | None:
        """``do-retry``: while the counter is above zero, take one from it and return true; then return nil."""
        if self.left > 0:
            self.left -= 1
            return True
        return None

    def reset(self) -> float:
        """``reset-counter``: evaluate the initial-value form again, store its value and return it. Only real numbers are allowed."""
        left = one(self.initial())
        if isinstance(left, bool) or not isinstance(left, numbers.Real):
            return type_error(left, "REAL", "\nwhen setting a retry counter")
        self.left: float = left  # type: ignore[assignment]  # a ratio may be among them
        return self.left


def counter_variable(name):
    """The variable that holds counters called ``name``."""
    return _variables.setdefault(name, Symbol(f"RETRY-COUNTER-{symbol_name(name)}"))


def known_counter(name, environment):
    """The variable of the counter ``name``, at expansion time. If there is none, signal an error that lists the counters around."""
    if is_symbol(name) and environment.variable(counter_variable(name)) is not None:
        return counter_variable(name)
    around = list_from([name for name, variable in _variables.items() if environment.variable(variable) is not None])
    return error(
        CompileError(
            "There is no retry counter ~S here; WITH-RETRY-COUNTERS defines ~S.", name, around, position=PORTS.definitions.expansion_place()
        )
    )
