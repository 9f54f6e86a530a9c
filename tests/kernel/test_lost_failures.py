"""No failure is lost: an exception that nobody looks at is reported (law 3)."""

import pytest

from cramhy_runtime import kernel


def fail():
    raise LookupError("no such turtle")


def names(reported):
    return [name for name, _ in reported]


def test_a_failure_that_nobody_waits_for_is_reported_when_the_instant_is_over(k, reported):
    kernel.spawn(fail, name="drive")
    kernel.sleep(1)
    assert names(reported) == ["drive"]
    assert isinstance(reported[0][1], LookupError)


def test_a_failure_with_a_joiner_is_the_joiners(k, reported):
    kernel.spawn(fail).join()
    kernel.sleep(1)
    assert reported == []


def test_a_joiner_that_comes_later_in_the_same_instant_is_in_time(k, reported):
    tasks = [kernel.spawn(fail) for _ in range(3)]
    for task in tasks:
        task.join()
    kernel.sleep(1)
    assert reported == []


def test_a_joiner_that_left_before_the_end_takes_no_care(k, reported):
    failing = kernel.spawn(lambda: (kernel.sleep(2), fail()), name="drive")
    joiner = kernel.spawn(failing.join)
    kernel.sleep(1)
    joiner.cancel()
    kernel.sleep(5)
    assert names(reported) == ["drive"]


def test_whoever_reads_the_exception_takes_care_of_it(k, reported):
    task = kernel.spawn(fail)
    kernel.yield_()
    assert isinstance(task.exception, LookupError)
    kernel.sleep(1)
    assert reported == []


def test_it_is_reported_when_the_parent_ends_without_having_looked(k, reported):
    def parent():
        kernel.spawn(fail, name="child")
        kernel.yield_()

    kernel.spawn(parent)
    kernel.yield_()
    kernel.yield_()
    assert names(reported) == ["child"]


def test_it_is_reported_when_the_repl_settles(k, reported):
    kernel.spawn(fail, name="drive")
    kernel.settle()
    assert names(reported) == ["drive"]


def test_it_is_reported_once(k, reported):
    kernel.spawn(fail, name="drive")
    kernel.settle()
    kernel.sleep(1)
    kernel.settle()
    kernel.stop()
    assert names(reported) == ["drive"]


def test_it_is_reported_when_the_kernel_stops(k, reported):
    kernel.spawn(fail, name="drive")
    kernel.yield_()
    kernel.stop()
    assert names(reported) == ["drive"]


def test_a_failure_in_cleanup_is_a_failure(k, reported):
    def body():
        try:
            kernel.park("for ever")
        finally:
            fail()

    task = kernel.spawn(body, name="cleanup")
    kernel.yield_()
    task.cancel()
    kernel.sleep(1)
    assert names(reported) == ["cleanup"]


@pytest.mark.parametrize("exception", [SystemExit, KeyboardInterrupt, GeneratorExit])
def test_base_exceptions_end_the_task_and_nothing_else(k, reported, exception):
    def leave():
        raise exception

    task = kernel.spawn(leave)
    task.join()
    assert isinstance(task.exception, exception)
    kernel.sleep(1)


def test_a_hook_that_fails_does_not_stop_the_scheduler(k, monkeypatch, capsys):
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, exception: 1 / 0)
    kernel.spawn(fail, name="drive")
    kernel.sleep(1)
    err = capsys.readouterr().err
    assert "LookupError: no such turtle" in err
    assert "ZeroDivisionError" in err


def test_the_traceback_begins_in_the_users_code(k, capsys):
    kernel.spawn(fail, name="drive")
    kernel.sleep(1)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "Unhandled exception in task drive:"
    assert lines[1] == "Traceback (most recent call last):"
    assert lines[2].startswith(f'  File "{__file__}", line ')
    assert lines[-1] == "LookupError: no such turtle"


def test_wrong_arguments_are_a_failure_of_the_task(k):
    task = kernel.spawn(fail, "too", "many")
    task.join()
    assert isinstance(task.exception, TypeError)
