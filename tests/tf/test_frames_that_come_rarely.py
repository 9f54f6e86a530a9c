"""Frames that come less than once a second: a time between two stamps is answered by its two neighbours."""

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cramhy_runtime.tf.buffer import FrameBuffer, Unavailable
from cramhy_runtime.tf.stamped import TransformStamped
from cramhy_runtime.transforms.quaternions import quaternion
from cramhy_runtime.transforms.vectors import vector


def sent(stamps):
    """A buffer in which the frame base lies at x = the square of the stamp, so that only the nearest neighbours give the x between them."""
    frames = FrameBuffer()
    for stamp in stamps:
        frames.store(TransformStamped("map", "base", stamp, vector((stamp**2, -stamp, 0.0)), quaternion((0.0, 0.0, 0.0, 1.0))))
    return frames


def between(stamps, time):
    """The x at ``time`` on the line between the neighbours among ``stamps``."""
    before, after = max(s for s in stamps if s <= time), min(s for s in stamps if s >= time)
    share = (time - before) / (after - before) if after > before else 0.0
    return before**2 + share * (after**2 - before**2)


@pytest.mark.parametrize("apart", [0.3, 1.0, 1.5, 2.0, 2.9, 3.0, 5.0, 8.0, 9.0])
@pytest.mark.parametrize("first", [10.0, 9.75])
def test_the_neighbours_answer(first, apart):
    stamps = [first + count * apart for count in range(int(60 / apart))]
    frames = sent(stamps)
    for tenth in range(0, 91, 5):
        time = stamps[-1] - tenth / 10
        if math.floor(stamps[-1]) - math.floor(max(s for s in stamps if s <= time)) >= 10:
            break  # the neighbour before is forgotten: ten seconds are kept
        transform = frames.lookup("map", "base", time)
        assert transform.translation.x == pytest.approx(between(stamps, time)), time
        assert transform.translation.y == pytest.approx(-time) and transform.stamp == time


@pytest.mark.soak
@settings(max_examples=200, deadline=None)
@given(st.lists(st.floats(0.05, 8.0), min_size=2, max_size=40), st.floats(0.0, 1.0))
def test_whatever_the_gaps(gaps, share):
    stamps = list(itertools.accumulate([100.0, *gaps]))
    oldest = max(stamps[0], stamps[-1] - 9)
    time = oldest + share * (stamps[-1] - oldest)
    before = max(s for s in stamps if s <= time)
    if math.floor(stamps[-1]) - math.floor(before) < 10:  # else the neighbour before may be forgotten
        assert sent(stamps).lookup("map", "base", time).translation.x == pytest.approx(between(stamps, time))


def test_a_gap_of_ten_seconds_is_not_bridged():
    for time in (5.0, 12.0, 2.5, 13.5):
        with pytest.raises(Unavailable) as caught:
            sent((1.0, 2.0, 14.0)).lookup("map", "base", time)
        assert str(caught.value) == (
            f"The transform from base to map is not known at {time} s. What is known of the transform from base to map is from 1.0 to "
            f"14.0 s; {time} s is in a gap of that, of ten seconds or more. Without a time the newest is taken."
        )


def test_what_a_later_second_has_overwritten_is_not_bridged():
    with pytest.raises(Unavailable):
        sent((11.0, 12.0, 21.5)).lookup("map", "base", 11.5)
    assert sent((11.0, 12.0, 21.5)).lookup("map", "base", 16.75).translation.x == pytest.approx((12**2 + 21.5**2) / 2)


@pytest.mark.parametrize("time", ["10.9d0", "42.1d0", "50d0"])
def test_before_the_first_and_after_the_last_there_is_no_answer(lisp, time):
    lisp('(loop for stamp from 11 to 41 by 3 do (told "map" "base" (float stamp 1d0) stamp))')
    assert lisp(f'(can-transform *tf* :target-frame "map" :source-frame "base" :time {time})') == "NIL"
    assert lisp.condition(f'(cached "map" "base" {time})') is not None


def test_who_waits_for_a_time_in_a_gap_is_woken_by_the_frame_after_it(lisp):
    lisp('(told "map" "base" 10d0 1)')
    assert lisp('(can-transform *tf* :target-frame "map" :source-frame "base" :time 12d0)') == "NIL"
    lisp('(told "map" "base" 14d0 3)')
    assert lisp('(x (translation (lookup-transform *tf* "map" "base" :time 12d0 :timeout 1)))') == "2.0d0"
