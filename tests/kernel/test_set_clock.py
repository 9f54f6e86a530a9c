"""A kernel goes on in another kind of time: from the same second on, with what waits."""

import pytest

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def fresh_kernel():
    kernel.start()
    yield
    kernel.stop()


def test_what_waits_in_virtual_time_wakes_at_its_moment_of_wall_time():
    woken = []
    kernel.sleep(3600.0)
    kernel.spawn(lambda: (kernel.sleep(0.02), woken.append(kernel.now())), name="sleeper")
    kernel.yield_()
    kernel.set_clock("wall")
    assert 3600.0 <= kernel.now() < 3600.5
    kernel.sleep(0.04)
    assert 3600.02 <= woken[0] < 3600.5


def test_wall_time_becomes_virtual():
    kernel.set_clock("wall")
    kernel.set_clock("virtual")
    begin = kernel.now()
    kernel.sleep(1000.0)
    assert kernel.now() == begin + 1000.0


def test_who_watches_virtual_time_is_told(capsys):
    pace, told = kernel.pace(), []
    pace.on_change.append(lambda: told.append(pace.virtual))
    pace.set_speed(2.0)
    pace.pause()
    kernel.set_clock("wall")
    assert told == [True, True, False]
    assert (pace.speed, pace.paused) == (1.0, False)


def test_the_kind_that_it_is_already_changes_nothing():
    before = kernel.active().clock
    kernel.set_clock("virtual")
    assert kernel.active().clock is before


def test_there_is_no_third_kind():
    with pytest.raises(ValueError, match='There is no clock "slow". Choose "virtual" or "wall".'):
        kernel.set_clock("slow")
