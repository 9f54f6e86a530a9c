"""What Python and Lisp get of a received message, where the graph's form of it (``wire.py``) is that of the other.

A number of a laser that is not finite is roslisp's keyword on the graph, and so in Lisp; Python and Hy get a float. A ``uint8[]`` is
`Octets` on the graph, and so in Python and Hy; Lisp gets a vector of integers. Most types have neither: their receivers are called as they
are.

The graph's object may have other receivers in the same node. So a message in which something changes is a copy.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar
from cramhy_runtime.utilities.generated_functions import generated_function

from .arrays import OCTETS, as_float
from .messages import RosMessage, part_class
from .wire import fresh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

M = TypeVar("M", bound="RosMessage")
T = TypeVar("T")

_FLOATS = ("float32", "float64")
_finite: dict[type, Callable[[Any], bool] | None] = {}
_with_octets: dict[type, bool] = {}


def for_python(message: M) -> M:
    """``message`` as Python and Hy see it: ``inf`` and ``nan`` are floats."""
    cls = message.__class__
    finite = _finite[cls] if cls in _finite else _finiteness(cls)
    if finite is None:
        return message
    try:
        if finite(message):
            return message
    except TypeError:
        pass  # a keyword
    return _changed(fresh(message), _FLOATS, _as_floats)


def for_lisp(message: M) -> M:
    """``message`` as Lisp sees it: a ``uint8[]`` is a vector of integers."""
    return _changed(fresh(message), OCTETS, list) if has_octets(message.__class__) else message


def python_receiver(cls: type[M], callback: Callable[[M], T]) -> Callable[[M], T]:
    """The function of a message of ``cls`` from the graph that calls ``callback`` with it in Python's form."""
    if (_finite[cls] if cls in _finite else _finiteness(cls)) is None:
        return callback
    return lambda message: callback(for_python(message))


def lisp_receiver(cls: type[M], callback: Callable[[M], T]) -> Callable[[M], T]:
    """The function of a message of ``cls`` from the graph that calls ``callback`` with it in Lisp's form."""
    return (lambda message: callback(for_lisp(message))) if has_octets(cls) else callback


def has_octets(cls: type[RosMessage]) -> bool:
    """Whether messages of ``cls`` have a ``uint8[]``, perhaps in a message inside."""
    found = _with_octets.get(cls)
    if found is None:
        found = _with_octets[cls] = any(
            field.is_array and field.base in OCTETS or not field.primitive and has_octets(part_class(field.base)) for field in cls.fields
        )
    return found


def _finiteness(cls: type[RosMessage]) -> Callable[[Any], bool] | None:
    """Generate, compile and keep the function that tells whether all floats of a message of ``cls`` are finite; ``None`` if it has none.

    A keyword among them may be a TypeError.
    """
    scope: dict[str, Any] = {"isfinite": math.isfinite}
    tests = list(_tests(cls, "message", scope))
    lines = [f"return {' and '.join(tests)}"]
    made = generated_function(f"finiteness of {cls.ros_type}", "finite", ["message"], lines, scope) if tests else None
    _finite[cls] = made
    return made


def _tests(cls: type[RosMessage], message: str, scope: dict[str, Any]) -> Iterator[str]:
    """The expressions that are true if the floats of the ``message``, an expression itself, are finite."""
    for field in cls.fields:
        value = f"{message}.{field.attribute}"
        if field.base in _FLOATS:
            yield f"all(map(isfinite, {value}))" if field.is_array else f"isfinite({value})"
        elif not field.primitive and not field.is_array:
            yield from _tests(part_class(field.base), value, scope)
        elif not field.primitive:
            part = _finiteness(part_class(field.base))
            if part is not None:
                name = f"part{len(scope)}"
                scope[name] = part
                yield f"all(map({name}, {value}))"


def _changed(message: M, bases: tuple[str, ...], convert: Callable[[Any], Any]) -> M:
    """``message``, after ``convert`` was called with the values of its fields of these types. It belongs to the caller."""
    for field in message.fields:
        value = getattr(message, field.attribute)
        if field.base in bases:
            if field.is_array or bases is _FLOATS:
                setattr(message, field.attribute, convert(value))
        elif not field.primitive:
            for part in value if field.is_array else (value,):
                _changed(part, bases, convert)
    return message


def _as_floats(value: Any) -> Any:
    if value.__class__ is list:
        return [as_float(each) if isinstance(each, Symbol) else each for each in value]
    return as_float(value) if isinstance(value, Symbol) else value
