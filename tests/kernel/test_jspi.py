"""What is true of stacks of WebAssembly alone; see `cramhy_runtime.kernel.backends.jspi`. Runs in Node, by tests/webassembly."""

import asyncio
import gc
import sys
import time

import pytest
from outside_world import in_a_thread
from systems import IN_WEBASSEMBLY, SOAK

from cramhy_runtime import kernel
from cramhy_runtime.kernel import reports

if not IN_WEBASSEMBLY:
    pytest.skip("only in WebAssembly: tests/webassembly runs these in Node", allow_module_level=True)

from js import Promise
from pyodide.code import run_js
from pyodide.ffi import JsException, run_sync, to_js

from cramhy_runtime.kernel.backends import jspi

FIVE_MINUTES = 300.0 if SOAK else 0.0
PARKED = 500


def below_c(wait):
    """Call WAIT with a function of C's between it and the caller."""
    return sorted([0], key=lambda _: (wait(), 0)[1])


def waits_below_c():
    below_c(lambda: below_c(lambda: kernel.park("the end")))


def frames(innermost):
    found = []
    while innermost is not None:
        found.append(innermost)
        innermost = innermost.f_back
    return found


# -------------------------------------------------------------------------------------------------------------------- by itself


def test_it_is_the_default_and_stands_for_threads():
    for chosen in ({}, {"backend": "threads"}, {"backend": "jspi"}):
        assert kernel.start(**chosen).backend.name == "jspi"
    kernel.stop()


def test_recursion_ends_where_the_stacks_of_javascript_still_have_room():
    kernel.allow_deep_recursion()
    assert sys.getrecursionlimit() == 1000


@pytest.mark.parametrize("in_a_task", [False, True])
@pytest.mark.parametrize("way", ["plain", "C", "handlers"])
def test_endless_recursion_is_an_error(k, way, in_a_task):
    def plain():
        return 1 + plain()

    def through_c():
        return max([0], key=lambda _: through_c())

    def with_handlers():
        try:
            return with_handlers()
        finally:
            kernel.checkpoint()

    endless = {"plain": plain, "C": through_c, "handlers": with_handlers}[way]
    if in_a_task:
        task = kernel.spawn(endless)
        task.join()
        assert isinstance(task.exception, RecursionError)
    else:
        with pytest.raises(RecursionError):
            endless()
    kernel.sleep(1)


# -------------------------------------------------------------------------------------------------------------------- frames


def test_a_parked_task_tells_where_it_stands_by_copies_of_its_frames(k):
    task = kernel.spawn(waits_below_c)
    kernel.settle()
    found = frames(k.frame_of(task))
    assert {type(frame) for frame in found} == {jspi.Seen}
    names = [frame.f_code.co_name for frame in found]
    assert names.count("below_c") == 2 and "waits_below_c" in names
    place = found[names.index("waits_below_c")]
    assert place.f_lineno == waits_below_c.__code__.co_firstlineno + 1 and place.f_lasti > 0


def test_asking_where_tasks_stand_changes_nothing(k):
    log = []

    def body(name):
        for step in range(3):
            log.append((name, step))
            below_c(lambda: kernel.sleep(1))

    tasks = [kernel.spawn(body, name) for name in "abc"]
    for _ in range(3):
        kernel.settle()
        for task in tasks:
            assert all(type(frame) is jspi.Seen for frame in frames(k.frame_of(task)))
        kernel.sleep(1)
    assert log == [(name, step) for step in range(3) for name in "abc"]
    kernel.settle()
    assert all(task.dead for task in tasks)


def test_a_deadlock_tells_where_everybody_waits(k):
    tasks = [kernel.spawn(waits_below_c, name=f"task {number}") for number in range(5)]
    with pytest.raises(kernel.Deadlock) as told:
        tasks[0].join()
    assert str(told.value).count("test_jspi.py") == 6


def test_the_running_task_stands_where_it_calls(k):
    assert "test_the_running_task_stands_where_it_calls" in [frame.f_code.co_name for frame in frames(k.frame_of(kernel.current()))]


def test_a_list_of_parked_tasks_that_is_made_outside_of_all_stacks_is_without_places(k):
    task = kernel.spawn(waits_below_c, name="the task")
    told = []
    with kernel.outside_source():
        main = kernel.current()
        in_a_thread(lambda: (told.append(reports.list_of(k, [task])), k.post(lambda: k.unpark(main))))
        kernel.park("the list")
    assert "the task" in told[0] and "test_jspi.py" not in told[0]


# -------------------------------------------------------------------------------------------------------------------- the collector


def test_the_collector_runs_while_five_hundred_stacks_are_parked(k):
    """It may walk frames that other code has overwritten (pyodide#6464). This short form does not always find that; the soak takes five
    minutes."""

    def again_and_again():
        while True:
            below_c(lambda: kernel.park("the next round"))
            for _ in range(100):  # enough that the collector comes by itself, while the others are parked
                circle = []
                circle.append(circle)

    tasks = [kernel.spawn(again_and_again) for _ in range(PARKED)]
    kernel.settle()
    began, rounds = time.monotonic(), 0
    while rounds < 4 or time.monotonic() < began + FIVE_MINUTES:
        rounds += 1
        below_c(gc.collect)
        for task in tasks[rounds % 3 :: 3]:
            k.unpark(task)
        kernel.sleep(1)
        gc.collect(0)
    assert len(k.tasks) == PARKED + 1


# -------------------------------------------------------------------------------------------------------------------- how many


@pytest.mark.parametrize("most, asked", [(150, 200), pytest.param(jspi.MOST, 10_000, marks=pytest.mark.soak)])
def test_more_tasks_than_there_is_room_for_are_refused_and_the_others_go_on(k, monkeypatch, most, asked):
    monkeypatch.setattr(jspi, "MOST", most)
    room = most - jspi._stacks
    tasks = [kernel.spawn(kernel.park, "the end") for _ in range(asked)]
    for task in tasks:
        task.claimed = True
    kernel.settle()
    refused = [task for task in tasks if task.dead]
    assert len(refused) == asked - room
    assert {str(task.exception) for task in refused} == {jspi.FULL}
    for task in tasks:
        k.unpark(task)
    kernel.settle()
    assert all(task.dead for task in tasks)
    assert kernel.spawn(lambda: "room again").join() == "room again"


def test_stacks_that_are_over_give_their_places_back():
    before = jspi._stacks
    for _ in range(3):
        kernel.start()
        for task in [kernel.spawn(kernel.sleep, 1) for _ in range(50)]:
            task.join()
        kernel.run_blocking(lambda: None)
        kernel.stop()
    assert jspi._stacks == before


# -------------------------------------------------------------------------------------------------------------------- promises


def test_others_run_while_a_call_waits_for_a_promise(k):
    halves = Promise.withResolvers()
    log = []

    def other():
        kernel.sleep(0)
        log.append("other")
        halves.resolve(to_js("resolved"))

    kernel.spawn(other)
    assert kernel.run_blocking(lambda: jspi.wait_for(halves.promise)) == "resolved"
    assert log == ["other"]


def test_a_promise_that_is_rejected_is_an_error_of_the_call(k):
    with pytest.raises(JsException, match="refused"):
        kernel.run_blocking(lambda: jspi.wait_for(run_js("Promise.reject(new Error('refused'))")))


def test_asyncio_is_as_it_was_for_others(k):
    async def soon():
        return await asyncio.ensure_future(Promise.resolve(2))

    assert kernel.run_blocking(lambda: run_sync(soon())) == 2
    assert isinstance(asyncio.ensure_future(Promise.resolve(3)), asyncio.Future)


# -------------------------------------------------------------------------------------------------------------------- the event loop


@pytest.mark.parametrize("work", ["checkpoints", "hand-overs", "virtual time", "a callback"])
def test_a_message_comes_in_while_a_plan_computes(k, work):
    """The event loop has a turn after every 25 ms. The second is a bound for busy machines, and only a test that fails computes so long."""
    came = []
    latest = time.monotonic() + 20

    def until_it_comes(step):
        in_a_thread(came.append, time.monotonic())
        while not came and time.monotonic() < latest:
            step()
        assert came

    if work == "hand-overs":
        busy = kernel.spawn(lambda: [kernel.yield_() for _ in iter(lambda: bool(came), True)])
        until_it_comes(kernel.yield_)
        busy.join()
    elif work == "a callback":
        kernel.call_at(1.0, lambda: until_it_comes(kernel.checkpoint))
        kernel.sleep(2)
        assert came
    else:
        until_it_comes({"checkpoints": kernel.checkpoint, "virtual time": lambda: kernel.sleep(1)}[work])
