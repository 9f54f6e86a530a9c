"""The active kernel, and the functions that act on it.

A process has one active kernel at a time; tests start hundreds, one after the other. The functions here are what the
floors above call: `kernel.park(...)` is `kernel.active().park(...)`.
"""

import atexit
from _thread import get_ident
from collections.abc import Callable
from contextlib import contextmanager
from typing import Any, TypeVar

from . import signals
from .budget import budget
from .endings import CLEANUP_LIMIT
from .errors import KernelError, Terminated
from .pace import Pace, TimeWanted
from .scheduler import Kernel

_active = None
T = TypeVar("T")


def start(clock="virtual", backend="threads", seed=None, time_limit=None, kind=Kernel, cleanup_limit=CLEANUP_LIMIT):
    """Make a fresh kernel active, whose main task is the caller. The one before, if any, is stopped first.

    In the main thread it hears SIGINT and the signals that end a process from now on, if nobody else has a handler for them
    (`signals`).

    CLOCK: "virtual", "wall", or a clock object. BACKEND: "threads", "greenlet", or a back end. SEED: None for first
    come, first served; a number shuffles the order, reproducibly; a function of the queue gives the place in it of the
    task that goes next. TIME_LIMIT: seconds of the kernel's clock after which the main task gets `TimeLimit`, or None.
    KIND: a subclass of `Kernel`, for tests that look on. CLEANUP_LIMIT: seconds that plans get for their cleanup when the process is
    asked to end, by the kernel's clock and by the wall's, or None.
    """
    global _active
    if _active is not None and _active.main.carrier.ident == get_ident():
        _active.stop()
    _active = None
    kernel = kind(clock, backend, seed, time_limit)
    kernel.cleanup_limit = cleanup_limit
    kernel.when_stopped = lambda: _forget(kernel)
    _active = kernel
    signals.listen(kernel)
    return kernel


def stop():
    """Stop the active kernel (see `Kernel.stop`); afterwards none is active."""
    if _active is not None:
        _active.stop()


@contextmanager
def aside():
    """While the block runs, the active kernel is put aside as if there were none, and others may be started and stopped."""
    global _active
    before, _active = _active, None
    try:
        yield
    finally:
        stop()
        _active = before
        budget.renew()


_idle = None


@contextmanager
def at_hand():
    """While the block runs a kernel is active: the one that is, or one in virtual time that is there for the moment.

    For what may be asked outside of any plan. The moment's kernel is kept for the next one, if nothing has happened in it.
    """
    global _active, _idle
    if _active is not None:
        yield
        return
    kernel, _idle = _idle, None
    if kernel is None or kernel.main.carrier.ident != get_ident():
        kernel = Kernel()
    _active = kernel
    unused = False
    try:
        yield
        unused = kernel.untouched
    finally:
        if not (unused or kernel.stopped):
            kernel.stop()
        if _active is kernel:
            _active = None
        if unused:
            _idle = kernel
        budget.renew()


def _forget(kernel):
    global _active
    signals.forget(kernel)
    if _active is kernel:
        _active = None


@atexit.register
def _stop_at_exit():
    """A script that just ends shall not leave out the cleanup of its tasks, nor what serves them (a recording, a robot's connection)."""
    kernel = _active
    signals.leaving = True
    if kernel is not None:
        asked_before = kernel.ended_by
        try:
            if kernel.current is kernel.main and kernel.main.carrier.ident == get_ident():
                stop()
            else:
                kernel.close_what_serves()
        except Terminated as ended:
            if asked_before is None:  # else the main program has an exit status already
                signals.end_by(ended.number)
    signals.end_as_interrupted()


def active():
    """The active kernel, or None."""
    return _active


def _none():
    raise KernelError("No kernel is running. Call kernel.start() first; the caller becomes the main task.")


def checkpoint() -> None:
    """Named in every loop's back edge: counts, and now and then lets others run or raises a request to end."""
    budget.left = left = budget.left - 1
    if left < 0:
        slice_over()


def slice_over():
    """What comes when all checkpoints of a slice are used up."""
    if _active is None:
        budget.renew()
    else:
        _active.end_slice()


def refill():
    """What a compiled loop calls when it has no more ticks (see ``budget.py``)."""
    if budget.refill():
        slice_over()


def current():
    """The task that runs. While timers fire and messages are read this is a stand-in, which cannot park."""
    return (_active or _none()).current


def now() -> float:
    """Seconds of the kernel's clock since `start`."""
    return (_active or _none()).clock.now()


def spawn(fn, *args, name=None, parent=None):
    """See `Kernel.spawn`."""
    return (_active or _none()).spawn(fn, *args, name=name, parent=parent)


def park(why="", until=None):
    """See `Kernel.park`."""
    return (_active or _none()).park(why, until)


def unpark(task):
    """See `Kernel.unpark`."""
    return task.kernel.unpark(task)


def sleep(seconds):
    """See `Kernel.sleep`."""
    (_active or _none()).sleep(seconds)


def yield_():
    """See `Kernel.yield_`."""
    (_active or _none()).yield_()


def settle():
    """See `Kernel.settle`."""
    (_active or _none()).settle()


def shield():
    """See `Kernel.shield`."""
    return (_active or _none()).shield()


def call_at(time, fn):
    """See `Kernel.call_at`."""
    return (_active or _none()).call_at(time, fn)


def call_every(period, fn, first=None):
    """See `Kernel.call_every`."""
    return (_active or _none()).call_every(period, fn, first)


def post(fn):
    """See `Kernel.post`."""
    (_active or _none()).post(fn)


def outside_source():
    """See `Kernel.outside_source`."""
    return (_active or _none()).outside_source()


def woken_by(wake):
    """See `Kernel.woken_by`."""
    return (_active or _none()).woken_by(wake)


def run_blocking(fn: Callable[..., T], *args: Any) -> T:
    """See `Kernel.run_blocking`."""
    return (_active or _none()).run_blocking(fn, *args)


def pace():
    """The `Pace` of the active kernel's time; as fast as the machine computes until it is told otherwise."""
    kernel = _active or _none()
    if not kernel.clock.virtual:
        return Pace(kernel)
    if kernel.clock.pace is None:
        kernel.clock.pace = Pace(kernel)
    return kernel.clock.pace


def time_wanted():
    """See `TimeWanted`."""
    return TimeWanted(_active or _none())


def time_held():
    """See `Kernel.time_held`."""
    return (_active or _none()).time_held()


def interrupt():
    """See `Kernel.interrupt`."""
    (_active or _none()).interrupt()


def interrupt_over():
    """See `Kernel.interrupt_over`."""
    (_active or _none()).interrupt_over()
