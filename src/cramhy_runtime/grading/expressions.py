"""Numbers of an exercise that depend on the seed, and arithmetic with them, such as ``hypot(x, y) + 1``.

An exercise varies: the side of the square, or the place where the turtle begins. A value is drawn by the seed and the name of the value,
so a seed always gives the same exercise. Formulas are Python's arithmetic without anything else: they are taken apart and computed here,
and never run as code.
"""

from __future__ import annotations

import ast
import math
import operator
import random
import re

from .problems import ExerciseError

_BINARY = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
_NAMES = {"pi": math.pi}
_FUNCTIONS = {
    name: getattr(math, name)
    for name in ("sqrt", "hypot", "sin", "cos", "tan", "atan2", "radians", "degrees", "floor", "ceil", "fabs", "dist")
} | {"abs": abs, "min": min, "max": max, "round": round}
_IN_BRACES = re.compile(r"\{([^{}]*)\}")


def computed(formula, values):
    """The number that ``formula`` gives, a number or a text. values: a dictionary from names to numbers. Raises `ExerciseError`."""
    if isinstance(formula, (int, float)):
        return formula
    if not isinstance(formula, str):
        raise ExerciseError(f"{formula!r} is neither a number nor a formula.")
    try:
        found = _value(ast.parse(formula.strip(), mode="eval").body, values)
        if math.isfinite(found):
            return found
    except (SyntaxError, ArithmeticError, TypeError, ValueError, RecursionError, MemoryError) as problem:
        raise ExerciseError(f"The formula {formula!r} cannot be computed: {problem}.")
    raise ExerciseError(f"The formula {formula!r} gives {found}, which is not a finite number.")


def _value(node, values):
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return node.value
    if isinstance(node, ast.Name):
        if node.id in values:
            return values[node.id]
        if node.id in _NAMES:
            return _NAMES[node.id]
        raise ValueError(f"there is no value {node.id}; there are {', '.join([*values, *_NAMES])}")
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        return _BINARY[type(node.op)](_value(node.left, values), _value(node.right, values))
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, values)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _FUNCTIONS and not node.keywords:
        return _FUNCTIONS[node.func.id](*(_value(argument, values) for argument in node.args))
    raise ValueError(f"{ast.unparse(node)} is not arithmetic")


def filled(text, values):
    """``text`` with each ``{formula}`` in it replaced by its number, as Lisp reads it; a value that is a text stands as it is."""

    def number(match):
        found = values.get(match[1].strip())
        return found if isinstance(found, str) else written(computed(match[1], values))

    return _IN_BRACES.sub(number, text)


def written(number):
    """A number as Lisp reads it: an integer, or a float with at most six digits behind the point."""
    return str(number) if isinstance(number, int) else repr(round(float(number), 6))


def drawn(vary, seed):
    """The values for a seed: a dictionary.

    vary: for each name a list of values to choose from, or a table with ``from``, ``to`` and perhaps ``step``. seed: a number. The value
    ``seed`` is there, too.
    """
    values = {"seed": seed}
    for name, choice in vary.items():
        chance = random.Random(f"{name} {seed}").random()  # of all that `random` gives, this is the same in every version of Python
        if isinstance(choice, list):
            values[name] = choice[int(chance * len(choice))]
            continue
        begin, end = choice["from"], choice["to"]
        step = choice.get("step")
        if step is None:
            values[name] = round(begin + chance * (end - begin), 3)
        else:
            value = begin + int(chance * (round((end - begin) / step) + 1)) * step
            values[name] = value if isinstance(value, int) else round(value, 6)
    return values
