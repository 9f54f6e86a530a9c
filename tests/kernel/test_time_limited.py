"""`kernel.time_limited`: a block of any task gets so many seconds, and its cleanup as many again."""

from __future__ import annotations

import pytest

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def running():
    kernel.start("virtual")
    yield
    kernel.stop()


def waits_too_long(seen):
    try:
        with kernel.time_limited(3):
            try:
                kernel.sleep(10)
            finally:
                kernel.sleep(1)
                seen.append(kernel.now())
    except kernel.TimeLimit:
        seen.append("limit")


@pytest.mark.parametrize("in_a_task", [False, True], ids=["main", "another task"])
def test_a_wait_is_ended_after_the_limit_and_cleanup_runs(in_a_task):
    seen = []
    kernel.spawn(waits_too_long, seen).join() if in_a_task else waits_too_long(seen)
    assert seen == [4.0, "limit"]


def test_nothing_happens_to_a_block_that_is_over_in_time():
    with kernel.time_limited(3):
        kernel.sleep(2)
    kernel.sleep(5)
    assert kernel.now() == 7


def test_cleanup_that_takes_longer_than_the_limit_is_ended_too():
    seen = []
    with pytest.raises(kernel.TimeLimit):
        with kernel.time_limited(2):
            try:
                kernel.sleep(10)
            finally:
                kernel.sleep(10)
                seen.append("never")
    assert (kernel.now(), seen) == (4.0, [])
