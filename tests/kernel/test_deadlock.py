"""Deadlock: said at once, to the main task, with who waits for what, and where."""

import threading

import pytest
from systems import needs_threads

from cramhy_runtime import kernel


@pytest.fixture(autouse=True)
def no_threads_of_other_tests(monkeypatch):
    """The text names all threads of the program; those that other tests have left are none of ours."""
    before, enumerate_all = set(threading.enumerate()) - {threading.main_thread()}, threading.enumerate
    monkeypatch.setattr(threading, "enumerate", lambda: [thread for thread in enumerate_all() if thread not in before])


def line_of(marker):
    with open(__file__) as file:
        return next(number for number, line in enumerate(file, 1) if line.rstrip().endswith(f"# {marker}"))


def wait_for_a_pulse():
    kernel.park("a pulse of (> *battery* 0.5)")  # here the waiter parks


def test_the_text_names_each_task_what_it_waits_for_and_where(k):
    kernel.spawn(wait_for_a_pulse, name="recharge")
    joined = kernel.spawn(lambda: kernel.park(lambda: "the door"), name="enter")  # here the other parks
    with pytest.raises(kernel.Deadlock) as told:
        joined.join()  # here main parks
    assert str(told.value) == (
        "Nothing can happen any more: every task waits, and no timer and no outside event can wake one.\n"
        "  main waits for the end of task enter\n"
        f"      at {__file__}:{line_of('here main parks')} in test_the_text_names_each_task_what_it_waits_for_and_where\n"
        "  recharge waits for a pulse of (> *battery* 0.5)\n"
        f"      at {__file__}:{line_of('here the waiter parks')} in wait_for_a_pulse\n"
        "  enter waits for the door\n"
        f"      at {__file__}:{line_of('here the other parks')} in <lambda>\n"
        "Look for the one that should have been woken: a fluent that nobody sets any more, or tasks that wait for each other."
    )


def test_frames_are_described_in_the_terms_of_the_floor_above(k, monkeypatch):
    def describe(frame):
        return "drive.lisp:7 in (RECHARGE)" if frame.f_code.co_name == "plan" else None

    def plan():
        wait_for_a_pulse()

    monkeypatch.setattr(kernel.reports.installed.reporter, "describe_frame", describe)
    kernel.spawn(plan, name="recharge")
    with pytest.raises(kernel.Deadlock) as told:
        kernel.park("the end")
    lines = str(told.value).splitlines()
    assert lines[1:4] == [
        "  main waits for the end",
        "  recharge waits for a pulse of (> *battery* 0.5)",
        "      at drive.lisp:7 in (RECHARGE)",
    ]


def test_a_hook_or_a_reason_that_fails_does_not_spoil_the_report(k, monkeypatch):
    monkeypatch.setattr(kernel.reports.installed.reporter, "describe_frame", lambda frame: 1 / 0)
    with pytest.raises(kernel.Deadlock) as told:
        kernel.park(lambda: {}["missing"])
    lines = str(told.value).splitlines()
    assert lines[1] == "  main waits for something that cannot say what it is (KeyError('missing'))"
    assert lines[2].startswith("      at (the hook describe_frame failed: ZeroDivisionError(")


def test_a_long_list_is_cut(k):
    for _ in range(100):
        kernel.spawn(kernel.park, "x")
    with pytest.raises(kernel.Deadlock) as told:
        kernel.park("y")
    assert "  and 71 more" in str(told.value).splitlines()


def test_a_task_that_dies_of_a_failure_is_told_of_before_the_deadlock_it_causes(k, reported):
    kernel.spawn(lambda: 1 / 0, name="setter")
    with pytest.raises(kernel.Deadlock):
        kernel.park("what the setter sets")
    assert [name for name, _ in reported] == ["setter"]


def test_after_a_deadlock_the_others_can_be_cancelled_and_the_run_goes_on(k):
    task = kernel.spawn(kernel.park, "godot")
    with pytest.raises(kernel.Deadlock):
        task.join()
    task.cancel()
    task.join()
    kernel.sleep(1)
    assert kernel.now() == 1.0


def test_a_deadlock_in_cleanup_under_a_shield_is_told_as_well(k):
    with pytest.raises(kernel.Deadlock), kernel.shield():
        kernel.park("godot")


def test_a_parked_task_with_a_timer_somewhere_is_no_deadlock(k):
    main = kernel.current()
    kernel.call_at(5.0, lambda: kernel.unpark(main))
    assert kernel.park("the timer")


def test_a_cancelled_timer_does_not_hide_a_deadlock(k):
    kernel.call_at(5.0, lambda: None).cancel()
    with pytest.raises(kernel.Deadlock):
        kernel.park("the timer")
    assert kernel.now() == 0.0


@needs_threads
def test_the_text_says_what_to_do_about_threads_of_the_user(k):
    released = threading.Event()
    thread = threading.Thread(target=released.wait, args=(30,), name="bumper", daemon=True)
    thread.start()
    try:
        with pytest.raises(kernel.Deadlock) as told:
            kernel.park("the bumper")
    finally:
        released.set()
        thread.join()
    assert str(told.value).splitlines()[-1] == (
        "The program has other threads (bumper). Plans do not wait for threads of Python, and virtual time passes without them. If one of "
        "them was to set the fluent, let a branch of the plan do its work: cpl.run_blocking(work) returns what it returns, and time stands "
        "still meanwhile. Or run the plan in wall time, cpl.run(main, clock='wall'), and open `with kernel.outside_source():` in it while "
        "the thread works."
    )
