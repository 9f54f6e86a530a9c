"""Which names of declarations mean something, besides those of the standard and of types (ANSI 3.3.3)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Symbol

EXTENSIONS = """MAYBE-INLINE TRULY-DYNAMIC-EXTENT DISABLE-PACKAGE-LOCKS ENABLE-PACKAGE-LOCKS GLOBAL ALWAYS-BOUND FREEZE-TYPE DEPRECATED
START-BLOCK END-BLOCK""".split()
"""Declarations of SB-EXT that are known and need nothing done here."""


def is_extension(symbol, *names):
    """Whether ``symbol`` is one of those of SB-EXT called ``names``."""
    return isinstance(symbol, Symbol) and symbol.name in names and symbol.package is not None and symbol.package.name == "SB-EXT"


def is_declared(symbol):
    """Whether ``(declaim (declaration symbol))`` made it a known declaration."""
    return isinstance(symbol, Symbol) and symbol.compiler_data is not None and "declaration" in symbol.compiler_data


def check_type_name(symbol):
    """Signal that ``symbol``, which is to become the name of a type, names a declaration (ANSI 3.3.3)."""
    if is_declared(symbol):
        error("~S names a declaration, so it cannot become the name of a type.", symbol)
