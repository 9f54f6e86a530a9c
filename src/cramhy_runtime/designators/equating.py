"""Equating: saying that two designators describe the same thing.

Equated designators form a chain from the oldest to the youngest. A new member goes behind the youngest, not behind the one to which it
was equated. If it has ancestors of its own, they go in front of the oldest. All members get the object id of the oldest, and their
callbacks are called. Source: designators.md section 6.
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime.lisp_core.conditions import error, handler_case, type_error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.hooks import Hook
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic, protocol_function
from cramhy_runtime.lisp_core.packages import is_symbol
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from ..utilities.lazy_lists import from_iterator
from .classes import Designator, DesignatorError, copy_designator
from .protocol import equate, next_solution, reference

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from .signatures import EqualityOfTwo, OfOne

on_equate_designators = Hook("CUT::ON-EQUATE-DESIGNATORS", "(successor parent)")
desig_equal: EqualityOfTwo = generic("DESIG::DESIG-EQUAL", "(desig-1 desig-2)", documentation="Whether both are designators of one chain.")
first_desig: OfOne = generic("DESIG::FIRST-DESIG", "(desig)", documentation="The oldest designator of its chain.")
current_desig: OfOne = generic("DESIG::CURRENT-DESIG", "(desig)", documentation="The youngest designator of its chain; nil for nil.")


@equate.method(Designator, Designator)
def _equate(parent, successor):
    if desig_equal(parent, successor):
        return error("Cannot equate designators that are already equal.")
    if on_equate_designators:
        on_equate_designators(successor, parent)
    first, last = oldest(parent), youngest(parent)
    ancestor = successor.parent
    if ancestor is not None:
        ancestor.successor = first
        first.parent = ancestor
    successor.parent = last
    last.successor = successor
    members = chain(parent)
    identity = members[0].object_id
    for member in members:
        member.object_id = identity
    _tell([callback for member in members for callback in member.callbacks or ()], successor)
    return successor


def _tell(callbacks, successor):
    """Call all ``callbacks``. An exit from one of them goes on when the others have been called."""
    for index, callback in enumerate(callbacks):
        try:
            callback(successor)
        except BaseException:
            _tell(callbacks[index + 1 :], successor)
            raise


def chain(designator):
    """The members of the chain of ``designator``, oldest first, as a Python list."""
    members, member = [], oldest(designator)
    while member is not None:
        members.append(member)
        member = member.successor
    return members


@desig_equal.method(None, None)
def _never_equal(first, second):
    return None


@desig_equal.method(Designator, Designator)
def _same_chain(first, second):
    return True if oldest(first) is oldest(second) else None


@first_desig.method(Designator)
def oldest(designator):
    """The oldest member of the chain of ``designator``."""
    while designator.parent is not None:
        designator = designator.parent
    return designator


@current_desig.method(Designator)
def youngest(designator):
    """The youngest member of the chain of ``designator``."""
    while designator.successor is not None:
        designator = designator.successor
    return designator


@current_desig.method(type(None))
def _no_designator(designator):
    return None


def newest_effective_designator(desig):
    """The youngest effective member of the chain of ``desig``, or nil."""
    member = current_desig(desig)
    while member is not None and member.effective is None:
        member = member.parent
    return member


def _designator(thing):
    return thing if isinstance(thing, Designator) else type_error(thing, "DESIGNATOR")


def get_equal_designators(d):
    """The other members of the chain of ``d``: its ancestors oldest first, then its successors youngest first."""
    members = chain(_designator(d))
    here = members.index(d)
    return list_from(members[:here] + members[:here:-1])


def designator_solutions(desig, from_root=None):
    """The lazy list of the references of ``desig`` and of its next solutions; empty if it has none.

    With ``from_root``, it begins with the oldest member of the chain.
    """
    _designator(desig)

    def solutions():
        member = oldest(desig) if from_root is not None else desig
        while member is not None:
            value = handler_case([(DesignatorError, lambda problem: _END)], lambda: reference(member))
            if value is _END or value is None:
                return
            yield value
            member = handler_case([(DesignatorError, lambda problem: None)], lambda: next_solution(member))

    return from_iterator(solutions())


_END = object()


def _reset(designator: Designator) -> Designator:
    copy: Designator = copy_designator(designator)
    equate(designator, copy)
    return copy


reset = protocol_function("DESIG::RESET", "(desig)", _reset)
"""``desig:reset``: a new designator with the same description and without solutions, which is equated to the old one."""

register_equate_callback = generic(
    "DESIG::REGISTER-EQUATE-CALLBACK",
    "(designator callback)",
    documentation="""
Call ``callback`` with the new member whenever the chain is joined to another.""",
)
unregister_equate_callback = generic(
    "DESIG::UNREGISTER-EQUATE-CALLBACK",
    "(designator callback)",
    documentation="""
Stop calling ``callback``. An unknown one is ignored.""",
)


@register_equate_callback.method(Designator, None)
def _register_equate_callback(designator, callback):
    if not callable(callback) or is_symbol(callback):
        return type_error(callback, "FUNCTION")
    if designator.callbacks is None:
        designator.callbacks = []
    if callback not in designator.callbacks:
        designator.callbacks.append(callback)
    return callback


@unregister_equate_callback.method(Designator, None)
def _unregister_equate_callback(designator, callback):
    if designator.callbacks and callback in designator.callbacks:
        designator.callbacks.remove(callback)


def with_equate_callback(designator, callback, body):
    """Call ``body()`` while ``callback`` is registered, and return its values."""
    with told_of_equating(designator, callback):
        return body()


@contextmanager
def told_of_equating(designator: Designator, callback: Callable[[Designator], object]) -> Iterator[None]:
    """``callback`` is registered while the block runs."""
    register_equate_callback(designator, callback)
    try:
        yield
    finally:
        unregister_equate_callback(designator, callback)
