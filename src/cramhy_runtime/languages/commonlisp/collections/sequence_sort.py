"""Sorting and merging: ``sort``, ``stable-sort``, ``merge``.

Python's sort asks only "is this before that?", as Lisp's predicate answers, and is stable; so ``sort`` is stable too.
A sequence is sorted in place: its conses or its storage stay, only the elements change places. Therefore a caller who ignores
the result has the whole sorted sequence, which the standard allows and SBCL does not do for lists.

Source: ANSI 17.3; texts are SBCL's.
"""

from __future__ import annotations

from functools import cmp_to_key

from cramhy_runtime.lisp_core.equality import is_number
from cramhy_runtime.lisp_core.functions import directly, function_of, holds, key_of, values_of
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.kernel.active import checkpoint
from .sequence_types import elements, in_turns, same_kind, sequence_type, store_all

LESS, GREATER = sym("<"), sym(">")
LISP_NAMES = "sort stable-sort merge"

RUN = 20_000
"""So many numbers Python sorts at once: nothing can interrupt it meanwhile."""

_CONTEXT = "\nwhen binding SB-IMPL::PREDICATE"


def _ordered(items, predicate, key):
    """A new Python list of ``items`` in the order of the predicate."""
    plain = key is None or key is False
    keys = items if plain else values_of(function_of(key, "\nwhen binding SB-IMPL::KEY"), in_turns(items))
    if predicate is LESS.function or predicate is GREATER.function:
        if _comparable(keys):
            if plain and len(items) <= RUN:
                return sorted(items, reverse=predicate is GREATER.function)
            indices = _numbered(keys, predicate is GREATER.function)
            return [items[index] for index in in_turns(indices)]
    predicate = directly(predicate)

    def compared(one, other):
        """Negative where ``one`` comes before ``other``. Python's sort asks nothing else."""
        checkpoint()
        answer = predicate(one, other)
        return -1 if answer is not None and (answer is True or holds(answer)) else 0

    in_order = cmp_to_key(compared)
    if plain:
        return sorted(items, key=in_order)
    places = list(map(in_order, keys))
    return [items[index] for index in sorted(range(len(keys)), key=places.__getitem__)]


def _comparable(keys):
    """Whether Python compares ``keys`` as ``<`` does: real numbers, none of which is a NaN."""
    classes = {*map(type, keys)}
    if classes <= {int}:
        return True
    return all(is_number(one) and one.__class__ is not complex and one == one for one in in_turns(keys))


def _numbered(keys, descending):
    """The indices of the numbers ``keys`` in their order. Many are sorted in runs, which are merged, with a checkpoint after each."""
    order = {"key": keys.__getitem__, "reverse": descending}
    runs = []
    for start in range(0, len(keys), RUN):
        checkpoint()
        runs.append(sorted(range(start, min(start + RUN, len(keys))), **order))
    while len(runs) > 1:  # Python's sort finds two runs and merges them
        merged = []
        for pair in range(0, len(runs), 2):
            checkpoint()
            merged.append(sorted(runs[pair] + runs[pair + 1], **order) if pair + 1 < len(runs) else runs[pair])
        runs = merged
    return runs[0] if runs else []


def sort(sequence, predicate, *, key=None):
    """``sort``: ``sequence`` with its elements in the order of ``predicate``, in place (a plain string: a new one)."""
    items = elements(sequence, "\nwhen binding SEQUENCE")
    items = _ordered(items, function_of(predicate, _CONTEXT), key)
    if sequence.__class__ is str:
        return same_kind(sequence, items)
    store_all(sequence, 0, items)
    return sequence


def stable_sort(sequence, predicate, *, key=None):
    """``stable-sort``: as `sort`; equal elements keep their order."""
    return sort(sequence, predicate, key=key)


def merge(result_type, first, second, predicate, *, key=None):
    """``merge``: a sequence of the elements of two sorted ones, in order; of equals those of ``first`` come first."""
    wanted = sequence_type(result_type)
    left, right = elements(first, "\nwhen binding SEQUENCE"), elements(second, "\nwhen binding SEQUENCE")
    predicate, key = function_of(predicate, _CONTEXT), key_of(key)
    result, i, j = [], 0, 0
    while i < len(left) and j < len(right):
        checkpoint()
        x, y = (left[i], right[j]) if key is None else (key(left[i]), key(right[j]))
        if holds(predicate(y, x)):
            result.append(right[j])
            j += 1
        else:
            result.append(left[i])
            i += 1
    return wanted.make(result + left[i:] + right[j:])
