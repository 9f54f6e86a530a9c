"""The active kernel, and the functions that act on it.

A process has one active kernel at a time; tests start hundreds, one after the other. The floors above call the functions
here: `kernel.park(...)` is `kernel.active().park(...)`.
"""

from __future__ import annotations

import atexit
from _thread import get_ident
from contextlib import contextmanager

from . import images, signals
from .budget import budget
from .clocks import make_clock
from .endings import CLEANUP_LIMIT
from .errors import KernelError, Terminated, TimeLimit
from .images import Cell
from .throttle import Pace, TimeWanted
from .scheduler import Kernel
from .typing_names import TYPE_CHECKING, NoReturn, TypeVar, TypeVarTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from .inbox import OutsideSource, TimeHeld
    from .signatures import BackendName, Backend, Callback, Clock, ClockName, Name, Seed, Why
    from .tasks import Task, shield as Shield, unshielded as Unshielded
    from .timers import Timer

T = TypeVar("T")
K = TypeVar("K", bound=Kernel, default=Kernel)
Arguments = TypeVarTuple("Arguments")
ACTIVE: Cell[Kernel | None] = Cell(None, fresh=True)
"""The active kernel. Code that asks at each binding of a variable looks here; a call of `active` would double its time."""


def start(
    clock: ClockName | Clock = "virtual",
    backend: BackendName | Backend = "auto",
    seed: Seed | None = None,
    time_limit: float | None = None,
    kind: type[K] = Kernel,  # type: ignore[assignment]  # which is what K is then
    cleanup_limit: float | None = CLEANUP_LIMIT,
) -> K:
    """Make a fresh kernel active, and return it. Its main task is the caller. A kernel that was active is stopped first.

    In the main thread the kernel handles SIGINT and the signals that end a process from now on, unless other code handles them
    (`signals`).

    CLOCK: "virtual", "wall", or a clock object. BACKEND: "threads", "greenlet", "auto" (greenlets where they are installed),
    or a back end. SEED: None for first come, first served; a number shuffles the order, reproducibly; a function of the
    queue gives the place in it of the task that goes next. TIME_LIMIT: seconds of the kernel's clock after which the main
    task gets `TimeLimit`, or None.
    KIND: a subclass of `Kernel`, for tests. CLEANUP_LIMIT: seconds that plans get for their cleanup when the process is
    asked to end, by the kernel's clock and by the wall clock, or None. Another word for CLOCK or BACKEND is a ValueError.
    """
    before = ACTIVE.value
    if before is not None and before.main.carrier.ident == get_ident():
        before.stop()
    ACTIVE.value = None
    kernel = kind(clock, backend, seed, time_limit)
    kernel.cleanup_limit = cleanup_limit
    kernel.when_stopped = lambda: _forget(kernel)
    ACTIVE.value = kernel
    signals.listen(kernel)
    return kernel


def stop() -> None:
    """Stop the active kernel (see `Kernel.stop`). Afterwards no kernel is active."""
    if ACTIVE.value is not None:
        ACTIVE.value.stop()


@contextmanager
def aside() -> Iterator[None]:
    """Put the active kernel aside during the block, in which others may be started and stopped. Then it is active again."""
    before, ACTIVE.value = ACTIVE.value, None
    try:
        yield
    finally:
        stop()
        ACTIVE.value = before
        budget.renew()


@contextmanager
def time_limited(seconds: float) -> Iterator[None]:
    """Raise `TimeLimit` in the current task after ``seconds``, unless the block is over by then. Cleanup in the block gets as long again.

    The limit of `start` ends the main task; this one ends any task. A task that computes is not disturbed, only one that waits.
    """
    task = current()
    limit = TimeLimit(f"It took longer than {seconds:g} s.")
    timer = call_every(seconds, lambda: task.end_wait(limit))
    try:
        yield
    finally:
        timer.cancel()


def on_own_stack() -> bool:
    """Whether the caller is the task that runs, and not an outside thread that came by."""
    carrier = current().carrier
    return carrier is None or carrier.ident == get_ident()


@contextmanager
def work_limited(slices: int) -> Iterator[None]:
    """Raise `WorkLimit` in the current task when the block has used up so many slices of the processor, and at the end of each slice after.

    It ends a block that computes, where `time_limited` ends one that waits. Slices are counted, not seconds, so that a run stays a function
    of its inputs (law 4). In a block that is limited already the limit around it counts.
    """
    task = current()
    if task.slices_left is not None:
        yield
        return
    task.slices_left = slices
    try:
        yield
    finally:
        task.slices_left = None


_idle: Cell[Kernel | None] = Cell(None, fresh=True)


@contextmanager
def at_hand() -> Iterator[None]:
    """Run the block with an active kernel: the present one, or a temporary one in virtual time.

    It is for functions that work outside of plans. A temporary kernel is kept for the next use if nothing has happened in it.
    """
    if ACTIVE.value is not None:
        yield
        return
    kernel, _idle.value = _idle.value, None
    if kernel is None or kernel.main.carrier.ident != get_ident():
        kernel = Kernel()
    ACTIVE.value = kernel
    unused = False
    try:
        yield
        unused = kernel.untouched
    finally:
        if not (unused or kernel.stopped):
            kernel.stop()
        if ACTIVE.value is kernel:
            ACTIVE.value = None
        if unused:
            _idle.value = kernel
        budget.renew()


def _forget(kernel: Kernel) -> None:
    signals.forget(kernel)
    if ACTIVE.value is kernel:
        ACTIVE.value = None


@atexit.register
def _stop_at_exit() -> None:
    """Run the cleanup of tasks, and close what serves them (a recording, a robot's connection), when a script just ends."""
    signals.leaving.set()
    for image in signals.listening_images():
        if image is not images.current():
            with image.entered():
                _stop_active_at_exit()
    _stop_active_at_exit()
    signals.end_as_interrupted()


def _stop_active_at_exit() -> None:
    kernel = ACTIVE.value
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


def active() -> Kernel | None:
    """The active kernel, or None."""
    return ACTIVE.value


def _none() -> NoReturn:
    raise KernelError(
        "No kernel is running. Make the call in a plan: cpl.run(drive), without the parentheses behind drive, or `with cpl.plan():` around "
        "the call. Or call kernel.start() first; the caller becomes the main task."
    )


def checkpoint() -> None:
    """Count one turn of a loop. From time to time let other tasks run, or raise a request to end. Loops call it in each turn."""
    budget.left = left = budget.left - 1
    if left < 0:
        slice_over()


def slice_over() -> None:
    """End the slice: all its checkpoints are used up."""
    if ACTIVE.value is None:
        budget.renew()
    else:
        ACTIVE.value.end_slice()


def refill() -> None:
    """Get new ticks for a compiled loop that has used up its own (see ``budget.py``)."""
    if budget.refill():
        slice_over()


def current() -> Task[object]:
    """The task that runs. While timers fire and messages are read it is a stand-in, which cannot park. Without a kernel: KernelError."""
    return (ACTIVE.value or _none()).current


def holds_baton() -> bool:
    """Whether the code that asks is that of the task with the baton: not that of another thread, nor of the scheduler."""
    kernel = ACTIVE.value
    carrier = None if kernel is None or kernel.stopped else kernel.current.carrier
    return carrier is not None and carrier.ident == get_ident()


def now() -> float:
    """Seconds of the kernel's clock since `start`. Without a kernel: KernelError."""
    return (ACTIVE.value or _none()).clock.now()


def spawn(fn: Callable[[*Arguments], T], *args: *Arguments, name: Name | None = None, parent: Task[object] | None = None) -> Task[T]:
    """See `Kernel.spawn`."""
    return (ACTIVE.value or _none()).spawn(fn, *args, name=name, parent=parent)


def park(why: Why = "", until: float | None = None) -> bool:
    """See `Kernel.park`."""
    return (ACTIVE.value or _none()).park(why, until)


def unpark(task: Task[object]) -> bool:
    """See `Kernel.unpark`."""
    return task.kernel.unpark(task)


def sleep(seconds: float) -> None:
    """See `Kernel.sleep`."""
    (ACTIVE.value or _none()).sleep(seconds)


def yield_() -> None:
    """See `Kernel.yield_`."""
    (ACTIVE.value or _none()).yield_()


def choice_point(why: Why) -> None:
    """See `Kernel.choice_point`."""
    (ACTIVE.value or _none()).choice_point(why)


def settle() -> None:
    """See `Kernel.settle`."""
    (ACTIVE.value or _none()).settle()


def shield() -> Shield:
    """See `Kernel.shield`."""
    return (ACTIVE.value or _none()).shield()


def unshielded() -> Unshielded:
    """See `Kernel.unshielded`."""
    return (ACTIVE.value or _none()).unshielded()


def call_at(time: float, fn: Callback) -> Timer:
    """See `Kernel.call_at`."""
    return (ACTIVE.value or _none()).call_at(time, fn)


def call_every(period: float, fn: Callback, first: float | None = None) -> Timer:
    """See `Kernel.call_every`."""
    return (ACTIVE.value or _none()).call_every(period, fn, first)


def post(fn: Callback) -> None:
    """See `Kernel.post`."""
    (ACTIVE.value or _none()).post(fn)


def outside_source() -> OutsideSource:
    """See `Kernel.outside_source`."""
    return (ACTIVE.value or _none()).outside_source()


def woken_by(wake: Callback) -> AbstractContextManager[None]:
    """See `Kernel.woken_by`."""
    return (ACTIVE.value or _none()).woken_by(wake)


def run_blocking(fn: Callable[[*Arguments], T], *args: *Arguments) -> T:
    """See `Kernel.run_blocking`."""
    return (ACTIVE.value or _none()).run_blocking(fn, *args)


def pace() -> Pace:
    """The `Pace` of the active kernel's time. At first time passes as fast as the machine computes."""
    kernel = ACTIVE.value or _none()
    if not kernel.clock.virtual:
        return Pace(kernel)
    if kernel.clock.pace is None:
        kernel.clock.pace = Pace(kernel)
    return kernel.clock.pace


def set_clock(kind: ClockName) -> None:
    """Let the active kernel go on in "virtual" or in "wall" time, from the same second on. If that is its time already, do nothing.

    Tasks keep the moments for which they wait. Another word is a ValueError.
    """
    kernel = ACTIVE.value or _none()
    before = kernel.clock
    clock = make_clock(kind, kernel.now())
    if clock.virtual == before.virtual:
        return
    clock.wanted, clock.pace = before.wanted, before.pace
    kernel.clock = clock
    if clock.pace is not None:
        clock.pace.clock_changed()


def time_wanted() -> TimeWanted:
    """See `TimeWanted`."""
    return TimeWanted(ACTIVE.value or _none())


def time_held() -> TimeHeld:
    """See `Kernel.time_held`."""
    return (ACTIVE.value or _none()).time_held()


def interrupt() -> None:
    """See `Kernel.interrupt`."""
    (ACTIVE.value or _none()).interrupt()


def interrupt_over() -> None:
    """See `Kernel.interrupt_over`."""
    (ACTIVE.value or _none()).interrupt_over()
