"""How Emacs indents calls of macros: it is told how many arguments stand before the body.

SLIME keeps these numbers by names in small letters. Each connection is told of a macro once, and again when it takes other arguments.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import COMMON_LISP, KEYWORD, all_packages
from cramhy_runtime.languages.operators import OPERATORS
from cramhy_runtime.session.body_arguments import before_body, before_forms

from .wire import Name


def of_all(known):
    """What Emacs is not told yet: [(name, number, packages)]. known: {name: number} of what it knows, which is brought up to date."""
    found = {}
    for (home, name), operator in OPERATORS.items():
        count = before_forms(operator)
        if count is not None:
            found.setdefault(name.lower(), (count, []))[1].append(home)
    for package in all_packages():
        if package is COMMON_LISP or package is KEYWORD:
            continue
        for table in (package.external, package.internal):
            for symbol in table.values():
                if (
                    isinstance(symbol, Symbol)
                    and symbol.package is package
                    and symbol.macro is not None
                    and (package.name, symbol.name) not in OPERATORS
                ):
                    count = before_body(symbol)
                    if count is not None:
                        found.setdefault(symbol.name.lower(), (count, []))[1].append(package.name)
    new = [[name, count, packages] for name, (count, packages) in found.items() if known.get(name) != count]
    known.update({name: count for name, count, _ in new})
    return new


def tell(connection):
    """Tell Emacs of the macros that it does not know yet."""
    new = of_all(connection.indentation)
    if new:
        connection.send(Name(":indentation-update"), new)
