"""Random workers use a lock, a semaphore, a mailbox and a condition variable, some are killed at random: nothing is lost, nobody hangs."""

from collections import Counter

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import kernel
from cramhy_runtime.utilities.locks import ConditionVariable, Lock
from cramhy_runtime.utilities.queues import make_mailbox, receive_message, send_message
from cramhy_runtime.utilities.semaphores import make_semaphore, signal_semaphore, wait_on_semaphore

UNITS = 3
times = st.sampled_from([0.0, 0.5, 1.0, 2.0])
steps = st.one_of(
    st.tuples(st.just("alone"), times),
    st.tuples(st.just("units"), times, st.integers(1, UNITS), st.sampled_from([None, 0, 1])),
    st.tuples(st.just("send"), times),
    st.tuples(st.just("receive"), times),
    st.tuples(st.just("wait"), times),
    st.tuples(st.just("signal"), times),
)
workers = st.lists(st.lists(steps, max_size=6), min_size=2, max_size=6)
kills = st.lists(st.tuples(st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.0, 3.0]), st.integers(0, 5)), max_size=4)


class World:
    """What the workers share, and what they note."""

    def __init__(self):
        self.lock, self.semaphore, self.mailbox = Lock("l", recursive=True), make_semaphore(count=UNITS), make_mailbox()
        self.variable = ConditionVariable(self.lock)
        self.inside = self.taken = self.number = 0
        self.sent, self.received = [], []

    def work(self, program):
        for what, seconds, *rest in program:
            getattr(self, what)(seconds, *rest)
            if what in ("send", "signal"):
                kernel.sleep(seconds)

    def alone(self, seconds, do=lambda: None):
        with self.lock:
            self.inside += 1
            assert self.inside == 1
            try:
                with self.lock:
                    kernel.sleep(seconds)
                self.inside -= 1
                do()
                self.inside += 1
            finally:
                assert self.lock.held_by_me()
                self.inside = 0

    def units(self, seconds, n, timeout):
        if wait_on_semaphore(self.semaphore, n=n, timeout=timeout) is None:
            return
        self.taken += n
        assert self.taken <= UNITS
        try:
            kernel.sleep(seconds)
        finally:
            self.taken -= n
            signal_semaphore(self.semaphore, n)

    def send(self, seconds):
        self.number += 1
        self.sent.append(self.number)
        send_message(self.mailbox, self.number)

    def receive(self, seconds):
        message, there = receive_message(self.mailbox, timeout=seconds)
        if there:
            self.received.append(message)

    def wait(self, seconds):
        self.alone(0, lambda: self.variable.wait(kernel.now() + seconds))

    def signal(self, seconds):
        self.variable.signal()

    def check(self):
        """Everything is as it was before: nobody in line, all free, each message received once or still there."""
        assert self.lock.holder is None and self.semaphore.count == UNITS and self.taken == 0
        assert not any(map(len, (self.lock.line, self.semaphore.line, self.mailbox.line, self.variable.line)))
        assert Counter(self.received) + Counter(self.mailbox.messages) == Counter(self.sent)


@pytest.mark.soak
@settings(max_examples=120, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(workers, kills, st.sampled_from([None, 1, 2]))
def test_whoever_is_killed_everything_is_given_back_and_everybody_ends(fresh_kernel, programs, killed, seed):
    kernel.start(clock="virtual", backend=fresh_kernel.backend.name, seed=seed, time_limit=1000)
    world = World()
    tasks = [kernel.spawn(world.work, program, name=f"worker {index}") for index, program in enumerate(programs)]
    for when, index in killed:
        if index < len(tasks):
            kernel.call_at(when, lambda task=tasks[index]: task.cancel("at random"))
    for task in tasks:
        task.join()
        assert task.exception is None or isinstance(task.exception, kernel.Cancelled)
    world.check()


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(workers)
def test_without_a_seed_two_runs_are_the_same(fresh_kernel, programs):
    def run():
        kernel.start(clock="virtual", backend=fresh_kernel.backend.name, time_limit=1000)
        world = World()
        for task in [kernel.spawn(world.work, program) for program in programs]:
            task.join()
        return world.received, kernel.now()

    assert run() == run()
