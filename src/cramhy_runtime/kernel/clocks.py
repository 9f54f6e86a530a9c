"""Two clocks: virtual time, and a pace-maker that slows virtual time down to wall time (law 5).

The scheduler works with times of timers only. When nothing is left to do at this instant it asks its clock to go to
the next timer. The virtual clock jumps there. The wall clock waits until the operating system's clock says so, or until
the bell rings (for a message in the inbox, or an interrupt), and has no other part in the scheduling. SimPy's
`RealtimeEnvironment` has the same shape.

Where the original uses SBCL's timers and threads (`sleep`, `wait-for :timeout`, `top-level`), all calls come here.
"""

from __future__ import annotations

import _thread
import time

from .typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Clock, ClockName
    from .throttle import Pace

# s; a longer wait is cut and begun again. A signal that comes in the few instructions between giving up Python's lock and
# falling asleep does not wake the main thread (and none does on Windows): its handler runs when this is over.
LONGEST_WAIT = 0.05


class Bell:
    """Wakes the thread that waits while every task is parked.

    It is a plain lock used as a binary semaphore: unlike a condition variable it can be rung from a signal handler that interrupted
    the waiting thread itself. If no thread waits, the ring is kept, so none is lost; two rings are one.
    """

    __slots__ = ("_lock", "waited")

    def __init__(self) -> None:
        self._lock = _thread.allocate_lock()
        self._lock.acquire()
        self.waited = 0.0  # seconds of the wall so far: while nobody in the kernel had anything to do

    def ring(self) -> None:
        """Wake the waiting thread, or let the next wait return at once. Safe from any thread and from signal handlers."""
        try:
            self._lock.release()
        except RuntimeError:
            pass  # it rings already

    def wait(self, timeout: float | None = None) -> None:
        """Wait until the bell rings, at most TIMEOUT seconds. It may return early."""
        if timeout is None or timeout > LONGEST_WAIT:
            timeout = LONGEST_WAIT
        if timeout > 0:
            began = time.monotonic()
            self._lock.acquire(timeout=timeout)
            self.waited += time.monotonic() - began


class VirtualClock:
    """Time that stands still while a task runs, and jumps to the next timer when all tasks are parked."""

    virtual = True
    epoch = 1292688669.674
    """The moment at which virtual time begins, in seconds since 1970. Any value will do, if it is always the same. This one comes from the
    ROS lecture's transcript, so that stamps look as on the slides."""

    def __init__(self, begin: float = 0.0):
        self.time = begin
        self.pace: Pace | None = None  # what holds it back for somebody who watches (see `pace`)
        self.wanted = 0  # who wants time to pass even while the prompt waits

    def now(self) -> float:
        """Seconds since the start of the kernel."""
        return self.time

    def go_to(self, when: float, bell: Bell | None = None) -> None:
        """Set the time to WHEN. With a pace, wait first; then the time may be set to an earlier moment."""
        if self.pace is not None:
            when = self.pace.reach(self.time, when)
        if when > self.time:
            self.time = when

    def nudge(self, when: float) -> None:
        """Set the time to WHEN, because busy tasks used up their slices: time must not stand still for the others."""
        self.go_to(when)


class WallClock:
    """Time that passes by itself. OS_CLOCK returns seconds and never goes back; WAIT(bell, seconds) waits.

    Tests give both, to pace a run without waiting for it.
    """

    virtual = False
    wanted = 0
    pace: Pace | None = None

    def __init__(
        self,
        os_clock: Callable[[], float] = time.monotonic,
        wait: Callable[[Bell, float], object] = lambda bell, seconds: bell.wait(seconds),
        begin: float = 0.0,
    ):
        self._os_clock = os_clock
        self._wait = wait
        self._start = os_clock() - begin
        self.epoch = time.time() - begin  # the moment at which the kernel's time began, in seconds since 1970

    def now(self) -> float:
        """Seconds since the start of the kernel."""
        return self._os_clock() - self._start

    def go_to(self, when: float, bell: Bell) -> None:
        """Wait until it is WHEN or the bell rings. It may return early."""
        self._wait(bell, when - self.now())

    def nudge(self, when: float) -> None:
        """Do nothing: wall time passes by itself."""


KINDS: dict[str, type[VirtualClock | WallClock]] = {"virtual": VirtualClock, "wall": WallClock}


def make_clock(clock: ClockName | Clock, begin: float = 0.0) -> Clock:
    """A fresh clock for "virtual" or "wall" that shows BEGIN seconds. A clock object is returned as it is; another word is a ValueError."""
    if isinstance(clock, str) and clock in KINDS:
        return KINDS[clock](begin=begin)
    if isinstance(clock, str):
        raise ValueError(f'There is no clock "{clock}". Choose "virtual" or "wall".')
    return clock
