"""Rows with lists, found by everything that a goal says about its lists.

The tables of a relation find a list by its first symbol alone. That is quick, and enough for ``(property ?d (type ?t))``. Where many rows
have the same first symbol, as the poses of a thousand objects, they are looked up again, in a table for the *shape* of the goal's
terms: where they have conses, where they have atoms, and where nothing is known. ``(pose 77 ?y)`` is two conses with known cars, and so
on. The atoms of the goal, in order, are the key. Rows with other atoms there cannot match.

A shape ends after some conses. The rest counts as unknown, so terms of any length, and terms without end, have a shape.
"""

from __future__ import annotations

from functools import lru_cache

from cramhy_runtime.lisp_core.data import FLOATS, Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.equality import equal_key
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.generated_functions import generated_function

from cramhy_runtime.utilities.patterns import NOTHING

from ..terms.terms import Var, value_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    Row = Any  # a tuple of values, or the only value

FEW = 8
"""So many rows are tried one by one."""
_CONSES = 40
"""So many conses of a goal belong to its shape."""
_SHAPES = 50
"""The number of shapes that the rows of one key are sorted by."""
_CONS, _ATOM, _UNKNOWN = "c", "a", "?"
_BY_VALUE = frozenset([int, str, *FLOATS])


def index_key(atom: Any) -> Any:
    """The key of ``atom`` in an index, equal for atoms that are `same_atom`. ``NotImplemented`` for objects that are compared otherwise."""
    kind = atom.__class__
    if kind is Symbol or kind is Keyword or atom is None:
        return atom
    if atom is False or atom is NOTHING:
        return None
    return equal_key(atom) if kind in _BY_VALUE or atom is True else NotImplemented  # `t` is Python's True, which is 1 in a dict


class ListedRows(list[Any]):
    """The rows for one key of a table, in order: tuples, or the values themselves if the table keeps one column."""

    __slots__ = ("tables",)

    def __init__(self, rows: Iterable[Row]):
        super().__init__(rows)
        self.tables: dict[str, dict[Any, list[Row]] | None] = {}

    def narrowed(self, *terms: object) -> Sequence[Row]:
        """The rows that may match ``terms``, one for each column that is kept, in order. Others may be among them."""
        shape, key = _described(terms)
        table = self.tables.get(shape, self)
        if table is self:
            if len(self.tables) >= _SHAPES:
                return self
            table = self.tables[shape] = sorter(shape, len(terms))(self)
        return self if table is None else table.get(key, ())


def _described(terms: tuple[object, ...]) -> tuple[str, tuple[Any, ...]]:
    """The shape of ``terms``, and their atoms."""
    shape: list[str] = []
    key: list[object] = []
    waiting: list[Any] = [*reversed(terms)]
    room = _CONSES
    while waiting:
        term = waiting.pop()
        kind = term.__class__
        if kind is not Symbol and kind is not Cons:
            term = value_of(term)
            kind = term.__class__
        if kind is Cons:
            if room:
                room -= 1
                shape.append(_CONS)
                waiting.append(term.cdr)
                waiting.append(term.car)
            else:
                shape.append(_UNKNOWN)
            continue
        atom = term if kind is Symbol else NotImplemented if kind is Var else index_key(term)
        if atom is NotImplemented:
            shape.append(_UNKNOWN)
        else:
            shape.append(_ATOM)
            key.append(atom)
    return "".join(shape), tuple(key)


@lru_cache(200)
def sorter(shape: str, count: int) -> Callable[[Iterable[Row]], dict[Any, list[Row]] | None]:
    """A function that sorts rows of ``count`` columns for terms of a shape.

    It returns a dict from keys to the rows that may match, or ``None`` if a row has an atom there that has no key.
    """
    lines, keys = ["table = {}", "for row in rows:"], []
    waiting = [f"row[{i}]" for i in reversed(range(count))] if count > 1 else ["row"]
    for number, wanted in enumerate(shape):
        item, x = waiting.pop(), f"x{number}"
        if wanted == _CONS:
            lines += [f"    {x} = {item}", f"    if {x}.__class__ is not Cons: continue"]
            waiting += [f"{x}.cdr", f"{x}.car"]
        elif wanted == _ATOM:
            keys.append(x)
            lines += [
                f"    {x} = {item}",
                f"    if {x}.__class__ is not Symbol:",
                f"        if {x}.__class__ is Cons: continue",
                f"        {x} = index_key({x})",
                f"        if {x} is NotImplemented: return None",
            ]
    key = "".join(f"{x}, " for x in keys)
    lines += [f"    found = table.get(({key}))", f"    if found is None: table[{key or '()'}] = [row]", "    else: found.append(row)"]
    return generated_function("rows by the shape of terms", "sort", ["rows"], [*lines, "return table"], dict(_NAMES))


_NAMES = {"Cons": Cons, "Symbol": Symbol, "index_key": index_key}
