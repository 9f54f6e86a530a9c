"""Symbols of COMMON-LISP that are no function, macro, variable or type by themselves, and those that are not there.

`ABSENT` is the one table of what cramhy leaves out, with the reasons; a program that uses such a name gets its reason when it is
compiled, with the place. `INSIDE` says where a name has its meaning that has none elsewhere. ``docs/common-lisp.md`` is made
from both and from the image (see ``coverage.py``).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError
from cramhy_runtime.lisp_core.data import Symbol, UNBOUND, UndefinedFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP

ABSENT: dict[str, str] = {}
"""Name → why it is not there and what to do instead. At present all 978 are there."""

INSIDE = {
    "CALL-METHOD": ("macro", "in the form of a DEFINE-METHOD-COMBINATION"),
    "MAKE-METHOD": ("operator", "in the form of a DEFINE-METHOD-COMBINATION"),
    "CALL-NEXT-METHOD": ("function", "in the body of a method"),
    "NEXT-METHOD-P": ("function", "in the body of a method"),
    "DECLARE": ("symbol", "at the head of a body, before its forms"),
    "OTHERWISE": ("symbol", "as the key of the last clause of CASE and its relatives"),
}
"""Name → (what it is, where it has a meaning)."""


def is_there(symbol):
    """Whether ``symbol`` has a global definition as a function, macro or variable."""
    return symbol.macro is not None or symbol.value is not UNBOUND or not isinstance(symbol.function, UndefinedFunction)


def missing(symbol, position=None):
    """The compile error for a use of ``symbol`` of Common Lisp that is not there, or not where it is used; else ``None``."""
    if not isinstance(symbol, Symbol) or symbol.package is not COMMON_LISP or is_there(symbol):
        return None
    if symbol.name in ABSENT:
        return CompileError(f"~S of Common Lisp is not part of cramhy. {ABSENT[symbol.name].replace('~', '~~')}", symbol, position=position)
    if symbol.name in INSIDE:
        return CompileError(f"~S has a meaning only {INSIDE[symbol.name][1]}.", symbol, position=position)
    return None
