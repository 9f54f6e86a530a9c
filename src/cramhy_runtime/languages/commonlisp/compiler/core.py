"""Core Hy forms: what the compiler's output is made of.

A form is a `Symbol`, a number or a text, or an `Expression`, `List` or `Tuple` of forms, as in Hy. These classes are lighter than
Hy's models, because a program is made of very many of them, and ``python_code.py`` makes Python of them directly. In a ``.hy``
file, where Hy itself compiles, `hy_model` turns them into Hy's models. `HEADS` are the operators that mean the same in both.
"""

from __future__ import annotations

HEADS = frozenset(
    """setv setx . if when do while for try except finally else with return break continue nonlocal fn defn raise
is is-not and or not = != < <= > >= + - * ** // % get unpack-iterable unpack-mapping quote unquote cut del import require defclass
eval-and-compile cond let match annotate await yield assert global lfor gfor sfor dfor py pys in not-in del""".split()
)
"""What Hy understands as an operator in the head of a form; no variable of a program has such a name."""


class Symbol(str):
    """A Python name, or an operator of Hy. ``text``: the name as a plain string, which Python's syntax trees want."""

    __slots__ = ("text",)


class Keyword(str):
    """``:name`` in a call: the argument after it is a keyword argument of Python."""

    __slots__ = ()


class Expression(list):
    """A call or an operator with its operands. ``position``: where in the user's text, (line, column, end line, end column)."""

    position = None  # no slot: most have none, and to set it would be a call of a Python function for each


class List(list):
    """``[a b]``: parameters, targets of an assignment, a Python list."""

    __slots__ = ()


class Tuple(list):
    """``#(a b)``"""

    __slots__ = ()


class _Words(dict):
    """Name → its `Symbol`, which is made when it is first asked for."""

    def __missing__(self, name):
        found = self[name] = Symbol(name)
        found.text = str(name)
        return found


word = _Words().__getitem__
"""``word(name)``: the `Symbol` of that name, one object for each. A method of a dictionary, since the compiler calls it most of all."""


def expression(*items):
    return Expression(items)


NONE = word("None")
TRUE = word("True")


def hy_model(form):
    """``form`` as a Hy model, for Hy's own compiler."""
    from hy import models

    kind = form.__class__
    if kind is Symbol:
        return models.Symbol(form)
    if kind is Keyword:
        return models.Keyword(form)
    if kind is str:
        return models.String(form)
    if kind is int:
        return models.Integer(form)
    if kind is float:
        return models.Float(form)
    if kind is List:
        return models.List([hy_model(item) for item in form])
    if kind is Tuple:
        return models.Tuple([hy_model(item) for item in form])
    model = models.Expression([hy_model(item) for item in form])
    if form.position is not None:
        model.start_line, model.start_column, model.end_line, model.end_column = form.position
    return model
