"""Law 3 for tasks made by hand, for which no form waits: if they fail and nobody asks, the user is told."""

import pytest

from cramhy_runtime import cpl, kernel


@pytest.fixture
def told(monkeypatch):
    heard = []
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, exception: heard.append((task.name, str(exception))))
    return heard


def failing(text="stuck"):
    def body():
        cpl.sleep(1)
        cpl.fail(text)

    return cpl.Task(body, "gripper").execute()


def test_the_failure_of_a_task_that_nobody_asked_about_is_told_when_its_parent_ends(told):
    def plan():
        failing()
        cpl.sleep(5)
        assert told == []
        return "done"

    assert cpl.top_level(plan) == "done"
    assert told == [("gripper", "stuck")]


@pytest.mark.parametrize(
    "ask",
    [
        lambda task: cpl.with_failure_handling(
            [(cpl.PlanFailure, lambda failure, retry: retry.leave())], lambda retry: cpl.join_task(task)
        ),
        lambda task: cpl.wait_for(cpl.fl_funcall(lambda now: now is cpl.FAILED or None, task.status_fluent)),
    ],
)
def test_who_asked_has_been_told(told, ask):
    def plan():
        task = failing()
        ask(task)

    cpl.top_level(plan)
    assert told == [] and kernel.now() == 1.0


def test_a_failure_that_a_form_waits_for_is_told_once_by_the_form(told):
    with pytest.raises(cpl.PlanFailure):
        cpl.top_level(lambda: cpl.par(lambda: cpl.fail("stuck"), lambda: cpl.sleep(1)))
    assert told == []


def test_in_lisp_the_readers_count_as_asking(told):
    from cramhy_runtime.cpl.tasks import task_readers

    def plan():
        tasks = [failing(), failing(), failing()]
        cpl.sleep(2)
        return task_readers.task_failed_p(tasks[0]), str(task_readers.result(tasks[1]))

    assert cpl.top_level(plan) == (True, "stuck")
    assert told == [("gripper", "stuck")]
