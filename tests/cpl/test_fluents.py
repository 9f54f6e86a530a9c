"""Fluents and nets: cpl.md section 16, invariants 1 to 39."""

import gc

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.tasks import waiting
from cramhy_runtime.cpl.fluents import operators as op
from cramhy_runtime.cpl.fluents.fluents import get_update_callback
from cramhy_runtime.cpl.fluents.nets import CachedNet
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream
from cramhy_runtime.languages.commonlisp.tools.describing import describe


def collected(fluent):
    """The values that a callback on ``fluent`` gets, as a list that grows."""
    seen = []
    cpl.register_update_callback(fluent, "collect", seen.append)
    return seen


def pulses(fluent, mode="ONCE"):
    return cpl.pulsed(fluent, handle_missed_pulses=keyword(mode))


def reads(fluent, count):
    return [cpl.value(fluent) for _ in range(count)]


def in_a_plan(*branches):
    return cpl.top_level(lambda: cpl.par(*branches))


def test_anything_but_a_fluent_is_its_own_value():
    thing = object()
    assert cpl.value(thing) is thing and cpl.peek_value(thing) is thing


def test_a_fresh_fluent_is_nil_and_has_a_name_made_up():
    fluent = cpl.make_fluent()
    assert fluent.value is None
    assert fluent.name.name.startswith("FLUENT-")


def test_assigning_returns_the_new_value_whether_or_not_it_changed_anything():
    fluent = cpl.make_fluent(value=1)
    assert fluent.set(2) == 2 and fluent.set(2) == 2


def test_assigning_an_unchanged_value_is_not_a_pulse():
    fluent = cpl.make_fluent(value=1)
    seen = collected(fluent)
    fluent.set(1)
    assert seen == [] and fluent.pulses == 0


def test_one_and_one_point_zero_differ_and_so_do_equal_lists():
    fluent = cpl.make_fluent(value=1)
    seen = collected(fluent)
    fluent.set(1.0)
    fluent.set(lisp_list(1))
    fluent.set(lisp_list(1))
    assert len(seen) == 3


def test_a_test_of_its_own_decides_what_is_a_change():
    fluent = cpl.make_fluent(value=lisp_list(1), test=lambda old, new: list(old) == list(new) or None)
    seen = collected(fluent)
    fluent.set(lisp_list(1))
    assert seen == []
    always = cpl.make_fluent(value=1, test=lambda old, new: None)
    seen = collected(always)
    always.set(1)
    assert seen == [1]


def test_a_pulse_calls_callbacks_and_changes_nothing():
    fluent = cpl.make_fluent(value=7)
    seen = collected(fluent)
    assert cpl.pulse(fluent) is None
    assert seen == [7] and fluent.value == 7


def test_a_callback_may_read_assign_and_register_on_its_own_fluent():
    fluent = cpl.make_fluent(value=0)
    late = []

    def callback(value):
        if value < 3:
            fluent.set(value + 1)
        elif not late:
            cpl.register_update_callback(fluent, "late", late.append)

    cpl.register_update_callback(fluent, "counting", callback)
    fluent.set(1)
    assert fluent.value == 3
    fluent.set(9)
    assert late == [9]


def test_a_callback_name_can_be_taken_once_and_again_after_removal():
    fluent = cpl.make_fluent()
    cpl.register_update_callback(fluent, "name", print)
    with pytest.raises(Error) as problem:
        cpl.register_update_callback(fluent, "name", print)
    assert problem.value.format_control == "Callback with name ~a is already registered."
    assert cpl.remove_update_callback(fluent, "name") is True
    assert cpl.remove_update_callback(fluent, "name") is None
    cpl.register_update_callback(fluent, "name", print)


def test_an_operator_computes_on_plain_values_and_makes_a_net_of_fluents():
    assert op.fl_lt(1, 2) is True and op.fl_lt(2, 1) is None
    fluent = cpl.make_fluent(value=1)
    net = op.fl_lt(fluent, 5)
    assert isinstance(net, CachedNet) and net.value is True
    fluent.set(6)
    assert net.value is None
    assert net.name.name.startswith("FN-FL<")


def test_a_net_follows_all_its_inputs_before_the_assignment_returns():
    left, right = cpl.make_fluent(value=1), cpl.make_fluent(value=2)
    total = cpl.fl_funcall(lambda a, b: a + b, left, right)
    left.set(10)
    assert total.value == 12
    right.set(20)
    assert total.value == 30


def test_a_cached_net_is_computed_once_at_construction_and_pulses_only_when_it_changes():
    calls = []
    fluent = cpl.make_fluent(value=1)
    net = cpl.fl_funcall(lambda value: calls.append(value) or value > 5, fluent)
    seen = collected(net)
    assert calls == [1]
    fluent.set(2)
    assert seen == [] and calls == [1, 2]
    fluent.set(6)
    assert seen == [True]


def test_a_net_over_a_pulse_fluent_is_computed_when_read_and_pulses_every_time():
    calls = []
    fluent = cpl.make_fluent(value=1)
    net = cpl.fl_funcall(lambda pulse: calls.append(pulse), pulses(fluent))
    assert calls == []
    seen = collected(net)
    cpl.pulse(fluent)
    cpl.pulse(fluent)
    assert len(seen) == 2


def test_and_and_or_return_the_deciding_value_and_stop_reading_there():
    assert cpl.fl_and() is True and cpl.fl_or() is None
    assert cpl.fl_and(1, 2) == 2 and cpl.fl_or(None, 3, 4) == 3
    fluent = cpl.make_fluent(value=1)
    first, second = pulses(fluent), pulses(fluent)
    either = cpl.fl_or(first, second)
    cpl.pulse(fluent)
    assert either.value is True
    assert first.peek() is None and second.peek() is True


def test_funcall_does_not_look_into_lists():
    fluent = cpl.make_fluent(value=1)
    assert cpl.fl_funcall(lambda lst: lst.car, lisp_list(fluent)) is fluent


def test_apply_hands_over_a_list_of_values_and_follows_its_elements():
    first, second = cpl.make_fluent(value=3), cpl.make_fluent(value=4)
    net = cpl.fl_apply(lambda value, rest: [value, *rest], first, lisp_list(second, 5))
    assert net.value == [3, 4, 5]
    second.set(6)
    assert net.value == [3, 6, 5]
    alone = cpl.fl_apply(lambda values: list(values), lisp_list(first))
    first.set(9)
    assert alone.value == [9]


def test_a_net_that_cannot_be_computed_fails_at_once_and_leaves_its_input_alone():
    fluent = cpl.make_fluent()
    with pytest.raises(TypeError):
        cpl.fl_funcall(lambda value: value + 1, fluent)
    fluent.set(5)


def test_an_error_in_one_observer_reaches_the_setter_after_all_others_were_told():
    fluent = cpl.make_fluent(value=1)
    broken = cpl.fl_funcall(lambda value: 1 / (value - 2), fluent)
    good = cpl.fl_funcall(lambda value: value * 2, fluent)
    seen = collected(fluent)
    with pytest.raises(ZeroDivisionError):
        fluent.set(2)
    assert (fluent.value, good.value, seen, broken.value) == (2, 4, [2], -1.0)


def test_a_net_that_nobody_holds_is_forgotten_at_the_next_pulse():
    fluent = cpl.make_fluent(value=1)
    net = cpl.fl_funcall(lambda value: value, fluent)
    name = net.name
    assert get_update_callback(fluent, name)[1] is True
    del net
    gc.collect()
    fluent.set(2)
    assert get_update_callback(fluent, name) == (None, None) and fluent.nets == []


def test_a_net_in_the_middle_lives_as_long_as_the_net_above_it():
    fluent = cpl.make_fluent(value=1)
    net = op.fl_not(op.fl_lt(fluent, 5))
    gc.collect()
    fluent.set(9)
    assert net.value is True


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "mode, before, expected",
    [
        ("NEVER", 0, [None, None]), ("ONCE", 0, [None, None]), ("ALWAYS", 0, [None, None]),
        ("NEVER", 2, [None, None, None]), ("ONCE", 2, [True, None, None]), ("ALWAYS", 2, [True, True, None]),
    ],
)  # fmt: skip
def test_pulses_from_before_the_creation(mode, before, expected):
    fluent = cpl.make_fluent()
    for _ in range(before):
        cpl.pulse(fluent)
    assert reads(pulses(fluent, mode), len(expected)) == expected


@pytest.mark.parametrize("mode, expected", [("NEVER", 1), ("ONCE", 1), ("ALWAYS", 3)])
def test_pulses_after_the_creation(mode, expected):
    fluent = cpl.make_fluent()
    pulse = pulses(fluent, mode)
    for _ in range(3):
        cpl.pulse(fluent)
    assert [pulse.peek() for _ in range(5)] == [True] * 5
    assert reads(pulse, 5) == [True] * expected + [None] * (5 - expected)


def test_each_consumer_with_its_own_pulse_fluent_counts_every_pulse():
    fluent = cpl.make_fluent()
    consumers = [pulses(fluent, "ALWAYS") for _ in range(3)]
    for _ in range(4):
        cpl.pulse(fluent)
    assert [sum(map(bool, reads(consumer, 9))) for consumer in consumers] == [4, 4, 4]


def test_only_fluents_can_be_pulsed_and_only_in_three_modes():
    with pytest.raises(Error) as problem:
        cpl.pulsed(3)
    assert problem.value.format_control == "The value of FLUENT is ~S, which is not of type FLUENT."
    with pytest.raises(Error):
        pulses(cpl.make_fluent(), "SOMETIMES")


def test_value_changed_is_true_once_after_a_change_and_not_after_a_mere_pulse():
    fluent = cpl.make_fluent(value=1)
    changed = cpl.fl_value_changed(fluent)
    assert changed.value is None
    cpl.pulse(fluent)
    assert changed.value is None
    fluent.set(2)
    assert changed.peek() is True
    assert reads(changed, 2) == [True, None]


def test_value_changed_goes_on_applying_its_key():
    fluent = cpl.make_fluent(value=1)
    parity = cpl.fl_value_changed(fluent, key=lambda value: value % 2)
    fluent.set(2)
    assert reads(parity, 2) == [True, None]
    fluent.set(4)
    assert parity.value is None


def test_zero_and_the_empty_string_are_true_for_a_wait():
    assert cpl.wait_for(cpl.make_fluent(value=0)) == 0
    assert cpl.wait_for(cpl.make_fluent(value="")) == ""
    assert waiting.wait_for(5) == 5  # as Lisp calls it
    with pytest.raises(Error) as problem:
        waiting.wait_for(None)
    assert problem.value.format_control == "wait-for called with nil argument."


def test_a_true_value_releases_everybody_who_waits_for_it_or_for_a_net_over_it():
    fluent = cpl.make_fluent(value=0)
    done = []

    def waiter():
        done.append(cpl.wait_for(op.fl_gt(fluent, 2)))

    def setter():
        for value in (1, 2, 3):
            cpl.sleep(1)
            fluent.set(value)

    in_a_plan(waiter, waiter, waiter, setter)
    assert done == [True] * 3 and kernel.now() == 3


def test_a_pulse_does_not_release_a_wait_for_a_value_that_is_nil():
    fluent = cpl.make_fluent()

    def pulsing():
        for _ in range(5):
            cpl.sleep(0.1)
            cpl.pulse(fluent)

    in_a_plan(lambda: cpl.wait_for(fluent, timeout=10), pulsing)
    assert kernel.now() == pytest.approx(10)


def test_a_timed_wait_keeps_its_time_however_often_the_fluent_pulses():
    fluent = cpl.make_fluent()

    def pulsing():
        for _ in range(8):
            cpl.sleep(0.1)
            cpl.pulse(fluent)

    result = cpl.top_level(
        lambda: cpl.par(lambda: (cpl.wait_for(cpl.pulsed(fluent), timeout=0), cpl.wait_for(fluent, timeout=1.0), kernel.now()), pulsing)
    )
    assert result == (None, None, 1.0)


def test_a_timeout_of_zero_only_tests():
    assert cpl.wait_for(cpl.make_fluent(value=3), timeout=0) == 3
    assert cpl.wait_for(cpl.make_fluent(), timeout=0) is None
    assert cpl.wait_for(cpl.make_fluent(), timeout=-1) is None


def test_whenever_runs_once_per_pulse_with_always_though_the_body_is_slow():
    fluent = cpl.make_fluent(value=0)
    runs = []

    def react():
        def body():
            cpl.sleep(1)
            runs.append(fluent.value)

        cpl.whenever(pulses(fluent, "ALWAYS"), body)

    def setter():
        for value in range(1, 6):
            fluent.set(value)
        cpl.sleep(100)

    cpl.top_level(lambda: cpl.pursue(react, setter))
    assert runs == [5] * 5


def test_whenever_on_a_true_value_runs_again_and_again_and_lets_others_run():
    fluent = cpl.make_fluent(value=True)
    runs = []
    cpl.top_level(lambda: cpl.pursue(lambda: cpl.whenever(fluent, lambda: runs.append(1)), lambda: cpl.sleep(0.05)))
    assert len(runs) > 5


def test_two_tasks_may_update_two_inputs_of_one_net():
    left, right = cpl.make_fluent(value=0), cpl.make_fluent(value=0)
    net = cpl.fl_funcall(lambda a, b: a + b, left, right)

    def update(fluent):
        for value in range(1, 101):
            fluent.set(value)
            kernel.yield_()

    in_a_plan(lambda: update(left), lambda: update(right))
    assert net.value == 200


def test_a_parameter_reads_and_assigns_its_hidden_fluent():
    name = op.define_cpl_parameter(keyword("SPEED"), 1)
    op.set_parameter_value(op.parameter_value(name) + 1, name)
    assert op.parameter_value(name) == 2


def test_looking_at_a_fluent_consumes_nothing():
    """Printing, ``repr`` and ``describe`` peek."""
    fluent = cpl.make_fluent(value=1)
    pulse, changed = pulses(fluent), cpl.fl_value_changed(fluent)
    fluent.set(2)
    for look in (repr, prin1_to_string, lambda thing: describe(thing, StringOutputStream())):
        for thing in (pulse, changed, cpl.fl_and(pulse, changed)):
            look(thing)
    assert reads(pulse, 2) == [True, None] and reads(changed, 2) == [True, None]
