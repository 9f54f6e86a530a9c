"""The small functions of ``cram-utilities``: time stamps, comparing, names, data pools, copies.

Source: prolog.md 13.2, cpl.md 13.3.
"""

from __future__ import annotations

import os
from copy import copy as shallow_copy

import re

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Error, SimpleStyleWarning, error, type_error, warn
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, list_from, one, python_list, truth
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.equality import eql
from cramhy_runtime.lisp_core.functions import function_of, identity
from cramhy_runtime.lisp_core.dispatch.generic_functions import protocol_function
from cramhy_runtime.lisp_core.packages import keyword

from .symbols import sym

REAL, RUN = keyword("REAL"), keyword("RUN")


def _or_default(designator, default):
    return default if designator is None else function_of(designator)


class DeprecationWarning_(SimpleStyleWarning):
    """What `deprecate` signals."""

    lisp_name = "CRAM-UTILITIES::DEPRECATION-WARNING"


def deprecate(message):
    """Warn that something is deprecated."""
    warn(DeprecationWarning_("~a", message))


style_warn = conditions.style_warn


_copies = special(Symbol("*COPIES*"))


def _copy_of(obj):
    """A copy of an instance whose bound slots are copied in turn; a structure's slots are shared; other objects are themselves.

    An instance that is met again, in itself or in another slot, is copied once, so that circles and sharing are as before.
    """
    if hasattr(obj.__class__, "lisp_structure"):
        return shallow_copy(obj)
    if not hasattr(obj, "__dict__") or isinstance(obj, type | BaseException) or callable(obj):
        return obj
    if _copies.value is None:
        with binding(_copies, {}):
            return _copy_of(obj)
    copy = _copies.value.get(id(obj))
    if copy is None:
        copy = _copies.value[id(obj)] = obj.__class__.__new__(obj.__class__)
        copy.__dict__.update({name: one(copy_object(value)) for name, value in obj.__dict__.items()})
    return copy


copy_object = protocol_function("CUT::COPY-OBJECT", "(obj)", _copy_of)
"""``cut:copy-object``, a generic function: `_copy_of` is what it does without further methods."""


# --------------------------------------------------------------------------------------------------------------------- time

TIMESTAMP_FUNCTION = special(sym("CUT::*TIMESTAMP-FUNCTION*"))
"""``cut:*timestamp-function*``: the function that gives time stamps; nil for the kernel's clock."""


def current_timestamp(what_time=None):
    """Seconds as a double, from ``*timestamp-function*``; with ``:real`` the kernel's clock, with ``:run`` the time that was computed."""
    function = None
    if what_time is None:
        function = TIMESTAMP_FUNCTION.value
    elif what_time is RUN:
        return float(round(os.times().user, 6))
    elif what_time is not REAL:
        return type_error(what_time, "(MEMBER :REAL :RUN)")
    return float(kernel.now()) if function is None else one(function_of(function)())


def set_timestamp_function(fn):
    TIMESTAMP_FUNCTION.value = fn
    return fn


def set_default_timestamp_function():
    TIMESTAMP_FUNCTION.value = None


def microsecond_timestamp_function(*, relative=None):
    """A function that gives seconds to the microsecond, since 1970 or, with ``relative``, since now."""
    start = kernel.now() if truth(relative) else -kernel.active().epoch
    return lambda: float(round(kernel.now() - start, 6))


def current_string_timestamp():
    """The date and time of day (UTC) by the kernel's clock, as 14 digits."""
    import datetime

    moment = datetime.datetime.fromtimestamp(kernel.active().epoch + kernel.now(), datetime.UTC)
    return moment.strftime("%Y%m%d%H%M%S")


# ---------------------------------------------------------------------------------------------------------------- functions


def flip(fun):
    """``fun`` with its first two arguments exchanged."""
    function = function_of(fun)
    return lambda a, b, *rest: function(b, a, *rest)


def compare(x, y, *, test=None, key=None):
    """``test`` of the ``key`` of both."""
    key_of, same = _or_default(key, identity), _or_default(test, eql)
    return same(one(key_of(x)), one(key_of(y)))


def _extremum(seq, test, key):
    key_of, best, best_key, started = _or_default(key, identity), None, None, False
    for item in python_list(seq):
        value = one(key_of(item))
        if not started or truth(one(test(value, best_key))):
            best, best_key, started = item, value, True
    return best


def minimum(seq, *, test=None, key=None):
    """The least element; ``nil`` for an empty sequence."""
    return _extremum(seq, _or_default(test, lambda a, b: a < b), key)


def maximum(seq, *, test=None, key=None):
    """The greatest element; ``nil`` for an empty sequence."""
    return _extremum(seq, _or_default(test, lambda a, b: a > b), key)


def ensure_unused_string(base_string, used_p):
    """``base_string``, or with -1, -2, ... behind it, until ``used_p`` is false of it."""
    used, candidate, number = function_of(used_p), base_string, 0
    while truth(one(used(candidate))):
        number += 1
        candidate = f"{base_string}-{number}"
    return candidate


def sanitize_filename(filename):
    """Every character but letters, digits, ``-`` and ``_`` becomes ``_``."""
    return re.sub(r"[^a-zA-Z0-9_-]", "_", str(filename))


def equalize_two_list_lengths(a, b, *, return_as_list=None):
    """Both lists, padded with ``nil`` to the same length; what is not a list is a list of itself.

    return_as_list: one list of both, in place of two values.
    """
    left, right = (python_list(part) if part is None or isinstance(part, Cons) else [part] for part in (a, b))
    size = max(len(left), len(right))
    equalized = [list_from(part + [None] * (size - len(part))) for part in (left, right)]
    return MultipleValues(tuple(equalized)) if return_as_list is None else list_from(equalized)


def equalize_lists_of_lists_lengths(a, b):
    """Pads the lists in both lists pair by pair, and appends them: two flat lists of the same length."""
    left, right = python_list(a), python_list(b)
    size, first, second = max(len(left), len(right)), [], []
    for i in range(size):
        x, y = equalize_two_list_lengths(left[i] if i < len(left) else None, right[i] if i < len(right) else None)
        first += python_list(x)
        second += python_list(y)
    return MultipleValues((list_from(first), list_from(second)))


# ---------------------------------------------------------------------------------------------------------------- data pools


class PoolValueUnbound(Error):
    """A data pool has nothing under an id."""

    lisp_name = "CRAM-UTILITIES::POOL-VALUE-UNBOUND"
    initargs = {"ID": "id"}
    id = None

    def report(self):
        return f"Data pool does not contain a value for id {self.id}"


class DataPool:
    """A table from ids 0, 1, ... to objects."""

    def __init__(self):
        self.table, self.next_id = {}, 0


def make_data_pool():
    return DataPool()


def _pool(thing):
    return thing if isinstance(thing, DataPool) else type_error(thing, "DATA-POOL")


def new_pool_value(pool, value=None):
    """Store ``value`` under a new id, which is returned."""
    number, pool.next_id = _pool(pool).next_id, pool.next_id + 1
    pool.table[number] = value
    return number


def pool_value(pool, number):
    return _pool(pool).table[number] if number in _pool(pool).table else error(PoolValueUnbound(id=number))


def set_pool_value(value, pool, number):
    _pool(pool).table[number] = value
    return value


def delete_pool_value(pool, number):
    _pool(pool).table.pop(number, None)


# ------------------------------------------------------------------------------------------------------------------ features
