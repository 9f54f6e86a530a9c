"""What runs inside the loops that LOOP makes: collecting at the tail of a list, walking tables, packages and vectors.

The expansion calls these functions through symbols of the package CRAMHY. Collecting adds a cell behind the last one, so a loop
that collects is linear; the list under construction hangs behind a header cell.
"""

from __future__ import annotations

from ..collections.arrays import vectorp
from cramhy_runtime.lisp_core.hash_tables import maphash
from ..collections.lists import not_a_list
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Cons, list_from, new_object
from cramhy_runtime.lisp_core.packages import find_package_or_error, intern

NEXT_LOOP, END_LOOP = intern("NEXT-LOOP", "CRAMHY"), intern("END-LOOP", "CRAMHY")
"""The tags of a loop. ``(go cramhy::end-loop)`` is what ``loop-finish`` does."""


def car_of_cons(cell):
    """``car`` of what is known to be a cons; the compiler makes an attribute of it."""
    return cell.car


def cdr_of_cons(cell):
    """``cdr`` of what is known to be a cons."""
    return cell.cdr


def end_of_list(atom):
    """Nothing, where a list ends; an error where something else stands in its place."""
    return None if atom is None or atom is False else not_a_list(atom)


def collect(tail, item):
    """Add a cell with ``item`` behind the cell ``tail``; the new last cell."""
    cell = tail.cdr = Cons(item)
    return cell


def collect_append(tail, items):
    """Add a copy of the list ``items`` behind the cell ``tail``; the new last cell."""
    if items is not None and not isinstance(items, Cons):
        return type_error(items, "LIST", "\nwhen binding LIST")
    while items.__class__ is Cons:
        cell = tail.cdr = new_object(Cons)
        cell.car, cell.cdr = items.car, None
        tail, items = cell, items.cdr
    if items is not None:
        tail.cdr = items
    return tail


def collect_nconc(tail, items):
    """Add the list ``items`` itself behind the cell ``tail``; the new last cell."""
    if items is not None:
        tail.cdr = items
    while isinstance(tail.cdr, Cons):
        tail = tail.cdr
    return tail


def loop_vector(vector):
    """``vector``, which must be one."""
    return vector if vectorp(vector) else type_error(vector, "VECTOR")


def table_entries(table):
    """The pairs (key . value) of a hash table as they are now: the loop may change and remove what it visits."""
    pairs = []
    maphash(lambda key, value: pairs.append(Cons(key, value)), table)
    return list_from(pairs)


def loop_symbols(kind, package):
    """The symbols of a package: ``kind`` is ``SYMBOLS`` (accessible), ``PRESENT-SYMBOLS`` or ``EXTERNAL-SYMBOLS``."""
    found = []
    for each in list(package) if isinstance(package, Cons) else [package]:
        source = find_package_or_error(each)
        tables = [source.external] if kind == "EXTERNAL-SYMBOLS" else [source.external, source.internal]
        if kind == "SYMBOLS":
            tables += [other.external for other in source.use]
        for table in tables:
            found += [symbol for name, symbol in table.items() if source.lookup(name)[0] is symbol]
    return list_from(list(dict.fromkeys(found)))


CAR_OF_CONS, CDR_OF_CONS, END_OF_LIST, COLLECT, COLLECT_APPEND, COLLECT_NCONC, LOOP_VECTOR, TABLE_ENTRIES, LOOP_SYMBOLS = (
    intern(name, "CRAMHY")
    for name in """CAR-OF-CONS CDR-OF-CONS END-OF-LIST COLLECT COLLECT-APPEND COLLECT-NCONC LOOP-VECTOR TABLE-ENTRIES
    LOOP-SYMBOLS""".split()
)
"""The symbols of these functions; `package.fill` defines them, because kept code calls them without LOOP having been loaded."""
