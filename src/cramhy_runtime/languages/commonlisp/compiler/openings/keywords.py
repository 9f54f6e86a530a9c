"""Calls with keywords that the code names: they are sorted when they are compiled, not when they run.

A standard function with keywords is a Python function with keyword-only parameters behind one that sorts keyword objects
(`lisp_core.keyword_calls`). A call that names its keywords is sorted here, once, and calls the Python function itself.

Rows of ``make bench`` without a pass, as times of the row with it. ``keywords``: structures 3.4, calls with &key 1.6.
``standard-keywords``: no row has such a call in its loop; a loop of ``find``, ``position`` and ``member`` with keywords 1.6.
"""

from __future__ import annotations

from types import FunctionType

from cramhy_runtime.lisp_core.data import Keyword, Symbol
from cramhy_runtime.lisp_core.keyword_calls import keyword_calls, name_of_key, takes_keywords
from cramhy_runtime.lisp_core.packages import CRAMHY

from .. import core, nodes
from ..core import expression, word
from ..passes import GENERAL_CALLS, opens
from ..words import DOT


@opens("keywords", GENERAL_CALLS)
def keyword_call(generator, node, models):
    """The call of a user's function with keywords that the code names, if it takes them as Python's; else ``None``."""
    symbol, arguments = node.symbol, node.arguments
    if not isinstance(symbol, Symbol) or (count := _keys_begin(symbol.function, arguments)) is None:
        return None
    names = [name_of_key(key.value) for key in arguments[count::2]]
    if not takes_keywords(symbol.function, count, names) or len({*names}) < len(names):
        return None
    calls = generator.constant(keyword_calls(symbol, count, *[key.value for key in arguments[count::2]]))
    done = models[:count]
    for name, value in zip(names, models[count + 1 :: 2], strict=True):
        done += [core.Keyword(name), value]
    return generator.positioned(expression(expression(DOT, calls, word("call")), *done), node), node


@opens("standard-keywords", GENERAL_CALLS)
def standard_call(generator, node, models):
    """The call of the Python function behind a standard one."""
    symbol = node.symbol
    if not (generator.standard(symbol) or generator.standard(symbol, CRAMHY)):
        return None
    function = symbol.function
    if not hasattr(getattr(function, "python", None), "__code__"):
        return None
    sorted_ = sorted_arguments(function, models, node.arguments)
    if sorted_ is None:
        return None
    model = expression(word(generator.constants.name("function.python", symbol)), *sorted_)
    return generator.positioned(model, node), node


def _keys_begin(function, arguments):
    """The number of arguments of a call of ``function`` before those with keywords; ``None`` if there are none, or odd ones."""
    if function.__class__ is not FunctionType or len(arguments) < 2:
        return None
    code = function.__code__
    if not code.co_kwonlyargcount and "python_keys" not in function.__dict__:
        return None
    count = code.co_argcount
    keys = arguments[count::2]
    if not keys or len(arguments) - count & 1:
        return None
    return count if all(key.__class__ is nodes.Constant and key.value.__class__ is Keyword for key in keys) else None


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
