"""The world outside: messages from other threads, and calls that block."""

import contextvars

import pytest
from outside_world import Barrier, Event, in_a_thread
from systems import needs_threads

from cramhy_runtime import kernel


@pytest.mark.parametrize("clock", ["virtual", "wall"])
def test_a_thread_can_wake_a_task_by_a_message(start, clock):
    start(clock=clock)
    main = kernel.current()
    with kernel.outside_source():
        in_a_thread(kernel.post, lambda: kernel.unpark(main))
        assert kernel.park("the message") is True


def test_messages_are_read_in_the_order_they_came(k):
    log = []
    for number in range(100):
        kernel.post(lambda number=number: log.append(number))
    assert log == []
    kernel.yield_()
    assert log == list(range(100))


def test_a_message_reaches_a_run_of_busy_tasks(k):
    seen = []
    in_a_thread(kernel.post, lambda: seen.append(True))
    while not seen:
        kernel.checkpoint()


def test_a_failing_message_is_reported_and_the_next_is_read(k, reported):
    log = []
    kernel.post(lambda: 1 / 0)
    kernel.post(lambda: log.append("next"))
    kernel.yield_()
    assert [name for name, _ in reported] == ["scheduler"]
    assert log == ["next"]


def test_while_an_outside_source_is_open_waiting_is_no_deadlock_and_after_that_it_is(k):
    source = kernel.outside_source()
    source.__enter__()
    in_a_thread(source.__exit__)
    with pytest.raises(kernel.Deadlock):
        kernel.park("a message")


def test_virtual_time_jumps_although_an_outside_source_is_open(k):
    with kernel.outside_source():
        kernel.sleep(1000)
    assert kernel.now() == 1000.0


def test_a_blocking_call_gives_its_result(k):
    assert kernel.run_blocking(lambda a, b: a + b, 1, 2) == 3


def test_a_blocking_call_raises_what_it_raised(k):
    with pytest.raises(ZeroDivisionError):
        kernel.run_blocking(lambda: 1 / 0)
    kernel.sleep(1)


def test_others_run_while_a_call_blocks(k):
    done = Event()

    def other():
        for _ in range(3):
            kernel.yield_()
        done.set()

    kernel.spawn(other)
    assert kernel.run_blocking(done.wait, 10)


def test_several_calls_can_block_at_once(k):
    barrier = Barrier(4)
    tasks = [kernel.spawn(kernel.run_blocking, barrier.wait, 10) for _ in range(3)]
    kernel.run_blocking(barrier.wait, 10)
    assert sorted(task.join() for task in tasks)[0] >= 0
    assert all(task.exception is None for task in tasks)


def test_virtual_time_stands_still_while_a_call_blocks(k):
    released = Event()
    caller = kernel.spawn(kernel.run_blocking, released.wait, 10)
    sleeper = kernel.spawn(kernel.sleep, 5)
    kernel.settle()
    in_a_thread(released.set)
    caller.join()
    assert kernel.now() == 0.0
    sleeper.join()
    assert kernel.now() == 5.0


def test_virtual_time_stands_still_while_a_call_blocks_although_a_task_is_busy(k):
    released = Event()
    slices = [0]

    def busy():
        while not released.is_set():
            slices[0] += 1
            if slices[0] > 20000:
                released.set()
            kernel.checkpoint()

    kernel.spawn(busy)
    assert kernel.run_blocking(released.wait, 10)
    assert kernel.now() <= 0.005


def test_a_call_that_blocks_is_no_deadlock(k):
    released = Event()
    caller = kernel.spawn(kernel.run_blocking, released.wait, 10)
    kernel.post(lambda: in_a_thread(released.set))
    assert caller.join() is True


def test_a_request_to_end_is_delivered_when_the_call_has_returned(k):
    released = Event()
    caller = kernel.spawn(kernel.run_blocking, released.wait, 10)
    kernel.settle()
    caller.cancel()
    kernel.settle()
    assert not caller.dead
    released.set()
    caller.join()
    assert caller.cancelled_delivered


def test_a_message_for_a_task_that_waits_is_read_while_the_main_task_is_outside(k):
    heard = Event()

    def listener():
        kernel.park("the message")
        heard.set()

    task = kernel.spawn(listener)
    kernel.settle()
    with kernel.outside_source():
        in_a_thread(kernel.post, lambda: kernel.unpark(task))
        assert kernel.run_blocking(heard.wait, 10)


@pytest.mark.parametrize(
    "use, what",
    [
        (lambda task: kernel.park("x"), "wait"),
        (lambda task: kernel.sleep(1), "wait"),
        (lambda task: kernel.yield_(), "yield"),
        (lambda task: kernel.settle(), "settle"),
        (lambda task: kernel.spawn(print), "spawn a task"),
        (lambda task: kernel.unpark(task), "wake a task"),
        (lambda task: kernel.run_blocking(print), "start a blocking call"),
    ],
)
@needs_threads
def test_a_thread_without_the_baton_is_refused(k, use, what):
    task = kernel.spawn(kernel.park, "x")
    told = []

    def outside():
        try:
            use(task)
        except kernel.KernelError as error:
            told.append(str(error))

    in_a_thread(outside).join(10)
    assert told == [f"A thread that does not have the baton tried to {what}. Outside threads reach tasks by `kernel.post` only."]
    kernel.sleep(1)
    task.cancel()


@needs_threads
def test_a_checkpoint_in_an_outside_thread_preempts_nobody(k):
    def outside():
        for _ in range(5000):
            kernel.checkpoint()

    in_a_thread(outside).join(10)
    assert kernel.now() == 0.0


def test_context_variables_go_along_into_a_task_and_not_back(k):
    from contextvars import ContextVar

    place = ContextVar("place", default="nowhere")
    place.set("main")

    def task():
        before = place.get()
        place.set("task")
        return before

    assert kernel.spawn(task).join() == "main"
    assert kernel.spawn(task).join() == "main"
    assert place.get() == "main"


@pytest.mark.parametrize("clock", ["virtual", "wall"])
def test_a_call_that_blocks_sees_the_context_variables_of_its_task_and_keeps_its_own(start, clock):
    start(clock=clock)
    who = contextvars.ContextVar("who", default="nobody")

    def outside(name):
        seen = who.get()
        who.set(f"{name} outside")
        return seen

    def branch(name):
        who.set(name)
        seen = kernel.run_blocking(outside, name)
        return seen, kernel.run_blocking(who.get), who.get()

    who.set("walter")
    assert kernel.run_blocking(outside, "main") == "walter" == who.get()
    assert [task.join() for task in [kernel.spawn(branch, name) for name in "ab"]] == [("a", "a", "a"), ("b", "b", "b")]
    assert who.get() == "walter"
