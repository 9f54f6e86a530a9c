"""What to try: a hint for a condition, written for a student (law 7).

A condition may bring its own (``hint``). For names that mean nothing here the near ones are looked up: a variable whose stars
were forgotten, a function of another package, a typing mistake.
"""

from __future__ import annotations

from cramhy_runtime.lisp import pprint_dispatch
from cramhy_runtime.lisp.conditions import types
from cramhy_runtime.lisp.data import Symbol, UNBOUND, UndefinedFunction
from cramhy_runtime.lisp.dynamic import binding
from cramhy_runtime.lisp.evaluator import PACKAGE
from cramhy_runtime.lisp.packages import all_packages, near_names, symbol_name


def report_text(condition):
    """The text of ``condition``, with messages and other long objects in their short form, as SBCL's debugger shows them."""
    with binding(pprint_dispatch.PRINT_PPRINT_DISPATCH, pprint_dispatch.INITIAL):
        return str(condition)


def hint_for(condition):
    """One sentence of advice, or ``None``."""
    own = getattr(condition, "hint", None)
    if own:
        return own
    name = getattr(condition, "name", None)
    if isinstance(condition, types.UnboundVariable) and isinstance(name, Symbol):
        return _variable(name)
    if isinstance(condition, types.UndefinedFunction) and isinstance(name, Symbol):
        return _function(name)
    if isinstance(condition, types.PackageDoesNotExist):
        near = near_names(str(symbol_name(condition.package) if isinstance(condition.package, Symbol) else condition.package),
                          [name for package in all_packages() for name in package.names])
        return f"Did you mean {' or '.join(near)}?" if near else "Is the system that defines it loaded?"
    return None


def _visible(test):
    package = PACKAGE.value
    for source in [package.internal, package.external, *(other.external for other in package.use)]:
        for name, symbol in source.items():
            if isinstance(symbol, Symbol) and test(symbol):
                yield name


def _variable(symbol):
    starred = f"*{symbol.name}*"
    variables = set(_visible(lambda other: other.value is not UNBOUND and other.special))
    if starred in variables:
        return f"There is a variable {starred}, with stars."
    near = near_names(symbol.name, variables)
    if near:
        return f"Did you mean {' or '.join(near)}?"
    if symbol.name.startswith("?"):
        return f"A variable in a designator must be bound around it: (let (({symbol.name.lower()} ...)) ...)."
    return None


def _function(symbol):
    def defined(other):
        return not isinstance(other.function, UndefinedFunction) or other.macro is not None

    for package in all_packages():
        other = package.external.get(symbol.name)
        if isinstance(other, Symbol) and other is not symbol and defined(other):
            nickname = min(package.names, key=len).lower()
            return f"There is {nickname}:{symbol.name.lower()} in another package."
    near = near_names(symbol.name, set(_visible(defined)))
    return f"Did you mean {' or '.join(near)}?" if near else None
