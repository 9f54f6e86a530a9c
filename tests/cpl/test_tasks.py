"""Tasks: status, evaporation, suspension, task variables: cpl.md section 16, invariants 40 to 64."""

import gc
import weakref

import pytest
from small_plans import plan, started, statuses_of

from cramhy_runtime.cpl.failures import handling
from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl import task_variables
from cramhy_runtime.cpl.tasks import tasks
from cramhy_runtime.cpl.statuses import CREATED, EVAPORATED, FAILED, RUNNING, SUCCEEDED, SUSPENDED
from cramhy_runtime.cpl.tasks.tasks import Task
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import NO_VALUES, MultipleValues, Symbol
from cramhy_runtime.lisp_core.dynamic import binding


def test_a_status_goes_from_running_to_exactly_one_dead_state():
    def body():
        task = Task(lambda: 1, "child")
        seen = statuses_of(task)
        task.execute()
        assert cpl.join_task(task) == 1
        return seen

    assert plan(body) == [RUNNING, SUCCEEDED]


def test_the_result_is_there_when_the_status_is_dead():
    def body():
        task = Task(lambda: MultipleValues((1, 2)), "child")
        results = []
        cpl.register_update_callback(task.status_fluent, "watch", lambda status: results.append((status, task.result)))
        task.execute()
        cpl.join_task(task)
        return results[-1]

    assert plan(body) == (SUCCEEDED, (1, 2))


def test_a_parent_that_succeeds_leaves_no_living_child():
    children = []

    def body():
        children.append(started(lambda: cpl.sleep(1), "short"))
        children.append(started(lambda: cpl.sleep(100), "long"))
        cpl.sleep(2)

    plan(body)
    assert [child.status for child in children] == [SUCCEEDED, EVAPORATED] and kernel.now() == 2


def test_a_failing_parent_leaves_no_living_child_either():
    children = []

    def body():
        children.append(started(lambda: cpl.sleep(100)))
        cpl.sleep(1)
        cpl.fail("x")

    with pytest.raises(cpl.PlanFailure):
        plan(body)
    assert children[0].status is EVAPORATED


def test_evaporating_a_task_ends_all_below_it_children_first_and_then_its_cleanup_runs():
    order = []

    def worker(name, inner=lambda: cpl.sleep(100)):
        try:
            inner()
        finally:
            cpl.sleep(0.1)
            order.append(name)

    def body():
        parent = started(
            lambda: worker("parent", lambda: cpl.par(lambda: worker("child", lambda: cpl.pursue(lambda: worker("grandchild")))))
        )
        cpl.sleep(1)
        cpl.evaporate(parent)
        return parent.status

    assert plan(body) is EVAPORATED
    assert order == ["grandchild", "child", "parent"] and kernel.now() == pytest.approx(1.3)


def test_a_second_request_does_not_interrupt_cleanup():
    done = []

    def worker():
        try:
            cpl.sleep(100)
        finally:
            for _ in range(3000):  # three slices long
                kernel.checkpoint()
            done.append("complete")

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.evaporate(task, sync=None)
        kernel.yield_()
        cpl.evaporate(task, sync=None)
        kernel.yield_()
        assert done == []
        cpl.evaporate(task)

    plan(body)
    assert done == ["complete"]


def test_evaporation_is_no_condition_and_no_handler_catches_it():
    caught = []

    def worker():
        try:
            cpl.with_failure_handling([(True, lambda condition, retry: caught.append(condition))], lambda retry: cpl.sleep(100))
        except Exception as exception:
            caught.append(exception)

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.evaporate(task)
        return task.status

    assert plan(body) is EVAPORATED and caught == []


def test_a_failure_in_cleanup_makes_the_task_failed_and_cannot_be_caught_by_handlers_from_before():
    def worker():
        def body(retry):
            try:
                cpl.sleep(100)
            finally:
                cpl.fail("in cleanup")

        cpl.with_failure_handling([(cpl.PlanFailure, lambda failure, retry: retry())], body)

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.evaporate(task)
        return task.status

    assert plan(body) is FAILED


def test_a_task_asked_to_end_before_it_ran_never_runs():
    ran = []

    def body():
        task = started(lambda: ran.append(1))
        task.evaporate()
        cpl.sleep(1)
        return task.status

    assert plan(body) is EVAPORATED and ran == []


def test_evaporating_a_child_leaves_its_parent_running():
    def body():
        task = started(lambda: cpl.sleep(100))
        cpl.sleep(1)
        cpl.evaporate(task)
        return cpl.join_task(task), "still here"

    assert plan(body) == (NO_VALUES, "still here")


def test_suspension_stops_all_below_and_wake_up_lets_them_go_on():
    ticks = []

    def ticking():
        while True:
            cpl.sleep(0.1)
            ticks.append(kernel.now())

    def body():
        task = started(lambda: cpl.par(ticking, ticking))
        cpl.sleep(1.05)
        cpl.suspend(task)
        at_suspension = len(ticks), task.status
        below = [child.status for child in task.children]
        cpl.sleep(5)
        still = len(ticks)
        cpl.wake_up(task)
        woken = task.status
        cpl.sleep(1)
        return at_suspension, below, still, woken, len(ticks) > still

    (count, status), below, still, woken, went_on = plan(body)
    assert status is SUSPENDED and below == [SUSPENDED, SUSPENDED] and still == count == 20
    assert woken is RUNNING and went_on


def test_both_requests_are_idempotent():
    def body():
        task = started(lambda: cpl.sleep(3))
        cpl.sleep(1)
        cpl.wake_up(task)
        cpl.suspend(task)
        cpl.suspend(task)
        cpl.wake_up(task)
        cpl.wake_up(task)
        cpl.join_task(task)
        cpl.suspend(task)
        cpl.wake_up(task)
        return task.status

    assert plan(body) is SUCCEEDED and kernel.now() == 3


def test_a_sleep_counts_the_time_spent_suspended():
    def body():
        task = started(lambda: cpl.sleep(3))
        cpl.sleep(1)
        cpl.with_task_suspended(task, lambda: cpl.sleep(5))
        cpl.join_task(task)
        return kernel.now()

    assert plan(body) == 6


def test_a_condition_that_came_true_during_suspension_is_found_after_wake_up():
    fluent = cpl.make_fluent()

    def body():
        task = started(lambda: cpl.wait_for(fluent))
        cpl.sleep(1)

        def meanwhile():
            fluent.set("now")
            cpl.sleep(1)
            return task.status

        assert cpl.with_task_suspended(task, meanwhile) is SUSPENDED
        return cpl.join_task(task)

    assert plan(body) == "now"


def test_a_suspended_task_can_be_evaporated_and_cleans_up():
    done = []

    def worker():
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(1)
            done.append(1)

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.suspend(task)
        cpl.evaporate(task)
        return task.status

    assert plan(body) is EVAPORATED and done == [1]


def test_handlers_of_suspension_run_innermost_first_while_the_task_is_running():
    seen = []

    def worker():
        def note(name):
            return lambda: seen.append((name, cpl.current_task().status))

        cpl.on_suspension(note("outer"), lambda: cpl.on_suspension(note("inner"), lambda: cpl.sleep(3)))

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.with_task_suspended(task, lambda: seen.append(("body", task.status)))

    plan(body)
    assert seen == [("inner", RUNNING), ("outer", RUNNING), ("body", SUSPENDED)]


def test_retry_after_suspension_cleans_up_and_starts_again():
    order = []

    def worker():
        def attempt():
            order.append("start")
            try:
                cpl.sleep(2)
            finally:
                order.append("cleanup")
            return "values of the last run"

        return cpl.on_suspension(lambda: order.append("handler"), lambda: cpl.retry_after_suspension(attempt))

    def body():
        task = started(worker)
        cpl.sleep(1)
        cpl.with_task_suspended(task, lambda: order.append("suspended"))
        return cpl.join_task(task)

    assert plan(body) == "values of the last run"
    assert order == ["start", "cleanup", "handler", "suspended", "start", "cleanup"]


def test_with_task_suspended_wakes_the_task_though_its_body_fails():
    def body():
        task = started(lambda: cpl.sleep(3))
        cpl.sleep(1)
        _, failure = handling.attempt(lambda: cpl.with_task_suspended(task, lambda: cpl.fail("x")))
        return failure.format_control, task.status

    assert plan(body) == ("x", RUNNING)


def test_a_dead_task_can_be_suspended_without_waiting_for_ever():
    def body():
        task = started(lambda: 1)
        cpl.join_task(task)
        return cpl.with_task_suspended(task, lambda: "done")

    assert plan(body) == "done"


def test_without_scheduling_delays_requests_to_its_end():
    order = []

    def worker():
        def protected():
            cpl.sleep(1)
            order.append("protected part complete")

        cpl.without_scheduling(protected)
        cpl.sleep(100)

    def body():
        task = started(worker)
        cpl.sleep(0.5)
        cpl.evaporate(task)
        order.append(task.status)

    plan(body)
    assert order == ["protected part complete", EVAPORATED]


def test_joining_a_failed_task_signals_the_very_same_condition():
    failure = cpl.SimplePlanFailure("x")

    def body():
        task = started(lambda: cpl.fail(failure))
        _, caught = handling.attempt(lambda: cpl.join_task(task))
        return caught

    assert plan(body) is failure


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: cpl.join_task(cpl.current_task()), "Cannot join current task."),
        (lambda: Task(None, "t").execute(), "Tried to execute task ~S which has no thread-fun."),
        (lambda: started(lambda: 1).execute(), "Task ~S is already running a thread."),
        (lambda: Task(lambda: 1).change_status(SUSPENDED), "Invalid status transition from ~S to ~S."),
    ],
)
def test_wrong_use_of_tasks_says_what_is_wrong(call, text):
    with pytest.raises(Error) as problem:
        plan(call)
    assert problem.value.format_control == text


def test_making_a_task_from_lisp_starts_it():
    from cramhy_runtime.languages.commonlisp.objects.classes import find_class_or_error
    from cramhy_runtime.languages.commonlisp.objects.instances import make_instance
    from cramhy_runtime.lisp_core.packages import keyword, sym

    def made(*more):
        return make_instance(find_class_or_error(sym("CPL::TASK")), keyword("NAME"), "x", keyword("THREAD-FUN"), lambda: 42, *more)

    assert plan(lambda: cpl.join_task(made())) == 42
    assert plan(lambda: made(keyword("RUN-THREAD"), None).status) is CREATED


def test_a_task_needs_a_task_to_start_it():
    with pytest.raises(Error) as problem:
        started(lambda: 1)
    assert problem.value.format_control == "No current task active (*CURRENT-TASK* is NIL)."


def test_task_variables_are_inherited_and_ordinary_ones_are_not():
    ordinary, inherited = Symbol("*ORDINARY*"), Symbol("*INHERITED*")
    ordinary.value = "global"
    task_variables.define_task_variable(inherited, "global")
    seen = []

    def branch():
        seen.append((ordinary.value, inherited.value))
        inherited.value = "changed in a branch"

    try:
        with binding(ordinary, "bound", inherited, "bound"):
            plan(lambda: (cpl.par(branch, branch), seen.append((ordinary.value, inherited.value))))
            assert (ordinary.value, inherited.value) == ("bound", "bound")
    finally:
        task_variables.declared.pop(inherited)
    assert seen == [("global", "bound")] * 3 and inherited.value == "global"


def test_an_init_function_computes_a_task_variable_from_the_parents_value():
    depth = Symbol("*DEPTH*")
    task_variables.define_task_variable(depth, 0, init_function=lambda task, parent, value: value + 1)
    try:
        assert plan(lambda: cpl.par(lambda: cpl.par(lambda: depth.value))) == 3
    finally:
        task_variables.declared.pop(depth)


def test_outside_of_plans_there_is_no_current_task_but_a_dummy_can_be_had():
    assert cpl.current_task() is None
    assert tasks.current_task_or_dummy().status is RUNNING
    assert Task(lambda: 1).status is CREATED


def test_a_cleanup_that_waits_for_ever_is_named_in_the_deadlock_report():
    never = cpl.make_fluent(name="never")

    def stuck():
        try:
            cpl.sleep(100)
        finally:
            cpl.wait_for(never)

    with pytest.raises(kernel.Deadlock) as problem:
        plan(lambda: cpl.pursue(stuck, lambda: cpl.sleep(1)))
    assert "never" in str(problem.value)


def test_the_main_task_may_be_interrupted_and_the_plan_cleans_up():
    done = []

    def body():
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(1)
            done.append(kernel.now())

    with pytest.raises(kernel.Interrupted):
        plan(lambda: cpl.par(body, lambda: (cpl.sleep(1), kernel.interrupt())))
    assert done == [2]


def test_a_dead_task_goes_without_the_garbage_collector():
    gc.collect()
    gc.disable()
    try:
        seen = []

        def branch():
            seen.append(weakref.ref(cpl.current_task()))

        cpl.top_level(lambda: cpl.par(branch, lambda: cpl.pursue(branch, lambda: cpl.sleep(10))))
        kernel.settle()
        assert [reference() for reference in seen] == [None, None]
    finally:
        gc.enable()


@pytest.mark.parametrize(
    "wait",
    [lambda: cpl.sleep(10), lambda: cpl.wait_for(cpl.make_fluent()), lambda: cpl.par(lambda: cpl.sleep(10), lambda: cpl.sleep(20))],
    ids=["asleep", "waiting for a fluent", "waiting for branches"],
)
def test_a_task_that_was_ended_goes_without_the_garbage_collector(wait):
    gc.collect()
    gc.disable()
    try:
        seen = []

        def loser():
            seen.append(weakref.ref(cpl.current_task()))
            wait()

        cpl.top_level(lambda: cpl.pursue(loser, lambda: cpl.sleep(1)))
        kernel.settle()
        assert [reference() for reference in seen] == [None]
    finally:
        gc.enable()
