"""Timers: `call_at` and `call_every`."""

import pytest

from cramhy_runtime import kernel


def test_a_timer_fires_once_at_its_time(k):
    times = []
    timer = kernel.call_at(2.5, lambda: times.append(kernel.now()))
    assert timer.active
    kernel.sleep(10)
    assert times == [2.5]
    assert not timer.active


def test_timers_with_the_same_time_fire_in_the_order_of_creation(k):
    log = []
    for name in range(10):
        kernel.call_at(1.0, lambda name=name: log.append(name))
    kernel.sleep(2)
    assert log == list(range(10))


def test_a_periodic_timer_keeps_its_place_before_one_made_later(k):
    log = []
    kernel.call_every(1.0, lambda: log.append("first"))
    kernel.call_every(0.5, lambda: log.append("second"))
    kernel.sleep(2.1)
    assert log == ["second", "first", "second", "second", "first", "second"]


def test_a_periodic_timer_does_not_drift(k):
    times = []
    kernel.call_every(0.1, lambda: times.append(kernel.now()))
    kernel.sleep(100.01)
    assert times == [0.1 + n * 0.1 for n in range(1000)]


def test_a_periodic_timer_may_say_when_it_begins(k):
    times = []
    kernel.call_every(2.0, lambda: times.append(kernel.now()), first=0.5)
    kernel.sleep(5)
    assert times == [0.5, 2.5, 4.5]


def test_a_cancelled_timer_does_not_fire(k):
    log = []
    timer = kernel.call_at(1.0, lambda: log.append("fired"))
    timer.cancel()
    timer.cancel()
    kernel.sleep(2)
    assert log == []


def test_a_periodic_timer_may_cancel_itself(k):
    log = []

    def tick():
        log.append(kernel.now())
        if len(log) == 3:
            timer.cancel()

    timer = kernel.call_every(1.0, tick)
    kernel.sleep(10)
    assert log == [1.0, 2.0, 3.0]


def test_a_timer_may_cancel_another_of_the_same_time(k):
    log = []
    kernel.call_at(1.0, lambda: later.cancel())
    later = kernel.call_at(1.0, lambda: log.append("fired"))
    kernel.sleep(2)
    assert log == []


def test_a_timer_may_wake_and_spawn(k):
    log = []
    waiting = kernel.spawn(kernel.park, "the timer")
    kernel.call_at(1.0, lambda: kernel.unpark(waiting))
    kernel.call_at(2.0, lambda: kernel.spawn(lambda: log.append(kernel.current().parent)))
    waiting.join()
    assert kernel.now() == 1.0
    kernel.sleep(2)
    assert log == [k.main]


def test_a_timer_in_the_past_fires_at_the_next_hand_over(k):
    kernel.sleep(5)
    log = []
    kernel.call_at(1.0, lambda: log.append(kernel.now()))
    assert log == []
    kernel.yield_()
    assert log == [5.0]


def test_a_failing_callback_is_reported_and_the_scheduler_goes_on(k, reported):
    kernel.call_at(1.0, lambda: 1 / 0)
    kernel.sleep(2)
    assert kernel.now() == 2.0
    ((name, exception),) = reported
    assert name == "scheduler"
    assert isinstance(exception, ZeroDivisionError)


def test_a_periodic_timer_that_fails_fires_again(k, reported):
    kernel.call_every(1.0, lambda: 1 / 0)
    kernel.sleep(3.5)
    assert len(reported) == 3


@pytest.mark.parametrize("wait", [lambda: kernel.park("x"), lambda: kernel.sleep(1), kernel.yield_, kernel.settle])
def test_a_callback_that_tries_to_wait_is_told_what_to_do(k, reported, wait):
    kernel.call_at(1.0, wait)
    kernel.sleep(2)
    ((_, exception),) = reported
    assert str(exception) == (
        "A timer or a posted function tried to wait. It runs inside of the scheduler, where nothing can wait: "
        "spawn a task that waits, or wake one."
    )


def test_a_callback_with_long_loops_is_not_preempted(k):
    counted = []

    def count():
        for _ in range(5000):
            kernel.checkpoint()
        counted.append(kernel.now())

    kernel.call_at(1.0, count)
    kernel.sleep(2)
    assert counted == [1.0]


def test_a_callback_does_not_see_the_dynamic_state_of_the_task_it_came_upon(k):
    log = []

    class Bindings:
        def leave(self):
            log.append("leave")

        def enter(self):
            log.append("enter")

    kernel.call_at(1.0, lambda: log.append("fired"))
    kernel.current().dynamic = Bindings()
    kernel.sleep(2)
    kernel.current().dynamic = None
    assert log == ["leave", "fired", "enter"]


def test_timers_that_add_timers_for_now_do_not_keep_the_tasks_from_running(k):
    log = []

    def again():
        if not log:
            kernel.call_at(kernel.now(), again)

    kernel.call_at(0.0, again)
    kernel.spawn(log.append, "ran").join()
    assert log == ["ran"]


@pytest.mark.parametrize("period", [0, -1.0, float("inf"), float("nan")])
def test_a_period_must_be_a_time(k, period):
    with pytest.raises(ValueError) as told:
        kernel.call_every(period, lambda: None)
    assert str(told.value) == f"The period of a timer must be more than 0 s and finite, not {period}."


@pytest.mark.parametrize("time", [float("inf"), float("nan")])
def test_a_time_must_come(k, time):
    with pytest.raises(ValueError) as told:
        kernel.call_at(time, lambda: None)
    assert str(told.value) == f"A timer needs a finite time, not {time}."
