"""``apropos``: which symbols have a text in their names, and what they are. Source: ANSI 25.2; the lines are SBCL's."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import NO_VALUES, UNBOUND, Symbol, list_from
from cramhy_runtime.lisp_core.packages import all_packages, find_package_or_error, string_designator, symbol_name, symbol_package
from ..printer.printer import prin1_to_string
from ..streams.streams import standard_output
from ..evaluation.symbols import fboundp
from ..types.types import type_of

LISP_NAMES = "apropos apropos-list"


def _found(text, designator, external_only):
    """The symbols accessible in the package (or in any) whose names contain ``text``, letter case aside, by name."""
    text = string_designator(text).upper()
    if designator is None:
        tables = [table for package in all_packages() for table in (package.external, package.internal)]
    else:
        package = find_package_or_error(designator)
        tables = (
            [package.external]
            if external_only is not None
            else [package.external, package.internal, *(other.external for other in package.use)]
        )
    found = {symbol for table in tables for name, symbol in table.items() if text in name.upper()}
    return sorted(found, key=lambda symbol: (symbol_name(symbol), getattr(symbol_package(symbol), "name", "")))


def apropos_list(text, package=None, external_only=None):
    """``apropos-list``: the symbols whose names contain ``text``. Without a package, all packages are searched."""
    return list_from(_found(text, package, external_only))


def apropos(text, package=None, external_only=None):
    """``apropos``: print the symbols whose names contain ``text``, a line each, with what they are; no values."""
    output = standard_output()
    for symbol in _found(text, package, external_only):
        output.fresh_line()
        output.write(_line(symbol))
    return NO_VALUES


def _line(symbol):
    line = prin1_to_string(symbol)
    value = symbol.value if isinstance(symbol, Symbol) else symbol
    if value is None or value is True or isinstance(value, (int, Symbol)):
        line += f" = {prin1_to_string(value)}"
    elif value is not UNBOUND:
        line += f" (bound, {prin1_to_string(type_of(value))})"
    return line + (" (fbound)" if isinstance(symbol, Symbol) and fboundp(symbol) is not None else "")
