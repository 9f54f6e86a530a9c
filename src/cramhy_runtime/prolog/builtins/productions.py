"""Productions: conjunctions of fact patterns whose handlers are called when matches come and go.

A production keeps its matches from the registration of its first handler on. Each of its patterns has a store of the facts that match
it. Productions whose patterns differ only in the names of variables share a store, which is indexed by the values that joins ask for.
So a new fact is joined, from each pattern that it matches, only with facts that fit; a fact that goes takes back exactly its own
matches. First all matches are updated, then the handlers are called. Handlers may assert, retract and wait themselves. Each gets the
``:assert`` of a match before its ``:retract``, or neither. Source: prolog.md section 12.2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.lisp_core.conditions import SimpleError, as_name, error, style_warn
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from, python_list
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.lisp_core.printing import print_slots
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable, variables_of, vars_in

from .rete import content_key, match_fact, memory
from ..symbols import PROLOG, sym

_definitions = special(PROLOG.intern("*PRODUCTION-DEFINITIONS*"), {})
_ASSERT, _RETRACT = keyword("ASSERT"), keyword("RETRACT")


def _named(pattern):
    """The variables of a pattern that have names, in order of occurrence."""
    return [item for item in variables_of(pattern) if item is not ANONYMOUS]


class Store:
    """The facts that match one ``pattern``: occurrence → the values of its variables. Productions with this pattern share it."""

    def __init__(self, pattern):
        self.pattern, self.variables = pattern, _named(pattern)
        self.rows = {}
        self.indexes = {}
        self.users = []  # (production, place of the pattern in it)

    def add(self, occurrence):
        """Keep ``occurrence`` if it matches. Returns whether it does."""
        found = match_fact(self.pattern, occurrence.fact, {})
        if found is None:
            return False
        row = self.rows[occurrence] = [found[item] for item in self.variables]
        for columns, index in self.indexes.items():
            index.setdefault(_key(row, columns), {})[occurrence] = row
        return True

    def remove(self, occurrence):
        """Drop ``occurrence``. Returns whether it was kept."""
        row = self.rows.pop(occurrence, None)
        if row is None:
            return False
        for columns, index in self.indexes.items():
            key = _key(row, columns)
            del index[key][occurrence]
            if not index[key]:
                del index[key]
        return True

    def having(self, columns, key):
        """The (occurrence, row) pairs whose values in ``columns`` have ``key``."""
        if not columns:
            return list(self.rows.items())
        index = self.indexes.get(columns)
        if index is None:
            index = self.indexes[columns] = {}
            for occurrence, row in self.rows.items():
                index.setdefault(_key(row, columns), {})[occurrence] = row
        return list(index.get(key, {}).items())


def _key(row: list[Any], columns: tuple[int, ...]) -> tuple[Any, ...]:
    return tuple([content_key(row[column]) for column in columns])


class Network:
    """The stores. Those whose pattern begins with a constant are found by the first element of a fact."""

    def __init__(self):
        self.stores = {}
        self.by_first = {}
        self.watching = {}  # productions, in order

    def store(self, pattern):
        """The store for ``pattern``, with the facts that hold."""
        shape = _shape(pattern)
        found = self.stores.get(shape)
        if found is None:
            found = self.stores[shape] = Store(pattern)
            self.by_first.setdefault(_first_key(pattern), []).append(found)
            for occurrence in memory.matching(pattern):
                found.add(occurrence)
        return found

    def drop(self, production):
        """Forget a production, and the stores that no other production uses."""
        if production not in self.watching:
            return
        del self.watching[production]
        for store in set(production.stores):
            store.users = [user for user in store.users if user[0] is not production]
            if not store.users:
                del self.stores[_shape(store.pattern)]
                self.by_first[_first_key(store.pattern)].remove(store)

    def changed(self, operation, occurrence):
        """Update every store and match after a change of the memory, then call the handlers."""
        if operation == "CLEAR":
            self.__init__()
            return
        if not self.watching:
            return
        stores = [*self.by_first.get(content_key(occurrence.fact.car), ()), *self.by_first.get(None, ())]
        asserted = operation == "ASSERT"
        touched = [store for store in stores if (store.add(occurrence) if asserted else store.remove(occurrence))]
        places = {}
        for store in touched:
            for production, place in store.users:
                places.setdefault(production, []).append(place)
        news = []
        for production in sorted(places, key=lambda production: production.number):
            found = production.gained(occurrence, sorted(places[production])) if asserted else production.lost(occurrence)
            news += [(production, match) for match in found]
        _tell_all([match.announce if asserted else match.take_back for _, match in news])


def _shape(pattern: Any) -> tuple[Any, ...]:
    """A key that is the same for patterns that differ in the names of variables only."""
    return _shape_of(pattern, {})


def _shape_of(pattern: Any, numbers: dict[Symbol, int]) -> tuple[Any, ...]:
    shape = []
    while isinstance(pattern, Cons):
        shape.append(_part(pattern.car, numbers))
        pattern = pattern.cdr
    return (*shape, "." if pattern is not None else None, _part(pattern, numbers))


def _part(item: Any, numbers: dict[Symbol, int]) -> Any:
    if item is ANONYMOUS:
        return "_"
    if variable(item):
        return "?", numbers.setdefault(item, len(numbers))
    return ("list", _shape_of(item, numbers)) if _is_open(item) else ("c", content_key(item))


def _is_open(item: object) -> bool:
    """Whether ``item`` is a list with variables in it."""
    return isinstance(item, Cons) and vars_in(item) is not None


def _first_key(pattern: Any) -> Any:
    """The key of the first element of all facts of the pattern; ``None`` if it is a variable."""
    return None if not isinstance(pattern, Cons) or variable(pattern.car) or _is_open(pattern.car) else content_key(pattern.car)


_network = per_image(Network())
memory.watchers.append(lambda operation, occurrence: _network.changed(operation, occurrence))


def _tell_all(calls):
    """Make all calls, as cleanup forms are run: an error, or any other exit, in one of them does not stop the others."""
    for index, call in enumerate(calls):
        try:
            call()
        except BaseException:
            _tell_all(calls[index + 1 :])
            raise


class Match:
    """One match of a production: the values of its variables. ``waiting`` are the handlers that have not been called for it yet."""

    __slots__ = ("production", "occurrences", "values", "holds", "waiting")

    def __init__(self, production, occurrences, values):
        self.production, self.occurrences, self.values = production, occurrences, values
        self.holds, self.waiting = True, None

    def announce(self):
        """Call the handlers with ``:assert``, newest first, as long as the match holds."""
        self.waiting = list(self.production.callbacks)
        try:
            while self.waiting and self.holds:
                self.tell(self.waiting.pop(0), _ASSERT)
        finally:
            if self.holds:
                self.waiting = []

    def take_back(self):
        """Call the handlers that know of the match with ``:retract``."""
        unaware = [*self.production.callbacks] if self.waiting is None else self.waiting
        for callback in [callback for callback in self.production.callbacks if callback not in unaware]:
            self.tell(callback, _RETRACT)

    def tell(self, callback, operation):
        """Call one handler with the operation and the values."""
        arguments = [item for v in self.production.variables for item in (keyword(v.name), self.values.get(v))]
        function_of(callback)(operation, *arguments)


class Production:
    """A named conjunction of patterns with its handlers and, once there is a handler, its matches."""

    count = 0

    def __init__(self, name, patterns):
        self.name, self.patterns = name, patterns
        self.variables = _named(list_from(patterns))
        self.callbacks = []
        self.stores = []
        self.matches = {}  # occurrence -> its matches

    def start(self):
        """Keep matches from now on. The handlers are called at once for those that exist."""
        Production.count += 1
        self.number, self.matches = Production.count, {}
        _network.watching[self] = None
        self.stores = [_network.store(pattern) for pattern in self.patterns]
        self.names = [_named(pattern) for pattern in self.patterns]
        for place, store in enumerate(self.stores):
            store.users.append((self, place))
        self.orders = [self._order(first) for first in range(len(self.patterns))]
        seeds = list(self.stores[0].rows) if self.stores else []
        existing = [match for occurrence in seeds for match in self._joined(occurrence, 0, False)]
        _tell_all([match.announce for match in existing])

    def _order(self, first):
        """The order in which the other patterns are joined to ``first``: always the pattern with most known variables comes next."""
        known, order, left = set(self.names[first]), [], [place for place in range(len(self.patterns)) if place != first]
        while left:
            place = max(left, key=lambda place: len(known & set(self.names[place])))
            left.remove(place)
            columns = tuple(i for i, name in enumerate(self.names[place]) if name in known)
            order.append((place, columns))
            known |= set(self.names[place])
        return order

    def _joined(self, occurrence, first, excluding=True):
        """The matches with ``occurrence`` at place ``first`` and, if ``excluding``, at no earlier place. They are kept from now on."""
        found = []

        def join(step, occurrences, values):
            if step == len(self.orders[first]):
                match = Match(self, occurrences, values)
                found.append(match)
                for each in occurrences:
                    self.matches.setdefault(each, {})[match] = None
                return
            place, columns = self.orders[first][step]
            names = self.names[place]
            key = tuple([content_key(values[names[column]]) for column in columns])
            for other, row in self.stores[place].having(columns, key):
                if not (excluding and other is occurrence and place < first):
                    join(step + 1, (*occurrences, other), {**values, **dict(zip(names, row))})

        join(0, (occurrence,), dict(zip(self.names[first], self.stores[first].rows[occurrence])))
        return found

    def gained(self, occurrence, places):
        """The new matches with ``occurrence`` at one of ``places``."""
        return [match for place in places for match in self._joined(occurrence, place)]

    def lost(self, occurrence):
        """The matches with ``occurrence``, which are not kept any more."""
        found = list(self.matches.pop(occurrence, ()))
        for match in found:
            match.holds = False
            for other in match.occurrences:
                if other in self.matches:
                    self.matches[other].pop(match, None)
                    if not self.matches[other]:
                        del self.matches[other]
        return found


# ------------------------------------------------------------------------------------------------------- what a program calls


def register_production(name, definition):
    """``(register-production name definition)``: define a production by its list of patterns. Returns it. A redefinition warns."""
    if as_name(name) in _definitions.value:
        remove_production(name)
        style_warn("Redefining production `~S'.", name)
    production = _definitions.value[name] = Production(name, python_list(definition))
    return production


def remove_production(name):
    """``(remove-production name)``: forget a production, so that its handlers are not called any more. Returns nil if there is none."""
    production = _definitions.value.pop(as_name(name), None)
    if production is not None:
        _network.drop(production)
    return True if production else None


def clear_productions():
    """``(clear-productions)``: forget all productions."""
    for name in list(_definitions.value):
        remove_production(name)


def with_productions(productions, body):
    """``with-productions``: call ``body`` with ``productions``, a list of (name, list of patterns), that only it sees."""
    own = {name: Production(name, python_list(patterns)) for name, patterns in productions}
    with binding(_definitions, {**_definitions.value, **own}):
        try:
            return body()
        finally:
            for production in own.values():
                _network.drop(production)


def _production(name):
    found = _definitions.value.get(as_name(name))
    return found if found is not None else error(SimpleError("Production `~a' unknown.", name))


def register_production_handler(production_name, callback):
    """``(register-production-handler name callback)``: call ``(callback operation :?variable value...)`` when matches come and go.

    The operation is ``:assert`` or ``:retract``. The first handler of a production is called for the matches that exist. Returns the
    production; an unknown name is an error.
    """
    production = _production(production_name)
    production.callbacks.insert(0, callback)
    if production not in _network.watching:
        production.start()
    return production


def remove_production_handler(production_name, callback):
    """``(remove-production-handler name callback)``: stop calling ``callback``. An unknown name is an error."""
    production = _production(production_name)
    if callback in production.callbacks:
        production.callbacks.remove(callback)


def with_production_handlers(handlers, body):
    """``with-production-handlers``: call ``body`` with ``handlers`` in force, a list of (production name, function)."""
    registered = []
    try:
        for name, function in handlers:
            registered.append((register_production_handler(name, function), function))
        return body()
    finally:
        for production, function in registered:
            if function in production.callbacks:
                production.callbacks.remove(function)


@contextmanager
def watched(patterns: list[Cons], callback: Callable[..., object]) -> Iterator[None]:
    """While the block runs, ``callback`` is told of the matches of ``patterns``, a Python list: a production without a name."""
    production = Production(None, patterns)
    production.callbacks.append(callback)
    try:
        production.start()
        yield
    finally:
        _network.drop(production)


def _print_production(production, stream):
    print_slots(
        sym("CRAM-PROLOG::PRODUCTION-DEFINITION"),
        [
            ("NAME", production.name),
            ("VAR-BINDINGS", list_from(production.variables)),
            ("BODY", list_from(production.patterns)),
            ("NODE", None),
            ("CALLBACKS", list_from(production.callbacks)),
        ],
        stream,
    )


define_printer(Production, _print_production)
