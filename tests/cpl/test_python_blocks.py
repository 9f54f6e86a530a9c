"""Plan forms as ``with`` blocks of Python: when they are left everything in them is dead, and cleanup ran once and undisturbed."""

from __future__ import annotations

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.conditions import Error


class Stuck(cpl.PlanFailure):
    """A plan failure of Python code."""


class Log:
    """What happened, with the time at which it did."""

    def __init__(self):
        self.entries = []

    def note(self, what):
        self.entries.append((what, round(cpl.now(), 6)))

    def branch(self, name, seconds, result=None, failure=None, cleanup=0.0):
        """A branch that takes ``seconds``, then returns or raises, and whose cleanup takes time too."""
        try:
            cpl.sleep(seconds)
            if failure is not None:
                raise failure
            return result
        finally:
            if cleanup:
                cpl.sleep(cleanup)
            self.note(name)


@pytest.fixture
def log():
    return Log()


def in_plan(function):
    """The test runs as a plan."""

    def test(log):
        before = len(kernel.active().tasks)
        with cpl.plan() as root:
            function(log)
            assert not root.children and not kernel.current().local.blocks
            assert not kernel.current().cancelled_delivered
        kernel.yield_()  # a branch that was ended before it began is still in the queue
        assert len(kernel.active().tasks) == before

    test.__name__, test.__doc__ = function.__name__, function.__doc__
    return test


@in_plan
def test_a_par_block_waits_for_all_its_branches(log):
    with cpl.par() as branches:
        first = branches.start(log.branch, "first", 2, result="a")
        second = branches.start(log.branch, "second", 1, result="b")
        log.note("body")
    assert log.entries == [("body", 0), ("second", 1), ("first", 2)]
    assert (branches.result, branches.results) == ("a", ["a", "b"])
    assert (first.result, second.join(), second.status) == ("a", "b", cpl.SUCCEEDED)


@in_plan
def test_an_empty_par_block_is_left_at_once(log):
    with cpl.par() as branches:
        pass
    assert branches.result is None and branches.results == []


@in_plan
def test_a_failing_branch_ends_the_body_and_the_other_branches_before_it_is_raised(log):
    with pytest.raises(Stuck) as caught, cpl.par() as branches:
        branches.start(log.branch, "stuck", 1, failure=Stuck("door"))
        branches.start(log.branch, "other", 100, cleanup=0.5)
        log.branch("body", 100, cleanup=0.25)
    assert log.entries == [("stuck", 1), ("body", 1.25), ("other", 1.75)]
    assert str(caught.value) == "door" and caught.value.__context__ is None
    cpl.sleep(1)
    assert cpl.now() == 2.75


@in_plan
def test_an_exception_of_the_body_is_raised_when_the_branches_are_dead(log):
    with pytest.raises(KeyError), cpl.par() as branches:
        branches.start(log.branch, "branch", 100, cleanup=0.5)
        cpl.sleep(1)
        raise KeyError("body")
    assert log.entries == [("branch", 1.5)]


@in_plan
def test_leaving_a_block_by_break_or_return_ends_nothing_early(log):
    def leave():
        with cpl.par() as branches:
            branches.start(log.branch, "branch", 1)
            return "left"

    assert leave() == "left" and log.entries == [("branch", 1)]


@in_plan
def test_evaporating_the_task_of_a_block_ends_its_branches_first(log):
    def task():
        try:
            with cpl.par() as branches:
                branches.start(log.branch, "branch", 100, cleanup=0.5)
                log.branch("body", 100)
        finally:
            log.note("task")

    with cpl.move_on_after(1) as limit:
        cpl.with_task(task)
    assert limit.expired and log.entries == [("body", 1), ("branch", 1.5), ("task", 1.5)]


@in_plan
def test_a_race_is_won_by_the_first_end_and_the_losers_are_dead(log):
    with cpl.pursue() as race:
        race.start(log.branch, "slow", 100, result="slow", cleanup=0.5)
        race.start(log.branch, "fast", 1, result="fast")
    assert race.result == "fast" and log.entries == [("fast", 1), ("slow", 1.5)]


@in_plan
def test_the_end_of_a_race_ends_the_body_too(log):
    with cpl.pursue() as race:
        race.start(log.branch, "fast", 1, result="fast")
        log.branch("body", 100)
        log.note("never")
    assert race.result == "fast" and log.entries == [("fast", 1), ("body", 1)]


@in_plan
def test_a_failure_of_a_loser_of_a_race_while_it_is_ended_is_not_lost(log):
    def loser():
        try:
            cpl.sleep(100)
        finally:
            raise Stuck("in cleanup")

    with pytest.raises(Stuck), cpl.pursue() as race:
        race.start(loser)
        race.start(log.branch, "fast", 1)


@in_plan
def test_try_all_ends_with_the_first_success(log):
    with cpl.try_all() as attempts:
        attempts.start(log.branch, "bad", 1, failure=Stuck())
        attempts.start(log.branch, "good", 2, result="good")
        attempts.start(log.branch, "late", 3, result="late")
    assert attempts.result == "good" and log.entries == [("bad", 1), ("good", 2), ("late", 2)]


@in_plan
def test_try_all_fails_with_all_failures_and_errors_come_without_envelope(log):
    with pytest.raises(cpl.CompositeFailure) as caught, cpl.try_all() as attempts:
        attempts.start(log.branch, "one", 1, failure=Stuck("a"))
        attempts.start(log.branch, "two", 2, failure=ValueError("b"))
    assert [type(failure) for failure in caught.value.exceptions] == [ValueError, Stuck]


@pytest.mark.parametrize("form", [cpl.pursue, cpl.try_all])
def test_a_block_that_nobody_can_decide_is_an_error(form):
    with cpl.plan(), pytest.raises(Error, match="has no branches, so nobody can decide it. Start at least one in it."):
        with form():
            pass


@in_plan
def test_branches_can_be_started_while_others_run_until_it_is_decided(log):
    with pytest.raises(Stuck), cpl.par() as branches:
        branches.start(log.branch, "first", 1, failure=Stuck())
        with cpl.without_scheduling():
            cpl.sleep(2)
            started = branches.start(log.branch, "allowed", 3)
        branches.start(log.branch, "never", 3)
    assert log.entries == [("first", 1)] and cpl.now() == 2
    assert branches.tasks[1:] == [started] and started.status is cpl.EVAPORATED


@in_plan
def test_a_branch_is_started_in_its_block_by_its_task(log):
    with cpl.par() as branches:
        with pytest.raises(Error, match="in a PAR block of another task. Start it in the task that entered the block, or open a block"):
            cpl.par(lambda: branches.start(cpl.sleep, 1))
    with pytest.raises(Error, match="A branch was started after the end of a PAR block. Start it in the block: with cpl.par"):
        branches.start(cpl.sleep, 1)
    with pytest.raises(Error, match="before entering a TRY-ALL block. Start it in the block: with cpl.try_all"):
        cpl.try_all().start(cpl.sleep, 1)
    with pytest.raises(Error, match="A PAR block was entered twice. Make a new one for each `with`."), branches:
        pass


@in_plan
def test_branches_are_called_by_the_names_of_their_functions(log):
    def grasp():
        pass

    with cpl.par() as branches:
        named, unnamed = branches.start(grasp), branches.start(lambda: None)
    assert named.name.startswith("[grasp]-") and unnamed.name.startswith("[PAR-CHILD-#2]-")


# -------------------------------------------------------------------------------------------------------------------- time


@in_plan
def test_a_timeout_fails_after_the_cleanup_of_its_body(log):
    with pytest.raises(cpl.TimedOut, match="^The time of 2 s was over.$") as caught, cpl.timeout(2) as limit:
        log.branch("body", 100, cleanup=1)
    assert log.entries == [("body", 3)] and limit.expired
    assert isinstance(caught.value, cpl.PlanFailure) and caught.value.seconds == 2 and caught.value.__context__ is None


@in_plan
def test_a_body_that_is_in_time_never_hears_of_its_timeout(log):
    with cpl.timeout(2) as limit:
        cpl.sleep(1)
    cpl.sleep(5)
    assert not limit.expired
    with cpl.timeout(float("inf")):
        cpl.sleep(1)


@in_plan
def test_move_on_after_ends_what_is_in_it_with_all_branches(log):
    with cpl.move_on_after(1) as limit:
        cpl.par(lambda: log.branch("left", 100), lambda: log.branch("right", 100, cleanup=0.5))
    assert limit.expired and log.entries == [("left", 1), ("right", 1.5)]
    with cpl.move_on_after(0) as limit:
        cpl.sleep(1)
    assert limit.expired and cpl.now() == 1.5


@in_plan
def test_the_outer_one_of_two_timeouts_waits_for_the_cleanup_that_the_inner_one_began(log):
    with cpl.move_on_after(1.5) as outer:
        with cpl.move_on_after(1) as inner:
            log.branch("body", 100, cleanup=1)
        log.branch("between", 100)
    assert inner.expired and outer.expired
    assert log.entries == [("body", 2), ("between", 2)]


@in_plan
def test_the_inner_one_of_two_timeouts_does_not_disturb_the_cleanup_that_the_outer_one_began(log):
    with cpl.move_on_after(1) as outer:
        with cpl.move_on_after(1.5) as inner:
            log.branch("body", 100, cleanup=1)
    assert outer.expired and not inner.expired and log.entries == [("body", 2)] and cpl.now() == 2


@in_plan
def test_timeouts_of_the_same_moment_end_both_blocks(log):
    with cpl.move_on_after(1) as outer, cpl.move_on_after(1) as inner:
        log.branch("body", 100)
    assert outer.expired and log.entries == [("body", 1)] and inner.expired in (True, False)
    with cpl.move_on_after(1) as outer:
        with cpl.move_on_after(1):
            cpl.sleep(100)
        cpl.sleep(100)
    assert outer.expired and cpl.now() == 2


@in_plan
def test_a_timeout_bounds_the_cleanup_of_an_evaporated_task(log):
    def task():
        try:
            cpl.sleep(100)
        finally:
            with cpl.move_on_after(2) as limit:
                cpl.sleep(100)
            log.note(limit.expired)
            cpl.sleep(1)
            log.note("rest of the cleanup")

    with cpl.move_on_after(1):
        cpl.with_task(task)
    assert log.entries == [(True, 3), ("rest of the cleanup", 4)]


@in_plan
def test_a_timeout_bounds_the_cleanup_that_another_timeout_began(log):
    with cpl.move_on_after(1):
        try:
            cpl.sleep(100)
        finally:
            with cpl.move_on_after(2):
                cpl.sleep(100)
            cpl.sleep(1)
            log.note("cleanup")
    assert log.entries == [("cleanup", 4)]


@in_plan
def test_an_evaporation_waits_until_the_cleanup_of_a_block_is_over_and_is_not_lost(log):
    def task():
        try:
            with cpl.move_on_after(1):
                log.branch("body", 100, cleanup=2)
            log.branch("after", 100)
        finally:
            log.note("task")

    with cpl.par() as branches:
        started = branches.start(task)
        cpl.sleep(2)
        cpl.evaporate(started)
    assert log.entries == [("body", 3), ("after", 3), ("task", 3)] and started.status is cpl.EVAPORATED


@in_plan
def test_the_end_of_a_block_waits_for_without_scheduling(log):
    with cpl.move_on_after(1):
        with cpl.without_scheduling():
            cpl.sleep(2)
            log.note("undisturbed")
        cpl.sleep(100)
    assert log.entries == [("undisturbed", 2)] and cpl.now() == 2


@in_plan
def test_the_end_of_a_block_comes_through_where_with_scheduling_lets_it(log):
    with cpl.move_on_after(1):
        with cpl.without_scheduling():
            with cpl.with_scheduling():
                cpl.sleep(2)
            log.note("never")
    assert log.entries == [] and cpl.now() == 1


@in_plan
def test_with_scheduling_lets_a_request_come_that_was_held_back_and_changes_nothing_elsewhere(log):
    with cpl.with_scheduling():
        log.note("elsewhere")
    with cpl.move_on_after(1):
        with cpl.without_scheduling():
            cpl.sleep(2)
            log.note("held back")
            with cpl.with_scheduling():
                log.note("never")
    assert log.entries == [("elsewhere", 0), ("held back", 2)]


@in_plan
def test_a_suspended_task_ends_its_block_after_the_wake_up(log):
    def task():
        with cpl.move_on_after(2) as limit:
            log.branch("body", 100)
        log.note(limit.expired)
        cpl.sleep(1)

    with cpl.par() as branches:
        started = branches.start(task)
        cpl.sleep(1)
        with cpl.task_suspended(started):
            cpl.sleep(5)
            log.note(started.status is cpl.SUSPENDED)
    assert log.entries == [(True, 6), ("body", 6), (True, 6)] and cpl.now() == 7


@in_plan
def test_a_failure_of_the_cleanup_takes_the_place_of_the_end(log):
    with pytest.raises(Stuck), cpl.move_on_after(1) as limit:
        try:
            cpl.sleep(100)
        finally:
            raise Stuck("in cleanup")
    assert limit.expired


@in_plan
def test_no_alternative_is_tried_by_what_is_being_ended(log):
    def broken_cleanup():
        try:
            cpl.sleep(100)
        finally:
            cpl.fail("in cleanup")

    with pytest.raises(cpl.PlanFailure, match="in cleanup"), cpl.move_on_after(1):
        cpl.try_in_order(broken_cleanup, lambda: log.note("never"))
    with pytest.raises(cpl.PlanFailure, match="in cleanup"), cpl.move_on_after(1):
        for attempt in cpl.attempts(3):
            with attempt:
                log.note(attempt.number)
                broken_cleanup()
    assert log.entries == [(1, 1)]


@in_plan
def test_handlers_outside_of_a_block_run_before_its_surroundings_unwind(log):
    def body():
        try:
            with cpl.timeout(1):
                cpl.sleep(100)
        finally:
            log.note("unwound")

    def handler(failure, retry):
        log.note(type(failure).__name__)
        retry.leave("handled")

    assert cpl.handling({cpl.TimedOut: handler})(body)() == "handled"
    assert log.entries == [("TimedOut", 1), ("unwound", 1)]


@pytest.mark.parametrize("form", [cpl.par, cpl.pursue, cpl.try_all, lambda: cpl.timeout(1)])
def test_outside_of_a_plan_a_block_says_what_to_do(form):
    with pytest.raises(Error, match="form not inside a plan.") as caught, form():
        pass
    assert caught.value.__notes__ == ["From Python, run the plan with cpl.run(main), or write it below `with cpl.plan():`."]
