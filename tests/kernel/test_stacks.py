"""Stacks: deep recursion, running out of it, and running out of threads."""

import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.kernel.backends import futexes, threads
from cramhy_runtime.kernel.errors import NoStack


@pytest.fixture
def deep():
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(20000)
    yield
    sys.setrecursionlimit(before)


def down(depth):
    return 0 if depth == 0 else 1 + down(depth - 1)


def down_through_c(depth):
    args = (depth - 1,)
    return 0 if depth == 0 else 1 + down_through_c(*args)


def test_a_task_may_recurse_deeply(k, deep):
    assert kernel.spawn(down, 15000).join() == 15000


def test_a_task_may_recurse_deeply_through_calls_that_use_the_stack_of_c(k, deep):
    assert kernel.spawn(down_through_c, 9000).join() == 9000


def test_endless_recursion_is_an_error_of_that_task_alone(k):
    def endless():
        return 1 + endless()

    task = kernel.spawn(endless)
    task.join()
    assert isinstance(task.exception, RecursionError)


@pytest.mark.soak(all_but=2)
@pytest.mark.parametrize("point", ["park", "sleep", "yield_", "run_blocking", "checkpoint", "unpark", "spawn"])
def test_a_task_that_runs_out_of_stack_at_a_park_point_harms_nobody(k, point):
    """Whatever line of the kernel the recursion limit strikes, the queue stays whole."""
    other = kernel.spawn(lambda: [kernel.sleep(0.001) for _ in range(50)], name="other")
    waiting = kernel.spawn(kernel.park, "the end", name="waiting")
    reach = {
        "park": lambda: kernel.park("x", until=kernel.now()),
        "sleep": lambda: kernel.sleep(1e-9),
        "yield_": kernel.yield_,
        "run_blocking": lambda: kernel.run_blocking(int),
        "checkpoint": lambda: [kernel.checkpoint() for _ in range(300)],
        "unpark": lambda: kernel.unpark(waiting),
        "spawn": lambda: kernel.spawn(int),
    }[point]

    def endless(offset):
        if offset:
            return endless(offset - 1)
        reach()
        return 1 + endless(0)

    for offset in range(6):
        task = kernel.spawn(endless, offset)
        task.join()
        assert isinstance(task.exception, RecursionError)
    other.join()
    assert other.exception is None
    kernel.unpark(waiting)
    waiting.join()


def test_tasks_that_start_tasks_do_not_go_deeper_and_deeper(k):
    """On greenlets a stack begins where its starter's ended, if one does not look out."""

    def chain(left):
        if left:
            kernel.spawn(chain, left - 1)
        kernel.park("the end")

    kernel.spawn(chain, 1500)
    kernel.settle()
    assert len(k.tasks) == 1502


def test_a_task_that_gets_no_thread_dies_of_it_and_the_others_go_on(start, backend, monkeypatch):
    if backend != "threads":
        pytest.skip("greenlets do not run out")
    start()
    first = kernel.spawn(kernel.park, "the end")
    kernel.settle()

    def refuse(*_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr(threads, "_idle", type(threads._idle)())
    monkeypatch.setattr(threads._thread, "start_new_thread", refuse)
    second = kernel.spawn(kernel.park, "the end")
    second.join()
    assert str(second.exception) == "can't start new thread"
    monkeypatch.undo()
    assert kernel.unpark(first)
    first.join()
    assert issubclass(NoStack, Exception)


def test_many_threads_ask_once_for_a_wide_table_of_those_that_wait(start, backend, monkeypatch):
    if backend != "threads":
        pytest.skip("greenlets wait nowhere")
    asked = []

    class Table(futexes.Table):
        def widen(self):
            asked.append(threads._thread._count())
            return super().widen()

    start()
    monkeypatch.setattr(threads, "_idle", type(threads._idle)())
    monkeypatch.setattr(threads, "_table", Table())
    monkeypatch.setattr(threads, "MANY", threads._thread._count() + 5)
    tasks = [kernel.spawn(kernel.park, "the end") for _ in range(20)]
    kernel.settle()
    assert asked == [threads.MANY]
    for task in tasks:
        kernel.unpark(task)
        task.join()
    assert all(task.dead and task.exception is None for task in tasks)


@pytest.mark.parametrize("system", ["win32", "darwin"])
def test_other_systems_have_no_table_to_widen(monkeypatch, system):
    monkeypatch.setattr(futexes.sys, "platform", system)
    table = futexes.Table()
    assert table.widen() is False and table.wide


def test_the_pool_keeps_few_threads_when_the_kernel_has_stopped(start, backend, monkeypatch):
    if backend != "threads":
        pytest.skip("each kernel has greenlets of its own")
    monkeypatch.setattr(threads, "_idle", type(threads._idle)())
    monkeypatch.setattr(threads, "KEEP_AFTERWARDS", 3)
    for _ in range(2):
        start()
        tasks = [kernel.spawn(kernel.park, "the end") for _ in range(12)]
        kernel.settle()
        for task in tasks:
            kernel.unpark(task)
            task.join()
        assert len(threads._idle) == 12
        kernel.stop()
        assert len(threads._idle) == 3
