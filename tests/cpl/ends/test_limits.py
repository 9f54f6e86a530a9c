"""What a limit takes as its seconds, what it says afterwards, and the limit of a run whose body swallows it."""

from __future__ import annotations

import decimal
import fractions
import re

import numpy
import pytest
from systems import BACKENDS

from cramhy_runtime import cpl, kernel

from cramhy_runtime.cpl.tasks.delegated_work import Errand

from . import scenarios
from .scenarios import swallowing

NUMBER = "give a number of seconds, or float('inf') for no limit."


@pytest.fixture(autouse=True)
def fresh_kernel():
    kernel.stop()


@pytest.mark.parametrize("limit", [cpl.timeout, cpl.move_on_after], ids=["timeout", "move_on_after"])
@pytest.mark.parametrize("seconds", [None, "3", True, False, [1], 1j, b"1"])
def test_what_is_not_a_number_of_seconds_is_a_type_error(limit, seconds):
    with pytest.raises(TypeError) as problem:
        limit(seconds)
    assert str(problem.value) == f"cpl.{limit.__name__}({seconds!r}): {NUMBER}"


@pytest.mark.parametrize("limit", [cpl.timeout, cpl.move_on_after], ids=["timeout", "move_on_after"])
@pytest.mark.parametrize("seconds", [float("nan"), numpy.float64("nan"), numpy.float32("nan"), decimal.Decimal("nan")])
def test_not_a_number_is_a_value_error(limit, seconds):
    with pytest.raises(ValueError) as problem:
        limit(seconds)
    assert str(problem.value) == (
        f"cpl.{limit.__name__}(nan): this is not a number. Give a number of seconds, or float('inf') for no limit."
    )


@pytest.mark.parametrize("seconds, kind", [("3", TypeError), (True, TypeError), (float("nan"), ValueError)])
def test_the_other_limits_of_a_plan_are_as_careful(seconds, kind):
    with pytest.raises(kind, match=r"^time_limit="):
        cpl.run(lambda: None, time_limit=seconds)
    with pytest.raises(kind, match=r"^cpl.cleanup_time_limit\("):
        cpl.cleanup_time_limit(seconds)


@pytest.mark.parametrize(
    "seconds", [2, 2.0, fractions.Fraction(2), decimal.Decimal(2), numpy.float64(2), numpy.float32(2), numpy.int64(2), numpy.uint8(2)]
)
def test_numbers_of_all_kinds_are_seconds(seconds):
    with cpl.plan(clock="virtual"):
        with cpl.move_on_after(seconds) as limit:
            cpl.sleep(100)
        assert limit.expired and cpl.now() == 2
        with pytest.raises(cpl.TimedOut, match="^The time of 2 s was over.$"), cpl.timeout(seconds):
            cpl.sleep(100)


@pytest.mark.parametrize("seconds, ends", [(float("inf"), 5), (numpy.inf, 5), (0, 0), (-1, 0), (float("-inf"), 0), (-numpy.inf, 0)])
def test_no_limit_and_limits_in_the_past(seconds, ends):
    with cpl.plan(clock="virtual"):
        with cpl.move_on_after(seconds) as limit:
            cpl.sleep(5)
        assert (cpl.now(), limit.expired) == (ends, ends == 0)


def test_a_shielded_body_that_is_late_has_expired():
    with cpl.plan(clock="virtual"):
        with cpl.move_on_after(1) as limit, cpl.without_scheduling():
            cpl.sleep(4)
        assert limit.expired and cpl.now() == 4
        with pytest.raises(cpl.TimedOut), cpl.timeout(1):
            with cpl.cleanup():
                cpl.sleep(4)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_block_that_is_the_plan_gets_the_time_limit_again_when_it_swallows_it(backend):
    times = []
    with pytest.raises(kernel.TimeLimit), cpl.plan(backend=backend, time_limit=3):
        for _ in range(5):
            swallowing()
            times.append(cpl.now())
        cpl.sleep(100)
        times.append("never")
    assert times == [3] * 5


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_time_limit_lets_the_cleanup_of_a_block_that_is_the_plan_run(backend):
    times = []
    with pytest.raises(kernel.TimeLimit), cpl.plan(backend=backend, time_limit=3):
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(2)
            times.append(cpl.now())
    assert times == [5]


def test_a_plan_that_leaves_a_block_open_says_so_with_both_places():
    opened = cpl.move_on_after(10)
    with pytest.raises(Exception, match="A TIMEOUT block was never left: the task ended. It was entered at .*test_limits.py:") as problem:
        with cpl.plan(clock="virtual"):
            opened.__enter__()
    assert "the task that ended is [TOP-LEVEL]" in str(problem.value)


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_main_task_that_swallows_its_block_for_long_goes_on_and_is_told_of(backend, capsys):
    with cpl.plan(backend=backend):
        with cpl.move_on_after(1) as limit:
            for _ in range(1500):
                swallowing()
        assert limit.expired and cpl.now() == 1
        cpl.sleep(1)
    told = capsys.readouterr().err
    assert told.count("swallows every request to end it.\nCatch Exception, not BaseException or everything, or raise again") == 1


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_piece_of_work_for_others_that_swallows_its_end_gets_it_again(backend):
    errand, outcomes = Errand(), []

    def body():
        swallowing()
        outcomes.append(cpl.now())
        cpl.sleep(100)

    with cpl.plan(backend=backend), cpl.par() as branches:
        branches.start(lambda: outcomes.append((errand.run(body), cpl.now())))
        cpl.sleep(1)
        errand.end()
    assert outcomes == [1, ((cpl.EVAPORATED, ()), 1)]


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_generator_that_the_garbage_collector_closes_elsewhere_is_an_error_of_its_task(backend):
    kept = []

    def opens():
        kept.append(scenarios.ticking(None))
        next(kept[0])
        cpl.sleep(100)

    def drops():
        cpl.sleep(2)
        kept.clear()
        cpl.sleep(1)

    with pytest.raises(Exception, match="A TIMEOUT block was left in another task than the one that entered it."):
        cpl.run(lambda: cpl.par(opens, drops), backend=backend)


def texts(plan):
    with pytest.raises(Exception) as problem:
        cpl.run(plan, lambda what: None)
    return re.sub(r"tests/cpl/ends/|/[^ ]*/", "", re.sub(r":\d+", "", str(problem.value)))


FILE = "scenarios.py in "
REMEDY = (
    " Leave blocks in the reverse order in which they were entered, in the task that entered them. If a generator waits in a block, use it "
    "up, or close it (contextlib.closing), before you leave what is around it."
)


@pytest.mark.parametrize(
    "plan, text",
    [
        (
            scenarios.generator_in_a_block_that_is_left,
            "A PAR block was left before the TIMEOUT block that was entered after it. The PAR block was entered at "
            f"{FILE}generator_in_a_block_that_is_left, and the TIMEOUT block at {FILE}ticking." + REMEDY,
        ),
        (
            scenarios.generator_whose_time_is_over_elsewhere,
            "A TIMEOUT block was to end, but the generator that entered it does not run. It was entered at "
            f"{FILE}ticking, and its task is at {FILE}generator_whose_time_is_over_elsewhere." + REMEDY,
        ),
        (
            scenarios.block_that_is_left_in_another_task,
            "A TIMEOUT block was left in another task than the one that entered it. It was entered at "
            f"{FILE}block_that_is_left_in_another_task, in [TOP-LEVEL]-N, and left at {FILE}<lambda>, in [PAR-CHILD-#1/1]-N." + REMEDY,
        ),
        (
            scenarios.generator_that_nobody_closes,
            f"A TIMEOUT block was never left: the task ended. It was entered at {FILE}ticking, and the task that ended is [TOP-LEVEL]-N."
            + REMEDY,
        ),
        (
            scenarios.branch_that_swallows_for_ever,
            f"The task swallows every request to end it, at {FILE}stubborn. It was left where it is, and its other cleanup did not run. "
            "Catch Exception, not BaseException or everything, or raise again what you have caught, and do not leave a `finally` by "
            "return, break or continue.",
        ),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_the_errors_say_where_and_what_to_do(plan, text):
    assert re.sub(r"\]-\d+", "]-N", texts(plan)) == text
