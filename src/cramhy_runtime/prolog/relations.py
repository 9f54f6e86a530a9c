"""Relations: predicates that consist of ground facts only, kept as tables.

A goal says which arguments it knows. For each such combination an index from the known values to rows is made when it is first
asked for; then answering means to walk the rows that fit and set the unknown arguments. The order of answers is that of the facts.
"""

from __future__ import annotations

from cramhy_runtime.lisp.data import DoubleFloat, Keyword, Symbol
from cramhy_runtime.lisp.equality import equal_key

from cramhy_runtime.utilities.lazy_lists import LazyTail
from .machine import fail
from .terms import UNSET, TermTail, Var, undo, unify

_BY_VALUE = frozenset([int, str, float, DoubleFloat])


def index_key(atom):
    """The key of ``atom`` in an index, equal for atoms that are `same_atom`; ``NotImplemented`` for what is compared otherwise."""
    kind = atom.__class__
    if kind is Symbol or kind is Keyword or atom is None:
        return atom
    return equal_key(atom) if kind in _BY_VALUE or atom is True else NotImplemented  # `t` is Python's True, which is 1 in a dict


def compile_relation(rows):
    """The call function for goals over the ground facts ``rows``, each the list of its arguments."""
    rows = [tuple(row) for row in rows]
    arity = len(rows[0])
    if not arity:
        return _constant(len(rows))
    indexable = [all(index_key(row[i]) is not NotImplemented for row in rows) for i in range(arity)]
    indexes = {}
    positions = range(arity)
    every = rows

    def call(m, step):
        k = step[1]
        known, unknown, mask, fuzzy = [], [], 0, None
        i = 0
        for term in step[2:]:
            while term.__class__ is Var:
                value = term.ref
                if value is UNSET:
                    break
                term = value
            kind = term.__class__
            if kind is Var:
                if term in unknown:
                    fuzzy = True
                unknown.append(term)
            else:
                if kind is Symbol:
                    key = term
                elif kind is LazyTail or kind is TermTail or not indexable[i]:
                    key = NotImplemented
                else:
                    key = index_key(term)
                if key is NotImplemented:
                    fuzzy = True
                    if indexable[i] and kind is not LazyTail and kind is not TermTail:
                        return fail(m)
                    unknown.append(term)
                else:
                    known.append(key)
                    mask |= 1 << i
            i += 1
        if mask:
            index = indexes.get(mask)
            if index is None:
                index = indexes[mask] = _index(every, mask, positions)
            found = index.get(known[0] if len(known) == 1 else tuple(known))
            if found is None:
                return fail(m)
        else:
            found = every if arity > 1 else [row[0] for row in every]
        if fuzzy:
            return _unify_rows(m, k, found, unknown, 0)
        if not unknown:
            if len(found) > 1:
                m.choices.append((len(m.trail), (_again, k, len(found) - 1)))
            return k
        if len(unknown) == 1:
            return _set_one(m, (None, k, found, 0, unknown[0]))
        return _set_many(m, (None, k, found, 0, unknown))

    return call


def _index(rows, mask, positions):
    """Known values → for each row that fits, its unknown values (the bare value when there is one, the row when none)."""
    known = [i for i in positions if mask >> i & 1]
    unknown = [i for i in positions if not mask >> i & 1]
    index = {}
    for row in rows:
        keys = [index_key(row[i]) for i in known]
        rest = row[unknown[0]] if len(unknown) == 1 else tuple(row[i] for i in unknown)
        index.setdefault(keys[0] if len(keys) == 1 else tuple(keys), []).append(rest)
    return index


def _set_one(m, step):
    _, k, rows, i, variable = step
    trail = m.trail
    if i + 1 < len(rows):
        m.choices.append((len(trail), (_set_one, k, rows, i + 1, variable)))
    variable.ref = rows[i]
    trail.append(variable)
    return k


def _set_many(m, step):
    _, k, rows, i, variables = step
    trail = m.trail
    if i + 1 < len(rows):
        m.choices.append((len(trail), (_set_many, k, rows, i + 1, variables)))
    for variable, value in zip(variables, rows[i]):
        variable.ref = value
    trail += variables
    return k


def _again(m, step):
    _, k, count = step
    if count > 1:
        m.choices.append((len(m.trail), (_again, k, count - 1)))
    return k


def _retry(m, step):
    return _unify_rows(m, step[1], step[2], step[3], step[4])


def _unify_rows(m, k, rows, terms, i):
    """The general case: an argument is a list, or a variable occurs twice."""
    trail = m.trail
    height = len(trail)
    single = len(terms) == 1
    while i < len(rows):
        row = rows[i]
        i += 1
        if unify(terms[0], row, trail) if single else all(unify(term, value, trail) for term, value in zip(terms, row)):
            if i < len(rows):
                m.choices.append((height, (_retry, k, rows, terms, i)))
            return k
        undo(trail, height)
    return fail(m)


def _constant(count):
    """Facts without arguments: succeed once for each."""

    def call(m, step):
        if count > 1:
            m.choices.append((len(m.trail), (_again, step[1], count - 1)))
        return step[1]

    return call


