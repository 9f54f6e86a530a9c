"""How Emacs indents calls of macros: it is told how many arguments stand before the body.

SLIME keeps these numbers by names in small letters. Each connection is told of a macro once, and again when it takes other arguments.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Cons, Symbol
from cramhy_runtime.ground.packages import COMMON_LISP, KEYWORD, all_packages
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.operators import OPERATORS

from .wire import Name


def before_body(symbol):
    """How many arguments stand before the body of a call of the macro ``symbol``; ``None`` if it has no body."""
    lambda_list, count = lambda_list_of(symbol.macro), 0
    while isinstance(lambda_list, Cons):
        item, lambda_list = lambda_list.car, lambda_list.cdr
        name = item.name if isinstance(item, Symbol) else ""
        if name == "&BODY":
            return count
        if name in ("&REST", "&KEY", "&AUX"):
            return None
        if name in ("&WHOLE", "&ENVIRONMENT"):
            lambda_list = lambda_list.cdr if isinstance(lambda_list, Cons) else None
        elif name != "&OPTIONAL":
            count += 1
    return None


def _before_forms(operator):
    """The same for an operator of the plan language, by its shape: its forms are the body."""
    depth, items, item = 0, [], ""
    for character in operator.shape.strip()[1:-1]:
        depth += (character in "([") - (character in ")]")
        if character == " " and depth == 0:
            items.append(item)
            item = ""
        else:
            item += character
    items = [*items, item][1:]
    return items.index("form...") if "form..." in items else None


def of_all(known):
    """What Emacs is not told yet: [(name, number, packages)]. known: {name: number} of what it knows, which is brought up to date."""
    found = {}
    for (home, name), operator in OPERATORS.items():
        count = _before_forms(operator)
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
