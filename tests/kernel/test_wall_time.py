"""Wall time: the same scheduling with a pace-maker. No test here waits: the operating system's clock is a toy."""

import time

import pytest

from cramhy_runtime import kernel


class ToyOS:
    """An operating system whose clock moves when somebody waits for it, or works."""

    def __init__(self):
        self.time = 1024.0
        self.waits = []

    def clock(self):
        return self.time

    def wait(self, bell, seconds):
        self.waits.append(seconds)
        self.time += min(max(seconds, 1e-9), 3600.0)  # a wait takes some time, however short

    def work(self, seconds):
        self.time += seconds


@pytest.fixture
def toy(start):
    toy = ToyOS()
    start(clock=kernel.WallClock(toy.clock, toy.wait))
    return toy


def test_it_begins_at_zero_and_passes_with_the_work(toy):
    assert kernel.now() == 0.0
    toy.work(1.5)
    assert kernel.now() == 1.5


def test_a_sleep_waits_for_the_operating_system(toy):
    kernel.sleep(2.0)
    assert toy.waits == [2.0]
    assert kernel.now() == 2.0


def test_the_kernel_waits_only_for_what_is_left(toy):
    def sleeper():
        kernel.sleep(1.0)

    task = kernel.spawn(sleeper)
    kernel.yield_()
    toy.work(0.75)
    task.join()
    assert toy.waits == [0.25]


def test_timers_fire_in_the_order_of_their_times_even_when_all_are_late(toy):
    log = []
    kernel.call_at(0.3, lambda: log.append("c"))
    kernel.call_at(0.1, lambda: log.append("a"))
    kernel.call_at(0.2, lambda: log.append("b"))
    toy.work(1.0)
    kernel.yield_()
    assert log == ["a", "b", "c"]


def test_a_periodic_timer_catches_up_after_a_hiccup(toy):
    log = []
    kernel.call_every(0.1, lambda: log.append(round(kernel.now(), 6)))
    toy.work(0.35)
    kernel.yield_()
    assert log == [0.35, 0.35, 0.35]
    kernel.sleep(0.1)
    assert log == [0.35, 0.35, 0.35, 0.4]


def test_a_periodic_timer_leaves_firings_out_after_a_long_pause(toy):
    log = []
    kernel.call_every(0.1, lambda: log.append(kernel.now()))
    toy.work(3600.0)
    kernel.yield_()
    assert len(log) <= 12
    log.clear()
    kernel.sleep(1.05)
    assert len(log) == pytest.approx(10, abs=1)


def test_a_wait_that_comes_back_early_is_taken_up_again(start):
    toy = ToyOS()
    half = lambda bell, seconds: toy.wait(bell, seconds / 2 if seconds > 0.01 else seconds)  # noqa: E731
    start(clock=kernel.WallClock(toy.clock, half))
    kernel.sleep(1.0)
    assert kernel.now() >= 1.0
    assert len(toy.waits) > 3


def test_a_deadlock_is_told_at_once(toy):
    with pytest.raises(kernel.Deadlock):
        kernel.park("godot")
    assert toy.waits == []


def test_the_time_limit_holds(start):
    toy = ToyOS()
    start(clock=kernel.WallClock(toy.clock, toy.wait), time_limit=5)
    kernel.call_every(2.0, lambda: None)
    with pytest.raises(kernel.TimeLimit):
        kernel.park("godot")
    assert kernel.now() == 5.0


def test_busy_tasks_do_not_move_the_clock(toy):
    def busy():
        while True:
            kernel.checkpoint()

    task = kernel.spawn(busy)
    for _ in range(5):
        kernel.yield_()
    assert kernel.now() == 0.0
    task.cancel()
    task.join()


def test_a_run_in_wall_time_does_the_same_as_one_in_virtual_time(start):
    def run():
        log = []

        def walk(name, seconds):
            for _ in range(4):
                kernel.sleep(seconds)
                log.append((name, round(kernel.now(), 6)))

        for task in [kernel.spawn(walk, name, seconds) for name, seconds in (("a", 0.5), ("b", 0.75), ("c", 0.25))]:
            task.join()
        return log

    start()
    virtual = run()
    toy = ToyOS()
    start(clock=kernel.WallClock(toy.clock, toy.wait))
    assert run() == virtual


def test_the_real_clock_can_be_asked_for_by_name(start):
    start(clock="wall")
    before = kernel.now()
    kernel.sleep(0.001)
    assert kernel.now() >= before + 0.001


def test_every_clock_knows_the_moment_of_its_zero(start):
    start(clock="wall")
    assert abs(kernel.active().epoch + kernel.now() - time.time()) < 5
    start(clock="virtual")
    assert kernel.active().epoch == kernel.VirtualClock.epoch


def test_an_unknown_clock_or_back_end_is_refused():
    with pytest.raises(ValueError, match='There is no clock "sundial". Choose "virtual" or "wall".'):
        kernel.Kernel(clock="sundial")
    with pytest.raises(ValueError, match='There is no back end "steam". Choose "auto", "threads" or "greenlet".'):
        kernel.Kernel(backend="steam")
