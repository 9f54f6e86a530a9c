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

from cramhy_runtime.lisp_core.data import FLOATS, TRUE_CLASSES, one, plain_truth, truth
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.generated_functions import generated_function
from .fluents import Fluent

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Formula = Callable[[], Any]

FLUENT, NUMBER, OTHER = "fno"
TRUE = "{0} is not None and {0} is not False and ({0}.__class__ in TRUE_CLASSES or truth({0}))"
"""The question `truth` in place, for a variable."""
NUMBERS = (int, *FLOATS)
"""The kinds whose arithmetic and order are Python's, also between one and the other."""
MOST = 1000  # makers that are kept; a program needs a few dozen
_makers: dict[tuple[Any, ...], Callable[..., Formula]] = {}
"""(what writes the lines, the operation, the kinds of the arguments) → the function that makes such formulas."""
_by_classes: dict[tuple[Any, ...], Callable[..., Formula]] = {}
"""The same with the classes of the arguments, which take no call to find out."""


def of_call(function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """Call ``function`` with the values of ``arguments``."""
    return _formula(_call, "", arguments, function)


def _call(_: str, values: list[str], kinds: str) -> list[str]:
    return [f"return function({', '.join(values)})"]


def of_users_call(function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """As `of_call`, but only the first of several values."""
    return _formula(_users_call, "", arguments, function)


def _users_call(_: str, values: list[str], kinds: str) -> list[str]:
    return [
        f"result = function({', '.join(values)})",
        "if result.__class__ in TRUE_CLASSES: return result",
        "return plain_truth(one(result))",
    ]


def of_numbers(symbol: str, function: Callable[..., Any], arguments: Sequence[Any]) -> Formula:
    """Python's operation ``symbol``, one of ``+ - * < > ==``, if the two ``arguments`` are ordinary numbers; else call ``function``."""
    return _formula(_numbers, symbol, arguments, function)


def _numbers(symbol: str, values: list[str], kinds: str) -> list[str]:
    named = [f"v{index}" if kind is FLUENT else value for index, (value, kind) in enumerate(zip(values, kinds, strict=True))]
    asked = [f"(type({name}) is int or type({name}) is float)" for name, kind in zip(named, kinds, strict=True) if kind is FLUENT]
    lines = [f"{name} = {value}" for name, value in zip(named, values, strict=True) if name != value]
    if OTHER not in kinds:
        operation = f" {symbol} ".join(named)
        lines += [f"if {' and '.join(asked)}:", f"    return {operation}" if symbol in "+-*" else f"    return {operation} or None"]
    return [*lines, f"return function({', '.join(named)})"]


def of_python(symbol: str, arguments: Sequence[Any]) -> Formula:
    """Python's operation ``symbol`` on the values of two ``arguments``."""
    return _formula(_python, symbol, arguments)


def _python(symbol: str, values: list[str], kinds: str) -> list[str]:
    operation = f" {symbol} ".join(values)
    if symbol in "+-*/":
        return [f"return {operation}"]
    return [f"result = {operation}", "return result if result.__class__ is bool else plain_truth(result)"]


def of_not(argument: Fluent[object]) -> Formula:
    """True while the value of ``argument`` is not."""
    return _formula(_not, "", (argument,))


def _not(_: str, values: list[str], kinds: str) -> list[str]:
    return [f"value = {values[0]}", f"return None if {TRUE.format('value')} else True"]


def of_and(arguments: Sequence[Any]) -> Formula:
    """The last value if all are true, else nil. The fluents after a value that is not true are not read."""
    return _formula(_and, "", arguments)


def _and(_: str, values: list[str], kinds: str) -> list[str]:
    each = [[f"result = {value}", f"if not ({TRUE.format('result')}):", "    return None"] for value in values]
    return ["result = True", *(line for lines in each for line in lines), "return result"]


def of_or(arguments: Sequence[Any]) -> Formula:
    """The first true value, or nil. The fluents after it are not read."""
    return _formula(_or, "", arguments)


def _or(_: str, values: list[str], kinds: str) -> list[str]:
    each = [[f"result = {value}", f"if {TRUE.format('result')}:", "    return result"] for value in values]
    return [*(line for lines in each for line in lines), "return None"]


def _formula(
    lines: Callable[[str, list[str], str], list[str]], symbol: str, arguments: Sequence[Any], function: Callable[..., Any] | None = None
) -> Formula:
    """The formula of these ``arguments``. ``lines`` writes it, of ``symbol``, the texts that read the arguments, and their kinds."""
    maker = _by_classes.get((lines, symbol, *map(type, arguments)))
    if maker is None:
        if len(_by_classes) >= MOST:
            _by_classes.clear()
            _makers.clear()
        kinds = "".join([FLUENT if isinstance(each, Fluent) else NUMBER if type(each) in NUMBERS else OTHER for each in arguments])
        maker = _makers.get((lines, symbol, kinds))
        if maker is None:
            names = [f"a{index}" for index in range(len(kinds))]
            values = [f"{name}._fluent_value" if kind is FLUENT else name for name, kind in zip(names, kinds, strict=True)]
            maker = _makers[lines, symbol, kinds] = generated_function(
                "formula of a net",
                "formula_of",
                ["function", *names],
                ["def formula():", *("    " + line for line in lines(symbol, values, kinds)), "return formula"],
                {"one": one, "TRUE_CLASSES": TRUE_CLASSES, "truth": truth, "plain_truth": plain_truth},
            )
        _by_classes[lines, symbol, *map(type, arguments)] = maker
    return maker(function, *arguments)
