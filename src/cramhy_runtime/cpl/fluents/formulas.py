"""Formulas: the functions that compute nets, written for the shape of each net.

A net is computed whenever an input pulses, so at each step of the world, and most of that time would go into calls: of a function that
reads an input, of one that looks at the kinds of the values, of the operation itself. What a formula has to do is known when the net is
made: which arguments are fluents, and how each is read. So the formula of ``(< distance 0.5)`` is

    def formula():
        v0 = a0._fluent_value
        if type(v0) is int or type(v0) is float:
            return v0 < a1 or None
        return function(v0, a1)

and all nets of this shape share its code (``utilities/generated_functions.py``). Each function here returns a formula.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import MultipleValues, one
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.generated_functions import generated_function
from .fluents import Fluent

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Formula = Callable[[], Any]

_makers: dict[tuple[str, str], Callable[..., Formula]] = {}
"""(what is computed, the kinds of the arguments) → the function that makes such formulas."""
MOST = 1000  # makers that are kept; a program needs a few dozen
NUMBERS = (int, float)
"""The kinds whose arithmetic and order are Python's, also between one and the other."""
FLUENT, NUMBER, OTHER = "fno"


def of_call(function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """Call ``function`` with the values of ``arguments``."""
    return _formula("call", arguments, lambda values, _: [f"return function({', '.join(values)})"], function)


def of_users_call(function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """As `of_call`, but only the first of several values."""

    def body(values: list[str], _: str) -> list[str]:
        return [f"result = function({', '.join(values)})", "return one(result) if type(result) is MultipleValues else result"]

    return _formula("first value", arguments, body, function)


def of_numbers(symbol: str, function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """Python's operation ``symbol``, one of ``+ - * < > ==``, if the two ``arguments`` are ordinary numbers; else call ``function``."""

    def body(values: list[str], kinds: str) -> list[str]:
        named = [f"v{index}" if kind is FLUENT else value for index, (value, kind) in enumerate(zip(values, kinds, strict=True))]
        asked = [f"(type({name}) is int or type({name}) is float)" for name, kind in zip(named, kinds, strict=True) if kind is FLUENT]
        lines = [f"{name} = {value}" for name, value in zip(named, values, strict=True) if name != value]
        if OTHER not in kinds:
            lines += [f"if {' and '.join(asked)}:", f"    return {f' {symbol} '.join(named)}{'' if symbol in '+-*' else ' or None'}"]
        return [*lines, f"return function({', '.join(named)})"]

    return _formula(symbol, arguments, body, function)


def of_python(symbol: str, arguments: Sequence[Any]) -> Formula:
    """Python's operation ``symbol`` on the values of two ``arguments``."""
    return _formula(f"python {symbol}", arguments, lambda values, _: [f"return {f' {symbol} '.join(values)}"])


def of_not(argument: Fluent[object]) -> Formula:
    """True while the value of ``argument`` is not."""

    def body(values: list[str], _: str) -> list[str]:
        return [f"value = {values[0]}", "return True if value is None or value is False else None"]

    return _formula("not", [argument], body)


def of_and(arguments: Sequence[Any]) -> Formula:
    """The last value if all are true, else nil. The fluents after a value that is not true are not read."""

    def body(values: list[str], _: str) -> list[str]:
        each = [[f"result = {value}", "if result is None or result is False:", "    return None"] for value in values]
        return ["result = True", *(line for lines in each for line in lines), "return result"]

    return _formula("and", arguments, body)


def of_or(arguments: Sequence[Any]) -> Formula:
    """The first true value, or nil. The fluents after it are not read."""

    def body(values: list[str], _: str) -> list[str]:
        each = [[f"result = {value}", "if result is not None and result is not False:", "    return result"] for value in values]
        return [*(line for lines in each for line in lines), "return None"]

    return _formula("or", arguments, body)


def _formula(
    what: str, arguments: Sequence[Any], body: Callable[[list[str], str], list[str]], function: Callable[..., Any] | None = None
) -> Formula:
    """The formula of these ``arguments``. ``body`` gives its lines, for the texts that read the arguments and for their kinds."""
    kinds = "".join([_kind(argument) for argument in arguments])
    maker = _makers.get((what, kinds))
    if maker is None:
        if len(_makers) >= MOST:
            _makers.clear()
        names = [f"a{index}" for index in range(len(kinds))]
        values = [f"{name}._fluent_value" if kind is FLUENT else name for name, kind in zip(names, kinds, strict=True)]
        maker = _makers[what, kinds] = generated_function(
            "formula of a net",
            "formula_of",
            ["function", *names],
            ["def formula():", *("    " + line for line in body(values, kinds)), "return formula"],
            {"one": one, "MultipleValues": MultipleValues},
        )
    return maker(function, *arguments)


def _kind(argument: object) -> str:
    return FLUENT if isinstance(argument, Fluent) else NUMBER if argument.__class__ in NUMBERS else OTHER
