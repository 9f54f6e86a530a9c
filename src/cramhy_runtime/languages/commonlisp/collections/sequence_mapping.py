"""Functions over the elements of sequences: ``map``, ``reduce``, and the questions ``every`` and ``some``.

With several sequences the shortest decides where to stop. Source: ANSI 17.3; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, LispString, MultipleValues, one
from cramhy_runtime.lisp_core.functions import function_of, holds, key_of, primary
from cramhy_runtime.lisp_core.packages import sym
from .lists import cells
from .sequence_types import elements, in_turns, part, sequence_type, store_all
from cramhy_runtime.lisp_core.arrays import Vector

PLUS = sym("+")
LISP_NAMES = "map map-into reduce every some notany notevery"


def _rows(first, more, context=""):
    """Iterate over the argument lists for a function on several sequences."""
    if more:
        return zip(in_turns(elements(first, context)), *map(elements, more))  # noqa: B905  the shortest decides
    if isinstance(first, Cons):
        return _cars(first)
    return zip(in_turns(elements(first, context)))  # noqa: B905


def _cars(lst):
    for cell in cells(lst):
        yield (cell.car,)


def map_(result_type, function, sequence, *sequences):
    """``map``: a sequence of type ``result_type`` of what ``function`` gives for the elements; nil if the type is nil."""
    function = function_of(function)
    rows = _rows(sequence, sequences)
    if result_type is None or result_type is False:
        for row in rows:
            function(*row)
        return None
    wanted = sequence_type(result_type)
    function = primary(function)
    return wanted.make([function(*row) for row in rows])


def map_into(target, function, *sequences):
    """``map-into``: store what ``function`` gives for the elements into ``target``; a fill pointer is set to the end."""
    function = primary(function_of(function, "\nwhen binding FUNCTION"))
    if isinstance(target, Vector):
        whole = target.dimensions[0]
    else:
        whole = len(target.chars) if isinstance(target, LispString) else len(elements(target))
    sources = [elements(sequence) for sequence in sequences]
    count = min([whole, *map(len, sources)])
    results = [function(*(source[index] for source in sources)) for index in in_turns(range(count))]
    if getattr(target, "fill_pointer", None) is not None:
        target.fill_pointer = count
    store_all(target, 0, results)
    return target


def reduce(function, sequence, *, key=None, from_end=None, start=0, end=None, initial_value=UNSUPPLIED):
    """``reduce``: combine the elements with a function of two arguments; without elements call it with none."""
    function = function_of(function, "\nwhen binding FUNCTION")
    items = part(sequence, start, end)
    if key is None and from_end is None and function is PLUS.function and initial_value is UNSUPPLIED and {*map(type, items)} == {int}:
        return sum(items)
    key = key_of(key)
    if from_end is not None and from_end is not False:
        items = items[::-1]
        combine = _swapped(function)
    else:
        combine = function
    remaining = iter(in_turns(items)) if key is None else map(key, in_turns(items))
    if initial_value is UNSUPPLIED:
        if not items:
            return function()
        value = next(remaining)
    else:
        value = initial_value
    for item in remaining:
        value = combine(value, item)
        if value.__class__ is MultipleValues:
            value = value[0] if len(value) else None
    return value


def _swapped(function):
    return lambda value, item: function(item, value)


_FIRST = "\nwhen binding SB-IMPL::FIRST-SEQ"


def every(predicate, sequence, *sequences):
    """``every``: whether ``predicate`` accepts all elements."""
    predicate = _predicate(predicate)
    if not sequences and sequence.__class__ is Cons:
        for cell in cells(sequence, _FIRST):
            if (answer := predicate(cell.car)) is None or answer is not True and not holds(answer):
                return None
        return True
    return True if all(holds(predicate(*row)) for row in _rows(sequence, sequences, _FIRST)) else None


def some(predicate, sequence, *sequences):
    """``some``: the first true answer of ``predicate``, or nil."""
    predicate = _predicate(predicate)
    if not sequences and sequence.__class__ is Cons:
        for cell in cells(sequence, _FIRST):
            if (answer := predicate(cell.car)) is not None and (answer is True or holds(answer)):
                return one(answer)
        return None
    predicate = primary(predicate)
    for row in _rows(sequence, sequences, _FIRST):
        answer = predicate(*row)
        if answer is not None and answer is not False:
            return answer
    return None


def notany(predicate, sequence, *sequences):
    """``notany``: whether ``predicate`` accepts no element."""
    predicate = _predicate(predicate)
    return None if any(holds(predicate(*row)) for row in _rows(sequence, sequences, _FIRST)) else True


def notevery(predicate, sequence, *sequences):
    """``notevery``: whether ``predicate`` rejects an element."""
    return None if every(predicate, sequence, *sequences) else True


def _predicate(predicate):
    return function_of(predicate, "\nwhen binding SB-IMPL::PRED")
