"""Designators inside plans: ``with-designators`` and ``with-equate-fluent`` (designators.md section 10)."""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.cpl.fluents.fluents import make_fluent
from cramhy_runtime.cpl.tree.task_tree import with_task_tree_node
from cramhy_runtime.lisp_core.data import lisp_list, one
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.hooks import Hook
from cramhy_runtime.designators.classes import make_designator
from cramhy_runtime.designators.equating import with_equate_callback
from cramhy_runtime.designators.symbols import sym

on_with_designator = Hook("CPL::ON-WITH-DESIGNATOR", "(designator)")
_create_functions = per_image([])


def register_designator_create_function(function):
    """Ask ``function(name, type, properties)`` first when ``with-designators`` makes a designator; nil passes the question on."""
    if function in _create_functions:
        _create_functions.remove(function)
    _create_functions.insert(0, function)
    return function


def create_designator(name, type_, properties):
    """The designator that a definition ``(name type properties)`` of ``with-designators`` makes."""
    for function in _create_functions:
        made = one(function_of(function)(name, type_, properties))
        if made is not None:
            break
    else:
        made = make_designator(type_, properties)
    if on_with_designator:
        on_with_designator(made)
    return made


def with_designators(body, definitions=None):
    """Values of ``body()``, run as a node ``WITH-DESIGNATORS`` of the task tree; ``definitions`` are the forms, for the path.

    The macro binds the names sequentially, each to `create_designator` of its name, type and properties, inside ``body``.
    """
    return with_task_tree_node(
        lisp_list(sym("CPL-IMPL::GOAL-CONTEXT"), lisp_list(sym("CPL-DESIG-SUPP::WITH-DESIGNATORS"), definitions)),
        body,
        name="WITH-DESIGNATORS",
    )


def with_equate_fluent(designator, name, body):
    """Values of ``body(fluent)`` with a new fluent that is pulsed whenever the chain of ``designator`` is equated."""
    fluent = make_fluent(name=name)
    return with_equate_callback(designator, lambda successor: fluent.pulse(), lambda: body(fluent))
