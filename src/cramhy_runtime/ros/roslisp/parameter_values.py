"""Convert Lisp values to parameters and back, as XML-RPC does, but without the text.

Symbols become their names, lists and vectors become arrays, structs become dictionaries. On the way back, floats become
those of Lisp's literals, arrays lists, and false NIL. An integer has 32 bits. Source: roslisp.md 8, xmlrpc.com/spec.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError, shown
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, list_from
from cramhy_runtime.lisp_core.floats import literal_float
from cramhy_runtime.lisp_core.packages import symbol_name
from .structs import Struct
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from ..signatures import Parameter


LEAST, MOST = -(2**31), 2**31 - 1


def encode(value: object) -> Parameter:
    """Convert a Lisp value to a parameter for the master. A value without a parameter type is an error."""
    if value is None or value is False:
        return False
    if value is True or isinstance(value, str):
        return value
    if isinstance(value, int):
        return (
            value
            if LEAST <= value <= MOST
            else _refuse(
                f"The integer {value} does not fit into a parameter: those have 32 bits, from {LEAST} to {MOST}. "
                "A float or a string holds it."
            )
        )
    if isinstance(value, LispString):
        return str(value)
    if isinstance(value, (float, Fraction)):
        return float(value)
    if isinstance(value, Symbol):
        return symbol_name(value)
    if isinstance(value, (list, tuple)) or isinstance(value, Cons) and _last(value).cdr is None:
        return [encode(element) for element in value]
    if isinstance(value, Struct):
        value = value.members
    if isinstance(value, dict):
        return {str(key): encode(element) for key, element in value.items()}
    return _refuse(f"A parameter can be a string, number, boolean, list or vector of these, but not {shown(value)}.")


def _last(cell: Cons) -> Cons:
    while isinstance(cell.cdr, Cons):
        cell = cell.cdr
    return cell


def _refuse(text: str) -> NoReturn:
    conditions.error(SimpleError("~a", text))


def decode(value: Parameter) -> Any:
    """Convert a parameter of the master to a Lisp value."""
    if value is False:
        return None
    if isinstance(value, (list, tuple)):
        return list_from([decode(element) for element in value])
    if isinstance(value, dict):
        return Struct({name: decode(element) for name, element in value.items()})
    return literal_float(value) if value.__class__ is float else value
