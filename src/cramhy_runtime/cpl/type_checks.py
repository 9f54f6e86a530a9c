"""Functions that take objects of one class only: they check that, as the readers of a structure do.

Without a check, a wrong argument would end in a missing attribute. A Lisp user wants to know which value is not of which type.
"""

from __future__ import annotations

import functools

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons


def of(cls):
    """A decorator for functions of one argument: an argument that is not a ``cls`` is a type error."""
    expected = cls.lisp_name.partition("::")[2]

    def decorate(function):
        @functools.wraps(function)
        def checked(thing):
            return function(thing) if isinstance(thing, cls) else type_error(thing, expected)

        return checked

    return decorate


def parts_of(path):
    """The parts of ``path``, a Lisp list, as a Python list, the deepest first. Other objects are a type error."""
    if path is not None and not isinstance(path, Cons):
        return type_error(path, "LIST", "\n(A path is a list of parts, the deepest first: ((tagged a) (fetch)).)")
    return list(path or ())
