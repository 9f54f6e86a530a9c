"""Python's exceptions as conditions: each class of exceptions has a class of conditions, arranged as in Python.

``(handler-case (py:call "int" "x") (py:ValueError (e) ...))`` works because ``py:ValueError`` (or ``py:value-error``) names the
condition class of ``ValueError``; all are errors. Where Common Lisp has a class of its own for the same thing, that is it: a
``ZeroDivisionError`` is a ``division-by-zero``. The text of such a condition is that of the exception, which
``py:exception`` gives.
"""

from __future__ import annotations

from .. import condition_types as types
from ..conditions import type_error
from .python_names import lisp_spelling

PYTHON = "PYTHON"
EQUIVALENT = {Exception: types.Error, ArithmeticError: types.ArithmeticError_, ZeroDivisionError: types.DivisionByZero,
              OverflowError: types.FloatingPointOverflow, RecursionError: types.StorageCondition, MemoryError: types.StorageCondition}
"""Classes of exceptions that are classes of conditions already."""

_classes: dict = {}


def condition_class(cls):
    """The class of conditions for the class ``cls`` of exceptions."""
    found = EQUIVALENT.get(cls) or _classes.get(cls)
    if found is None:
        bases = tuple(dict.fromkeys(condition_class(base) for base in cls.__bases__
                                    if issubclass(base, Exception) and base not in EQUIVALENT)) or (types.PythonError,)
        found = _classes[cls] = type(cls.__name__, bases, {
            "lisp_name": f"{PYTHON}::{lisp_spelling(cls.__name__)}", "__module__": __name__, "__doc__": cls.__doc__})
    return found


def python_condition(exception):
    """The condition for an exception that has no meaning of its own in Lisp."""
    condition = condition_class(type(exception))(exception)
    if isinstance(exception, ModuleNotFoundError) and exception.name:
        condition.hint = f"Is there a module {exception.name} in this Python, or is it to be installed with pip?"
    return condition


def exception(condition):
    """``py:exception``: the Python exception that ``condition`` stands for."""
    if isinstance(condition, types.PythonError):
        return condition.exception
    return condition if isinstance(condition, types.Condition) else type_error(condition, "CONDITION")
