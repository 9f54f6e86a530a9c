"""Plans that swallow a request to end, and what trio's own tests do with cancel scopes, as plans in Python.

Each is a function of ``note``, which writes down a text with the time. Beside it stands what it notes. A plan that ends with an error
notes the first line of that last. ``scenarios_in_hy.hy`` has some of them in Hy, under the same names.
"""

from __future__ import annotations

import contextlib

from cramhy_runtime import cpl

SCENARIOS = {}
KEPT = []  # generators that nobody closes


def notes(*expected, time_limit=None):
    """This plan notes ``expected``, and nothing else."""

    def keep(plan):
        SCENARIOS[plan.__name__] = plan, list(expected), time_limit
        return plan

    return keep


def swallowing(seconds=10.0):
    """Waits, and swallows what ends the wait."""
    try:
        cpl.sleep(seconds)
    except:  # noqa: E722  what is tested
        pass


def returning(seconds=10.0):
    try:
        cpl.sleep(seconds)
    finally:
        return "returned"  # noqa: B012, SIM107  what is tested


@notes("swallowed 1", "True 1")
def bare_except(note):
    with cpl.move_on_after(1) as limit:
        swallowing()
        note("swallowed")
        cpl.sleep(100)
        note("never")
    note(limit.expired)


@notes("returned 1", "returned 1", "returned 1", "True 1")
def return_in_finally(note):
    with cpl.move_on_after(1) as limit:
        for _ in range(3):
            note(returning())
    note(limit.expired)


@notes("True 1")
def a_loop_that_continues(note):
    with cpl.move_on_after(1) as limit:
        for _ in range(50):
            try:
                cpl.sleep(10)
            except BaseException:
                continue
        cpl.sleep(1)
    note(limit.expired)


@notes("TimedOut 1")
def timeout_that_is_swallowed(note):
    try:
        with cpl.timeout(1):
            swallowing()
            cpl.sleep(100)
    except cpl.TimedOut as failure:
        note(type(failure).__name__)


@notes("TimedOut 1")
def timeout_that_is_swallowed_by_the_last_thing_in_the_body(note):
    try:
        with cpl.timeout(1):
            swallowing()
    except cpl.TimedOut as failure:
        note(type(failure).__name__)


@notes("won 1")
def body_of_pursue(note):
    with cpl.pursue() as race:
        race.start(lambda: (cpl.sleep(1), "won")[1])
        swallowing()
        cpl.sleep(100)
        note("never")
    note(race.result)


@notes("ValueError 1")
def body_of_par(note):
    def fails():
        cpl.sleep(1)
        raise ValueError("no signal")

    try:
        with cpl.par() as branches:
            branches.start(fails)
            swallowing()
            cpl.sleep(100)
            note("never")
    except ValueError as problem:
        note(type(problem).__name__)


@notes("cleanup begins 1", "cleanup ends 3", "True 3")
def cleanup_that_waits_is_run_to_its_end(note):
    with cpl.move_on_after(1) as limit:
        try:
            cpl.sleep(10)
        finally:
            note("cleanup begins")
            cpl.sleep(1)
            cpl.par(lambda: cpl.sleep(1), lambda: cpl.sleep(0.5))
            note("cleanup ends")
    note(limit.expired)


@notes("brakes 2", "goes on 2", "True 2")
def handler_that_waits_and_then_swallows(note):
    with cpl.move_on_after(1) as limit:
        try:
            cpl.sleep(10)
        except BaseException:
            cpl.sleep(1)
            note("brakes")
        note("goes on")
        cpl.sleep(100)
        note("never")
    note(limit.expired)


@notes("shielded 3", "True 3")
def shielded_cleanup_that_swallows(note):
    def stop():
        try:
            cpl.sleep(10)
        finally:
            with cpl.cleanup():
                cpl.sleep(2)
                note("shielded")
            return  # noqa: B012, SIM107

    with cpl.move_on_after(1) as limit:
        stop()
        cpl.sleep(100)
        note("never")
    note(limit.expired)


@notes("False 1", "True 1")
def outer_deadline_first(note):
    with cpl.move_on_after(1) as outer:
        with cpl.move_on_after(5) as inner:
            swallowing()
            cpl.sleep(100)
        note("never")
    note(inner.expired)
    note(outer.expired)


@notes("True 1", "True 3")
def inner_deadline_first(note):
    with cpl.move_on_after(3) as outer:
        with cpl.move_on_after(1) as inner:
            swallowing()
            cpl.sleep(100)
        note(inner.expired)
        swallowing()
        cpl.sleep(100)
        note("never")
    note(outer.expired)


@notes("held 4", "True 4")
def both_deadlines_pass_in_a_shield(note):
    with cpl.move_on_after(2) as outer:
        with cpl.move_on_after(1):
            with cpl.without_scheduling():
                cpl.sleep(4)
                note("held")
            swallowing()
        cpl.sleep(100)
        note("never")
    note(outer.expired)


@notes("True 0", "True 0")
def deadline_in_the_past(note):
    for seconds in (0, -3):
        with cpl.move_on_after(seconds) as limit:
            swallowing()
            cpl.sleep(100)
            note("never")
        note(limit.expired)


@notes("cleanup 3", "EVAPORATED 3")
def evaporated_while_the_block_unwinds(note):
    def task():
        with cpl.move_on_after(1):
            try:
                cpl.sleep(10)
            except:  # noqa: E722
                cpl.sleep(2)
                note("cleanup")
            cpl.sleep(100)
            note("never")
        cpl.sleep(100)
        note("never, too")

    with cpl.par() as branches:
        started = branches.start(task)
        cpl.sleep(2)
        started.evaporate()
    note(started.status.name)


@notes("entered after it 1", "True 1")
def block_that_is_entered_after_the_swallowed_end(note):
    with cpl.move_on_after(1) as outer:
        swallowing()
        note("entered after it")
        with cpl.move_on_after(5):
            cpl.sleep(3)
            note("never")
    note(outer.expired)


@notes("suppressed 1", "True 1")
def suppress_of_the_standard_library(note):
    with cpl.move_on_after(1) as limit:
        with contextlib.suppress(BaseException):
            cpl.sleep(10)
        note("suppressed")
        cpl.wait_for(cpl.make_fluent(value=False))
    note(limit.expired)


@notes("another error 1", "True 1")
def request_that_becomes_another_exception(note):
    with cpl.move_on_after(1) as limit:
        try:
            try:
                cpl.sleep(10)
            finally:
                raise KeyError("in cleanup")
        except KeyError:
            note("another error")
        cpl.sleep(100)
        note("never")
    note(limit.expired)


@notes("ValueError 1", "True 1")
def failure_of_the_cleanup_of_a_block_that_expired(note):
    limit = cpl.move_on_after(1)
    try:
        with limit:
            try:
                cpl.sleep(10)
            finally:
                raise ValueError("in cleanup")
    except ValueError as problem:
        note(type(problem).__name__)
    note(limit.expired)


@notes("True 1", "after 2")
def manager_of_a_generator_around_a_block(note):
    @contextlib.contextmanager
    def patient():
        with cpl.move_on_after(1) as limit:
            yield limit

    with patient() as limit, contextlib.ExitStack() as stack:
        stack.enter_context(cpl.move_on_after(50))
        swallowing()
        cpl.sleep(100)
        note("never")
    note(limit.expired)
    cpl.sleep(1)
    note("after")


def ticking(note, limit=5.0):
    """A generator that waits in a block of its own."""
    with cpl.move_on_after(limit):
        while True:
            cpl.sleep(1)
            yield cpl.now()


@notes("first 1", "A TIMEOUT block was never left: the task ended. 2")
def generator_that_nobody_closes(note):
    ticks = ticking(note)
    KEPT.append(ticks)
    next(ticks)
    note("first")
    cpl.sleep(1)


@notes("first 1", "A TIMEOUT block was to end, but the generator that entered it does not run. 5")
def generator_whose_time_is_over_elsewhere(note):
    ticks = ticking(note)
    next(ticks)
    note("first")
    cpl.sleep(100)
    note("never")


@notes("first 1", "A PAR block was left before the TIMEOUT block that was entered after it. 1")
def generator_in_a_block_that_is_left(note):
    with cpl.par():
        ticks = ticking(note)
        next(ticks)
        note("first")
    note("never")
    del ticks


@notes("1.0 2.0 2", "A TIMEOUT block was left before the TIMEOUT block that was entered after it. 2.5")
def two_generators_in_turn(note):
    one, two = ticking(note, 2.5), ticking(note)
    note(f"{next(one)} {next(two)}")
    for _ in one:
        note("never")
    note("never")


@notes("A TIMEOUT block was left before the TIMEOUT block that was entered after it. 1")
def exit_stack_that_outlives_the_block(note):
    with cpl.move_on_after(3):
        with contextlib.ExitStack() as stack:
            stack.enter_context(cpl.move_on_after(2))
            cpl.sleep(1)
            kept = stack.pop_all()
    note("never")
    kept.close()


@notes("A TIMEOUT block was left in another task than the one that entered it. 1")
def block_that_is_left_in_another_task(note):
    limit = cpl.move_on_after(10)
    limit.__enter__()
    cpl.sleep(1)
    cpl.par(lambda: limit.__exit__(None, None, None))
    note("never")


@notes("closed 1", "on 2")
def generator_that_a_loop_closes(note):
    for _ in ticking(note):
        break
    note("closed")
    cpl.sleep(1)
    note("on")


@notes("The task swallows every request to end it 1")
def branch_that_swallows_for_ever(note):
    def stubborn():
        while True:
            try:
                cpl.sleep(0.25)
            except BaseException:
                continue

    cpl.pursue(lambda: cpl.sleep(1), stubborn)


@notes("The task swallows every request to end it 1")
def block_whose_body_swallows_for_ever(note):
    with cpl.move_on_after(1):
        while True:
            returning()


@notes("The run reached its time limit of 3 s. 3", time_limit=3)
def time_limit_that_is_swallowed(note):
    while cpl.now() < 100:
        swallowing()
