"""Classes and their names, by the class world that is installed (``ports.py``), and who hears of it when classes change."""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import Any

from .packages import keyword
from .plain_answers import named, register_class
from .ports import PORTS

__all__ = [
    "BigInteger",
    "class_name",
    "find_class",
    "find_class_or_error",
    "is_of_type",
    "make_instance",
    "named",
    "register_class",
    "touch_classes",
    "when_classes_change",
]


class BigInteger(int):
    """Stands for the class of an integer that is not a fixnum where methods are chosen. No object is an instance of it."""


def class_name(cls: type) -> Any:
    """The symbol that names ``cls``."""
    return PORTS.classes.name(cls)


def find_class(symbol: Any) -> Any:
    """The class that ``symbol`` names, or ``None``."""
    return PORTS.classes.find(symbol, False)


def find_class_or_error(designator: Any) -> Any:
    """The class that a symbol names, or the class itself; a symbol that names none is an error."""
    if isinstance(designator, type):
        return designator
    return PORTS.classes.find(designator, True)


def make_instance(cls: Any, *initargs: Any, **slots: Any) -> Any:
    """A new instance of a class or of the class that a symbol names; initargs are keywords and values in turn, or Python keywords."""
    given = [part for name, value in slots.items() for part in (keyword(name.rstrip("_").replace("_", "-").upper()), value)]
    return PORTS.classes.make(find_class_or_error(cls), *initargs, *given)


def is_of_type(thing: Any, specifier: Any) -> bool:
    """Whether ``thing`` is of the type ``specifier``; false for what is no type."""
    test = PORTS.types.test(specifier)
    return test is not None and bool(test(thing))


_watchers: list = []


def when_classes_change(function):
    """Call ``function()`` whenever a class is defined again, so that caches can be emptied."""
    _watchers.append(function)
    return function


def touch_classes():
    """Tell everybody that what was computed about classes is to be forgotten."""
    for function in _watchers:
        function()
