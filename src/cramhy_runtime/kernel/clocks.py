"""Two clocks: virtual time, and a pace-maker that holds virtual time back to the wall's (law 5).

The scheduler works with times of timers only. When nothing is left to do at this instant it asks its clock to go to
the next timer. The virtual clock jumps there. The wall clock waits until the operating system's clock says so, or until
somebody rings the bell (a message in the inbox, an interrupt), and has no other part in the scheduling. SimPy's
`RealtimeEnvironment` has the same shape.

What the original leaves to SBCL's timers and threads (`sleep`, `wait-for :timeout`, `top-level`) all comes here.
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

    A plain lock used as a binary semaphore: unlike a condition it can be rung from a signal handler that interrupted
    the very thread that waits. A ring with nobody waiting is kept, so none is lost; two rings are one.
    """

    __slots__ = ("_lock", "waited")

    def __init__(self) -> None:
        self._lock = _thread.allocate_lock()
        self._lock.acquire()
        self.waited = 0.0  # seconds of the wall so far: while nobody in the kernel had anything to do

    def ring(self) -> None:
        try:
            self._lock.release()
        except RuntimeError:
            pass  # it rings already

    def wait(self, timeout: float | None = None) -> None:
        """Wait until the bell rings, TIMEOUT seconds at most; may come back early."""
        if timeout is None or timeout > LONGEST_WAIT:
            timeout = LONGEST_WAIT
        if timeout > 0:
            began = time.monotonic()
            self._lock.acquire(timeout=timeout)
            self.waited += time.monotonic() - began


class VirtualClock:
    """Time that stands still while anything runs, and jumps to the next timer when everything is parked."""

    virtual = True
    epoch = 1292688669.674
    """The moment at which virtual time begins, in seconds since 1970: any will do, if it is always the same. It is that of the ROS
    lecture's transcript, so that stamps look as on the slides."""

    def __init__(self, begin: float = 0.0):
        self.time = begin
        self.pace: Pace | None = None  # what holds it back for somebody who watches (see `pace`)
        self.wanted = 0  # who wants time to pass even while the prompt waits

    def now(self) -> float:
        """Seconds since the start of the kernel."""
        return self.time

    def go_to(self, when: float, bell: Bell | None = None) -> None:
        """Let it be WHEN; with a pace, after its wait, or earlier."""
        if self.pace is not None:
            when = self.pace.reach(self.time, when)
        if when > self.time:
            self.time = when

    def nudge(self, when: float) -> None:
        """Busy tasks used up their slices: time must not stand still for the others because of them."""
        self.go_to(when)


class WallClock:
    """Time that passes by itself. OS_CLOCK gives seconds and never goes back; WAIT(bell, seconds) waits.

    Both can be given, so that tests pace a run without waiting for it.
    """

    virtual = False
    wanted = 0
    pace: Pace | None = None

    def __init__(
        self, os_clock: Callable[[], float] = time.monotonic, wait: Callable[[Bell, float], object] = Bell.wait, begin: float = 0.0
    ):
        self._os_clock = os_clock
        self._wait = wait
        self._start = os_clock() - begin
        self.epoch = time.time() - begin  # the moment at which the kernel's time began, in seconds since 1970

    def now(self) -> float:
        """Seconds since the start of the kernel."""
        return self._os_clock() - self._start

    def go_to(self, when: float, bell: Bell) -> None:
        """Wait until it is WHEN or the bell rings; may come back early."""
        self._wait(bell, when - self.now())

    def nudge(self, when: float) -> None:
        """Wall time needs no help to pass."""


KINDS: dict[str, type[VirtualClock | WallClock]] = {"virtual": VirtualClock, "wall": WallClock}


def make_clock(clock: ClockName | Clock, begin: float = 0.0) -> Clock:
    """A fresh clock for "virtual" or "wall" that shows BEGIN seconds; a clock object is taken as it is."""
    if isinstance(clock, str) and clock in KINDS:
        return KINDS[clock](begin=begin)
    if isinstance(clock, str):
        raise ValueError(f'There is no clock "{clock}". Choose "virtual" or "wall".')
    return clock
