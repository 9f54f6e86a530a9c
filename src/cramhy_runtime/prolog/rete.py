"""Rete: a memory of facts, and productions that fire when facts that match them come and go.

A fact is a list of constants; the memory counts how often each was asserted. A production is a named conjunction of patterns;
from the registration of its first handler on it keeps its matches, so that an assertion only looks for matches that use the
new fact, and a retraction takes back exactly those that used the old one. Elements are compared by ``eql`` of their
`object_id`, so strings and lists never match by content. Source: prolog.md section 12.
"""

from __future__ import annotations

from cramhy_runtime.lisp.conditions import SimpleError, error, style_warn
from cramhy_runtime.lisp.data import Cons, list_from, python_list
from cramhy_runtime.lisp.dynamic import binding, special
from cramhy_runtime.lisp.equality import eql, eql_key
from cramhy_runtime.lisp.evaluation.functions import function_of
from cramhy_runtime.lisp.packages import keyword
from cramhy_runtime.lisp.printer.printer import define_printer
from cramhy_runtime.lisp.printer.standard_printers import print_slots

from cramhy_runtime.utilities.lazy_lists import from_iterator
from .natives import predicate
from cramhy_runtime.utilities.patterns import ANONYMOUS, substitute_vars, variable, variables_of, vars_in
from .symbols import PROLOG, sym
from .terms import import_term, raw

_object_ids: list = []


def object_id(obj):
    """The identity of a fact element: the object itself, unless `define_object_id` says otherwise for its class."""
    for cls, function in reversed(_object_ids):
        if isinstance(obj, cls):
            return function(obj)
    return obj


def define_object_id(cls, function):
    """Let ``function(obj)`` be the identity of objects of ``cls``."""
    _object_ids.append((cls, function))


class Node:
    """A node of the alpha network: the facts that start alike. At the end of a fact, ``occurrences`` counts it."""

    def __init__(self, fact=None):
        self.fact = fact
        self.children = {}
        self.occurrences = []

    def size(self):
        return 1 + sum(child.size() for child in self.children.values())

    def leaves(self):
        """The nodes of the facts that hold, newest first."""
        if self.occurrences:
            yield self
        for child in reversed(list(self.children.values())):
            yield from child.leaves()


class Occurrence:
    """One assertion of a fact."""

    __slots__ = ("fact",)

    def __init__(self, fact):
        self.fact = fact


class Production:
    """A named conjunction of patterns with its handlers and, once there is a handler, its matches."""

    def __init__(self, name, patterns):
        self.name, self.patterns = name, patterns
        self.variables = [v for v in variables_of(list_from(patterns)) if v is not ANONYMOUS]
        self.callbacks = []
        self.matches = None

    def find(self, fixed=None, position=None):
        """The matches, as (occurrences, values of the variables); ``fixed`` must stand at ``position`` and not before it."""

        def join(index, occurrences, bindings):
            if index == len(self.patterns):
                yield occurrences, bindings
                return
            candidates = [fixed] if index == position else _memory.occurrences
            for occurrence in candidates:
                if fixed is not None and index < position and occurrence is fixed:
                    continue
                extended = match_fact(self.patterns[index], occurrence.fact, bindings)
                if extended is not None:
                    yield from join(index + 1, (*occurrences, occurrence), extended)

        yield from join(0, (), {})

    def fire(self, operation, bindings):
        arguments = [item for v in self.variables for item in (keyword(v.name), bindings.get(v))]
        for callback in list(self.callbacks):
            function_of(callback)(keyword(operation), *arguments)

    def start(self):
        """Build the matches and deliver those that exist."""
        self.matches = list(self.find())
        for _, bindings in self.matches:
            self.fire("ASSERT", bindings)

    def asserted(self, occurrence):
        new = [match for position in range(len(self.patterns)) for match in self.find(occurrence, position)]
        self.matches += new
        for _, bindings in new:
            self.fire("ASSERT", bindings)

    def retracted(self, occurrence):
        old = [match for match in self.matches if occurrence in match[0]]
        self.matches = [match for match in self.matches if occurrence not in match[0]]
        for _, bindings in old:
            self.fire("RETRACT", bindings)


class _Memory:
    def __init__(self):
        self.root = Node()
        self.occurrences = []
        self.watching = []


_memory = _Memory()
_definitions = special(PROLOG.intern("*PRODUCTION-DEFINITIONS*"), {})


def match_fact(pattern, fact, bindings):
    """``bindings``, a dict, extended so that ``pattern`` is ``fact``; ``None`` if it cannot be."""
    extended = dict(bindings)
    while isinstance(pattern, Cons) and isinstance(fact, Cons):
        if not _element_matches(pattern.car, fact.car, extended):
            return None
        pattern, fact = pattern.cdr, fact.cdr
    if pattern is None and fact is None or (pattern is not None and _element_matches(pattern, fact, extended)):
        return extended
    return None


def _element_matches(item, value, bindings):
    if variable(item):
        if item is ANONYMOUS:
            return True
        if item not in bindings:
            bindings[item] = value
            return True
        item = bindings[item]
    return eql(object_id(item), object_id(value)) is not None


# -------------------------------------------------------------------------------------------------------------------- facts


def _leaf(fact, create):
    node = _memory.root
    for element in fact:
        key = eql_key(object_id(element))
        child = node.children.get(key)
        if child is None:
            if not create:
                return None
            child = node.children[key] = Node()
        node = child
    node.fact = fact
    return node


def _check(fact):
    if fact is None:
        error("The assertion FACT failed: a fact is a list with at least one element.")
    if ANONYMOUS in python_list(fact):
        error("The assertion (NOT (FIND '?_ FACT)) failed: the fact ~s contains ?_.", fact)


def rete_assert(fact):
    """Add one occurrence of ``fact`` and tell the productions; returns the memory node."""
    _check(fact)
    node, occurrence = _leaf(fact, True), Occurrence(fact)
    node.occurrences.append(occurrence)
    _memory.occurrences.append(occurrence)
    for production in list(_memory.watching):
        production.asserted(occurrence)
    return node


def rete_retract(fact):
    """Remove one occurrence of ``fact`` and tell the productions. An absent fact is an error."""
    node = _leaf(fact, False) if fact is not None else None
    if node is None or not node.occurrences:
        return error("wme-memory already empty. Cannot retract.")
    occurrence = node.occurrences.pop()
    _memory.occurrences.remove(occurrence)
    for production in list(_memory.watching):
        production.retracted(occurrence)
    return node


def with_facts_asserted(fact_thunks, body):
    """Assert the facts that the thunks give, call ``body``, retract them in the same order on any exit."""
    asserted = []
    try:
        for thunk in fact_thunks:
            fact = thunk()
            rete_assert(fact)
            asserted.append(fact)
        return body()
    finally:
        for fact in asserted:
            rete_retract(fact)


def clear_alpha_network():
    """Retract everything and empty the network; productions registered before do not fire any more."""
    for occurrence in list(_memory.occurrences):
        rete_retract(occurrence.fact)
    _memory.root, _memory.occurrences, _memory.watching = Node(), [], []


def alpha_network_size(node=None):
    """The number of nodes, the root included."""
    return (node or _memory.root).size()


def _pairs(bindings, tail=None):
    return list_from([Cons(symbol, value) for symbol, value in reversed(bindings.items())], tail)


def rete_holds(fact_pattern, test=None, processed=None, node=None):
    """The lazy list of bindings under which ``fact_pattern`` is a fact, the newest fact first."""

    if vars_in(fact_pattern) is None:
        leaf = _leaf(fact_pattern, False)
        return Cons(None) if leaf is not None and leaf.occurrences else None

    def matches():
        for leaf in list((node or _memory.root).leaves()):
            bindings = match_fact(fact_pattern, leaf.fact, {})
            if bindings is not None:
                yield _pairs(bindings)

    return from_iterator(matches())


def rete_prove(expr, bdgs=None):
    """The lazy list of bindings under which all patterns of the list ``expr`` are facts."""

    def join(patterns, bindings):
        if patterns is None:
            yield bindings
            return
        pattern = substitute_vars(patterns.car, bindings)
        for leaf in list(_memory.root.leaves()):
            found = match_fact(pattern, leaf.fact, {})
            if found is not None:
                yield from join(patterns.cdr, _pairs(found, bindings))

    return from_iterator(join(expr, bdgs)) if expr is not None else Cons(bdgs)


@predicate("CRAM-PROLOG::RETE-HOLDS")
def _rete_holds(m, pattern):
    written = raw(pattern, m.names)
    if not isinstance(written, Cons):
        error("The pattern ~a of a RETE-HOLDS goal is no list.", written)
    for leaf in list(_memory.root.leaves()):
        bindings = match_fact(written, leaf.fact, {})
        if bindings is not None:
            pairs = [term for symbol, value in bindings.items() for term in (import_term(symbol, m.names), value)]
            if m.unify(*pairs):
                yield


# -------------------------------------------------------------------------------------------------------------- productions


def register_production(name, definition):
    """Define the production ``name`` with the list of patterns ``definition``; a redefinition warns."""
    if name in _definitions.value:
        remove_production(name)
        style_warn("Redefining production `~S'.", name)
    production = _definitions.value[name] = Production(name, python_list(definition))
    return production


def remove_production(name):
    """Forget a production; nothing fires for it any more."""
    production = _definitions.value.pop(name, None)
    if production in _memory.watching:
        _memory.watching.remove(production)
    return True if production else None


def clear_productions():
    """Forget all productions."""
    for name in list(_definitions.value):
        remove_production(name)


def with_productions(productions, body):
    """Call ``body`` with productions, a list of (name, list of patterns), that only it sees."""
    own = {name: Production(name, python_list(patterns)) for name, patterns in productions}
    with binding(_definitions, {**_definitions.value, **own}):
        try:
            return body()
        finally:
            for production in own.values():
                if production in _memory.watching:
                    _memory.watching.remove(production)


def _production(name):
    found = _definitions.value.get(name)
    return found if found is not None else error(SimpleError("Production `~a' unknown.", name))


def register_production_handler(production_name, callback):
    """Call ``callback(operation, :?variable value...)`` when matches come (``:assert``) and go (``:retract``).

    The first handler of a production gets the matches that exist. Returns the production.
    """
    production = _production(production_name)
    production.callbacks.insert(0, callback)
    if production not in _memory.watching:
        _memory.watching.append(production)
        production.start()
    return production


def remove_production_handler(production_name, callback):
    """Do not call ``callback`` any more."""
    production = _production(production_name)
    if callback in production.callbacks:
        production.callbacks.remove(callback)


def with_production_handlers(handlers, body):
    """Call ``body`` with handlers in force, a list of (production name, function)."""
    registered = []
    try:
        for name, function in handlers:
            register_production_handler(name, function)
            registered.append((name, function))
        return body()
    finally:
        for name, function in registered:
            if name in _definitions.value:
                remove_production_handler(name, function)


def _print_production(production, stream):
    print_slots(sym("CRAM-PROLOG::PRODUCTION-DEFINITION"), [
        ("NAME", production.name), ("VAR-BINDINGS", list_from(production.variables)), ("BODY", list_from(production.patterns)),
        ("NODE", None), ("CALLBACKS", list_from(production.callbacks))], stream)


define_printer(Production, _print_production)
