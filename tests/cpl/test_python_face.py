"""The plan language as a Python library: starting plans, exceptions, attempts, handlers, steps, policies."""

from __future__ import annotations

import subprocess
import sys
import traceback
from functools import partial

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import MultipleValues


class Stuck(cpl.PlanFailure):
    """A plan failure of Python code."""


class Jammed(Stuck):
    def __init__(self, angle):
        super().__init__(f"jammed at {angle}")
        self.angle = angle


def raising(problem):
    def branch():
        raise problem

    return branch


def after(seconds, value):
    def branch():
        cpl.sleep(seconds)
        return value

    return branch


# ---------------------------------------------------------------------------------------------------------------- starting


def test_run_gives_what_the_function_returns_in_the_active_kernel():
    active = kernel.active()
    assert cpl.run(lambda a, b: cpl.sleep(a) or a + b, 1, 2) == 3
    assert kernel.active() is active and kernel.now() == 1


def test_run_with_options_has_a_kernel_of_its_own_and_puts_the_active_one_aside():
    active = kernel.active()
    kernel.sleep(5)

    def main():
        cpl.sleep(1)
        return kernel.active(), cpl.now()

    own, time = cpl.run(main, clock="virtual", backend="greenlet", seed=3)
    assert own is not active and own.stopped and time == 1
    assert kernel.active() is active and kernel.now() == 5


def test_run_without_a_kernel_starts_one_in_virtual_time_and_stops_it():
    with kernel.aside():
        assert cpl.run(lambda: cpl.sleep(1000) or cpl.now()) == 1000
        assert kernel.active() is None
        with cpl.plan(time_limit=10):
            cpl.sleep(1)
        assert kernel.active() is None


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("way", ["run", "plan"])
@pytest.mark.parametrize(
    "problem",
    [
        Stuck("a"),
        ValueError("b"),
        KeyError("c"),
        ZeroDivisionError("d"),
        RecursionError("e"),
        TypeError("f() missing 1 required positional argument: 'x'"),
        KeyboardInterrupt(),
    ],
)
@pytest.mark.parametrize("depth", [0, 1, 2])
def test_what_a_plan_fails_with_is_the_object_that_was_raised(way, problem, depth):
    body = raising(problem)
    for _ in range(depth):
        body = partial(cpl.par, body)
    with pytest.raises(type(problem)) as caught:
        if way == "run":
            cpl.run(body)
        else:
            with cpl.plan():
                body()
    assert caught.value is problem and caught.value.__context__ is None
    assert "in branch" in "".join(traceback.format_exception(problem))


def test_a_plan_within_a_plan_is_an_error():
    def inner():
        with cpl.plan():
            pass

    for function in (lambda: cpl.run(print), inner):
        with pytest.raises(Error, match="A plan was started inside of a plan. Call its function as it is"):
            cpl.run(function)


def test_a_kernel_of_its_own_is_not_for_tasks_of_another():
    problems = []

    def task():
        try:
            cpl.run(print, seed=1)
        except Error as problem:
            problems.append(str(problem))

    kernel.spawn(task).join()
    assert problems == [
        "A kernel cannot be started by a task of another one. Leave out the options of the plan, so that it uses this kernel."
    ]


def test_everything_below_a_plan_block_is_dead_when_it_is_left():
    ended = []

    def branch():
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(1)
            ended.append(cpl.now())

    with pytest.raises(KeyError), cpl.plan() as root:
        cpl.Task(branch).execute()
        cpl.sleep(1)
        assert len(root.children) == 1 and cpl.current_task() is root
        raise KeyError
    assert ended == [2] and root.status is cpl.FAILED and cpl.current_task() is None


def test_a_plan_block_can_be_evaporated_and_the_kernel_goes_on():
    with cpl.plan() as root:
        cpl.Task(lambda: cpl.evaporate(root, sync=None)).execute()
        cpl.sleep(100)
        raise AssertionError("never")
    assert root.status is cpl.EVAPORATED and kernel.now() == 0
    with cpl.plan():
        cpl.sleep(1)
    assert kernel.now() == 1


SCRIPT = """
from cramhy_runtime import cpl

never = cpl.make_fluent(name="never")

def wait():
    cpl.wait_for(never)

cpl.run(lambda: cpl.par(wait))
"""


def test_a_deadlock_of_a_script_shows_its_lines_and_none_of_the_library(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
    report = done.stderr.partition("Deadlock: ")[2]
    assert "[PAR-CHILD-#1/1]-2 waits for the fluent #<FLUENT never [NIL]>" in report
    assert f"{script}:7 in wait" in report and "cramhy_runtime" not in report


def test_an_interrupt_ends_the_plan_and_is_pythons():
    cleaned = []

    def main():
        kernel.post(kernel.active().interrupt)
        try:
            cpl.sleep(100)
        finally:
            cleaned.append(cpl.now())

    with pytest.raises(KeyboardInterrupt):
        cpl.run(main)
    with pytest.raises(KeyboardInterrupt), cpl.plan():
        main()
    assert cleaned == [0, 0] and cpl.run(lambda: 1) == 1


# -------------------------------------------------------------------------------------------------------------- exceptions


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "form",
    [
        cpl.par,
        cpl.pursue,
        lambda branch: cpl.par_loop([1], lambda _: branch()),
        lambda branch: cpl.partial_order([branch], []),
        cpl.with_task,
        lambda branch: cpl.plan_function(branch)(),
        lambda branch: cpl.tag("step").run(branch),
        lambda branch: cpl.join_task(cpl.Task(branch).execute()),
    ],
)
def test_an_exception_of_a_branch_is_caught_around_the_form(form):
    problem = ValueError("x")
    with cpl.plan(), pytest.raises(ValueError) as caught:
        form(raising(problem))
    assert caught.value is problem


def test_within_the_plan_language_the_same_exception_counts_as_a_failure():
    seen = []

    def note(failure, retry):
        seen.append(failure)

    def main():
        assert cpl.try_in_order(lambda: cpl.par(raising(ValueError("x"))), lambda: "second") == "second"
        with pytest.raises(ValueError):
            cpl.handling({cpl.PlanFailure: note, ValueError: note, (KeyError, TypeError): note})(
                lambda: cpl.par(lambda: cpl.par(raising(ValueError("y"))))
            )()

    cpl.run(main)
    assert [type(failure) for failure in seen] == [ValueError, cpl.CommonLispErrorEnvelope]
    assert str(seen[0]) == "y" and cpl.opened(seen[1]).exception is seen[0]


def test_what_goes_on_through_python_code_is_the_same_envelope():
    envelopes = []

    def main():
        @cpl.handling({cpl.PlanFailure: lambda failure, retry: envelopes.append(failure)})
        def level(inner):
            return cpl.par(inner)

        level(lambda: level(raising(ValueError("x"))))

    with pytest.raises(ValueError):
        cpl.run(main)
    assert len(envelopes) == 2 and envelopes[0] is envelopes[1]


def test_several_failures_are_told_below_the_traceback():
    def main():
        cpl.par(raising(ValueError("first")), raising(KeyError("last")))

    with pytest.raises(KeyError) as caught:
        cpl.run(main)
    assert len(caught.value.__notes__) == 1
    assert caught.value.__notes__[0].endswith("failed too: ValueError: first")


def test_a_failure_class_of_python_has_text_and_attributes():
    with pytest.raises(Stuck, match="^jammed at 3$") as caught:
        cpl.run(lambda: cpl.par(lambda: cpl.fail(Jammed(3))))
    assert caught.value.angle == 3 and not isinstance(caught.value, Exception)
    with pytest.raises(Stuck):
        cpl.run(lambda: cpl.fail(Stuck))
    with pytest.raises(cpl.TimedOut, match="4 s"):
        cpl.run(lambda: cpl.fail(cpl.TimedOut, seconds=4))


@pytest.mark.parametrize(
    ("arguments", "text"), [((), "Plan failure."), (("100% of ~ 3",), "100% of ~ 3"), (("~a of ~a", 1, 2), "1 of 2"), (("~",), "~")]
)
def test_a_failure_may_be_a_text(arguments, text):
    with pytest.raises(cpl.PlanFailure) as caught:
        cpl.run(lambda: cpl.fail(*arguments))
    assert str(caught.value) == text


@pytest.mark.parametrize("problem", [ValueError("x"), ValueError])
def test_fail_takes_no_exceptions_of_python(problem):
    with pytest.raises(
        Error, match="which is no plan failure. Write `raise` for an exception of Python; for fail, derive the class from cpl.PlanFailure."
    ):
        cpl.run(lambda: cpl.fail(problem))


def test_raise_is_as_good_as_fail_for_handlers_and_branches():
    order = []

    def handler(failure, retry):
        order.append(str(failure))
        retry.leave("handled")

    def main():
        handled = cpl.handling({Stuck: handler})
        return (
            handled(raising(Stuck("here")))(),
            handled(lambda: cpl.par(raising(Stuck("branch"))))(),
            cpl.try_in_order(raising(Stuck("order")), lambda: "second"),
        )

    assert cpl.run(main) == ("handled", "handled", "second") and order == ["here", "branch"]


# ------------------------------------------------------------------------------------------------------ attempts and handlers


def test_attempts_end_with_the_first_success_and_pause_in_between():
    numbers = []

    def main():
        for attempt in cpl.attempts(5, pause=2):
            with attempt:
                numbers.append(attempt.number)
                if attempt.number < 3:
                    cpl.fail("not yet")
                return "done", cpl.now()

    assert cpl.run(main) == ("done", 4) and numbers == [1, 2, 3]


def test_the_failure_of_the_last_attempt_is_raised_and_others_at_once():
    tries = []

    def main(problem, on):
        for attempt in cpl.attempts(2, on=on):
            with attempt:
                tries.append(1)
                raise problem

    for problem, on, count in [
        (Stuck("a"), cpl.PlanFailure, 2),
        (ValueError("b"), cpl.PlanFailure, 1),
        (ValueError("c"), (Stuck, ValueError), 2),
    ]:
        tries.clear()
        with pytest.raises(type(problem)):
            cpl.run(main, problem, on)
        assert len(tries) == count


def test_wrong_uses_of_attempts_are_told():
    def forgotten():
        for _ in cpl.attempts(2):
            pass

    with pytest.raises(Error, match="has to be a with block: for attempt in cpl.attempts"):
        cpl.run(forgotten)
    with pytest.raises(Error, match="would try nothing. Ask for one attempt at least."):
        cpl.run(lambda: list(cpl.attempts(0)))


def test_a_handler_runs_before_anything_unwinds_and_may_retry():
    events = []

    def body(limit):
        try:
            events.append("try")
            if events.count("try") < limit:
                cpl.fail(Stuck("x"))
            return "done"
        finally:
            events.append("unwound")

    def again(failure, retry):
        events.append("handler")
        retry()

    assert cpl.run(cpl.handling({Stuck: again})(body), 2) == "done"
    assert events == ["try", "handler", "unwound", "try", "unwound"]


def test_a_handler_that_returns_declines_and_what_it_raises_goes_outside():
    asked = []

    def note(name):
        return lambda failure, retry: asked.append((name, str(failure)))

    def breaking(failure, retry):
        raise Stuck("worse")

    def main():
        inner = cpl.handling({Jammed: note("first"), Stuck: breaking, cpl.PlanFailure: note("never")})(lambda: cpl.fail(Jammed(1)))
        return cpl.handling({cpl.PlanFailure: note("outer")})(inner)()

    with pytest.raises(Stuck, match="worse"):
        cpl.run(main)
    assert asked == [("first", "jammed at 1"), ("outer", "worse")]


def test_a_handler_for_what_ends_programs_is_refused():
    with pytest.raises(Error, match="There can be no handler for KeyboardInterrupt"):
        cpl.handling({KeyboardInterrupt: print})


def test_decorators_keep_name_and_text_of_the_function():
    @cpl.plan_function
    @cpl.handling({Stuck: print})
    def grasp():
        """Close the hand."""

    assert (grasp.__name__, grasp.__doc__) == ("grasp", "Close the hand.")


# ------------------------------------------------------------------------------------------------------------------ values


def test_several_lisp_values_are_a_tuple_and_no_values_the_empty_one():
    def main():
        assert cpl.par(lambda: MultipleValues((1, 2))) == (1, 2)
        with cpl.par() as branches:
            gone = branches.start(cpl.sleep, 10)
            branches.start(cpl.evaporate, gone)
        return branches.results

    assert cpl.run(main) == [(), None]


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(("value", "counts"), [(0, True), ("", True), ([], True), (0.0, True), (None, False), (False, False)])
def test_waiting_is_for_what_is_not_none_and_not_false(value, counts):
    fluent = cpl.make_fluent(value=value)
    assert cpl.run(lambda: cpl.wait_for(fluent, timeout=1)) == (value if counts else None)
    assert kernel.now() == (0 if counts else 1)


def test_any_iterable_will_do_for_loops():
    def main():
        assert cpl.par_loop((n for n in (3, 1, 2)), lambda n: cpl.sleep(n) or n * n) == 9
        assert cpl.try_each_in_order(range(5), lambda n: n if n > 2 else cpl.fail("~a", n)) == 3
        assert cpl.par_loop([], print) is None
        with pytest.raises(cpl.CompositeFailure) as caught:
            cpl.try_each_in_order([], print)
        assert caught.value.exceptions == []
        return cpl.now()

    assert cpl.run(main) == 3


def test_whenever_is_a_loop_that_break_ends():
    door, seen = cpl.make_fluent(value=None), []

    def main():
        with cpl.par() as branches:
            branches.start(lambda: [cpl.sleep(1) or setattr(door, "value", n) for n in (1, None, 2)])
            for value in cpl.whenever(cpl.pulsed(door)):
                seen.append((value, door.value, cpl.now()))
                if len(seen) == 3:
                    break

    cpl.run(main)
    assert seen == [(True, 1, 1), (True, None, 2), (True, 2, 3)]


# ------------------------------------------------------------------------------------------------------- suspension and steps


def test_suspension_handlers_and_methods_of_tasks():
    events = []

    def robot():
        with cpl.on_suspension(lambda: events.append(("stop", cpl.now()))):
            cpl.sleep(4)
        events.append(("there", cpl.now()))

    def main():
        with cpl.par() as branches:
            task = branches.start(robot)
            cpl.sleep(1)
            assert list(cpl.current_task().children) == [task] and task.parent is cpl.current_task()
            task.suspend()
            assert task.status is cpl.SUSPENDED and task.alive
            cpl.sleep(5)
            task.wake_up()
            assert task.status is cpl.RUNNING
            task.join()
            other = branches.start(cpl.sleep, 100)
            other.evaporate()
            assert other.join() == () and other.dead

    cpl.run(main)
    assert events == [("stop", 1), ("there", 6)]


def test_a_task_is_woken_however_its_suspended_block_is_left():
    def main():
        with cpl.par() as branches:
            task = branches.start(cpl.sleep, 3)
            cpl.sleep(1)
            with pytest.raises(KeyError), cpl.task_suspended(task):
                raise KeyError
            assert task.status is cpl.RUNNING

    cpl.run(main)


def test_plan_functions_are_tasks_at_places_of_the_tree():
    places = []

    @cpl.plan_function
    def grasp(thing, *, force=1):
        places.append(str([part.car.name for part in cpl.current_task().path]))
        return thing, force

    @cpl.plan_function
    def fetch(thing):
        return grasp(thing, force=2)

    assert cpl.run(fetch, "cup") == ("cup", 2) and places == ["['GRASP', 'FETCH']"]


def test_tags_can_be_ordered_before_they_run():
    order = []

    def main():
        look, grasp = cpl.tag("look"), cpl.tag("grasp")
        assert look.task.status is cpl.CREATED

        def step(name, seconds):
            cpl.sleep(seconds)
            order.append(name)
            return name

        cpl.partial_order([lambda: grasp.run(step, "grasp", 0), lambda: look.run(step, "look", 2)], [(look, grasp)])
        first = look.task
        return look.run(step, "again", 0), look.task is not first

    assert cpl.run(main) == ("again", True) and order == ["look", "grasp", "again"]


def test_a_policy_guards_a_block():
    battery, events = cpl.make_fluent(value=10), []
    guard = cpl.make_policy(
        "battery",
        init=lambda store, least: True,
        check=lambda store, least: battery.value < least,
        recover=lambda store, least: events.append("recover"),
        clean_up=lambda store, least: events.append("clean up"),
    )

    def main():
        with cpl.policy(guard, 3):
            cpl.sleep(1)
        assert events == ["clean up"]
        try:
            with cpl.policy(guard, 3):
                try:
                    cpl.sleep(1)
                    battery.value = 1
                    cpl.sleep(100)
                finally:
                    events.append("body")
        except cpl.PolicyCheckConditionMet as met:
            return list(met.parameters), met.name, round(cpl.now(), 1)

    assert cpl.run(main) == ([3], "battery", 2.0) and events == ["clean up", "body", "recover", "clean up"]
    plain = cpl.make_policy("plain", clean_up=lambda store: events.append("plain"))
    with cpl.plan(), cpl.policy(plain):
        pass
    assert events[-1] == "plain"
    with cpl.plan(), pytest.raises(cpl.PolicyInitFailed), cpl.policy(cpl.make_policy("never", init=lambda store: None)):
        pass


@pytest.mark.parametrize("problem", [cpl.SimplePlanFailure("stuck"), ValueError("no signal")])
def test_run_raises_what_the_plan_failed_with_where_no_kernel_is_left(problem):
    def fail():
        raise problem

    with kernel.aside(), pytest.raises(type(problem)) as raised:
        cpl.run(fail)
    assert raised.value is problem


def test_a_form_outside_of_any_plan_says_so_where_there_is_no_kernel():
    with kernel.aside(), pytest.raises(Error) as problem:
        cpl.par(lambda: 1)
    assert str(problem.value) == "'PAR' form not inside a plan."
    assert problem.value.__notes__ == ["From Python, run the plan with cpl.run(main), or write it below `with cpl.plan():`."]
