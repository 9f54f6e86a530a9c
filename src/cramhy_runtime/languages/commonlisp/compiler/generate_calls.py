"""Calls of functions whose shape is known: no frame stands between the call and the function.

A standard function with keywords is a Python function with keyword-only parameters behind one that sorts keyword objects
(`ground.keyword_calls`). A call that names its keywords is sorted here, once, and calls the Python function itself.
"""

from __future__ import annotations

from cramhy_runtime.ground.data import Keyword
from . import core, nodes
from .core import expression, word


class CallGenerator:
    """The part of the `Generator` that calls functions of known shape."""

    def standard_function(self, symbol, models, arguments):
        """The call of a standard function with the values ``models`` of the nodes ``arguments``."""
        function = symbol.function
        python = getattr(function, "python", None)
        if python is not None:
            sorted_ = sorted_arguments(function, models, arguments)
            if sorted_ is not None:
                return expression(word(self.constants.name("function.python", symbol)), *sorted_)
        return expression(word(self.constants.name("function", symbol)), *models)


def sorted_arguments(function, models, arguments):
    """``models``, the arguments of a call of the lispified ``function``, for the Python function behind it; ``None`` if only it can
    sort them, as where a keyword is computed, unknown or repeated."""
    code = function.python.__code__
    positional, defaults = code.co_argcount, function.python.__defaults__ or ()
    if len(models) <= positional:
        return models if len(models) >= positional - len(defaults) else None
    if len(models) - positional & 1 or code.co_flags & 0x0C:
        return None
    keys = arguments[positional::2]
    if any(key.__class__ is not nodes.Constant or key.value.__class__ is not Keyword for key in keys):
        return None
    names = [function.python_keywords.get(key.value) for key in keys]
    if None in names or len(set(names)) < len(names):
        return None
    done = models[:positional]
    for name, value in zip(names, models[positional + 1 :: 2], strict=True):
        done += [core.Keyword(name), value]
    return done


__all__ = ["CallGenerator"]
