"""Ctrl-C: reaches the main task wherever it is; a second one gives up cleanup."""

import _thread
import signal
import threading
import time

import pytest
from outside_world import Event, in_a_thread
from systems import IN_WEBASSEMBLY

from cramhy_runtime import kernel


ASKING = getattr(signal, "SIGUSR1", signal.SIGINT)


@pytest.fixture
def on_signal():
    """A signal interrupts, as SIGINT does at the prompt."""
    before = signal.signal(ASKING, lambda *_: kernel.interrupt())
    yield
    signal.signal(ASKING, before)


def send(number=ASKING):
    """The signal comes to the main thread, whatever that is doing. On Windows it ends no wait. A page sends a message instead."""
    if IN_WEBASSEMBLY:
        in_a_thread(kernel.interrupt)
    elif hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident, number)
    else:
        _thread.interrupt_main(number)


def wait_long():
    """A blocking call of ten seconds. In slices: Python loses a signal that comes just before a lock falls asleep."""
    never = Event()
    return any(never.wait(0.05) for _ in range(200))


def sends_when_idle():
    """How a wall clock waits during whose first wait the user types Ctrl-C, once: waits are short, and a busy machine is slow."""
    helpers = []

    def wait(bell, seconds):
        if not helpers:
            helpers.append(in_a_thread(send))
        bell.wait(10)

    return wait


def test_the_main_task_in_a_busy_loop(k, on_signal):
    with pytest.raises(kernel.Interrupted):
        send()
        while True:
            kernel.checkpoint()
    assert kernel.now() < (1 if IN_WEBASSEMBLY else 0.02)  # there a message has to wait for a turn of the event loop


def test_the_main_task_waits_while_another_is_busy(k, on_signal):
    def busy():
        send()
        while True:
            kernel.checkpoint()

    task = kernel.spawn(busy)
    with pytest.raises(kernel.Interrupted):
        task.join()
    assert not task.dead
    task.cancel()
    task.join()


def test_the_main_task_sleeps_in_virtual_time(k, on_signal):
    def other():
        kernel.sleep(1)
        send()
        while True:
            kernel.sleep(1)

    kernel.spawn(other)
    with pytest.raises(kernel.Interrupted):
        kernel.sleep(1e9)
    assert kernel.now() < 1e6


def test_everything_is_parked_in_wall_time_and_the_main_thread_waits_for_the_clock(start, on_signal):
    start(clock=kernel.WallClock(wait=sends_when_idle()))
    begin = time.monotonic()
    with pytest.raises(kernel.Interrupted):
        kernel.sleep(1000)
    assert time.monotonic() - begin < 100


def test_everything_is_parked_in_wall_time_and_another_waits_for_the_clock(start, on_signal):
    start(clock=kernel.WallClock(wait=sends_when_idle()))
    task = kernel.spawn(kernel.sleep, 1000)
    with pytest.raises(kernel.Interrupted):
        task.join()
    assert not task.dead


def test_everything_waits_for_a_message(k, on_signal):
    with kernel.outside_source(), pytest.raises(kernel.Interrupted):
        in_a_thread(send)
        kernel.park("a message")


def test_an_interrupt_from_another_thread(k):
    with kernel.outside_source(), pytest.raises(kernel.Interrupted):
        in_a_thread(kernel.interrupt)
        kernel.park("a message")


@pytest.mark.parametrize("clock", ["virtual", "wall"])
def test_the_main_task_is_in_a_blocking_call(start, on_signal, clock):
    start(clock=clock)
    kernel.spawn(lambda: (kernel.yield_(), in_a_thread(send)))
    begin = time.monotonic()
    with pytest.raises(kernel.Interrupted):
        kernel.run_blocking(wait_long)
    assert time.monotonic() - begin < 100
    kernel.sleep(0.001)
    assert kernel.current() is kernel.active().main


def test_the_main_task_is_in_a_blocking_call_and_nothing_else_is_there(k, on_signal):
    in_a_thread(send)
    with pytest.raises(kernel.Interrupted):
        kernel.run_blocking(wait_long)
    kernel.sleep(1)


def test_another_task_in_a_blocking_call_does_not_hold_it_up(k, on_signal):
    released = Event()
    task = kernel.spawn(kernel.run_blocking, released.wait, 10)
    kernel.settle()
    with pytest.raises(kernel.Interrupted):
        in_a_thread(send)
        task.join()
    released.set()
    task.join()


def test_without_a_handler_of_ours_ctrl_c_still_reaches_the_main_task_that_waits_for_the_baton(start, backend):
    if backend != "threads":
        pytest.skip("a greenlet never waits for the baton: it is not there")
    start()

    def busy():
        send(signal.SIGINT)
        while True:
            kernel.checkpoint()

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        task = kernel.spawn(busy)
        with pytest.raises(kernel.Interrupted):
            task.join()
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_main_task_goes_first(k):
    log = []

    def others(name):
        while True:
            log.append(name)
            kernel.yield_()

    tasks = [kernel.spawn(others, name) for name in "abc"]
    kernel.yield_()
    log.clear()
    kernel.interrupt()
    with pytest.raises(kernel.Interrupted):
        kernel.park("the others")
    assert log == []
    for task in tasks:
        task.cancel()


def test_an_endless_callback_is_broken_off(k, reported):
    def endless():
        kernel.interrupt()
        while True:
            kernel.checkpoint()

    kernel.call_at(1.0, endless)
    with pytest.raises(kernel.Interrupted):
        kernel.sleep(2)
    assert reported == []


def test_a_shield_delays_the_first_interrupt(k):
    log = []
    with pytest.raises(kernel.Interrupted):
        with kernel.shield():
            kernel.interrupt()
            kernel.sleep(1)
            log.append("cleaned up")
        kernel.checkpoint()
        log.append("never")
    assert log == ["cleaned up"]


def test_cleanup_after_the_first_interrupt_may_wait(k):
    log = []

    def body():
        try:
            kernel.park("for ever")
        finally:
            kernel.sleep(1)
            log.append("turtle stopped")

    task = kernel.spawn(body)
    kernel.yield_()
    kernel.interrupt()
    with pytest.raises(kernel.Interrupted):
        try:
            task.join()
        finally:
            task.cancel()
            task.join()
    assert log == ["turtle stopped"]


def stuck_in_cleanup(log, name):
    try:
        kernel.park("for ever")
    finally:
        try:
            with kernel.shield():
                kernel.park("a cleanup that never ends")
        finally:
            log.append(f"{name} left")


def test_the_second_interrupt_abandons_cleanup_in_the_whole_tree(k):
    log = []
    bystander = kernel.spawn(kernel.sleep, 1000, name="bystander")

    def parent():
        child = kernel.spawn(stuck_in_cleanup, log, "child")
        kernel.yield_()
        try:
            kernel.park("for ever")
        finally:
            child.cancel()
            child.join()
            log.append("never")

    task = kernel.spawn(parent)
    kernel.sleep(1)
    kernel.interrupt()
    with pytest.raises(kernel.Abandoned):
        try:
            task.join()
        finally:
            task.cancel()
            kernel.call_at(kernel.now() + 5, kernel.interrupt)
            try:
                task.join()
            finally:
                log.append("main left")
    assert log[0] == "main left"
    task.join()
    assert log[1:] == ["child left"]
    assert isinstance(task.exception, kernel.Abandoned)
    assert not bystander.dead
    assert kernel.now() == 6.0


def test_the_second_interrupt_goes_through_a_shield_of_the_main_task(k):
    with pytest.raises(kernel.Abandoned), kernel.shield():
        kernel.interrupt()
        kernel.call_at(1.0, kernel.interrupt)
        kernel.sleep(100)
    assert kernel.now() == 1.0
    kernel.sleep(1)


def test_a_task_below_an_abandoned_one_is_cancelled(k):
    children = []

    def parent():
        try:
            kernel.park("for ever")
        finally:
            children.append(kernel.spawn(kernel.park, "an answer"))
            children[0].join()

    task = kernel.spawn(parent)
    kernel.yield_()
    task.cancel()
    kernel.settle()
    for expected in (kernel.Interrupted, kernel.Abandoned):
        kernel.interrupt()
        with pytest.raises(expected):
            kernel.yield_()
    task.join()
    children[0].join()
    assert str(children[0].exception) == "cancelled: the cleanup of its parent was abandoned"


@pytest.mark.parametrize("end", [kernel.interrupt_over, kernel.settle])
def test_when_the_first_is_dealt_with_the_next_is_a_first_one_again(k, end):
    for _ in range(3):
        kernel.interrupt()
        with pytest.raises(kernel.Interrupted):
            kernel.sleep(1)
        end()


def test_a_task_that_swallows_abandonment_is_left_for_dead(k):
    def undead():
        while True:
            try:
                kernel.park("nothing")
            except BaseException:
                pass

    task = kernel.spawn(undead)
    kernel.yield_()
    task.cancel()
    for expected in (kernel.Interrupted, kernel.Abandoned):
        kernel.interrupt()
        with pytest.raises(expected):
            kernel.yield_()
    task.join()
    assert task.dead
    kernel.sleep(1)


def test_texts():
    assert str(kernel.Interrupted()) == "interrupted"
    assert str(kernel.Abandoned()) == "cleanup abandoned"
