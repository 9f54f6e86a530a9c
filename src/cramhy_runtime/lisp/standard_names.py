"""Symbols of COMMON-LISP that are no function, macro, variable or type by themselves, and those that are not there.

`ABSENT` is the one table of what cramhy leaves out, with the reasons; a program that uses such a name gets its reason when it is
compiled, with the place. `INSIDE` says where a name has its meaning that has none elsewhere. ``docs/common-lisp.md`` is made
from both and from the image (see ``coverage.py``).
"""

from __future__ import annotations

from .conditions import CompileError
from .data import Symbol, UNBOUND, UndefinedFunction
from .packages import COMMON_LISP, sym

COMPILED = 'Files are compiled when they are loaded, and kept compiled: (load "plan.lisp").'

ABSENT = {
    "COMPILE-FILE": COMPILED,
    "COMPILE-FILE-PATHNAME": COMPILED,
    "*COMPILE-FILE-PATHNAME*": COMPILED,
    "*COMPILE-FILE-TRUENAME*": COMPILED,
    "*COMPILE-PRINT*": COMPILED,
    "*COMPILE-VERBOSE*": COMPILED,
    "*LOAD-PRINT*": "LOAD prints nothing about the forms that it loads.",
    "*LOAD-VERBOSE*": "LOAD prints nothing about the forms that it loads.",
}
"""Name → why it is not there and what to do instead."""

INSIDE = {
    "CALL-METHOD": ("macro", "in the form of a DEFINE-METHOD-COMBINATION"),
    "MAKE-METHOD": ("operator", "in the form of a DEFINE-METHOD-COMBINATION"),
    "CALL-NEXT-METHOD": ("function", "in the body of a method"),
    "NEXT-METHOD-P": ("function", "in the body of a method"),
    "PPRINT-POP": ("macro", "in the body of PPRINT-LOGICAL-BLOCK"),
    "PPRINT-EXIT-IF-LIST-EXHAUSTED": ("macro", "in the body of PPRINT-LOGICAL-BLOCK"),
    "LOOP-FINISH": ("macro", "in the body of LOOP"),
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


def absent_symbols():
    """The symbols of the table `ABSENT`."""
    return {sym(name) for name in ABSENT}
