"""The trail forgets variables that nobody else knows, and no others."""

from __future__ import annotations

import gc
import weakref

from cramhy_runtime.prolog.engine.machine import Machine
from cramhy_runtime.prolog.terms.terms import UNSET, Var


class _Undo:
    """An entry that is no variable."""


def bound(machine, value):
    variable = Var()
    variable.ref = value
    machine.trail.append(variable)
    return variable


def machine_with_a_choice(height):
    machine = Machine.__new__(Machine)
    machine.trail, machine.choices = [], []
    older = [bound(machine, number) for number in range(height)]
    machine.choices.append((None, None, len(machine.trail)))
    return machine, [weakref.ref(each) for each in older]


def test_what_only_the_trail_knows_is_forgotten_above_the_newest_choice_point():
    machine, older = machine_with_a_choice(3)
    known = bound(machine, "kept")
    gone = weakref.ref(bound(machine, "gone"))
    machine._tidy()
    assert machine.trail[3:] == [known]
    assert gone() is None
    assert all(each() is not None for each in older)  # a choice point may unbind them


def test_chains_of_variables_live_as_long_as_somebody_knows_their_beginning():
    machine, _ = machine_with_a_choice(0)
    last = bound(machine, 1)
    middle = bound(machine, last)
    first = bound(machine, middle)
    unknown = bound(machine, bound(machine, 2))
    last = middle = unknown = None  # noqa: F841
    machine._tidy()
    assert [each.ref if each.ref.__class__ is not Var else "variable" for each in machine.trail] == [1, "variable", "variable"]
    assert first.ref.ref.ref == 1 and first.ref is not UNSET


def test_other_entries_stay_and_the_order_is_kept():
    machine, _ = machine_with_a_choice(1)
    undo, variables = _Undo(), [bound(machine, number) for number in range(5)]
    machine.trail.insert(3, undo)
    before = machine.trail[1:]
    machine._tidy()
    assert machine.trail[1:] == before and len(variables) == 5


def test_a_long_deterministic_proof_keeps_its_trail_short(monkeypatch):
    machine, _ = machine_with_a_choice(0)
    for number in range(50_000):
        bound(machine, number)
    gc.disable()  # nothing here is left to the collector
    try:
        machine._tidy()
    finally:
        gc.enable()
    assert machine.trail == []
