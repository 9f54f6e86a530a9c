"""Removing and replacing elements: ``remove``, ``substitute``, ``remove-duplicates`` and their destructive forms.

``delete`` takes conses out of the list that it is given, so that a caller who ignores the result sees what he would see in
SBCL; on vectors it does what ``remove`` does, and lowers a fill pointer.

Source: ANSI 17.3; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, LispString
from cramhy_runtime.lisp_core.equality import eql_key
from cramhy_runtime.lisp_core.functions import accepted, function_of, key_of, match_of, predicate_of, test_of
from cramhy_runtime.kernel.active import checkpoint
from .sequence_types import elements, in_turns, limit, same_kind, span, store_all
from cramhy_runtime.lisp_core.arrays import Vector

LISP_NAMES = """
remove remove-if remove-if-not delete delete-if delete-if-not remove-duplicates delete-duplicates
substitute substitute-if substitute-if-not nsubstitute nsubstitute-if nsubstitute-if-not
"""


def _chosen(match, sequence, from_end, start, end, count):
    """(elements, set of the indices of those that match), at most ``count`` of them; from the end if asked, with or without ``count``."""
    most = limit(count)
    items, start, end = span(sequence, start, end)
    backwards = from_end is not None and from_end is not False
    order = range(end - 1, start - 1, -1) if backwards else range(start, end)
    if most is None:
        return items, {index for index in in_turns(order) if match(items[index])}
    chosen = set()
    for index in in_turns(order):
        if len(chosen) >= most:
            break
        if match(items[index]):
            chosen.add(index)
    return items, chosen


def _whole(predicate, sequence, wanted):
    """``sequence`` without the elements that ``predicate`` accepts, or only them if they are ``wanted``."""
    function = function_of(predicate, "\nwhen binding SB-IMPL::PREDICATE")
    return same_kind(sequence, accepted(function, in_turns(elements(sequence)), wanted))


def _removed(match, sequence, from_end, start, end, count):
    if count is None and end is None and start == 0 and from_end is None:
        return same_kind(sequence, [item for item in in_turns(elements(sequence)) if not match(item)])
    items, chosen = _chosen(match, sequence, from_end, start, end, count)
    return same_kind(sequence, [item for index, item in enumerate(in_turns(items)) if index not in chosen])


def _deleted(match, sequence, from_end, start, end, count):
    items, chosen = _chosen(match, sequence, from_end, start, end, count)
    return _without(sequence, items, chosen)


def _without(sequence, items, chosen):
    """``sequence`` without the elements of the indices ``chosen``: a list and a fill-pointer vector are changed."""
    if isinstance(sequence, Cons):
        head = previous = Cons(None, sequence)
        cell, index = sequence, 0
        while isinstance(cell, Cons):
            if index in chosen:
                previous.cdr = cell.cdr
            else:
                previous = cell
            cell, index = cell.cdr, index + 1
        return head.cdr
    kept = [item for index, item in enumerate(in_turns(items)) if index not in chosen]
    if isinstance(sequence, (Vector, LispString)) and sequence.fill_pointer is not None:
        store_all(sequence, 0, kept)
        sequence.fill_pointer = len(kept)
        return sequence
    return same_kind(sequence, kept)


def remove(item, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, count=None, key=None):
    """``remove``: a sequence without the elements that match ``item``."""
    return _removed(match_of(item, key, test, test_not), sequence, from_end, start, end, count)


def remove_if(predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``remove-if``: a sequence without the elements that ``predicate`` accepts."""
    if key is None is count and end is None is from_end and start == 0:
        return _whole(predicate, sequence, False)
    return _removed(predicate_of(predicate, key), sequence, from_end, start, end, count)


def remove_if_not(predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``remove-if-not``: a sequence of only the elements that ``predicate`` accepts."""
    if key is None is count and end is None is from_end and start == 0:
        return _whole(predicate, sequence, True)
    return _removed(predicate_of(predicate, key, wanted=False), sequence, from_end, start, end, count)


def delete(item, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, count=None, key=None):
    """``delete``: as `remove`, using up the argument."""
    return _deleted(match_of(item, key, test, test_not), sequence, from_end, start, end, count)


def delete_if(predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``delete-if``: as `remove_if`, using up the argument."""
    return _deleted(predicate_of(predicate, key), sequence, from_end, start, end, count)


def delete_if_not(predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``delete-if-not``: as `remove_if_not`, using up the argument."""
    return _deleted(predicate_of(predicate, key, wanted=False), sequence, from_end, start, end, count)


# --------------------------------------------------------------------------------------------------------------- duplicates


def _duplicates(sequence, from_end, test, test_not, start, end, key, among_all=False):
    """(elements, set of the indices of those that occur again); the last one of equals stays, or the first if ``from_end``."""
    compare, key = test_of(test, test_not), key_of(key)
    items, start, end = span(sequence, start, end)
    keyed = items[start:end] if key is None else [key(item) for item in in_turns(items[start:end])]
    first_stays = from_end is not None and from_end is not False
    if compare is None:
        return items, _repeated(keyed, start, first_stays)
    count = len(keyed)
    if first_stays:
        chosen = _later_ones(keyed, compare, among_all)
    else:
        chosen = set()
        for index in range(count):
            checkpoint()
            if any(compare(keyed[index], keyed[other]) for other in in_turns(range(index + 1, count))):
                chosen.add(index)
    return items, {start + index for index in chosen}


def _later_ones(keyed, compare, among_all):
    # As SBCL asks: the later element first, and on vectors and in delete-duplicates only against those that stay.
    chosen, others = set(), []
    for index, one in enumerate(keyed):
        checkpoint()
        if any(compare(one, other) for other in in_turns(others)):
            chosen.add(index)
            if not among_all:
                continue
        others.append(one)
    return chosen


def _repeated(keyed, start, first_stays):
    chosen, seen = set(), set()
    for index in in_turns(range(len(keyed)) if first_stays else range(len(keyed) - 1, -1, -1)):
        name = eql_key(keyed[index])
        if name in seen:
            chosen.add(start + index)
        seen.add(name)
    return chosen


def remove_duplicates(sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, key=None):
    """``remove-duplicates``: a sequence in which no two elements match; the last of equals stays, unless ``from_end``."""
    among_all = isinstance(sequence, Cons)
    items, chosen = _duplicates(sequence, from_end, test, test_not, start, end, key, among_all)
    return same_kind(sequence, [item for index, item in enumerate(in_turns(items)) if index not in chosen])


def delete_duplicates(sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, key=None):
    """``delete-duplicates``: as `remove_duplicates`, using up the argument."""
    return _without(sequence, *_duplicates(sequence, from_end, test, test_not, start, end, key))


# ------------------------------------------------------------------------------------------------------------- substitution


def _substituted(new, match, sequence, from_end, start, end, count):
    items, chosen = _chosen(match, sequence, from_end, start, end, count)
    return same_kind(sequence, [new if index in chosen else item for index, item in enumerate(in_turns(items))])


def _nsubstituted(new, match, sequence, from_end, start, end, count):
    items, chosen = _chosen(match, sequence, from_end, start, end, count)
    if sequence.__class__ is str:
        return same_kind(sequence, [new if index in chosen else item for index, item in enumerate(in_turns(items))])
    store_all(sequence, 0, [new if index in chosen else item for index, item in enumerate(in_turns(items))])
    return sequence


def substitute(new, old, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, count=None, key=None):
    """``substitute``: a sequence with ``new`` for the elements that match ``old``."""
    return _substituted(new, match_of(old, key, test, test_not), sequence, from_end, start, end, count)


def substitute_if(new, predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``substitute-if``: a sequence with ``new`` for the elements that ``predicate`` accepts."""
    return _substituted(new, predicate_of(predicate, key), sequence, from_end, start, end, count)


def substitute_if_not(new, predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``substitute-if-not``: a sequence with ``new`` for the elements that ``predicate`` rejects."""
    return _substituted(new, predicate_of(predicate, key, wanted=False), sequence, from_end, start, end, count)


def nsubstitute(new, old, sequence, *, from_end=None, test=None, test_not=None, start=0, end=None, count=None, key=None):
    """``nsubstitute``: as `substitute`, in place."""
    return _nsubstituted(new, match_of(old, key, test, test_not), sequence, from_end, start, end, count)


def nsubstitute_if(new, predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``nsubstitute-if``: as `substitute_if`, in place."""
    return _nsubstituted(new, predicate_of(predicate, key), sequence, from_end, start, end, count)


def nsubstitute_if_not(new, predicate, sequence, *, from_end=None, start=0, end=None, count=None, key=None):
    """``nsubstitute-if-not``: as `substitute_if_not`, in place."""
    return _nsubstituted(new, predicate_of(predicate, key, wanted=False), sequence, from_end, start, end, count)
