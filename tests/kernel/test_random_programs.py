"""Random programs: whatever tasks do to each other, the laws hold.

A program is a list of scripts. Each spawned task follows one script; its steps spawn, wait, wake and cancel others. The
trace of a run is everything that happened with its time. The laws:

* the same program gives the same trace, on both back ends (law 5);
* one task runs at a time (law 4), and time never goes back;
* a wake-up that was given is received, or the task was cancelled: none is lost;
* in the end every task is dead.
"""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime import kernel

pytest.importorskip("greenlet")

number = st.integers(0, 7)
seconds = st.sampled_from([0.0, 0.001, 0.01, 0.01, 0.02, 1.0])
step = st.one_of(
    st.tuples(st.just("spawn"), number),
    st.tuples(st.just("sleep"), seconds),
    st.tuples(st.just("park"), seconds),
    st.tuples(st.just("park for ever")),
    st.tuples(st.just("unpark"), number),
    st.tuples(st.just("cancel"), number),
    st.tuples(st.just("yield")),
    st.tuples(st.just("busy"), st.integers(1, 3000)),
    st.tuples(st.just("join"), number),
    st.tuples(st.just("shielded sleep"), seconds),
    st.tuples(st.just("timer"), seconds, number),
    st.tuples(st.just("clean up"), seconds),
    st.tuples(st.just("fail")),
)
programs = st.lists(st.lists(step, max_size=6), min_size=1, max_size=5)
MOST_TASKS = 25


class Run:
    """One run of a program."""

    def __init__(self, program, backend, seed):
        self.program = program
        self.tasks = []
        self.trace = []
        self.running = None
        self.given = {}
        self.received = {}
        k = kernel.start(backend=backend, seed=seed)
        self.spawn(0)
        self.spawn(len(program) - 1)
        kernel.sleep(50)
        while alive := [task for task in self.tasks if not task.dead]:
            for task in alive:
                task.cancel("the end")
            for task in alive:
                task.join()
        assert k.tasks == [k.main]
        self.end = kernel.now()

    def spawn(self, script):
        if len(self.tasks) < MOST_TASKS:
            steps = self.program[script % len(self.program)]
            self.tasks.append(kernel.spawn(self.follow, len(self.tasks), steps, name=f"task {len(self.tasks)}"))

    def note(self, *what):
        task = kernel.current()
        assert self.running in (None, task), "two tasks ran at once"
        self.trace.append((task.name, *what, kernel.now()))

    def wait(self, park, *args):
        me = kernel.current()
        assert self.running is me
        self.running = None
        try:
            return park(*args)
        finally:
            assert self.running is None, "two tasks ran at once"
            self.running = me

    def wake(self, other):
        if kernel.unpark(other):
            self.given[other] = self.given.get(other, 0) + 1

    def wait_for_wake_up(self, until):
        me = kernel.current()
        woken = self.wait(kernel.park, "a wake-up", until)
        if woken:
            self.received[me] = self.received.get(me, 0) + 1
        return woken

    def follow(self, number, steps):
        self.running = kernel.current()
        try:
            for count, (kind, *args) in enumerate(steps):
                self.note(count, kind)
                self.note(self.take(kind, *args))
            self.note("end")
        except kernel.Cancelled as cancelled:
            self.note(str(cancelled))
            self.wait(kernel.sleep, 0.005)
            self.note("cleaned up")
            raise
        finally:
            self.running = None

    def take(self, kind, *args):
        if kind == "spawn":
            self.spawn(*args)
        elif kind == "sleep":
            self.wait(kernel.sleep, *args)
        elif kind == "park":
            return self.wait_for_wake_up(kernel.now() + args[0])
        elif kind == "park for ever":
            return self.wait_for_wake_up(None)
        elif kind == "unpark":
            self.wake(self.other(*args))
        elif kind == "cancel":
            self.other(*args).cancel(f"by {kernel.current().name}")
        elif kind == "yield":
            self.wait(kernel.yield_)
        elif kind == "busy":
            for _ in range(*args):
                self.wait(kernel.checkpoint)
        elif kind == "join":
            other = self.other(*args)
            if other is not kernel.current():
                self.wait(other.join)
        elif kind == "shielded sleep":
            with kernel.shield():
                self.wait(kernel.sleep, *args)
        elif kind == "timer":
            kernel.call_at(kernel.now() + args[0], lambda: self.wake(self.other(args[1])))
        elif kind == "clean up":
            try:
                self.wait_for_wake_up(None)
            finally:
                self.wait(kernel.sleep, *args)
        elif kind == "fail":
            kernel.current().local.failed = True
            raise LookupError("on purpose")
        return None

    def other(self, number):
        return self.tasks[number % len(self.tasks)]


@pytest.fixture(autouse=True)
def quiet(monkeypatch):
    monkeypatch.setattr(kernel.reports.installed.reporter, "unhandled", lambda task, exception: None)
    yield
    kernel.stop()


def check(run):
    times = [entry[-1] for entry in run.trace]
    assert times == sorted(times), "time went back"
    for task in run.tasks:
        assert task.dead
        if isinstance(task.exception, AssertionError):
            raise task.exception
        lost = run.given.get(task, 0) - run.received.get(task, 0)
        # A sleep and a join look again after a wake-up; a park reports each one.
        waits_only_in_parks = not any(entry[0] == task.name and entry[2] in WAITS for entry in run.trace if len(entry) == 4)
        assert lost >= 0
        if waits_only_in_parks and not task.cancelled:
            assert lost == 0, "a wake-up was lost"


WAITS = {"sleep", "join", "shielded sleep", "clean up"}
few = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@few
@given(programs, st.sampled_from([None, 1, 2]))
def test_the_laws_hold_and_both_back_ends_agree(program, seed):
    on_threads = Run(program, "threads", seed)
    check(on_threads)
    on_greenlets = Run(program, "greenlet", seed)
    check(on_greenlets)
    assert on_threads.trace == on_greenlets.trace
    assert on_threads.end == on_greenlets.end


@few
@given(programs, st.integers(0, 1000))
def test_the_same_seed_gives_the_same_run(program, seed):
    one, two = Run(program, "greenlet", seed), Run(program, "greenlet", seed)
    assert one.trace == two.trace
