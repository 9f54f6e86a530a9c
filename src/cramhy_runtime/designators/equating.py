"""Equating: saying that two designators describe the same thing.

Equated designators form a chain from the oldest to the youngest. A new member goes behind the youngest, not behind the one it was
equated to; if it brings ancestors of its own, these go in front of the oldest. All members get the object id of the oldest, and
their callbacks are told. Source: designators.md section 6.
"""

from __future__ import annotations

from ..cpl.hooks import Hook
from ..lisp.conditions import error, type_error
from ..lisp.data import list_from
from .classes import Designator, DesignatorError

on_equate_designators = Hook("on-equate-designators")


def equate(parent, successor):
    """Join the chains of the two and return ``successor``; an error if they are one already."""
    if desig_equal(parent, successor):
        return error("Cannot equate designators that are already equal.")
    if on_equate_designators:
        on_equate_designators(successor, parent)
    oldest, youngest = first_desig(parent), current_desig(parent)
    ancestor = successor.parent
    if ancestor is not None:
        ancestor.successor = oldest
        oldest.parent = ancestor
    successor.parent = youngest
    youngest.successor = successor
    members = chain(parent)
    identity = members[0].object_id
    for member in members:
        member.object_id = identity
    for member in members:
        for callback in list(member.callbacks or ()):
            callback(successor)
    return successor


def chain(designator):
    """The members of its chain, oldest first, as a Python list."""
    members, member = [], first_desig(designator)
    while member is not None:
        members.append(member)
        member = member.successor
    return members


def desig_equal(first, second):
    """Whether both are designators of one chain."""
    if not isinstance(first, Designator) or not isinstance(second, Designator):
        return None
    return True if first_desig(first) is first_desig(second) else None


def first_desig(designator):
    """The oldest of its chain."""
    while designator.parent is not None:
        designator = designator.parent
    return designator


def current_desig(designator):
    """The youngest of its chain; nil for nil."""
    if designator is None:
        return None
    if not isinstance(designator, Designator):
        from ..lisp.generic import no_applicable_method

        return no_applicable_method("CRAM-DESIGNATORS:CURRENT-DESIG", (designator,))
    while designator.successor is not None:
        designator = designator.successor
    return designator


def newest_effective_designator(designator):
    """The youngest effective member of its chain, or nil."""
    member = current_desig(designator)
    while member is not None and member.effective is None:
        member = member.parent
    return member


def get_equal_designators(designator):
    """The others of its chain: ancestors oldest first, then successors youngest first."""
    members = chain(designator)
    here = members.index(designator)
    return list_from(members[:here] + members[:here:-1])


def designator_solutions(designator, from_root=None):
    """The lazy list of its reference (or that of the oldest) and those of the solutions after it; empty if it has none."""
    from ..lisp.conditions import handler_case
    from ..prolog.lazy_lists import from_iterator
    from .resolution import next_solution, reference

    def solutions():
        member = first_desig(designator) if from_root is not None else designator
        while member is not None:
            value = handler_case([(DesignatorError, lambda problem: _END)], lambda: reference(member))
            if value is _END or value is None:
                return
            yield value
            member = handler_case([(DesignatorError, lambda problem: None)], lambda: next_solution(member))

    return from_iterator(solutions())


_END = object()


def register_equate_callback(designator, callback):
    """Call ``callback`` with the new member whenever the chain is joined to another."""
    if not callable(callback):
        return type_error(callback, "FUNCTION")
    if designator.callbacks is None:
        designator.callbacks = []
    if callback not in designator.callbacks:
        designator.callbacks.append(callback)
    return callback


def unregister_equate_callback(designator, callback):
    """Forget ``callback``; an unknown one is ignored."""
    if designator.callbacks and callback in designator.callbacks:
        designator.callbacks.remove(callback)


def with_equate_callback(designator, callback, body):
    """Values of ``body()`` while ``callback`` is registered."""
    register_equate_callback(designator, callback)
    try:
        return body()
    finally:
        unregister_equate_callback(designator, callback)
