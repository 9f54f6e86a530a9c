"""Lisp's data and conditions in ``pickle``, for another process of the same version.

A symbol is found by its name again, and its package made if it is not there. A list travels as its elements, so its length does not
matter; a circular list stays one. A condition keeps its class, slots, text and notes; a slot that cannot travel (a live task, a stream, a
closure) becomes the text that describes it. A condition of a class that the other process has not defined is one of the nearest class that
Python can import, with the same text.
"""

from __future__ import annotations

import sys

from cramhy_runtime.kernel.typing_names import Any

from .classes import class_name, find_class
from .data import Cons, Symbol, list_end, list_from, list_parts
from .packages import ensure_package, find_package


def reduced_symbol(symbol: Symbol) -> tuple[Any, ...]:
    """What ``pickle`` keeps of ``symbol``: its name and package, or for the name of a Python function that function."""
    if symbol.package is not None:
        return interned, (symbol.name, symbol.package.name)
    function = getattr(symbol.function, "called_from_lisp", None)
    if function is not None:
        return type(symbol.function).symbol_of, (function,)
    return symbol.__class__, (symbol.name,)


def interned(name: str, package: str) -> Symbol:
    """The symbol of that name, in the package of that name, which is made if it does not exist."""
    found: Symbol = (find_package(package) or ensure_package(package)).intern(name)
    return found


def reduced_list(cell: Cons) -> tuple[Any, ...]:
    """What ``pickle`` and ``copy`` keep of the list that begins with ``cell``: its elements and what ends it."""
    if isinstance(list_end(cell), Cons):
        return new_cons, (), ([cell.car], cell.cdr)
    return new_cons, (), list_parts(cell)


def new_cons() -> Cons:
    """A cons to be filled by `fill`. Elements of the list may refer to it before that."""
    return Cons(None, None)


def fill(cell: Cons, state: tuple[list[object], object]) -> None:
    """Make the list that begins with ``cell`` the one of the items of ``state`` that ends as ``state`` says."""
    items, end = state
    cell.car, cell.cdr = items[0], list_from(items[1:], end)


# Set here, as the classes stand below packages and the names of classes, which these functions need.
for _class, _method, _function in (
    (Symbol, "__reduce__", reduced_symbol),
    (Cons, "__reduce__", reduced_list),
    (Cons, "__setstate__", fill),
):
    setattr(_class, _method, _function)


# ----------------------------------------------------------------------------------------------------------------- conditions


def class_reference(cls: type) -> tuple[type, Any]:
    """(The nearest class that Python can import, the symbol that names ``cls`` if that is another one)."""
    for known in cls.__mro__:
        found: Any = sys.modules.get(known.__module__)
        for part in known.__qualname__.split("."):
            found = getattr(found, part, None)
        if found is known:
            return known, None if known is cls else class_name(cls)
    return object, class_name(cls)


def referenced(known: type, name: Any) -> type:
    """The class for a `class_reference`."""
    found = find_class(name) if name is not None else None
    return found if isinstance(found, type) and issubclass(found, known) else known


def reduced_condition(condition: Any) -> tuple[Any, ...]:
    """What ``pickle`` keeps of ``condition``; see the head of this module."""
    text, state, described = str(condition), {}, False
    for name, value in condition.__dict__.items():
        if name in _LEFT_BEHIND:
            continue
        if name == "hint":
            state[name] = value() if callable(value) else value
            continue
        if name == "format_arguments" and isinstance(value, tuple):
            parts = tuple(map(described_unless_it_travels, value))
        else:
            parts = described_unless_it_travels(value)
        described = described or parts is not value and parts != value
        state[name] = parts
    if hasattr(condition, "told"):  # the hint is computed, of what stays here
        state["told"] = Report(condition.hint)
    known, name = class_reference(type(condition))
    return restored_condition, (known, name, tuple(map(described_unless_it_travels, condition.args)), text, described), state


_LEFT_BEHIND = ("restarts", "position", "about", "told")


def described_unless_it_travels(value: object) -> object:
    """``value`` if it can be pickled, else the text that shows it."""
    if value is None or isinstance(value, (str, int, float)):
        return value
    import pickle  # it takes as long to import as a room

    try:
        pickle.dumps(value)
    except Exception:
        return str(value) if isinstance(value, BaseException) else repr(value)
    return value


def restored_condition(known: type, name: Any, arguments: tuple[object, ...], text: str, described: bool) -> BaseException:
    """The condition for the data of `reduced_condition`, without its slots."""
    cls = referenced(known, name)
    made: BaseException = cls.__new__(cls, *arguments)
    made.args = arguments
    if described or class_name(cls) is not name is not None:
        made.report = Report(text)  # type: ignore[attr-defined]
    return made


class Report:
    """The text of a condition that came from another process, or its hint, in place of the function that made it."""

    def __init__(self, text: Any):
        self.text = text

    def __call__(self) -> Any:
        return self.text
