"""Lists between Hy and the functions of Prolog and of lazy lists: the empty list, and Python's collections in goals.

Lisp has one object for the empty list, false and nothing. Hy goes through lists, so where such a function gives ``nil``, Hy gets an empty
list (`EmptyList`): ``(for [answer (prolog goal)] ...)`` has no turns if there is no answer, and ``(not (prolog goal))`` is true. What Hy
inserts into the template of a goal or fact, `` `(member ?x ~places)``, is a list if it is a collection of Python. An iterator is refused,
since a goal may be proved twice.
"""

from __future__ import annotations

import functools
from types import FunctionType

from hy import models

from cramhy_runtime.lisp_core.data import EmptyList, MultipleValues
from cramhy_runtime.lisp_core.packages import intern
from cramhy_runtime.prolog.builtins.function_calls import RESULTS
from cramhy_runtime.prolog.python.terms import gets_objects, list_argument, to_lisp
from .lisp_data import GIVE_LISTS, inserted


@functools.cache
def list_function(package, name):
    """The function that a symbol names, for Hy: an empty list of Python is ``nil`` for it, and ``nil`` is an `EmptyList` for Hy."""
    symbol = intern(name, package)
    gives = name in GIVE_LISTS.get(package, ())

    def call(*arguments, **keywords):
        found = symbol.function(*[None if _is_empty(argument) else argument for argument in arguments], **keywords)
        return EmptyList() if found is None and gives else found

    return call


def _is_empty(thing):
    return (thing.__class__ is EmptyList or thing.__class__ is list) and not thing


class Lists:
    """Its attributes are packages, whose attributes are functions: ``lists.cram_prolog.prolog`` is a `list_function`."""

    def __init__(self, package=None):
        self._package = package

    def __getattr__(self, name):
        written = name.upper().replace("_", "-")
        found = Lists(written) if self._package is None else list_function(self._package, written)
        setattr(self, name, found)
        return found


def is_ours(value):
    """Whether a prompt of Hy shows ``value`` as Lisp prints it. An `EmptyList` is shown as any empty list of Hy."""
    kind = type(value)
    return kind.__module__.partition(".")[0] == "cramhy_runtime" and kind is not EmptyList


def in_goal(value, package, functor):
    """The Lisp object that ``value`` stands for in a goal of ``functor``, a symbol or ``None``; package: as for `inserted`."""
    if functor is not None and gets_objects(functor):
        return inserted(value, package)
    if type(value) in (list, tuple):
        return to_lisp([in_goal(each, package, None) for each in value])
    if isinstance(value, models.Object):
        return inserted(value, package)
    return list_argument(functor, value)


def spliced_in_goal(values, package, functor):
    """The values of ``~@values`` in the template of a goal, each as `in_goal` has it."""
    return [in_goal(value, package, functor) for value in values or ()]


def for_lisp(function):
    """``function``, a function or class of Hy, as Lisp calls it: an `EmptyList` is ``nil`` there."""
    if not isinstance(function, FunctionType):
        return function

    @functools.wraps(function)
    def call(*arguments, **keywords):
        found = function(*arguments, **keywords)
        return None if found.__class__ is EmptyList and not found else found

    if not hasattr(function, "python"):
        call.python = function
    return call


def in_rules(function):
    """``function``, a function or class of Hy, for rules only: its results are what Python's values are in goals."""

    def call(*arguments):
        found = function(*arguments)
        return found if found.__class__ is MultipleValues else _result(found)

    return functools.update_wrapper(call, function, updated=())


def published(symbol):
    """Note that Hy code has defined the function of ``symbol``: in a rule, its results are what Python's values are in goals."""
    RESULTS[symbol] = _result


def _result(value):
    return to_lisp(value, True)
