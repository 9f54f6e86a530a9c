"""What other libraries need for the same, measured in this run where they are installed.

Each function gives a text, or "" where its library is missing. ``make bench`` installs those that PyPI has.
"""

from __future__ import annotations

import functools
import shutil
import statistics
import subprocess
import time


def spent(work, rounds=7):
    """The median processor time of ``work()`` in seconds."""
    work()
    times = []
    for _ in range(rounds):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return statistics.median(times)


def empty_call():
    """Microseconds of a call of a Python function that does nothing: the speed of this machine."""

    def nothing():
        pass

    def work():
        for _ in range(20_000):
            nothing()

    return spent(work, 25) / 20_000 * 1e6


def where_installed(function):
    @functools.wraps(function)
    def told():
        try:
            return function()
        except ImportError as missing:
            return f"{missing.name} is not installed"

    return told


@where_installed
def trio_failures():
    import trio

    async def fails():
        raise ValueError("no")

    async def plan():
        for _ in range(2000):
            try:
                await fails()
            except ValueError:
                pass
        async with trio.open_nursery() as nursery:
            for _ in range(1000):
                nursery.start_soon(trio.sleep_forever)
            await trio.lowlevel.checkpoint()
            nursery.cancel_scope.cancel()

    return f"trio {spent(lambda: trio.run(plan)) * 1e3:.1f}"


@where_installed
def trio_sleepers():
    import trio
    import trio.testing

    async def plan():
        async with trio.open_nursery() as nursery:
            for _ in range(1000):
                nursery.start_soon(trio.sleep, 1)

    return f"trio {spent(lambda: trio.run(plan, clock=trio.testing.MockClock(autojump_threshold=0))) * 1e3:.1f}"


@where_installed
def py_trees_tick():
    import py_trees

    root = py_trees.composites.Parallel("all", policy=py_trees.common.ParallelPolicy.SuccessOnAll(synchronise=False))
    root.add_children([py_trees.behaviours.Running(name=f"b{i}") for i in range(100)])
    return f"py_trees {spent(lambda: [root.tick_once() for _ in range(20)]) / 20 * 1e3:.2f}"


@where_installed
def simpy_sleeps():
    import simpy

    def steps(world):
        for _ in range(100):
            yield world.timeout(1)

    def plan():
        world = simpy.Environment()
        for _ in range(10):
            world.process(steps(world))
        world.run()

    return f"SimPy {spent(plan) * 1e3:.2f}"


@functools.cache
def _swi():
    from prolog_programs import swi_figures

    from cramhy_runtime.repl.session import Session

    from .reasoning import read

    Session(time="virtual", turtlesim=False)  # the programs are read as Lisp data
    return swi_figures(read)


def swi(goal):
    """A function that tells SWI-Prolog's time for a goal of ``prolog_programs``."""

    def told():
        rate = _swi().get(goal)
        return f"SWI {1e6 / rate:,.1f} us" if rate else ""

    return told


def sbcl(program):
    """A function that tells what SBCL needs for the call of one of ``programs``, the least of three times."""

    def told():
        if not shutil.which("sbcl"):
            return "sbcl is not installed"
        text = f"""(progn (declaim (sb-ext:muffle-conditions warning compiler-note)) {program.lisp}
(let ((best nil) (inner 200))
  (dotimes (i 3)
    (let ((before (get-internal-run-time)))
      (dotimes (k inner) {program.call})
      (let ((used (- (get-internal-run-time) before))) (when (or (null best) (< used best)) (setq best used)))))
  (format t "~f" (/ best internal-time-units-per-second inner 0.001))))"""
        done = subprocess.run(["sbcl", "--noinform", "--non-interactive", "--eval", text], capture_output=True, text=True)
        try:
            return f"SBCL {float(done.stdout.split()[-1]):.3f} ms"
        except (ValueError, IndexError):
            return ""

    return told
