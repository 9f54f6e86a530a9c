"""Rete's memory: facts that come and go, and queries for patterns of facts.

A fact is a proper list of constants; the memory counts how often each was asserted. It is a tree that branches by the elements of
the facts (the original's alpha network), so the search for a pattern follows only its constants. Elements are compared as Prolog compares
terms, by content, and lists in a pattern may have variables in them. The original compares by ``eql``, so that a text or a list never
matches; a class with a method for `object_id` is compared by what that gives. Watchers of the memory hear of facts that come and go (see
``productions.py``). Source: prolog.md section 12.1.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from cramhy_runtime.lisp_core.data import FLOATS, list_end
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, list_from, list_parts, one, python_list, truth
from cramhy_runtime.lisp_core.equality import eql_key, equal_key
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.printing import define_printer, output_object, print_unreadable
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic, when_methods_change
from cramhy_runtime.lisp_core.dispatch.methods import specializer_of
from cramhy_runtime.utilities.lazy_lists import force_ll, from_iterator, lazy_cdr
from cramhy_runtime.utilities.patterns import ANONYMOUS, compared_by_python, equal, substitute_vars, variable, vars_in
from cramhy_runtime.kernel.images import Cell, per_image
from cramhy_runtime.kernel.typing_names import Any

from .native_predicates import predicate
from ..symbols import sym
from ..terms.terms import import_term, raw

object_id = generic(
    "CRAM-PROLOG::OBJECT-ID",
    "(obj)",
    documentation="""
    The object that identifies ``obj`` as an element of a fact: itself, unless there is a method for its class.""",
)
object_id.method(object)(lambda obj: obj)

_ATOMS = frozenset([Symbol, Keyword, int, str, *FLOATS, bool, type(None)])
_plain = Cell(_ATOMS)  # the classes whose objects are their own identity


@when_methods_change
def _see_who_has_identity(function):
    """While no method of `object_id` is about atoms, `identity` need not call it for them."""
    if function is object_id:
        special = [method.specializers[0] for method in function.methods if method.specializers[0] is not specializer_of(object)]
        about_atoms = any(not isinstance(cls, type) or any(issubclass(atom, cls) for atom in _ATOMS) for cls in special)
        _plain.value = frozenset() if about_atoms else _ATOMS


def identity(obj: Any) -> Any:
    """The `object_id` of ``obj``."""
    return obj if obj.__class__ in _plain.value else one(object_id(obj))


def content_key(obj: Any) -> Any:
    """A hashable value that is the same for two elements of facts exactly if they are the same for Prolog. It may hold ``id(obj)``.

    A list that is circular is the same as itself only.
    """
    obj = identity(obj)
    cls = obj.__class__
    if cls is Symbol or cls is Keyword or cls is int or cls is str or obj is None:
        return obj
    if isinstance(obj, Cons):
        if isinstance(list_end(obj), Cons):
            return eql_key(obj)
        items, end = list_parts(force_ll(obj))
        return ("cons", *map(content_key, items), content_key(end))
    if compared_by_python(cls):
        try:
            hash(obj)
        except TypeError:  # a part of it can change
            return eql_key(obj)
        return cls, obj
    return equal_key(obj)


class Node:
    """A node of the tree: the facts with the same beginning. At the end of a fact, ``occurrences`` are its assertions that still hold."""

    __slots__ = ("parent", "key", "identity", "children", "fact", "occurrences")

    def __init__(self, parent=None, key=None, identity=None):
        self.parent, self.key, self.identity = parent, key, identity  # a key is only good while the object lives
        self.children = {}
        self.fact = None
        self.occurrences = []

    def copy(self):
        """A copy of the tree from here on."""
        made = Node(self.parent, self.key, self.identity)
        made.fact, made.occurrences = self.fact, list(self.occurrences)
        for key, child in self.children.items():
            made.children[key] = copied = child.copy()
            copied.parent = made
        return made

    def size(self):
        """The number of nodes from here on."""
        count, nodes = 0, [self]
        while nodes:
            count += 1
            nodes += nodes.pop().children.values()
        return count

    def leaves(self, pattern=None):
        """The nodes of the facts that hold and that fit the constants of ``pattern`` (all facts, without one), newest first."""
        stack = [(self, pattern)]
        while stack:
            node, cell = stack.pop()
            if node.occurrences and not (pattern is not None and isinstance(cell, Cons)):
                yield node
            if isinstance(cell, Cons):
                item, rest = cell.car, cell.cdr
                if not variable(item) and (item.__class__ is not Cons or vars_in(item) is None):
                    child = node.children.get(content_key(item))
                    if child is not None:
                        stack.append((child, rest))
                    continue
            elif cell is None and pattern is not None:
                continue
            else:
                rest = cell
            stack += [(child, rest) for child in node.children.values()]


_ALPHA_NODE = sym("CRAM-PROLOG::ALPHA-NODE")


def _print_node(node, stream):
    print_unreadable(node, stream, identity=True, body=lambda: output_object(_ALPHA_NODE, stream))


define_printer(Node, _print_node)


class Occurrence:
    """One assertion of a fact."""

    __slots__ = ("fact",)

    def __init__(self, fact):
        self.fact = fact


class Memory:
    """The facts that hold. ``watchers`` are called as ``watcher(operation, occurrence)`` with ``"ASSERT"`` and ``"RETRACT"``."""

    def __init__(self):
        self.watchers = []
        self.clear()

    def clear(self):
        """Forget all facts, without calling watchers."""
        self.root = Node()
        self.occurrences = {}  # in order of assertion

    def matching(self, pattern):
        """The occurrences of the facts that may match ``pattern``, oldest first."""
        found = [occurrence for leaf in self.root.leaves(pattern) for occurrence in leaf.occurrences]
        return found[::-1]

    def tell(self, operation, occurrence):
        """Call the watchers."""
        for watcher in self.watchers:
            watcher(operation, occurrence)


memory = per_image(Memory())


def same(one_element: object, other: object) -> bool:
    """Whether two elements of facts are the same for Prolog."""
    return bool(equal(one_element, other))


def match_fact(pattern: Any, fact: Any, bindings: dict[Symbol, Any], test: Any = same) -> dict[Symbol, Any] | None:
    """A copy of the dict ``bindings``, extended so that ``pattern`` equals ``fact``, or ``None`` if that is impossible.

    test: compares two elements that are no variables. Only with `same` are lists in the pattern looked into.
    """
    extended = dict(bindings)
    while pattern.__class__ is Cons and fact.__class__ is Cons:
        item = pattern.car
        if item.__class__ is Symbol and item is fact.car and item.name[:1] != "?" and test is same:
            pass
        elif not _element_matches(item, fact.car, extended, test):
            return None
        pattern, fact = pattern.cdr, fact.cdr
    if pattern is None and fact is None or (pattern is not None and _element_matches(pattern, fact, extended, test)):
        return extended
    return None


def _element_matches(item: Any, value: Any, bindings: dict[Symbol, Any], test: Any) -> bool:
    if variable(item):
        if item is ANONYMOUS:
            return True
        if item not in bindings:
            bindings[item] = value
            return True
        item = bindings[item]
    elif item.__class__ is Cons and value.__class__ is Cons and test is same:
        return _list_matches(item, value, bindings)
    return truth(one(test(identity(item), identity(value))))


def _list_matches(pattern: Any, value: Any, bindings: dict[Symbol, Any]) -> bool:
    while pattern.__class__ is Cons and value.__class__ is Cons:
        if pattern is value and vars_in(pattern) is None:
            return True
        if not _element_matches(pattern.car, value.car, bindings, same):
            return False
        pattern, value = lazy_cdr(pattern), lazy_cdr(value)
    return _element_matches(pattern, value, bindings, same)


# -------------------------------------------------------------------------------------------------------------------- facts


def _leaf(fact, create):
    node = memory.root
    for element in python_list(fact):
        key = content_key(element)
        child = node.children.get(key)
        if child is None:
            if not create:
                return None
            child = node.children[key] = Node(node, key, element)
        node = child
    return node


def _check(fact):
    if fact is None:
        error("The assertion FACT failed: a fact is a list with at least one element.")
    if not isinstance(fact, Cons):
        type_error(fact, "LIST", "\nwhen binding LIST")
    end = list_end(fact)
    if end is not None and not isinstance(end, Cons):
        type_error(end, "LIST")
    if end is not None:
        error("The list that starts with ~s is circular: a fact is a proper list.", fact.car)
    if any(element is ANONYMOUS for element in python_list(fact)):
        error("The assertion (NOT (FIND '?_ FACT)) failed: the fact ~s contains ?_.", fact)


def rete_assert(fact):
    """``(rete-assert fact)``: add one occurrence of ``fact`` and tell the productions. Returns the memory node.

    A fact that is ``nil``, not a proper list, or contains ``?_``, is an error.
    """
    _check(fact)
    node, occurrence = _leaf(fact, True), Occurrence(fact)
    node.fact = fact
    node.occurrences.append(occurrence)
    memory.occurrences[occurrence] = None
    memory.tell("ASSERT", occurrence)
    return node


def rete_retract(fact):
    """``(rete-retract fact)``: remove the newest occurrence of ``fact`` and tell the productions. Returns the memory node.

    If the fact does not hold, it is an error.
    """
    node = _leaf(fact, False) if isinstance(fact, Cons) and list_end(fact) is None else None
    if node is None or not node.occurrences:
        return error("wme-memory already empty. Cannot retract.")
    occurrence = node.occurrences.pop()
    del memory.occurrences[occurrence]
    empty = node
    while not empty.occurrences and not empty.children and empty.parent is not None:  # what no fact needs takes no room
        del empty.parent.children[empty.key]
        empty = empty.parent
    memory.tell("RETRACT", occurrence)
    return node


def with_facts_asserted(fact_thunks, body):
    """``with-facts-asserted``: assert the facts that the thunks return, call ``body``, and retract them in the same order on any exit.

    If the body has retracted one of them itself, that is an error as in `rete_retract`, after the others are retracted.
    """
    with asserted(one(thunk()) for thunk in fact_thunks):
        return body()


@contextmanager
def asserted(facts: Iterable[Cons]) -> Iterator[None]:
    """The facts, an iterable, hold while the block runs, see `with_facts_asserted`."""
    those = []
    try:
        for fact in facts:
            _check(fact)
            those.append(fact)  # before a handler hears of it, who may leave by an exit
            rete_assert(fact)
        yield
    finally:
        _retract_all(those)


def _retract_all(facts):
    for index, fact in enumerate(facts):
        try:
            rete_retract(fact)
        except BaseException:
            _retract_all(facts[index + 1 :])
            raise


def clear_alpha_network():
    """``(clear-alpha-network)``: retract all facts and empty the memory. Productions registered before are not told of facts any more."""
    try:
        _retract_all([occurrence.fact for occurrence in memory.occurrences])
    finally:
        memory.clear()
        memory.tell("CLEAR", None)


def alpha_network_size(node=None):
    """``(alpha-network-size &optional node)``: the number of nodes below ``node`` (default: the root), itself included."""
    if not (node is None or isinstance(node, Node)):
        return type_error(node, _ALPHA_NODE)
    return (node or memory.root).size()


def _pairs(bindings, tail=None):
    return list_from([Cons(symbol, value) for symbol, value in reversed(bindings.items())], tail)


def rete_holds(fact_pattern, test=None, processed=None, node=None):
    """``(rete-holds fact-pattern)``: the lazy list of bindings under which the pattern is a fact, the newest fact first.

    test: compares the identities of elements; by default Prolog does, also within lists. node: a node of the memory; then only facts
    below it count.
    """
    compare = same if test is None else function_of(test)
    if compare is same and node is None and vars_in(fact_pattern) is None:
        leaf = _leaf(fact_pattern, False) if isinstance(fact_pattern, Cons) else None
        return Cons(None) if leaf is not None and leaf.occurrences else None

    def matches():
        by_constants = fact_pattern if compare is same and node is None else None
        for leaf in list((node or memory.root).leaves(by_constants)):
            bindings = match_fact(fact_pattern, leaf.fact, {}, compare)
            if bindings is not None:
                yield _pairs(bindings)

    return from_iterator(matches())


def rete_prove(expr, bdgs=None):
    """``(rete-prove expr &optional bdgs)``: the lazy list of bindings under which all patterns of the list ``expr`` are facts."""

    def join(patterns, bindings):
        if patterns is None:
            yield bindings
            return
        pattern = substitute_vars(patterns.car, bindings)
        for leaf in list(memory.root.leaves(pattern)):
            found = match_fact(pattern, leaf.fact, {})
            if found is not None:
                yield from join(patterns.cdr, _pairs(found, bindings))

    if expr is None:
        return Cons(bdgs)
    if list_end(expr) is not None:
        return type_error(expr, "LIST")
    return from_iterator(join(expr, bdgs))


@predicate("CRAM-PROLOG::RETE-HOLDS")
def _rete_holds(m, pattern):
    written = raw(pattern, m.names)
    if not isinstance(written, Cons):
        error("The pattern ~a of a RETE-HOLDS goal is not a list.", written)
    for leaf in list(memory.root.leaves(written)):
        bindings = match_fact(written, leaf.fact, {})
        if bindings is not None:
            pairs = [term for symbol, value in bindings.items() for term in (import_term(symbol, m.names), value)]
            if m.unify(*pairs):
                yield
