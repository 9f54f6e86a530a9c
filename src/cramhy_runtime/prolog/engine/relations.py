"""Relations: predicates that consist of ground facts only, kept as tables.

Some arguments of a goal are known. For each combination of known arguments, a table from the known values to rows is made when it is
first needed. To answer a goal, the relation goes through the rows that fit and sets the unknown arguments. Answers come in the order of
the facts.

The call function of a relation is written for its number of arguments: it is a tree of tests for known arguments. Lists among the
values, and a variable that occurs twice, are handled in general: rows that may fit (lists are found by their first symbol) are unified.
"""

from __future__ import annotations

import gc
from collections import defaultdict
from functools import lru_cache
from itertools import islice

from cramhy_runtime.lisp_core.data import FLOATS, Cons, Keyword, Symbol
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.generated_functions import generated_function

from .list_shapes import FEW, ListedRows, index_key
from .machine import fail
from ..terms.terms import UNSET, Var, deref, unify

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .database import Clause
    from .machine import Machine

    Rows = Sequence[Any]  # tuples of values, or the values of the only column

_SYMBOLS = {Symbol, Keyword}
_OWN_KEYS = {Symbol, Keyword, int, str, type(None)}
"""The kinds of atoms that are their own key."""
_MANY = 1000
"""So many rows are worth a look through the columns instead of a table, when somebody asks for the first time."""
_SAMPLE = 500
"""So many rows are looked at in order to guess whether each has a key of its own."""
_CONSTANTS = {int, str, *FLOATS, type(None), bool}
"""The kinds of atoms that are never variables."""


def column_key(term: Any) -> Any:
    """As `index_key`. Lists that begin with the same symbol have the same key."""
    if term.__class__ is Cons:
        first = deref(term.car)
        return (first,) if first.__class__ is Symbol or first.__class__ is Keyword else NotImplemented
    return index_key(term)


class Relation:
    """The rows of a relation and the tables made of them. ``exact`` says that every value is an atom with a key of its own.

    The rows are kept by columns, since Python looks through a list of 100,000 values in a hundredth of the time of a loop over rows.
    """

    def __init__(self, columns: Sequence[list[Any]], count: int, kinds: list[set[type]]):
        """``columns``: for each argument the list of its values in all ``count`` rows; ``kinds``: the set of their classes."""
        self.columns, self.count = columns, count
        self.arity = len(columns)
        self.keys = [
            column if found <= _OWN_KEYS else [column_key(value) for value in column] for column, found in zip(columns, kinds, strict=True)
        ]
        self.keyed = [keys is column or NotImplemented not in keys for keys, column in zip(self.keys, columns, strict=True)]
        self.lists = [Cons in found for found in kinds]
        self.exact = all(self.keyed) and not any(self.lists)
        self._tables: dict[tuple[int, tuple[int, ...] | None], Any] = {}
        self._asked: set[tuple[int, tuple[int, ...] | None]] = set()

    def rows(self, mask: int, kept: tuple[int, ...] | None, key: Any) -> Any:
        """The rows of `table` for ``key``, or ``None``. Who asks for the first time gets them without a table, if that would be long."""
        if mask and self.exact and self.count > _MANY and (mask, kept) not in self._asked:
            self._asked.add((mask, kept))
            return self._looked_up([i for i in range(self.arity) if mask >> i & 1], self._kept(mask, kept), key)
        return self.table(mask, kept).get(key)

    def _looked_up(self, known: list[int], kept: Sequence[int], key: Any) -> Any:
        """What a table of the columns ``known`` has for ``key``."""
        first, *others = zip(known, [key] if len(known) == 1 else key)
        places = _places(self.keys[first[0]], first[1])
        for i, value in others:
            keys = self.keys[i]
            places = [place for place in places if keys[place] == value]
        columns = [[self.columns[i][place] for place in places] for i in kept]
        return [*_side_by_side(columns, len(places))] or None

    def _kept(self, mask: int, kept: tuple[int, ...] | None) -> Sequence[int]:
        return [i for i in range(self.arity) if not mask >> i & 1] if kept is None else kept

    def table(self, mask: int, kept: tuple[int, ...] | None = None) -> Any:
        """A dict: known values → for each row that fits, a tuple with the values of the columns ``kept`` (default: the unknown ones).

        Bit i of ``mask`` is set if argument i is known. A single known or kept value stands without a tuple.
        """
        table = self._tables.get((mask, kept))
        if table is None:
            columns = self._kept(mask, kept)
            collecting = gc.isenabled()
            gc.disable()  # all that is made now is kept
            try:
                table = self._table([i for i in range(self.arity) if mask >> i & 1], columns)
            finally:
                if collecting:
                    gc.enable()
            self._tables[mask, kept] = table
        return table

    def _table(self, known: list[int], kept: Sequence[int]) -> Any:
        if not known:
            return {(): self._listed([*_side_by_side([self.columns[i] for i in kept], self.count)])}
        keys = [self.keys[i] for i in known]
        if self.count > _SAMPLE == len(set(islice(_side_by_side(keys, self.count), _SAMPLE))):  # perhaps each row has a key of its own
            rows = map(list, zip(_side_by_side([self.columns[i] for i in kept], self.count)))
            table = dict(zip(_side_by_side(keys, self.count), rows)) if kept else dict.fromkeys(_side_by_side(keys, self.count), [()])
            if len(table) == self.count:
                return table
        table = defaultdict(list)
        for key, row in zip(_side_by_side(keys, self.count), _side_by_side([self.columns[i] for i in kept], self.count)):
            table[key].append(row)
        table.default_factory = None
        if not self.exact:
            for key, rows in table.items():
                table[key] = self._listed(rows)
        return table

    def _listed(self, rows: Any) -> Any:
        return rows if self.exact or len(rows) <= FEW else ListedRows(rows)

    def call_general(self, m: Machine, step: Any) -> Any:
        """The call function for any goal."""
        terms, mask, keys = [], 0, []
        for i, term in enumerate(step[2:]):
            term = deref(term)
            terms.append(term)
            if term.__class__ is Var or not self.keyed[i]:
                continue
            key = column_key(term)
            if key is not NotImplemented:
                mask |= 1 << i
                keys.append(key)
        every = tuple(range(self.arity))
        rows = self.table(mask, every).get(keys[0] if len(keys) == 1 else tuple(keys), ())
        if len(rows) > FEW and rows.__class__ is ListedRows:
            rows = rows.narrowed(*terms)
        if self.arity == 1:
            return _unify_one(m, step[1], rows, terms[0], 0)
        return _unify_rows(m, step[1], rows, terms, 0)

    def call_function(self) -> Callable[[Machine, Any], Any]:
        """The call function, written for this relation if it is simple enough."""
        if not self.arity:
            return _constant(self.count)
        if self.arity <= (4 if self.exact else 3) and all(self.keyed):
            return self._written()
        return self.call_general

    def _written(self) -> Callable[[Machine, Any], Any]:
        arguments = ", ".join(f"a{i}" for i in range(self.arity))
        lines = [f"_, k, {arguments} = step"]
        for i in range(self.arity):
            lines += [
                f"while a{i}.__class__ is Var:",
                f"    r = a{i}.ref",
                "    if r is UNSET: break",
                f"    a{i} = r",
                f"c{i} = a{i}.__class__",
                f"if c{i} is Symbol: k{i} = a{i}",
                f"elif c{i} is not Var:",
                f"    k{i} = column_key(a{i})" if self.lists[i] else f"    k{i} = index_key(a{i})",
                f"    if k{i} is NotImplemented: return general(m, step)",
            ]

        def tests(i: int, known: Any, lists: Any, depth: int) -> Any:
            indent = "    " * depth
            if i == self.arity:
                lines.extend(indent + line for line in self._leaf(known, lists))
                return
            lines.append(f"{indent}if c{i} is Var:")
            tests(i + 1, known, lists, depth + 1)
            if self.lists[i]:
                lines.append(f"{indent}elif c{i} is Cons:")
                tests(i + 1, [*known, i], [*lists, i], depth + 1)
            lines.append(f"{indent}else:")
            tests(i + 1, [*known, i], lists, depth + 1)

        tests(0, [], [], 0)
        space = {
            "Var": Var,
            "UNSET": UNSET,
            "Symbol": Symbol,
            "Cons": Cons,
            "index_key": index_key,
            "column_key": column_key,
            "general": self.call_general,
            "fail": fail,
            "tables": self._tables,
            "get_rows": self.rows,
            "again": _again,
            "set_1": _set_one,
            "set_2": _set_two,
            "set_3": _set_many,
            "unify": unify,
            "unify_rows": _unify_rows,
            "unify_one": _unify_one,
        }
        return generated_function("call of a relation", "call", ["m", "step"], lines, space)

    def _leaf(self, known: Any, lists: Any) -> Iterable[str]:
        """The lines for goals of which the arguments ``known`` are known, and ``lists`` among them are lists."""
        unknown = [j for j in range(self.arity) if j not in known]
        for n, j in enumerate(unknown):
            for other in unknown[:n]:
                yield f"if a{other} is a{j}: return general(m, step)"
        mask = sum(1 << j for j in known)
        kept = tuple(j for j in range(self.arity) if j in unknown or j in lists) if lists else None
        key = f"k{known[0]}" if len(known) == 1 else f"({', '.join(f'k{j}' for j in known)})"
        yield f"found = tables.get(({mask}, {kept}))"
        yield f"rows = get_rows({mask}, {kept}, {key}) if found is None else found.get({key})"
        yield "if rows is None: return fail(m)"
        if lists:
            terms = ", ".join(f"a{j}" for j in kept)
            yield f"if len(rows) > {FEW}: rows = rows.narrowed({terms})"
            yield f"return unify_one(m, k, rows, {terms}, 0)" if len(kept) == 1 else f"return unify_rows(m, k, rows, ({terms}), 0)"
        elif not unknown:
            yield "return again(m, k, len(rows)) if len(rows) > 1 else k"
        else:
            terms = ", ".join(f"a{j}" for j in unknown)
            yield f"return set_{min(len(unknown), 3)}(m, k, rows, {f'[{terms}]' if len(unknown) > 2 else terms})"


def _side_by_side(columns: Sequence[list[Any]], count: int) -> Iterable[Any]:
    """Iterate over the ``count`` rows of ``columns``: tuples, or the values of a single column."""
    if len(columns) == 1:
        return columns[0]
    return zip(*columns) if columns else [()] * count


def _places(keys: list[Any], key: Any) -> list[int]:
    """Where ``key`` is in ``keys``."""
    places: list[int] = []
    at = -1
    try:
        while True:
            at = keys.index(key, at + 1)
            places.append(at)
    except ValueError:
        return places


def relation_of(clauses: Sequence[Clause], arity: int) -> Relation | None:
    """The `Relation` of clauses that are all facts with ``arity`` arguments without variables. ``None`` if some are not, or may not be."""
    columns = columns_of(arity)(clauses)
    if columns is None:
        return None
    kinds = [set(map(type, column)) for column in columns]
    return Relation(columns, len(clauses), kinds) if all(map(_constants, columns, kinds)) else None


@lru_cache(50)
def columns_of(arity: int) -> Callable[[Sequence[Clause]], list[list[Any]] | None]:
    """A function that takes facts apart: it returns a list of the values of each argument, or ``None`` if a clause is not such a fact."""
    lines = [f"v{i} = []; append{i} = v{i}.append" for i in range(arity)]
    lines += ["for clause in clauses:", "    if clause.goals is not None: return None", "    cell = clause.head.cdr"]
    for i in range(arity):
        lines += ["    if cell.__class__ is not Cons: return None", f"    append{i}(cell.car); cell = cell.cdr"]
    lines += ["    if cell is not None: return None", f"return [{', '.join(f'v{i}' for i in range(arity))}]"]
    return generated_function("columns of facts", "columns", ["clauses"], lines, {"Cons": Cons})


def relation_of_rows(rows: Sequence[Sequence[Any]]) -> Relation:
    """The `Relation` of ground facts, each the list of its arguments."""
    columns = [[row[i] for row in rows] for i in range(len(rows[0]))]
    return Relation(columns, len(rows), [set(map(type, column)) for column in columns])


def _constants(column: list[Any], kinds: set[type]) -> bool:
    """Whether all values, which are of these ``kinds``, are known to be without variables."""
    unlike = kinds - _CONSTANTS
    if Cons in unlike:
        if not all(_ground(value) for value in column if value.__class__ is Cons):
            return False
        column = [value for value in column if value.__class__ is not Cons]
        unlike.discard(Cons)
    if not unlike <= _SYMBOLS:
        return False
    return not unlike or not any(value.name[:1] == "?" for value in set(column) if value.__class__ in _SYMBOLS)


def _ground(cell: Any) -> bool:
    """Whether a list is known to be without variables."""
    waiting: list[Any] = []
    while True:
        while cell.__class__ is Cons:
            item = cell.car
            kind = item.__class__
            if kind is Cons:
                waiting.append(item)
            elif (item.name[:1] == "?") if kind in _SYMBOLS else kind not in _CONSTANTS:
                return False
            cell = cell.cdr
        kind = cell.__class__
        if (cell.name[:1] == "?") if kind in _SYMBOLS else kind not in _CONSTANTS:
            return False
        if not waiting:
            return True
        cell = waiting.pop()


# ---------------------------------------------------------------------------- the rows that fit, one after the other


def _set_one(m: Machine, k: Any, rows: Rows, variable: Var) -> Any:
    trail = m.trail
    if len(rows) > 1:
        m.choices.append([_next_one, k, len(trail), rows, 1, variable])
    variable.ref = rows[0]
    trail.append(variable)
    return k


def _next_one(m: Machine, step: Any) -> Any:
    _, k, _, rows, i, variable = step
    variable.ref = rows[i]
    m.trail.append(variable)
    i += 1
    if i == len(rows):
        m.choices.pop()
    else:
        step[4] = i
    return k


def _set_two(m: Machine, k: Any, rows: Rows, first: Var, second: Var) -> Any:
    trail = m.trail
    if len(rows) > 1:
        m.choices.append([_next_two, k, len(trail), rows, 1, first, second])
    first.ref, second.ref = rows[0]
    trail += (first, second)
    return k


def _next_two(m: Machine, step: Any) -> Any:
    _, k, _, rows, i, first, second = step
    first.ref, second.ref = rows[i]
    m.trail += (first, second)
    i += 1
    if i == len(rows):
        m.choices.pop()
    else:
        step[4] = i
    return k


def _set_many(m: Machine, k: Any, rows: Rows, variables: list[Var]) -> Any:
    if len(rows) > 1:
        m.choices.append([_next_many, k, len(m.trail), rows, 1, variables])
    for variable, value in zip(variables, rows[0]):
        variable.ref = value
    m.trail += variables
    return k


def _next_many(m: Machine, step: Any) -> Any:
    _, k, _, rows, i, variables = step
    for variable, value in zip(variables, rows[i]):
        variable.ref = value
    m.trail += variables
    i += 1
    if i == len(rows):
        m.choices.pop()
    else:
        step[4] = i
    return k


def _again(m: Machine, k: Any, count: int) -> Any:
    """Succeed ``count`` times."""
    m.choices.append([_next_again, k, len(m.trail), count - 1])
    return k


def _next_again(m: Machine, step: Any) -> Any:
    if step[3] == 1:
        m.choices.pop()
    else:
        step[3] -= 1
    return step[1]


def _constant(count: int) -> Callable[[Machine, Any], Any]:
    """The call function of facts without arguments: succeed once for each."""
    return lambda m, step: _again(m, step[1], count) if count > 1 else step[1]


def _retry(m: Machine, step: Any) -> Any:
    m.choices.pop()
    return _unify_rows(m, step[1], step[3], step[4], step[5])


def _unify_rows(m: Machine, k: Any, rows: Rows, terms: list[Any], i: int) -> Any:
    """The general case: an argument is a list, or a variable occurs twice. After the last row no choice point is left."""
    trail = m.trail
    height = len(trail)
    count = len(rows)
    while i < count:
        for term, value in zip(terms, rows[i]):
            if term is not value and not unify(term, value, trail):
                break
        else:
            i += 1
            if i < count:
                m.choices.append((_retry, k, height, rows, terms, i))
            return k
        i += 1
        while len(trail) > height:
            trail.pop().ref = UNSET
    return fail(m)


def _retry_one(m: Machine, step: Any) -> Any:
    m.choices.pop()
    return _unify_one(m, step[1], step[3], step[4], step[5])


def _unify_one(m: Machine, k: Any, rows: Rows, term: Any, i: int) -> Any:
    """The same for a single argument."""
    trail = m.trail
    height = len(trail)
    count = len(rows)
    while i < count:
        value = rows[i]
        i += 1
        if unify(term, value, trail):
            if i < count:
                m.choices.append((_retry_one, k, height, rows, term, i))
            return k
        while len(trail) > height:
            trail.pop().ref = UNSET
    return fail(m)
