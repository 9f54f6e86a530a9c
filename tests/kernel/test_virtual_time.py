"""Virtual time: it stands while anything runs, and jumps when everything is parked (law 5)."""

import pytest

from cramhy_runtime import kernel


def test_it_begins_at_zero_and_stands_while_the_main_task_runs(k):
    sum(range(100000))
    assert kernel.now() == 0.0


def test_a_sleep_takes_no_time_of_ours(k):
    kernel.sleep(86400.0)
    assert kernel.now() == 86400.0


def test_sleepers_wake_in_the_order_of_their_times(k):
    log = []

    def sleeper(seconds):
        kernel.sleep(seconds)
        log.append((seconds, kernel.now()))

    for task in [kernel.spawn(sleeper, seconds) for seconds in (3, 1, 2)]:
        task.join()
    assert log == [(1, 1.0), (2, 2.0), (3, 3.0)]


def test_sleepers_with_the_same_time_wake_in_the_order_they_went_to_sleep(k):
    log = []

    def sleeper(name):
        kernel.sleep(1)
        log.append(name)

    for task in [kernel.spawn(sleeper, name) for name in range(20)]:
        task.join()
    assert log == list(range(20))


def test_a_wake_up_does_not_cut_a_sleep_short(k):
    task = kernel.spawn(kernel.sleep, 2)
    kernel.sleep(1)
    kernel.unpark(task)
    task.join()
    assert kernel.now() == 2.0


@pytest.mark.parametrize("seconds", [0, -1, 0.0])
def test_a_sleep_of_nothing_yields(k, seconds):
    log = []
    kernel.spawn(log.append, "other")
    kernel.sleep(seconds)
    assert log == ["other"]
    assert kernel.now() == 0.0


def test_a_sleep_for_ever_is_a_park_without_a_time(k):
    with pytest.raises(kernel.Deadlock):
        kernel.sleep(float("inf"))


def test_a_time_that_is_not_a_number_is_refused(k):
    with pytest.raises(ValueError, match="The time to sleep is not a number."):
        kernel.sleep(float("nan"))
    with pytest.raises(ValueError, match="The time to park until is not a number."):
        kernel.park("x", until=float("nan"))
    kernel.sleep(1)
    assert kernel.now() == 1.0


def test_busy_tasks_let_time_pass_so_that_timers_fire(k):
    def busy():
        while True:
            kernel.checkpoint()

    tasks = [kernel.spawn(busy) for _ in range(3)]
    kernel.sleep(0.1)
    assert kernel.now() == 0.1
    for task in tasks:
        task.cancel()
        task.join()


def test_the_main_task_busy_alone_sees_a_timer_fire_at_its_very_time(k):
    fired = []
    kernel.call_at(0.0123, lambda: fired.append(kernel.now()))
    while not fired:
        kernel.checkpoint()
    assert fired == [0.0123]


def test_a_task_that_polls_with_yield_lets_time_pass_too(k):
    fired = []
    kernel.call_at(0.05, lambda: fired.append(True))
    while not fired:
        kernel.yield_()
    assert kernel.now() == 0.05


def test_a_round_of_slices_takes_five_milliseconds(k):
    from cramhy_runtime.kernel.budget import SLICE

    for _ in range(10 * SLICE + 10):
        kernel.checkpoint()
    assert kernel.now() == pytest.approx(0.05)


def test_the_time_limit_ends_a_run_that_only_periodic_timers_keep_alive(start):
    start(time_limit=60)
    kernel.call_every(1.0, lambda: None)
    with pytest.raises(kernel.TimeLimit) as told:
        kernel.park("godot")
    assert kernel.now() == 60.0
    text = str(told.value).splitlines()
    assert text[0] == "The run reached its time limit of 60 s."
    assert text[1] == "  main waits for godot"
    assert text[-1] == "If the plan needs longer, give a larger limit; else look for the wait that never ends."


def test_the_time_limit_ends_a_busy_run_too(start):
    start(time_limit=0.1)
    with pytest.raises(kernel.TimeLimit):
        while True:
            kernel.checkpoint()


def test_cleanup_after_the_time_limit_gets_as_long_again(start):
    start(time_limit=10)
    with pytest.raises(kernel.TimeLimit):
        try:
            kernel.sleep(100)
        finally:
            kernel.sleep(5)
    assert kernel.now() == 15.0
    with pytest.raises(kernel.TimeLimit):
        kernel.sleep(100)
    assert kernel.now() == 20.0


def test_a_run_that_ends_in_time_does_not_hear_of_the_limit(start):
    start(time_limit=10)
    kernel.sleep(9.99)


def test_ten_thousand_deadlines_that_were_not_needed_leave_nothing_behind(k):
    def waiter():
        for _ in range(10000):
            kernel.park("a pulse", until=kernel.now() + 3600)

    task = kernel.spawn(waiter)
    kernel.yield_()
    while not task.dead:
        kernel.unpark(task)
        kernel.yield_()
    assert len(k._timers.entries) < 200
