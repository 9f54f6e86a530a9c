"""Random plans, looked at: what is told of their tasks obeys the laws of tasks, and is what the tasks know themselves."""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import cpl, kernel
from cramhy_runtime.session import boot
from cramhy_runtime.chronicle import chronicler, fluents
from cramhy_runtime.cpl.tasks.task_observers import follow

DEAD = {"SUCCEEDED", "FAILED", "EVAPORATED"}
FOLLOWS = {"RUNNING": {"RUNNING", "SUSPENDED"} | DEAD, "SUSPENDED": {"SUSPENDED", "RUNNING"} | DEAD}

leaves = st.one_of(
    st.just(("nothing",)),
    st.tuples(st.just("sleep"), st.sampled_from([0, 0.25, 1, 2])),
    st.just(("fail",)),
    st.tuples(st.just("set"), st.integers(0, 3)),
    st.tuples(st.just("wait"), st.integers(0, 3)),
    st.tuples(st.just("pause"), st.sampled_from([0, 0.5])),
)
plans = st.recursive(
    leaves,
    lambda inner: st.one_of(
        *[st.tuples(st.just(form), st.lists(inner, min_size=1, max_size=3)) for form in ("seq", "par", "pursue", "try_all")]
    ),
    max_leaves=14,
)


def run(plan, fluent):
    kind, *rest = plan
    if kind == "sleep":
        cpl.sleep(rest[0])
    elif kind == "fail":
        cpl.fail("by lot")
    elif kind == "set":
        fluent.value = rest[0]
    elif kind == "wait":
        cpl.wait_for(fluent > rest[0] - 1, timeout=1)
    elif kind == "pause":
        me = cpl.current_task()
        kernel.call_at(kernel.now() + rest[0] + 0.1, lambda: me.wake_up(sync=False))
        me.suspend()
    elif kind == "seq":
        for part in rest[0]:
            run(part, fluent)
    elif kind != "nothing":
        getattr(cpl, kind)(*[lambda part=part: run(part, fluent) for part in rest[0]])
    return kind


def looked_at(plan, backend, seed):
    """(all tasks that there were, what was told of tasks in order)."""
    kernel.start(backend=backend, seed=seed, time_limit=1000)
    boot()
    told, tasks = [], []
    here = chronicler.active()
    here.listeners.append(lambda kind, message: told.extend(message.tasks if kind == "tasks" else ()))
    try:
        try:
            with cpl.plan() as root:
                follow(root, tasks.append)
                tasks.insert(0, root)
                run(plan, cpl.make_fluent(name="random", value=0))
        except cpl.PlanFailure:
            pass
        here.look()
    finally:
        here.listeners.clear()
        chronicler.dismiss()
        kernel.stop()
    return tasks, told


@pytest.fixture(autouse=True, scope="module")
def no_old_fluents():
    """Asking the garbage collector for those that live takes longer than a random plan."""
    asked, fluents.living_fluents = fluents.living_fluents, lambda: []
    yield
    fluents.living_fluents = asked


@pytest.mark.soak
@pytest.mark.parametrize("backend", ["threads", "greenlet"])
@given(plan=plans, seed=st.one_of(st.none(), st.integers(0, 5)))
@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
def test_what_is_told_of_random_plans(backend, plan, seed):
    tasks, told = looked_at(plan, backend, seed)
    histories = {}
    for task in told:
        histories.setdefault(task.id, []).append(task)
    began = [task for task in tasks if task.kernel_task is not None]
    assert {str(task.kernel_task.id) for task in began} == set(histories)
    for task in began:
        history = histories[str(task.kernel_task.id)]
        assert [each.state for each in history if each.state in DEAD] == [history[-1].state] == [task.status.name]
        for before, after in zip(history, history[1:]):
            assert after.state in FOLLOWS[before.state]
        last = history[-1]
        assert (last.began, last.ended) == (task.started_at, task.ended_at)
        assert all(math.isnan(each.ended) for each in history[:-1])
        assert last.parent == ("" if task.parent is None else str(task.parent.kernel_task.id))
        if last.parent:
            parent = histories[last.parent][-1]
            assert parent.began <= last.began <= last.ended <= parent.ended  # law 1
            assert told.index(last) < told.index(parent)
