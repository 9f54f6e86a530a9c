"""What calls a function takes: the `Shape` of functions of all kinds, and what is wrong with a call.

Generic functions and those of ``defun`` know their lambda lists; of others Python's parameters tell. The functions of Common Lisp
have theirs written down in ``ansi_lambda_lists.py``. Where nothing is known, calls are not judged.
"""

from __future__ import annotations

import types
from copy import copy

from cramhy_runtime.lisp_core.data import Keyword, list_from, python_list
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.dispatch.methods import Shape
from cramhy_runtime.lisp_core.packages import keyword

ALLOW_OTHER_KEYS = keyword("ALLOW-OTHER-KEYS")


def shape_of(function):
    """The `Shape` of a function object, or ``None`` when it cannot be known."""
    shape = getattr(function, "shape", None)
    if isinstance(shape, Shape):
        return _with_any_key(shape) if shape.has_keys and isinstance(function, GenericFunction) else shape
    known = getattr(function, "__lisp_lambda_list__", function)
    if known is not function:
        return Shape(known)
    function = getattr(function, "python", function)
    if not isinstance(function, types.FunctionType) or hasattr(function, "__wrapped__"):
        return None
    code, shape = function.__code__, Shape()
    defaults = len(function.__defaults__ or ())
    shape.required, shape.optional = code.co_argcount - defaults, defaults
    shape.rest = bool(code.co_flags & 0x04)
    if code.co_flags & 0x08 and not code.co_kwonlyargcount:
        return None  # &key of a lambda expression
    if code.co_kwonlyargcount:
        names = code.co_varnames[code.co_argcount : code.co_argcount + code.co_kwonlyargcount]
        frozen = function.__globals__.get("__name__") == "cramhy_code"  # variables caught by a closure are no keys
        if not frozen:
            shape.has_keys = True
            shape.keys = [keyword(name.rstrip("_").replace("_", "-").upper()) for name in names]
            shape.allow_other_keys = bool(code.co_flags & 0x08)
    return shape


def _with_any_key(shape):
    """``shape`` of a generic function: its methods may take other keywords than it names."""
    other = copy(shape)
    other.allow_other_keys = True
    return other


def wrong_call(name, shape, arguments):
    """What is wrong with a call of ``name`` with the argument forms ``arguments``: format controls with their arguments."""
    given, least, most = len(arguments), shape.required, shape.maximum
    if given < least or (most is not None and given > most):
        if least == most:
            yield "The function ~S is called with ~R argument~:P, but wants exactly ~R.", name, given, least
        elif given < least:
            yield "The function ~S is called with ~R argument~:P, but wants at least ~R.", name, given, least
        else:
            yield "The function ~S called with ~R argument~:P, but wants at most ~R.", name, given, most
        return
    keys = arguments[shape.required + shape.optional :]
    if not shape.has_keys or not keys:
        return
    if len(keys) % 2:
        yield "The function ~S is called with odd number of keyword arguments.", name
        return
    if shape.allow_other_keys or any(key is ALLOW_OTHER_KEYS for key in keys[::2]):
        return
    unknown = [key for key in keys[::2] if isinstance(key, Keyword) and key not in shape.keys]
    if len(unknown) == 1:
        yield "~S is not a known argument keyword.", unknown[0]
    elif unknown:
        yield "~{~S~^, ~} and ~S are not a known argument keywords.", list_from(unknown[:-1]), unknown[-1]


_OF_LAMBDA = {
    "The function ~S is called with ~R argument~:P, but wants exactly ~R.": "function called with ~R argument~:P, but wants exactly ~R",
    "The function ~S is called with ~R argument~:P, but wants at least ~R.": "function called with ~R argument~:P, but wants at least ~R",
    "The function ~S called with ~R argument~:P, but wants at most ~R.": "function called with ~R argument~:P, but wants at most ~R",
    "The function ~S is called with odd number of keyword arguments.": "function called with odd number of arguments in keyword portion",
}


def wrong_call_of_lambda(shape, arguments):
    """What is wrong with a call of a lambda expression, as `wrong_call`."""
    for control, *rest in wrong_call(None, shape, arguments):
        if control in _OF_LAMBDA:
            yield _OF_LAMBDA[control], *rest[1:]
        elif len(rest) == 1:
            yield "function called with unknown argument keyword ~S", rest[0]
        else:
            yield "function called with unknown argument keywords ~{~S~^, ~}", list_from([*python_list(rest[0]), rest[1]])
