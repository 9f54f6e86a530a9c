"""Looking into sequences: ``find``, ``position``, ``count``, ``search``, ``mismatch``.

Each has the keywords ``:key :test :test-not :start :end :from-end`` and variants that take a predicate. A list is walked
without copying it, so that an early find costs little and circular lists can be searched.

Source: ANSI 17.2.1 and 17.3; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import STRETCH, TEXTS, Character, Cons
from cramhy_runtime.lisp_core.equality import EQUAL_TO_THEMSELVES, eql
from cramhy_runtime.lisp_core.functions import accepted, function_of, holds, match_of, predicate_of, test_of, values_of
from cramhy_runtime.kernel.active import checkpoint
from .lists import cells
from .sequence_types import bounds, elements, in_turns, part, span

LISP_NAMES = """
find find-if find-if-not position position-if position-if-not count count-if count-if-not search mismatch
"""


def _found_among(item, sequence):
    """The place of ``item``, by ``eql``, in a whole sequence: its index, or -1; ``None`` if it is to be looked for another way."""
    cls = sequence.__class__
    if cls in TEXTS:
        return sequence.find(item.char) if item.__class__ is Character else None
    if item.__class__ is not int and item.__class__ not in EQUAL_TO_THEMSELVES:
        return None
    if cls is Cons:
        index, cell, number = 0, sequence, item.__class__ is int
        while True:
            for _ in STRETCH:
                if cell.__class__ is not Cons:
                    return -1 if cell is None else None
                each = cell.car
                if each is item or number and each.__class__ is int and each == item:
                    return index
                cell = cell.cdr
                index += 1
            checkpoint()
    return None


def _walk(match, cell):
    """(element, index) of the first element of the list that matches, or ``None``."""
    for index, each in enumerate(cells(cell, "\nwhen binding SEQUENCE")):
        if match(each.car):
            return each.car, index
    return None


def _first(match, sequence, from_end, start, end):
    """(element, index) of the first (or last) element between the bounds that matches, or ``None``."""
    backwards = from_end is not None and from_end is not False
    if isinstance(sequence, Cons) and start == 0 and end is None and not backwards:
        return _walk(match, sequence)
    items = elements(sequence)
    wanted_end, size = end, len(items)
    if (sequence is None or isinstance(sequence, Cons)) and start.__class__ is int and start >= 0:
        # SBCL walks a list before it looks at the bounds: it misses a :start or :end behind the list if it can answer without.
        if end is None and start > size:
            return None
        if not backwards and end.__class__ is int and start <= size < end:
            end = size
    start, end = bounds(start, end, size)
    if backwards and isinstance(sequence, Cons):  # a list is walked from its beginning, as in SBCL
        matching = [index for index in in_turns(range(start, end)) if match(items[index])]
        return (items[matching[-1]], matching[-1]) if matching else None
    for index in in_turns(range(end - 1, start - 1, -1) if backwards else range(start, end)):
        if match(items[index]):
            return items[index], index
    if end is not wanted_end and wanted_end is not None:
        bounds(start, wanted_end, size)
    return None


def find(item, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, key=None):
    """``find``: the first element that matches ``item``, or nil."""
    if key is None is test and test_not is None is end and from_end is None and start == 0:
        index = _found_among(item, sequence)
        if index is not None:
            return None if index < 0 else item
    found = _first(match_of(item, key, test, test_not), sequence, from_end, start, end)
    return None if found is None else found[0]


def find_if(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``find-if``: the first element that ``predicate`` accepts, or nil."""
    if sequence.__class__ is Cons and key is None is end and from_end is None and start == 0:
        predicate = function_of(predicate, "\nwhen binding SB-IMPL::PREDICATE")
        for cell in cells(sequence):
            if (answer := predicate(cell.car)) is not None and (answer is True or holds(answer)):
                return cell.car
        return None
    found = _first(predicate_of(predicate, key), sequence, from_end, start, end)
    return None if found is None else found[0]


def find_if_not(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``find-if-not``: the first element that ``predicate`` rejects, or nil."""
    found = _first(predicate_of(predicate, key, wanted=False), sequence, from_end, start, end)
    return None if found is None else found[0]


def position(item, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, key=None):
    """``position``: the index of the first element that matches ``item``, or nil."""
    if sequence.__class__ in TEXTS and item.__class__ is Character and key is None and test is None and test_not is None:
        start, end = bounds(start, end, len(sequence))
        index = (sequence.find if from_end is None else sequence.rfind)(item.char, start, end)
        return None if index < 0 else index
    if key is None is test and test_not is None is end and from_end is None and start == 0:
        index = _found_among(item, sequence)
        if index is not None:
            return None if index < 0 else index
    found = _first(match_of(item, key, test, test_not), sequence, from_end, start, end)
    return None if found is None else found[1]


def position_if(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``position-if``: the index of the first element that ``predicate`` accepts, or nil."""
    found = _first(predicate_of(predicate, key), sequence, from_end, start, end)
    return None if found is None else found[1]


def position_if_not(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``position-if-not``: the index of the first element that ``predicate`` rejects, or nil."""
    found = _first(predicate_of(predicate, key, wanted=False), sequence, from_end, start, end)
    return None if found is None else found[1]


def _count(match, sequence, from_end, start, end):
    items = part(sequence, start, end)
    if from_end is not None and from_end is not False:
        items = items[::-1]
    return sum(1 for item in in_turns(items) if match(item))


def count(item, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, key=None):
    """``count``: how many elements match ``item``."""
    return _count(match_of(item, key, test, test_not), sequence, from_end, start, end)


def count_if(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``count-if``: how many elements ``predicate`` accepts."""
    if key is None is end and from_end is None and start == 0:
        return len(accepted(function_of(predicate, "\nwhen binding SB-IMPL::PREDICATE"), in_turns(elements(sequence))))
    return _count(predicate_of(predicate, key), sequence, from_end, start, end)


def count_if_not(predicate, sequence, *, from_end=None, start=0, end=None, key=None):
    """``count-if-not``: how many elements ``predicate`` rejects."""
    return _count(predicate_of(predicate, key, wanted=False), sequence, from_end, start, end)


def _comparison(test, test_not):
    return test_of(test, test_not) or (lambda first, second: first is second or eql(first, second) is not None)


def _keyed(items, key):
    if key is None or key is False:
        return items
    return values_of(function_of(key, "\nwhen binding SB-IMPL::KEY"), in_turns(items))


def search(pattern, sequence, *, from_end=None, test=None, test_not=None, key=None, start1=0, end1=None, start2=0, end2=None):
    """``search``: the index in ``sequence`` where the elements of ``pattern`` stand in a row, or nil."""
    context = "\nwhen binding SB-IMPL::SUB-SEQUENCE1"
    if pattern.__class__ in TEXTS and sequence.__class__ in TEXTS and test is None is test_not and key is None:
        first, last = bounds(start1, end1, len(pattern))
        start, end = bounds(start2, end2, len(sequence))
        backwards = from_end is not None and from_end is not False
        found = (sequence.rfind if backwards else sequence.find)(pattern[first:last], start, end)
        return None if found < 0 else found
    wanted = elements(pattern, context)
    first, last = bounds(start1, end1, len(wanted))
    items, start, end = span(sequence, start2, end2)
    wanted, items, compare = _keyed(wanted[first:last], key), _keyed(items, key), _comparison(test, test_not)
    places = range(start, end - len(wanted) + 1)
    backwards, found = from_end is not None and from_end is not False, None
    keep_on = backwards and (test is not None or test_not is not None)  # SBCL asks forwards, too, and takes the last: a test may notice
    for place in in_turns(places[::-1] if backwards and not keep_on else places):
        if all(compare(one, items[place + offset]) for offset, one in enumerate(in_turns(wanted))):
            found = place
            if not keep_on:
                break
    return found


def mismatch(first, second, *, from_end=None, test=None, test_not=None, key=None, start1=0, end1=None, start2=0, end2=None):
    """``mismatch``: the index in ``first`` where the two differ, or nil; ``from_end`` aligns their ends."""
    items, first_start, first_end = span(first, start1, end1)
    others = _keyed(part(second, start2, end2), key)
    items, compare = _keyed(items[first_start:first_end], key), _comparison(test, test_not)
    shorter = min(len(items), len(others))
    if from_end is not None and from_end is not False:
        for back in in_turns(range(1, shorter + 1)):
            if not compare(items[-back], others[-back]):
                return first_end - back + 1
        return None if len(items) == len(others) else first_end - shorter
    for index in in_turns(range(shorter)):
        if not compare(items[index], others[index]):
            return first_start + index
    return None if len(items) == len(others) else first_start + shorter
