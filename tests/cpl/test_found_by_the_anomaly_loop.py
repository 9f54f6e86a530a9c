"""What the anomaly loop (``anomalies/``) found, each defect as small as it gets."""

import gc
from weakref import ref

import pytest
from small_plans import plan, started, statuses_of

from cramhy_runtime import cpl, kernel, testing
from cramhy_runtime.cpl.forms import operators
from cramhy_runtime.cpl.tree import task_tree as tree
from cramhy_runtime.cpl.tasks import parallel_children as watching
from cramhy_runtime.cpl.statuses import EVAPORATED, FAILED, RUNNING, SUCCEEDED, SUSPENDED
from cramhy_runtime.cpl.tasks.tasks import Task
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import sym


def test_a_request_to_suspend_in_without_scheduling_is_obeyed_once():
    """Both the request and the end of ``without-scheduling`` lead to obeying; the second came while the first was at it."""

    def body():
        child = started(lambda: (cpl.without_scheduling(lambda: cpl.sleep(1)), cpl.sleep(1)))
        seen = statuses_of(child)
        cpl.sleep(0.5)
        cpl.suspend(child)
        cpl.sleep(2)
        cpl.wake_up(child)
        cpl.join_task(child)
        return seen, kernel.now()

    seen, now = plan(body)
    assert seen == [RUNNING, SUSPENDED, RUNNING, SUCCEEDED] and now == 4


def test_who_is_ended_while_it_waits_for_the_suspension_wakes_the_task():
    def body():
        stubborn = started(lambda: (cpl.without_scheduling(lambda: cpl.sleep(1)), cpl.sleep(1), "done")[-1])
        suspender = started(lambda: cpl.with_task_suspended(stubborn, lambda: cpl.sleep(100)))
        cpl.sleep(0.5)
        cpl.evaporate(suspender)
        return cpl.join_task(stubborn)

    assert plan(body) == "done" and kernel.now() == 2


def test_who_wakes_a_task_does_not_wait_for_ever_when_another_suspends_it_again_at_once():
    """Between its wake-up and its next step the task is still suspended, and a new request keeps it there."""

    def body():
        child = started(lambda: cpl.sleep(1))
        cpl.sleep(0.5)
        cpl.suspend(child)
        started(lambda: cpl.suspend(child, sync=False))  # it runs before the child does
        cpl.wake_up(child)
        before = child.status
        cpl.wake_up(child)
        return before, child.status

    assert plan(body) == (SUSPENDED, RUNNING)


def test_a_second_interrupt_leaves_nobody_in_a_protected_region():
    """The root was in one when the first came, so it had not asked its child to end, and the child is in one, too."""
    made = kernel.active()
    for moment in (0.25, 0.5):
        kernel.call_at(moment, kernel.interrupt)

    def body():
        started(lambda: cpl.without_scheduling(lambda: cpl.sleep(1)))
        cpl.without_scheduling(lambda: cpl.sleep(1))

    with pytest.raises(kernel.Abandoned):
        plan(body)
    kernel.settle()
    assert made.tasks == [made.main]


def test_who_suspended_the_task_around_it_comes_down_with_it():
    """The branch, woken by another, wakes its parent on its way out, and the parent, which was ended, waits for the branch's death."""

    def body():
        branches = []

        def branch():
            branches.append(cpl.current_task())
            cpl.with_task_suspended(cpl.current_task().parent, lambda: cpl.sleep(10))

        parent = started(lambda: cpl.par(branch))
        cpl.sleep(1)
        cpl.wake_up(branches[0])
        cpl.sleep(1)
        cpl.evaporate(parent)
        return parent.status, branches[0].status

    assert plan(body) == (EVAPORATED, EVAPORATED) and kernel.now() == 2


def test_who_is_woken_does_not_wait_for_a_branch_that_comes_down_and_waits_for_it():
    def body():
        branches = []

        def branch():
            branches.append(cpl.current_task())
            try:
                cpl.sleep(10)
            finally:
                cpl.sleep(1)
                cpl.wake_up(cpl.current_task().parent)

        parent = started(lambda: cpl.par(branch))
        cpl.sleep(1)
        cpl.suspend(parent)
        cpl.evaporate(branches[0], sync=False)
        cpl.wake_up(parent)
        cpl.join_task(parent)
        return parent.status, branches[0].status

    assert plan(body) == (SUCCEEDED, EVAPORATED) and kernel.now() == 2


@pytest.mark.parametrize("recovers", [True, False])
def test_a_task_that_fails_while_it_is_suspended_may_wait_and_end_in_any_way(recovers):
    def work():
        try:
            cpl.par(lambda: cpl.sleep(10), lambda: cpl.sleep(10))
        except cpl.PlanFailure:
            cpl.sleep(1)
            if not recovers:
                raise
        return "recovered"

    def body():
        child = started(work)
        seen = statuses_of(child)
        cpl.sleep(1)
        cpl.suspend(child)
        child.kernel_task.interject(lambda: cpl.fail("while suspended"))
        cpl.sleep(1)
        cpl.wake_up(child)
        cpl.wait_for(cpl.fl_funcall(lambda now: now in (SUCCEEDED, FAILED), child.status_fluent))
        return seen[-1], child.result

    status, result = plan(body)
    assert (status, result) == (SUCCEEDED, "recovered") if recovers else status is FAILED
    assert kernel.now() < 5


def test_children_of_a_task_that_fails_while_it_is_suspended_are_ended():
    ended = []

    def branch():
        try:
            cpl.sleep(10)
        finally:
            cpl.sleep(1)
            ended.append(kernel.now())

    def body():
        child = started(lambda: cpl.par(branch, branch))
        cpl.sleep(1)
        cpl.suspend(child)
        child.kernel_task.interject(lambda: cpl.fail("while suspended"))
        cpl.wake_up(child)
        cpl.wait_for(cpl.fl_funcall(lambda now: now is FAILED, child.status_fluent))

    plan(body)
    assert ended == [2, 2]


def test_a_wake_up_that_comes_while_a_task_is_suspended_before_it_parks_is_not_lost():
    """A request that waited for the end of a shield is obeyed at the beginning of the next wait."""
    flag = cpl.make_fluent()

    def work():
        with kernel.shield():
            kernel.sleep(1)
        return cpl.wait_for(flag, timeout=100)

    def body():
        child = started(work)
        cpl.sleep(0.5)
        cpl.suspend(child, sync=False)
        cpl.sleep(1)
        flag.set("seen")
        cpl.wake_up(child)
        return cpl.join_task(child)

    assert plan(body) == "seen" and kernel.now() == 1.5


def test_two_branches_may_call_the_same_plan_function_at_once():
    """The second call came when the task of the first was started but had not begun, and took it for its own."""

    def call(number):
        return tree.with_task_tree_node(lisp_list(sym("CPL-USER::STEP")), lambda: (cpl.sleep(1), number)[1])

    results = []
    assert plan(lambda: cpl.par(lambda: results.append(call(1)), lambda: results.append(call(2)))) is None
    assert results == [1, 2] and kernel.now() == 1


def test_a_plan_that_is_over_is_held_by_nobody():
    fluents = []

    def body():
        flag = cpl.make_fluent()
        fluents.append(ref(flag))
        cpl.pursue(lambda: cpl.wait_for(cpl.fl_not(cpl.fl_not(flag)), timeout=10), lambda: cpl.sleep(1))

    plan(body)
    gc.collect()
    assert fluents[0]() is None


def test_an_evaporated_task_does_not_hold_its_stack():
    held = []

    class Something:
        pass

    def branch():
        thing = Something()
        held.append(ref(thing))
        cpl.sleep(10)
        return thing

    def body():
        child = started(branch)
        cpl.sleep(1)
        cpl.evaporate(child)
        gc.collect()
        return child.status, held[0]()

    assert plan(body) == (EVAPORATED, None)


def test_the_general_parallel_form_leaves_no_watcher_on_its_children():
    children = []

    def watcher(running, done, failed):
        children.extend(running or ())
        if not running:
            cpl.fail("enough")

    with pytest.raises(cpl.PlanFailure):
        plan(lambda: watching.watch([Task(lambda: cpl.sleep(1), "one"), Task(lambda: cpl.sleep(2), "two")], watcher))
    assert children and not any(task.status_fluent.callbacks for task in children)


def test_the_kernel_that_looks_on_sees_no_difference():
    """What the loop runs on gives what an ordinary kernel gives."""
    outcome = testing.run(lambda: cpl.top_level(lambda: operators.par(lambda: (cpl.sleep(1), 1)[1], lambda: cpl.sleep(2))))
    assert outcome.value == 1 and outcome.time == 2
