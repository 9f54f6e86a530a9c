"""Tasks and fluents: how long they take, beside CRAM on SBCL, beside raw Python, and beside the goals.

    python benchmarks/cpl_bench.py [--only PART] [--backend threads|greenlet]

Microseconds, except where the row says otherwise. The plans are Lisp, compiled as users' plans are. What stands under CRAM was
recorded on another day (SBCL 2.2.9, roslisp); so were figures of trio and SimPy unless they are installed, then they are measured
here. What stands under Python without "recorded" is measured in this run, and so is a hand-over between two tasks of the kernel,
the floor under everything else. How, and why two figures: ``measuring.py``. The rest of the table of peers is in
``acting_bench.py`` and ``prolog_bench.py``.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import threading
import time

from measuring import Table, microseconds, number, repeat

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.fluents.operators import fl_funcall, fl_lt, fl_plus
from cramhy_runtime.repl.session import Session

PLANS = """
(defvar *never* (make-fluent))

(defun tops (n) (dotimes (i n) (top-level)))
(defun pars (n) (top-level (dotimes (i n) (par 1 2))))

(defun pursue-sleep (n) (top-level (dotimes (i n) (pursue (sleep 10) 1))))
(defun pursue-wait (n) (top-level (dotimes (i n) (pursue (wait-for *never*) 1))))
(defun pursue-loop (n) (top-level (dotimes (i n) (pursue (loop do (roslisp:wait-duration 0.1)) 1))))
(defun pursue-busy (n) (top-level (dotimes (i n) (pursue (loop) 1))))

(defun ping-pong (n)
  (let ((ping (make-fluent)) (pong (make-fluent)))
    (top-level
      (par (dotimes (i n) (setf (value ping) t) (wait-for pong) (setf (value pong) nil))
           (dotimes (i n) (wait-for ping) (setf (value ping) nil) (setf (value pong) t))))))

(defun assignments (fluent n) (dotimes (i n) (setf (value fluent) i)))
(defun readings (f n)
  (dotimes (i (floor n 10))
    (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f) (value f)))

(defun sleeps (n) (let ((each (floor n 10))) (top-level (par-loop (length '(1 1 1 1 1 1 1 1 1 1)) (dotimes (i each) (sleep length))))))

(def-cram-function take-step () 1)
(defun plan-functions (n) (top-level (dotimes (i n) (take-step))))
(defun failures (n)
  (top-level (dotimes (i n) (with-failure-handling ((simple-plan-failure (f) (declare (ignore f)) (return))) (fail "no")))))
(defun cleanups (n) (top-level (dotimes (i n) (unwind-protect 1 2))))
"""

# ------------------------------------------------------------------------------------------------------------- raw Python


def thread_start_and_join(count):
    for _ in range(count):
        thread = threading.Thread(target=int)
        thread.start()
        thread.join()


def two_threads(count):
    for _ in range(count):
        threads = [threading.Thread(target=int) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()


def lock_baton(count):
    """Two threads that wake each other by locks: round trips."""
    ping, pong = threading.Lock(), threading.Lock()
    ping.acquire()
    pong.acquire()

    def other():
        for _ in range(count):
            ping.acquire()
            pong.release()

    thread = threading.Thread(target=other)
    thread.start()
    for _ in range(count):
        ping.release()
        pong.acquire()
    thread.join()


def trio_nursery():
    """Microseconds of a nursery with two tasks, or what was recorded."""
    try:
        import trio
    except ImportError:
        return "trio nursery 34 (recorded)"

    async def nothing():
        pass

    async def nurseries(count):
        for _ in range(count):
            async with trio.open_nursery() as nursery:
                nursery.start_soon(nothing)
                nursery.start_soon(nothing)

    return f"trio nursery {number(microseconds(lambda count: trio.run(nurseries, count), 30))}"


def virtual_time_of_others():
    """Virtual sleeps a second of trio and SimPy, ten tasks each."""
    try:
        import trio
        import trio.testing
    except ImportError:
        in_trio = "trio MockClock 40-49 k (recorded)"
    else:

        async def sleeper(count):
            for _ in range(count // 10):
                await trio.sleep(1)

        async def sleepers(count):
            async with trio.open_nursery() as nursery:
                for _ in range(10):
                    nursery.start_soon(sleeper, count)

        def work(count):
            trio.run(sleepers, count, clock=trio.testing.MockClock(autojump_threshold=0))

        in_trio = f"trio MockClock {number(1e6 / microseconds(work, 200))}"
    try:
        import simpy
    except ImportError:
        return f"{in_trio}, SimPy 1.1 M events (recorded)"

    def steps(env, count):
        for _ in range(count // 10):
            yield env.timeout(1)

    def simulate(count):
        env = simpy.Environment()
        for _ in range(10):
            env.process(steps(env, count))
        env.run()

    return f"{in_trio}, SimPy {number(1e6 / microseconds(simulate, 500))} events"


# ------------------------------------------------------------------------------------------------------- what is measured


def hand_over(count):
    """Two tasks of the kernel that yield to each other: ``count`` hand-overs of the baton."""

    def yielding():
        for _ in range(count // 2):
            kernel.yield_()

    for task in [kernel.spawn(yielding) for _ in range(2)]:
        task.join()


def wide(branches):
    """A ``par`` of so many branches, as often as there are ``count`` branches in all."""

    def work(count):
        def body():
            for _ in range(count // branches):
                cpl.par(*[int] * branches)

        cpl.top_level(body)

    return work


def sleeping(branches):
    """A ``par`` of so many branches that sleep a second, as often as there are ``count`` branches in all."""

    def work(count):
        def body():
            for _ in range(count // branches):
                cpl.par(*[lambda: cpl.sleep(1)] * branches)

        cpl.top_level(body)

    return work


def wake_ups(count):
    """The times in microseconds from an assignment in one branch until ``wait-for`` returns in another."""
    here, there = cpl.make_fluent(), cpl.make_fluent()
    times, start = [], 0.0

    def waking():
        nonlocal start
        for _ in range(count):
            start = time.perf_counter()
            here.set(True)
            cpl.wait_for(there)
            there.set(None)

    def woken():
        for _ in range(count):
            cpl.wait_for(here)
            times.append((time.perf_counter() - start) * 1e6)
            here.set(None)
            there.set(True)

    cpl.top_level(lambda: cpl.par(woken, waking))
    return sorted(times)


def percentile(times, part):
    return times[min(len(times) - 1, int(len(times) * part))]


def park(backend, count):
    """Have ``count`` branches wait at once; print how many there were, the bytes of each, and the seconds to begin and to end."""
    Session(time="virtual", backend=backend, turtlesim=False)
    never, before, start = cpl.make_fluent(), resident(), time.perf_counter()

    def look():
        cpl.sleep(1)
        parked = sum(task.state == "parked" for task in kernel.active().tasks) - 3  # but for main, the top-level, and the par
        print(parked, (resident() - before) // parked, f"{time.perf_counter() - start:.2f}")

    cpl.top_level(lambda: cpl.pursue(lambda: cpl.par(*[lambda: cpl.wait_for(never)] * count), look))
    print(f"{time.perf_counter() - start:.2f}")


def resident():
    """The bytes of memory that this process has, where the system says."""
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0


# --------------------------------------------------------------------------------------------------------------- the table


class Bench:
    """The rows, for one back end. ``only``: part of the names of those that are wanted."""

    def __init__(self, backend, only):
        self.backend, self.only = backend, only
        self.session = Session(time="virtual", backend=backend, turtlesim=False)
        self.session.package = "CRAM-USER"
        self.session.evaluate_text(PLANS)
        self.table = Table("Tasks and fluents", backend)

    def lisp(self, name):
        return self.session.evaluate_text(f"#'{name}")[0]

    def row(self, name, work, *arguments, **named):
        if self.only in name:
            self.table.row(name, work if callable(work) else self.lisp(work), *arguments, **named)

    def peer(self, name, work, count):
        return f"{name} {number(microseconds(work, count))}" if self.only == "" else name

    def run(self):
        self.row("floor: a call of a Python function", repeat(lambda: None), 5000)
        self.row("floor: a hand-over between kernel tasks", hand_over, 200)
        self.tasks()
        self.losers()
        self.waking()
        self.fluents()
        self.many()
        self.beyond_the_table()
        self.table.end()

    def tasks(self):
        self.row("(top-level)", "tops", 50, goal=(30, 10), cram="96", python=self.peer("thread start and join", thread_start_and_join, 20))
        self.row(
            "par of 2 trivial branches, whole form",
            "pars",
            20,
            goal=(100, 25),
            cram="530",
            python=f"{self.peer('two threads', two_threads, 10)}, {trio_nursery()}",
        )
        for branches, cram in ((10, "102"), (100, "81"), (1000, "102")):
            self.row(f"par of {branches}, per branch", wide(branches), max(100, branches), goal=(30, 10), cram=cram)
        for branches in (100, 1000, 10_000):
            self.row(f"par of {branches} that sleep, per branch", sleeping(branches), branches)

    def losers(self):
        for loser, work, count, goal, cram in (
            ("in (sleep 10)", "pursue-sleep", 10, 150, "3,200"),
            ("in a wait that never ends", "pursue-wait", 10, 150, "1,700"),
            ("in (loop do (wait-duration 0.1))", "pursue-loop", 10, 150, "4,800"),
            ("in a busy loop", "pursue-busy", 5, 5000, "never ends"),
        ):
            self.row(f"pursue, loser {loser}", work, count, goal=goal, cram=cram)

    def waking(self):
        self.row("fluent ping-pong, round trip", "ping-pong", 50, goal=(40, 8), cram="374", python=self.peer("lock baton", lock_baton, 100))
        if self.only in "wake-up of a waiting branch":
            runs = [wake_ups(2000) for _ in range(7)]
            for name, part, goal, cram in (("median", 0.5, 25, "46-179"), ("p99", 0.99, 200, "up to 2,000")):
                figures = [percentile(run, part) for run in runs]
                self.table.line(f"wake-up of a waiting branch, {name}", min(figures), statistics.median(figures), goal, cram)

    def fluents(self):
        assign, read = self.lisp("assignments"), self.lisp("readings")
        for nets, cram, goal in ((0, "0.63", 0.6), (1, "1.5", 2), (10, "8.5", 12), (100, "54", 100)):
            fluent = cpl.make_fluent(value=-1)
            kept = [fl_plus(fluent, 1) for _ in range(nets)]
            self.row(f"(setf (value f) x), {nets} nets (+ f 1)", lambda n, f=fluent: assign(f, n), 4000 // (nets + 2), goal=goal, cram=cram)
        kept = [fl_funcall(lambda x: x, fluent) for _ in range(10)]
        self.row("(setf (value f) x), these and 10 nets of a function", lambda n: assign(fluent, n), 30)
        fluent = cpl.make_fluent(value=-1)
        kept = [fl_lt(fluent, 10**9) for _ in range(10)]
        self.row("the same, 10 nets (< f k) that do not change", lambda n: assign(fluent, n), 200, goal=4, cram="1.7")
        call = self.peer("a call", repeat(lambda: None), 5000)
        self.row("(value f)", lambda n: read(fluent, n), 5000, goal=0.1, cram="0.06", python=call)
        self.row("(value cached-net)", lambda n: read(kept[0], n), 5000, goal=0.1, cram="0.06")

    def many(self):
        if self.only in "virtual sleeps a second":
            work = self.lisp("sleeps")
            figures = [1e6 / microseconds(work, 200) for _ in range(3)]
            self.table.line(
                "virtual sleeps a second, of ten branches",
                max(figures),
                statistics.median(figures),
                (10_000, 50_000),
                python=virtual_time_of_others(),
                more_is_better=True,
            )
        if self.only in "parked tasks at once":
            goal = 100_000 if self.backend == "greenlet" else 10_000
            told = subprocess.run(
                [sys.executable, __file__, "--park", str(goal), "--backend", self.backend], capture_output=True, text=True
            )
            if told.returncode:
                print(f"{'parked tasks at once':48} failed: {told.stderr.strip().splitlines()[-1:]}")
                self.table.missed.append("parked tasks at once")
                return
            parked, each, begun, ended = told.stdout.split()
            peer = "10,000 threads of 256 KiB: 170 MB (recorded)" if self.backend == "threads" else ""
            self.table.line("parked tasks at once", int(parked), int(parked), goal, "about 1,000", peer, more_is_better=True)
            print(
                f"    {int(each) * int(parked) / 1e6:,.0f} MB, {int(each) / 1000:.1f} KB each; "
                f"all parked after {begun} s, dead after {ended} s"
            )

    def beyond_the_table(self):
        """What users feel, though no figures of CRAM stand beside it."""
        self.row("a call of a plan function", "plan-functions", 30)
        self.row("a failure, handled in the same task", "failures", 40)
        self.row("unwind-protect", "cleanups", 1000)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="part of the names of the rows to measure")
    parser.add_argument("--backend", choices=("threads", "greenlet"), help="measure on this back end only")
    parser.add_argument("--park", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.park:
        return park(options.backend, options.park)
    if options.backend is None:  # each in a process of its own, so that neither works in the memory of the other
        for backend in ("threads", "greenlet"):
            subprocess.run([sys.executable, __file__, "--backend", backend, "--only", options.only])
        return None
    try:
        return Bench(options.backend, options.only).run()
    except ImportError as missing:
        return print(missing)


if __name__ == "__main__":
    main()
