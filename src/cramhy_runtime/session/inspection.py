"""Inspection: what an object consists of, for who looks at it part by part.

The parts of what Common Lisp has are those of ``inspect``. The objects of CRAM tell more: a fluent its value and who waits for it, a
task its status, its place in the tree and its failure, a designator its resolution. Reading a part has no side effects on a plan: a
fluent is read without taking its pulse. A designator is resolved only when somebody asks, since that can take long and choose at
random: that is an action.
"""

from __future__ import annotations

from typing import NamedTuple

from cramhy_runtime import kernel
from cramhy_runtime.cpl.fluents.fluents import Fluent
from cramhy_runtime.cpl.tasks.tasks import AbstractTask
from cramhy_runtime.designators import classes, resolution
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_end, list_from
from cramhy_runtime.lisp_core.packages import is_symbol
from cramhy_runtime.lisp_core.printing import attempt_to_print, guarded
from cramhy_runtime.languages.commonlisp.objects.classes import class_of
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools import inspecting
from cramhy_runtime.languages.commonlisp.tools.recorded_calls import RecordedCall

from . import world_inspection


class Part(NamedTuple):
    """A part of an object: its label and its value. bound: ``False`` if there is no value, as in an unbound slot."""

    label: str
    value: object
    bound: bool = True


class Action(NamedTuple):
    """Something that can be done with an object: what it is called, and a function of no arguments that does it. Its result, if it is a
    list of one object, is what to look at next."""

    label: str
    run: object


class Inspected(NamedTuple):
    """What an object consists of: a title, `Part`s, and `Action`s."""

    title: str
    parts: list
    actions: list


def inspected(obj):
    """The `Inspected` of ``obj``."""
    if isinstance(obj, Fluent):
        return _fluent(obj)
    if isinstance(obj, AbstractTask):
        return _task(obj)
    if isinstance(obj, classes.Designator):
        return _designator(obj)
    if isinstance(obj, kernel.Task):
        return _kernel_task(obj)
    if isinstance(obj, RecordedCall):
        return _recorded_call(obj)
    if world_inspection.knows(obj):
        title, parts, actions = world_inspection.told(obj)
        return Inspected(title, [Part(*part) for part in parts], [Action(*action) for action in actions])
    title, _, entries = inspecting.parts(obj)
    found = [Part(label or str(index), _of_lisp(value), value is not inspecting.MISSING) for index, (label, value) in enumerate(entries)]
    actions = []
    if isinstance(obj, Cons) and list_end(obj) is not None:
        title = "The object is a CONS."
    if is_symbol(obj) and isinstance(obj, Symbol):
        actions = [Action("unintern it", lambda: _unintern(obj)), Action("make it unbound", lambda: _unbind(obj))]
    if isinstance(obj, Condition) and getattr(obj, "position", None):
        from cramhy_runtime.lisp_core.source_places import describe

        found.append(Part("Place", describe(obj.position)))
    if not isinstance(obj, (Cons, type)) and not is_symbol(obj):
        found.insert(0, Part("Class", class_of(obj)))
    return Inspected(title, found, actions)


def _of_lisp(value):
    """``value``; the tuple of Python in which a condition keeps its arguments as a list of Lisp."""
    return list_from(value) if type(value) is tuple else value


def _unintern(symbol):
    if symbol.package is not None:
        symbol.package.unintern(symbol)


def _unbind(symbol):
    from cramhy_runtime.languages.commonlisp.evaluation.symbols import makunbound

    makunbound(symbol)


def _safe(read):
    """The value that ``read()`` gives, or the text of what went wrong."""
    return guarded(read, lambda problem: f"It cannot be told: {problem}")


def _fluent(fluent):
    parts = [
        Part("Name", fluent.name),
        Part("Value", _safe(fluent.peek)),
        Part("Pulses", fluent.pulses),
        Part("Tasks that wait for it", list_from(list(fluent.waiters or ()))),
        Part("Fluents computed from it", list_from([net for each in fluent.nets or () if (net := each()) is not None])),
    ]
    actions = [Action("pulse it", lambda: fluent.pulse())]
    if hasattr(type(fluent), "value") and getattr(type(fluent).value, "fset", None):
        actions.append(Action("set it to NIL", lambda: setattr(fluent, "value", None)))
    return Inspected(f"The object is a fluent of type {prin1_to_string(class_of(fluent))}.", parts, actions)


def _attributes(obj, names):
    found = []
    for label, name in names:
        value = guarded(lambda name=name: getattr(obj, name, inspecting.MISSING), lambda problem: inspecting.MISSING)
        if value is not inspecting.MISSING:
            found.append(Part(label, list_from(list(value)) if isinstance(value, (list, tuple, set, dict)) else value))
    return found


def _task(task):
    parts = _attributes(
        task,
        [
            ("Name", "name"),
            ("Status", "status"),
            ("Result", "result"),
            ("Failure", "exception"),
            ("Parent", "parent"),
            ("Children", "children"),
            ("Path", "path"),
        ],
    )
    return Inspected("The object is a task.", parts, [Action("evaporate it", lambda: task.evaporate())])


def _kernel_task(task):
    parts = [
        Part("Name", task.name),
        Part("State", task.state),
        Part("Waits for", task.describe_why()),
        Part("Parent", task.parent),
        Part("Task of the plan", task.owner),
    ]
    return Inspected("The object is a thread of control.", parts, [Action("end it", lambda: task.cancel("it was killed"))])


def _recorded_call(call):
    ended = not isinstance(call.outcome, str)
    parts = [
        Part("Function", call.name),
        Part("Arguments", list_from(call.arguments)),
        Part("Values", list_from(call.outcome)) if ended else Part("State", call.outcome),
        Part("Called by", call.outer),
        Part("Calls", list_from(call.inner)),
        Part("Task", call.task),
        Part("Time", call.began),
    ]
    return Inspected("The object is a recorded call.", parts, [])


def _designator(designator):
    parts = [Part("Class", class_of(designator)), *[_pair(pair) for pair in classes.pairs_of(designator)]]
    parts += _attributes(
        designator, [("Parent", "parent"), ("Successor", "successor"), ("Effective", "effective"), ("Timestamp", "timestamp")]
    )
    known = _safe(lambda: resolution.known(designator))
    parts.append(Part("Resolution so far", known))

    def resolve():
        return [resolution.reference(designator)]

    return Inspected("The object is a designator.", parts, [Action("resolve it", resolve)])


def _pair(pair):
    return (
        Part(attempt_to_print(prin1_to_string, pair.car), classes.value_of(pair))
        if isinstance(pair, Cons)
        else Part(attempt_to_print(prin1_to_string, pair), pair)
    )
