"""Random plans: whatever branches do to each other, the laws of tasks hold (invariants 40 to 54).

A plan is a tree of steps: branches, tasks made by hand, protected bodies, regions, handlers, and requests to any other task. What
happens is recorded with its time, and looked at while it happens and at the end.
"""

from contextlib import suppress

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.failures import handling as failures
from cramhy_runtime.cpl.statuses import CREATED, DEAD, EVAPORATED, FAILED, NEXT, RUNNING, SUSPENDED

pytest.importorskip("greenlet")

number = st.integers(0, 9)
seconds = st.sampled_from([0.0, 0.5, 1.0, 1.0, 2.0, 3.5])
leaf = st.one_of(
    st.tuples(st.just("sleep"), seconds),
    st.tuples(st.just("compute"), st.integers(1, 2500)),
    st.tuples(st.just("wait"), number, seconds),
    st.tuples(st.just("set"), number),
    st.tuples(st.just("fail")),
    st.tuples(st.sampled_from(["suspend", "wake-up", "evaporate", "join"]), number, st.booleans()),
)


def grown(step):
    steps = st.lists(step, max_size=4)
    return st.one_of(
        st.tuples(st.sampled_from(["par", "pursue", "try-all"]), st.lists(steps, min_size=1, max_size=3)),
        st.tuples(st.sampled_from(["task", "handled", "retry-after-suspension", "on-suspension"]), steps),
        st.tuples(st.just("protected"), steps, seconds),
        st.tuples(st.just("region"), seconds),
        st.tuples(st.just("while suspended"), number, steps),
    )


plans = st.lists(st.recursive(leaf, grown, max_leaves=12), min_size=1, max_size=4)
MOST_TASKS, MOST_ATTEMPTS = 25, 10


class Run:
    """One run of a plan; what must hold at each moment is checked then, by `complain`, since an error in a branch is data here."""

    def __init__(self, plan, backend, seed, interrupts=()):
        self.kernel = kernel.start(backend=backend, seed=seed, time_limit=500)
        self.tasks, self.trace, self.wrong = [], [], []
        self.paths, self.results, self.asked, self.cleanups = {}, {}, {}, []
        self.wakes = 0
        self.fluents = [cpl.make_fluent(name=f"f{index}") for index in range(3)]
        for time in interrupts:
            kernel.call_at(time, kernel.interrupt)
        try:
            cpl.top_level(lambda: self.body(plan))
        except (cpl.PlanFailure, Exception, kernel.Interrupted, kernel.Abandoned) as problem:
            self.trace.append(type(problem).__name__)
        with suppress(kernel.Interrupted, kernel.Abandoned):  # one that came at the very end
            kernel.settle()
        kernel.settle()  # what was evaporated before its first step leaves the queue
        if self.kernel.tasks != [self.kernel.main]:
            self.complain("tasks are left", *self.kernel.tasks)
        self.end = kernel.now()

    def complain(self, *what):
        self.wrong.append(what)

    # ------------------------------------------------------------------------------------------------- what is recorded

    def watch(self, task):
        number = len(self.tasks)
        self.tasks.append(task)
        path = self.paths[task] = [task.status]

        def changed(status):
            path.append(status)
            self.trace.append((number, str(status), kernel.now()))
            if status in DEAD:
                self.results[task] = task.result
                if task.children:
                    self.complain("dead before its children", task)

        cpl.register_update_callback(task.status_fluent, "watch", changed)

    def note(self, *what):
        task = cpl.current_task()
        if task.status is not RUNNING and not (task.status is SUSPENDED and task.kernel_task.cancelled_delivered):
            self.complain("runs though it is", task.status)
        self.trace.append((self.tasks.index(task), *what, kernel.now()))

    def other(self, number):
        return self.tasks[number % len(self.tasks)]

    # -------------------------------------------------------------------------------------------------- what is done

    def body(self, steps):
        if cpl.current_task() not in self.paths:
            self.watch(cpl.current_task())
        return self.follow(steps)

    def follow(self, steps):
        for step, *arguments in steps:
            self.note(step)
            getattr(self, step.replace("-", "_").replace(" ", "_"))(*arguments)
            self.note(step, "over")

    def sleep(self, seconds):
        cpl.sleep(seconds)

    def compute(self, count):
        for _ in range(count):
            kernel.checkpoint()

    def wait(self, number, seconds):
        cpl.wait_for(self.fluents[number % 3], timeout=seconds)

    def set(self, number):
        fluent = self.fluents[number % 3]
        fluent.value = None if fluent.value else True

    def fail(self):
        cpl.fail("on purpose")

    def suspend(self, number, sync):
        task, wakes = self.other(number), self.wakes
        cpl.suspend(task, sync=sync)
        if sync and task.status is SUSPENDED and wakes == self.wakes and not task.kernel_task.cancelled:
            for below in descendants(task):
                if below.status is not SUSPENDED and not below.kernel_task.cancelled and not below.kernel_task.shielded:
                    self.complain("is not suspended with its parent", below)

    def wake_up(self, number, sync):
        self.wakes += 1
        cpl.wake_up(self.other(number), sync=sync)

    def evaporate(self, number, sync):
        task = self.other(number)
        self.asked[task] = self.asked.get(task, 0) + 1
        cpl.evaporate(task, sync=sync)
        if sync and task is not cpl.current_task() and not task.dead:
            self.complain("alive after its evaporation", task)

    def join(self, number, _):
        task = self.other(number)
        if task is not cpl.current_task():
            failures.attempt(lambda: cpl.join_task(task))
            if not task.dead:
                self.complain("joined, but alive", task)

    def branches(self, form, scripts):
        born = []

        def branch(steps):
            def run():
                born.append(cpl.current_task())
                return self.body(steps)

            return run

        if len(self.tasks) > MOST_TASKS:
            return
        try:
            form(*map(branch, scripts))
        finally:
            for task in born:
                if not task.dead:
                    self.complain("outlived its form", task)

    def par(self, scripts):
        self.branches(cpl.par, scripts)

    def pursue(self, scripts):
        self.branches(cpl.pursue, scripts)

    def try_all(self, scripts):
        self.branches(cpl.try_all, scripts)

    def task(self, steps):
        if len(self.tasks) <= MOST_TASKS:
            task = cpl.Task(lambda: self.body(steps), f"task {len(self.tasks)}")
            self.watch(task)
            task.execute()

    def handled(self, steps):
        failures.attempt(lambda: self.follow(steps))

    def retry_after_suspension(self, steps):
        left = [None] * MOST_ATTEMPTS  # who suspends the task around it there is suspended too, and begins again, for ever
        cpl.retry_after_suspension(lambda: self.follow(steps) if left and not left.pop() else None)

    def on_suspension(self, steps):
        cpl.on_suspension(lambda: self.note("handler"), lambda: self.follow(steps))

    def protected(self, steps, seconds):
        entry = [cpl.current_task(), 0, 0]
        self.cleanups.append(entry)
        try:
            self.follow(steps)
        finally:
            with kernel.cleanup():
                entry[1] += 1
                if any(child.status not in DEAD for child in entry[0].children if child.ended is not None):
                    self.complain("a branch lives while its parent cleans up", entry[0])
                cpl.sleep(seconds)
                entry[2] += 1

    def region(self, seconds):
        def protected():
            cpl.sleep(seconds)
            complete.append(True)

        complete = []
        try:
            cpl.without_scheduling(protected)
        finally:
            if not complete and self.asked.get(cpl.current_task(), 0) < 2 and not self.hopeless():
                self.complain("a region was left", cpl.current_task())

    def while_suspended(self, number, steps):
        task = self.other(number)
        if task is cpl.current_task():
            return

        def body():
            if task.status not in (SUSPENDED, *DEAD):
                self.complain("not suspended", task.status)
            try:
                self.follow(steps)
            finally:
                self.wakes += 1

        cpl.with_task_suspended(task, body)

    def hopeless(self):
        return any(task.kernel_task.abandoned for task in self.tasks if task.kernel_task is not None)


def descendants(task):
    return [below for child in task.children for below in (child, *descendants(child))]


def ancestors(task):
    while task is not None:
        yield task
        task = task.parent


def check(run):
    assert run.wrong == []
    for task, path in run.paths.items():
        assert path[0] in (CREATED, RUNNING)
        for before, after in zip(path, path[1:], strict=False):
            assert after in NEXT[before], path  # 40
        assert path[-1] in DEAD
        assert run.results[task] is task.result if task in run.results else task.status is EVAPORATED  # 41
        if task.status is FAILED:
            assert isinstance(task.result, BaseException)
    deadlock = any(entry == "Deadlock" or entry == "TimeLimit" for entry in run.trace)
    for task, begun, complete in run.cleanups:
        assert begun == 1  # 53
        cut = deadlock or any(run.asked.get(each, 0) > 1 for each in ancestors(task))
        assert complete == 1 or cut, f"the cleanup of {task.name} was cut short"  # 54


few = settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])


@pytest.mark.law(40, 41, 42, 44, 46, 47, 50, 51, 53, 54, 59)
@few
@given(plans, st.sampled_from([None, 1, 2]))
def test_the_laws_of_tasks_hold_and_both_back_ends_agree(plan, seed):
    on_greenlets = Run(plan, "greenlet", seed)
    check(on_greenlets)
    on_threads = Run(plan, "threads", seed)
    check(on_threads)
    assert on_threads.trace == on_greenlets.trace and on_threads.end == on_greenlets.end


@few
@given(plans, st.sampled_from([None, 1, 2]), st.lists(st.sampled_from([0.0, 0.5, 1.0, 1.25, 2.0, 4.25]), min_size=1, max_size=2))
def test_a_plan_that_is_interrupted_at_any_moment_comes_down_whole(plan, seed, interrupts):
    """One interrupt ends it in order. A second one gives up cleanup, and with it the order, but nobody is left then either."""
    run = Run(plan, "greenlet", seed, interrupts)
    assert run.kernel.tasks == [run.kernel.main] and all(task.dead for task in run.tasks)
    if "Abandoned" not in run.trace:
        check(run)
