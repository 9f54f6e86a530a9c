"""Terms of the engine: Lisp data in which variables are `Var` objects.

The original binds symbols in association lists and copies them. Here a variable of a query or of a clause in use is an object that
points to its value, and a trail remembers the variables to unset. This makes inference fast. All other parts of a term are Lisp data,
shared, not copied. `import_term` turns symbols into variables, and `resolve` turns terms back into Lisp data. A variable without a value
becomes a symbol: a variable of the query its own symbol, a variable of a clause an uninterned one.

A `LazyTail` in a term stands for the list that it will compute. Looking at it forces one element at a time.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, EmptyList, Keyword, Symbol, list_from

from cramhy_runtime.utilities.lazy_lists import LazyTail, force_ll
from cramhy_runtime.utilities.patterns import ANONYMOUS, fresh_name, same_atom

from .deep_terms import CYCLE_SUSPECTED, LIST_SUSPECTED, rebuild, refuse_cycle, refuse_endless

_new = object.__new__
_CELLS = range(CYCLE_SUSPECTED)
_TURNS = 200_000
"""After unifying so many lists in lists, or parts of a list, `unify` asks whether they end."""

UNSET = type("Unset", (), {"__repr__": lambda self: "#<unset>", "__slots__": ()})()
"""The mark for a variable without a value."""


class Var:
    """A logic variable. ``ref`` is its value, which may be another variable, or `UNSET`; ``name`` is the symbol that shows it.

    ``written`` is its symbol in the text of a clause, while goals are watched. Slots are read ten times as fast as attributes that an
    object has from its class. Compiled code makes variables by `NEW_VARIABLE`, without a call of the constructor.
    """

    __slots__ = ("ref", "name", "written", "__weakref__")

    def __init__(self):
        self.ref = UNSET
        self.name = self.written = None

    def __repr__(self):
        return f"<{self.name.name if self.name else '?' + format(id(self), 'x')}{'' if self.ref is UNSET else ' = ' + repr(self.ref)}>"


NEW_VARIABLE = "{0} = new(Var); {0}.ref = UNSET; {0}.name = {0}.written = None"
"""Statements of compiled code that make the variable with the Python name ``{0}``; ``new`` is Python's ``object.__new__``."""


def named_variable(name):
    """A new variable that the symbol ``name`` shows, or ``None``."""
    variable = _new(Var)
    variable.ref = UNSET
    variable.name = name
    variable.written = None
    return variable


class TermTail(LazyTail):
    """The lazy tail of a list of ``findall``. Its elements may contain `Var` objects, and usually it is finite."""

    __slots__ = ()


class Restore:
    """A trail entry that puts an old value back, for a built-in that changed a variable with a value."""

    __slots__ = ("variable", "old")

    def __init__(self, variable):
        self.variable, self.old = variable, variable.ref

    def _undo(self, _):
        self.variable.ref = self.old

    ref = property(None, _undo)


def symbol_of(variable):
    """The symbol that stands for an unset variable outside the engine."""
    if variable.name is None:
        variable.name = fresh_name("?V-")
    return variable.name


def deref(term):
    """The value of ``term``: follow variables and compute lazy tails, on one level."""
    while True:
        kind = term.__class__
        if kind is Var:
            value = term.ref
            if value is UNSET:
                return term
            term = value
        elif kind is LazyTail or kind is TermTail:
            term = term.force()
        else:
            return term


# --------------------------------------------------------------------------------------------------------------- the border


def import_term(term, table):
    """The term for Lisp data. Symbols that are variables become `Var` objects, one for each symbol in the dict ``table``."""
    kind = term.__class__
    if kind is Symbol or kind is Keyword:
        if term.name[:1] != "?":
            return term
        if term is ANONYMOUS:
            return Var()
        variable = table.get(term)
        if variable is None:
            variable = table[term] = named_variable(term)
        return variable
    if kind is not Cons:
        return None if kind is EmptyList else term
    cell = term
    for _ in _CELLS:  # as far as nothing changes
        car = cell.car
        kind = car.__class__
        if kind is not int:
            if kind is Symbol or kind is Keyword:
                if car.name[:1] == "?":
                    break
            elif kind is Cons:
                break
        cell = cell.cdr
        if cell.__class__ is not Cons:
            if cell is None:
                return term
            break
    else:
        refuse_cycle(term, value_of)
    try:
        cars, changed, cell = [], False, term
        while cell.__class__ is Cons:
            car = cell.car
            kind = car.__class__
            if kind is Symbol or kind is Cons or kind is Keyword:
                value = import_term(car, table)
                if value is not car:
                    changed = True
                cars.append(value)
            else:
                cars.append(car)
            cell = cell.cdr
        if cell is not None:
            value = import_term(cell, table)
            changed = changed or value is not cell
            cell = value
        return list_from(cars, cell) if changed else term
    except RecursionError:
        return rebuild(term, value_of, lambda part: import_term(part, table))


def resolve(term, names=None):
    """Lisp data for a term, with values in place of variables. Ground data is returned as it is.

    Unset variables are entered in ``names``, a dict symbol → `Var`, if it is given, so that `import_term` recognises them.
    """
    while True:
        kind = term.__class__
        if kind is Cons:
            try:
                return _resolve_list(term, names)
            except RecursionError:
                return rebuild(term, value_of, lambda part: _resolved_part(part, names))
        if kind is Var:
            value = term.ref
            if value is UNSET:
                symbol = symbol_of(term)
                if names is not None:
                    names[symbol] = term
                return symbol
            term = value
        elif kind is LazyTail or kind is TermTail:
            term = term.force()
        else:
            return term


def _resolved_later(lazy, names):
    """The two ways to force a tail whose elements are those of ``lazy``, resolved."""
    return (lambda: resolve(lazy.force(), names)), (lambda: resolve(force_ll(lazy.force(True)), names))


def _resolved_part(part, names):
    if part.__class__ is TermTail:
        return TermTail(*_resolved_later(part, names))
    return resolve(part, names) if part.__class__ is Var else part


def value_of(term):
    """The value of ``term``: follow variables and lazy tails that are computed already, without computing others."""
    while True:
        kind = term.__class__
        if kind is Var and term.ref is not UNSET:
            term = term.ref
        elif (kind is LazyTail or kind is TermTail) and term.generator is None:
            term = term.value
        else:
            return term


def _resolve_list(term, names):
    cell = term
    for _ in _CELLS:  # as far as nothing changes
        kind = cell.car.__class__
        if kind is Cons or kind is Var or kind is LazyTail or kind is TermTail:  # quicker than a look into a set
            break
        cell = cell.cdr
        if cell.__class__ is not Cons:
            if cell is None:
                return term
            break
    cars, changed, cell = [], False, term
    while True:
        while cell.__class__ is Cons:
            car = cell.car
            kind = car.__class__
            if kind is Cons or kind is Var or kind is LazyTail or kind is TermTail:
                value = resolve(car, names)
                if value is not car:
                    changed = True
                cars.append(value)
            else:
                cars.append(car)
            cell = cell.cdr
            if len(cars) == CYCLE_SUSPECTED:
                refuse_cycle(term, value_of)
        kind = cell.__class__
        if kind is Var:
            changed = True
            value = cell.ref
            if value is UNSET:
                if names is not None:
                    names[symbol_of(cell)] = cell
                cell = symbol_of(cell)
                break
            cell = value
        elif kind is TermTail and cell.generator is not None:
            lazy = cell
            changed, cell = True, TermTail(*_resolved_later(lazy, names))
            break
        elif kind is LazyTail or kind is TermTail:
            if cell.generator is not None:
                break
            changed, cell = True, cell.value
        else:
            break
    return list_from(cars, cell) if changed else term


def raw(term, names):
    """Lisp data for a term as it is written: variables become symbols even if they have a value. They are entered in ``names``."""
    kind = term.__class__
    if kind is Var:
        symbol = symbol_of(term)
        names[symbol] = term
        return symbol
    if kind is not Cons:
        return term
    try:
        cars, changed, cell = [], False, term
        while cell.__class__ is Cons:
            value = raw(cell.car, names)
            changed = changed or value is not cell.car
            cars.append(value)
            cell = cell.cdr
        value = raw(cell, names)
        return list_from(cars, value) if changed or value is not cell else term
    except RecursionError:
        return rebuild(term, lambda part: part, lambda part: raw(part, names))


def copy_term(term, mapping):
    """A copy of ``term`` with values in place of set variables and ``mapping[variable]`` in place of unset ones.

    Missing variables are entered in ``mapping`` with a new `Var`. The copy does not change when bindings are undone.
    """
    term = deref(term) if term.__class__ is not Cons else term
    kind = term.__class__
    if kind is Var:
        copy = mapping.get(term)
        if copy is None:
            copy = mapping[term] = named_variable(term.name)
        return copy
    if kind is not Cons:
        return term
    cell = term
    for _ in _CELLS:  # as far as nothing changes
        kind = cell.car.__class__
        if kind is not int and (kind is Cons or kind is Var):
            break
        cell = cell.cdr
        if cell.__class__ is not Cons:
            if cell.__class__ is not Var:
                return term
            break
    try:
        cars, changed, cell = [], False, term
        while True:
            if cell.__class__ is Cons:
                if len(cars) == CYCLE_SUSPECTED:
                    refuse_cycle(term, value_of)
                car = cell.car
                kind = car.__class__
                if kind is Cons or kind is Var:
                    value = copy_term(car, mapping)
                    if value is not car:
                        changed = True
                    cars.append(value)
                else:
                    cars.append(car)
                cell = cell.cdr
            elif cell.__class__ is Var:
                changed = True
                if cell.ref is UNSET:
                    cell = copy_term(cell, mapping)
                    break
                cell = cell.ref
            else:
                break
        return list_from(cars, cell) if changed else term
    except RecursionError:
        return rebuild(term, value_of, lambda part: copy_term(part, mapping) if part.__class__ is Var else part)


def unset_variables(term, found):
    """Enter the unset variables of ``term`` in the dict ``found``, in order of occurrence, and return it."""
    stack, count = [term], 0
    while stack:
        item = stack.pop()
        count += 1
        while True:
            if len(stack) + count > CYCLE_SUSPECTED:
                refuse_cycle(term, value_of)
                count = -1_000_000_000
            if item.__class__ is Var:
                if item.ref is UNSET:
                    found.setdefault(item)
                    break
                item = item.ref
            elif item.__class__ is Cons:
                stack.append(item.cdr)
                item = item.car
            else:
                break
    return found


def ground(term):
    """Whether ``term`` contains no unset variables."""
    return not unset_variables(term, {})


# --------------------------------------------------------------------------------------------------------------- unification


def unify(a, b, trail):
    """Make both terms the same by setting variables, which are noted on ``trail``. Returns False if that is impossible. It makes no
    occurs check."""
    pending, turns = None, 0
    while True:
        while a.__class__ is Var:
            value = a.ref
            if value is UNSET:
                break
            a = value
        while b.__class__ is Var:
            value = b.ref
            if value is UNSET:
                break
            b = value
        if a is not b:
            kind = a.__class__
            if kind is Var:
                a.ref = b
                trail.append(a)
            elif b.__class__ is Var:
                b.ref = a
                trail.append(b)
            elif kind is Symbol or b.__class__ is Symbol:
                return False
            elif kind is Cons and b.__class__ is Cons:
                while True:  # along both lists as long as their elements are simple
                    x, y = a.car, b.car
                    a, b = a.cdr, b.cdr
                    if x is not y:
                        while x.__class__ is Var:
                            value = x.ref
                            if value is UNSET:
                                break
                            x = value
                        while y.__class__ is Var:
                            value = y.ref
                            if value is UNSET:
                                break
                            y = value
                        if x is not y:
                            kind = x.__class__
                            if kind is Var:
                                x.ref = y
                                trail.append(x)
                            elif y.__class__ is Var:
                                y.ref = x
                                trail.append(y)
                            elif kind is Symbol or y.__class__ is Symbol:
                                return False
                            else:
                                if pending is None:
                                    pending = []
                                pending.append(a)
                                pending.append(b)
                                a, b = x, y
                                break
                    if a.__class__ is not Cons or b.__class__ is not Cons:
                        break
                turns += 1
                if turns > _TURNS:
                    turns = -50 * _TURNS  # a long way until it is asked again
                    refuse_cycle(a, value_of)
                continue
            elif kind is LazyTail or kind is TermTail:
                a = a.force()
                continue
            elif b.__class__ is LazyTail or b.__class__ is TermTail:
                b = b.force()
                continue
            elif not same_atom(a, b):
                return False
        if not pending:
            return True
        b = pending.pop()
        a = pending.pop()


def undo(trail, height):
    """Unset the variables that were set since the trail had ``height`` entries."""
    while len(trail) > height:
        trail.pop().ref = UNSET


def elements(term):
    """Iterate over the elements of a list term, which are not dereferenced. The list must end in ``nil`` (see `list_end`)."""
    cell, count = deref(term), 0
    while cell.__class__ is Cons:
        yield cell.car
        cell = deref(cell.cdr)
        count += 1
        if count == LIST_SUSPECTED:
            refuse_endless(cell, value_of)


def list_end(term):
    """The end of the list ``term``: ``None`` if it is a proper list."""
    cell, count = deref(term), 0
    while cell.__class__ is Cons:
        cell = deref(cell.cdr)
        count += 1
        if count == LIST_SUSPECTED:
            refuse_endless(cell, value_of)
    return cell
