"""Plans as in ``scenarios.py``. They were written before the code that they try, and were first run when that was done."""

from __future__ import annotations

import contextlib

from cramhy_runtime import cpl

from .scenarios import SCENARIOS, returning, swallowing, ticking

OPEN = list(SCENARIOS)


def notes(*expected, time_limit=None):
    """This plan notes ``expected``, and nothing else."""

    def keep(plan):
        SCENARIOS[plan.__name__] = plan, list(expected), time_limit
        return plan

    return keep


@notes("a 1", "b 1", "True 1")
def body_of_try_all(note):
    with cpl.try_all() as attempts:
        attempts.start(lambda: cpl.sleep(1))
        swallowing()
        note("a")
        swallowing()
        note("b")
        cpl.sleep(100)
        note("never")
    note(cpl.now() == 1)


@notes("c 1", "d 1", "True 1")
def branches_after_the_swallowed_end_do_not_begin_to_wait(note):
    with cpl.move_on_after(1) as limit:
        try:
            cpl.par(lambda: cpl.sleep(10), lambda: cpl.sleep(10))
        except:  # noqa: E722
            note("c")
        swallowing()
        note("d")
        cpl.par(lambda: cpl.sleep(10))
        note("never")
    note(limit.expired)


@notes("limited 3", "rest 4", "True 4")
def limit_within_the_cleanup_of_a_limit(note):
    with cpl.move_on_after(1) as outer:
        try:
            cpl.sleep(10)
        finally:
            with cpl.move_on_after(2) as inner:
                swallowing()
                cpl.sleep(100)
            note("limited" if inner.expired else "not limited")
            cpl.sleep(1)
            note("rest")
    note(outer.expired)


@notes("end 0.5", "EVAPORATED 0.5")
def evaporation_is_swallowed_within_a_block(note):
    def task():
        with cpl.move_on_after(1):
            swallowing()
            note("end")
            cpl.sleep(100)
            note("never")
        note("never, too")

    with cpl.par() as branches:
        started = branches.start(task)
        cpl.sleep(0.5)
        started.evaporate()
    note(started.status.name)


@notes("True 1")
def attempts_that_take_the_request_for_a_failure(note):
    with cpl.move_on_after(1) as limit:
        for attempt in cpl.attempts(5, on=BaseException):
            with attempt:
                cpl.sleep(0 if attempt.number > 1 else 10)
                note("never")
            note("never, since attempts do not swallow an end")
    note(limit.expired)


@notes("True 4")
def both_expire_and_the_inner_body_waits_in_a_handler(note):
    with cpl.move_on_after(2) as outer:
        with cpl.move_on_after(1):
            try:
                cpl.sleep(10)
            except BaseException:
                cpl.sleep(3)
        cpl.sleep(100)
        note("never")
    note(outer.expired)


@notes("True 6", "woken 6")
def suspended_while_its_end_was_swallowed(note):
    def task():
        with cpl.move_on_after(2) as limit:
            swallowing()
            swallowing()
            cpl.sleep(100)
        note(limit.expired)

    with cpl.par() as branches:
        started = branches.start(task)
        cpl.sleep(1)
        with cpl.task_suspended(started):
            cpl.sleep(5)
    note("woken")


@notes("A TIMEOUT block was left before the PURSUE block that was entered after it. 1")
def race_in_a_generator_that_waits(note):
    def race():
        with cpl.pursue() as branches:
            branches.start(lambda: cpl.sleep(50))
            cpl.sleep(1)
            yield

    with cpl.move_on_after(10):
        racing = race()
        next(racing)
    note("never")


@notes("A TIMEOUT block was left in another task than the one that entered it. 2")
def generator_that_another_task_finishes(note):
    ticks = ticking(note)
    next(ticks)
    cpl.par(lambda: (cpl.sleep(1), ticks.close()))
    note("never")


@notes("The run reached its time limit of 2 s. 2", time_limit=2)
def time_limit_and_a_return_in_finally(note):
    def forever():
        while True:
            returning(0.3)

    cpl.pursue(forever, forever)


@notes("brakes 3", "The run reached its time limit of 2 s. 3", time_limit=2)
def time_limit_lets_cleanup_run(note):
    try:
        cpl.sleep(100)
    finally:
        cpl.sleep(1)
        note("brakes")


@notes("ExitStack True 1", "after 2")
def exit_stack_in_the_right_order(note):
    with contextlib.ExitStack() as stack:
        limits = [stack.enter_context(cpl.move_on_after(seconds)) for seconds in (3, 2, 1)]
        swallowing()
        cpl.sleep(100)
    note(f"ExitStack {limits[2].expired}")
    cpl.sleep(1)
    note("after")
