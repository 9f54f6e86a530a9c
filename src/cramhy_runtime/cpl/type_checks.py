"""Functions of one class of objects: what is given another one says so, as the readers of a structure do.

From Python a wrong argument would end in an attribute that is not there; a Lisp user wants to know which value is not of which type.
"""

from __future__ import annotations

import functools

from cramhy_runtime.ground.conditions import type_error
from cramhy_runtime.ground.data import Cons


def of(cls):
    """Let the decorated function of one argument refuse what is no ``cls`` with a type-error."""
    expected = cls.lisp_name.partition("::")[2]

    def decorate(function):
        @functools.wraps(function)
        def checked(thing):
            return function(thing) if isinstance(thing, cls) else type_error(thing, expected)

        return checked

    return decorate


def parts_of(path):
    """The parts of a path, a Lisp list, the deepest first, as a Python list."""
    if path is not None and not isinstance(path, Cons):
        return type_error(path, "LIST", "\n(A path is a list of parts, the deepest first: ((tagged a) (fetch)).)")
    return list(path or ())
