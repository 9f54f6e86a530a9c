"""How many arguments of a call stand before its body: what editors indent calls of macros by."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.operators import OPERATORS, operator_of


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


BODIES = ("form...", "goal...", "fact...")
"""What the body of an operator is called in its shape."""


def before_forms(operator):
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
    return next((number for number, each in enumerate(items) if each in BODIES), None)


def body_start(symbol):
    """How many arguments stand before the body of a call of ``symbol``; ``None`` if it has no body or is no macro."""
    operator = operator_of(symbol)
    if operator is not None:
        return before_forms(operator)
    return before_body(symbol) if getattr(symbol, "macro", None) is not None else None


LOCAL = {"DO-RETRY": 1, "WITH-RETRY": 0}
"""Macros that operators define in their bodies."""


def body_start_of_name(name):
    """The same for a name that no package is known for, such as one of a file whose system is not loaded."""
    short = name.rpartition(":")[2].upper()
    operator = next((each for each in OPERATORS.values() if each.name == short), None)
    return LOCAL.get(short) if operator is None else before_forms(operator)
