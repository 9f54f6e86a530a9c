"""Several values between a function and the form that binds them, without an object for them.

A function that gives several values makes a `MultipleValues`, which takes 120 ns, and ``multiple-value-bind`` takes it apart again. So a
small function whose body ends in ``values`` is made twice: as every function is, and so that it returns its values as a plain tuple. A
``multiple-value-bind`` of a call calls the second one, if there was one when it was compiled. `ValuesCalls` finds it, and hears when the
function of the symbol changes.
"""

from __future__ import annotations

from types import FunctionType

from cramhy_runtime.lisp_core.data import Symbol, all_values
from cramhy_runtime.lisp_core.packages import sym

VALUES = sym("VALUES")


def beside(function, other):
    """Note that ``other`` returns as a tuple what ``function`` gives."""
    function.beside = function.__code__, other


def other_body(function):
    """The function beside ``function``, or ``None``. One that stands around ``function``, as ``trace`` makes it, has none."""
    if function.__class__ is not FunctionType or "beside" not in function.__dict__:
        return None
    code, other = function.beside
    return other if code is function.__code__ else None


class ValuesCalls:
    """Calls of the function of ``symbol`` whose values are bound: ``call`` returns them as a tuple."""

    __slots__ = ("symbol", "call")

    def __init__(self, symbol):
        self.symbol = symbol
        self.refresh()

    def refresh(self):
        """Find out anew what the function is."""
        other = other_body(self.symbol.function)
        if other is None:
            self.call = self._values
        else:
            self.call, other.__qualname__ = other, self.symbol.function.__qualname__

    def _values(self, *arguments):
        return all_values(self.symbol.function(*arguments))


def values_calls(symbol):
    """The `ValuesCalls` of ``symbol``, one for all calls."""
    return symbol.calls.kept(VALUES, lambda: ValuesCalls(symbol))


def gives_tuple(symbol):
    """Whether the function of ``symbol`` has another one beside it now."""
    return isinstance(symbol, Symbol) and other_body(symbol.function) is not None


def first_of(values, count):
    """The first ``count`` of the tuple ``values``, with nil for missing ones."""
    return (*values, *(None,) * count)[:count]


__all__ = ["ValuesCalls", "beside", "first_of", "gives_tuple", "values_calls"]
