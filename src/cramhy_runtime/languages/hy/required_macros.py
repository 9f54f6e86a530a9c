"""The table of macros that Hy's ``require`` looks into.

It is filled when somebody does: Common Lisp, which imports the same package for its own macros, starts without those of plain Hy.
"""

from __future__ import annotations

from collections.abc import Callable, KeysView, Mapping
from typing import Any


class RequiredMacros(dict[str, Any]):
    """Mangled name → macro. first: those that are there in any case. required: what is called when a file asks for all, or for one."""

    def __init__(self, first: Mapping[str, Any], required: Callable[[], None]) -> None:
        super().__init__(first)
        self.required = required
        self.all_are_required = False
        self._first: dict[str, Any] | None = dict(first)

    def _fill(self) -> None:
        if self._first is not None:
            from .plan_macros import macros

            first, self._first = self._first, None
            super().update({**macros(), **first})

    def __bool__(self) -> bool:
        return True

    def __contains__(self, name: object) -> bool:
        if not super().__contains__(name):
            self._fill()
        return super().__contains__(name)

    def __getitem__(self, name: str) -> Any:
        if not super().__contains__(name):
            self._fill()
        if not (self.all_are_required or name.startswith("_")):  # those are not required, but stand in what ours expand into
            self.required()
        return super().__getitem__(name)

    def keys(self) -> KeysView[str]:
        """The names, of which Hy takes each."""
        return _Names(self)


class _Names(KeysView[str]):
    """The names of all macros, once somebody asks for one."""

    def __init__(self, table: RequiredMacros) -> None:
        super().__init__(table)
        self._table = table

    def __iter__(self):
        self._table._fill()
        self._table.required()
        self._table.all_are_required = True
        try:
            yield from list(dict.keys(self._table))
        finally:
            self._table.all_are_required = False
