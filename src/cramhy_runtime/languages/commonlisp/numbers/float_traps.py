"""Floating-point traps that are masked: what an operation gives instead of an error, as IEEE 754 says it.

``sb-int:with-float-traps-masked`` and ``sb-int:set-floating-point-modes`` say which. A NaN here is quiet with and without the trap for it.
Operations ask only when they would signal, so masks cost the others nothing.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.floats import result_class
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")
TRAPS = special("CRAMHY::*FLOAT-TRAPS*", lisp_list(*map(keyword, ("OVERFLOW", "INVALID", "DIVIDE-BY-ZERO"))))
"""The traps that are not masked: their keywords."""
OVERFLOW, INVALID, DIVIDE_BY_ZERO = keyword("OVERFLOW"), keyword("INVALID"), keyword("DIVIDE-BY-ZERO")
_OPERATIONS = {"+": float.__add__, "-": float.__sub__, "*": float.__mul__, "/": float.__truediv__}


def is_masked(trap: Symbol) -> bool:
    """Whether operations that meet ``trap`` give IEEE's result."""
    return trap not in python_list(TRAPS.value)


def masked(traps: Any, body: Callable[[], T]) -> T:
    """``sb-int:with-float-traps-masked``: the value of ``body``, in which the ``traps`` are masked."""
    without = set(python_list(traps))
    with binding(TRAPS, list_from([trap for trap in python_list(TRAPS.value) if trap not in without])):
        return body()


def infinity(operation: str, operands: tuple[Any, ...]) -> float:
    """What ``operation``, named as in Lisp, gives for ``operands`` where the result is too large for a float."""
    if operation == "EXPT":
        base, power = operands
        result = -math.inf if base < 0 and isinstance(power, int) and power % 2 else math.inf
    elif operation in _OPERATIONS:
        exact = _OPERATIONS[operation](*map(_clamped, operands))
        result = exact if exact != exact else math.copysign(math.inf, exact)
    else:
        result = math.copysign(math.inf, operands[0]) if operands else math.inf
    return result_class(*operands)(result)


def quotient_by_zero(number: Any, divisor: Any) -> float:
    """``number`` divided by the zero ``divisor``, of which one is a float."""
    number, sign = _clamped(number), math.copysign(1.0, divisor)
    result = math.nan if number == 0 or number != number else math.copysign(math.inf, number * sign)
    return result_class(number, divisor)(result) if isinstance(divisor, float) else result_class(number)(result)


def _clamped(number: Any) -> float:
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def modes() -> Any:
    """``sb-int:get-floating-point-modes``: a list of keywords and values, of which ``:traps`` can be set."""
    return lisp_list(
        keyword("TRAPS"), TRAPS.value, keyword("ROUNDING-MODE"), keyword("NEAREST"), keyword("CURRENT-EXCEPTIONS"), None,
        keyword("ACCRUED-EXCEPTIONS"), None, keyword("FAST-MODE"), None, keyword("PRECISION"), keyword("53-BIT"),
    )  # fmt: skip


def set_modes(*, traps: Any = UNBOUND, **others: Any) -> None:
    """``sb-int:set-floating-point-modes``: from now on the traps in the list are not masked. The other modes stay as they are."""
    if traps is not UNBOUND:
        TRAPS.value = traps


__all__ = ["DIVIDE_BY_ZERO", "INVALID", "OVERFLOW", "infinity", "is_masked", "masked", "modes", "quotient_by_zero", "set_modes"]
