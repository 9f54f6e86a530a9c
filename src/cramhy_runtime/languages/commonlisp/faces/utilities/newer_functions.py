"""Functions that CRAM-UTILITIES has since CRAM's branch devel, and that need Common Lisp: numbers at random, tables, texts."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Character, Cons, FreshString, one, python_list, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import sym


def random_with_minimum(value, offset):
    """A random number, at least ``offset`` and below ``value``, of their type. ``value`` must be the larger one."""
    return sym("RANDOM").function(value - offset) + offset


def recursive_alist_hash_table(alist, *hash_table_initargs):
    """The hash table of an association list, whose values that are lists become hash tables in turn. Of equal keys the first counts.

    hash_table_initargs: those of ``make-hash-table``, such as ``:test #'equal``.
    """
    table = sym("MAKE-HASH-TABLE").function(*hash_table_initargs)
    for pair in python_list(alist):
        if pair.car not in table:
            nested = pair.cdr is None or isinstance(pair.cdr, Cons)
            table[pair.car] = recursive_alist_hash_table(pair.cdr, *hash_table_initargs) if nested else pair.cdr
    return table


def replace_all(string, part, replacement, *, test=None):
    """A new string: ``string`` with ``replacement`` in the place of each ``part``.

    test: a function that compares two characters, ``char=`` if it is not given. Errors: an empty part.
    """
    text, part, replacement = str(string), str(part), str(replacement)
    if not part:
        return error("The text to replace is empty.")
    if test is None:
        return FreshString(text.replace(part, replacement))
    same, made, at = function_of(test), [], 0
    while at < len(text):
        if at + len(part) <= len(text) and all(truth(one(same(Character(a), Character(b)))) for a, b in zip(part, text[at:])):
            made.append(replacement)
            at += len(part)
        else:
            made.append(text[at])
            at += 1
    return FreshString("".join(made))
