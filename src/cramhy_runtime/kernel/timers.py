"""Timers: calls and wake-ups at times of the kernel's clock.

One heap holds both kinds of entries: callbacks (`call_at`, `call_every`) and tasks parked with a deadline. Entries are
tuples `(time, order, what, ticket)`. `order` counts up, so of two entries for the same time the one created first comes
first; a periodic timer keeps its first order. A task that is woken before its deadline leaves its entry behind: the ticket no
longer fits, and the entry is skipped, or removed with others when more than half are stale.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush

from .typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .signatures import Callback, Clock
    from .tasks import Task

    Entry = tuple[float, int, Any, int]  # when, its order, a Timer or a Task, a ticket

CALLBACK = -1  # the ticket of entries that are timers; tasks' tickets count from 0
INFINITY = float("inf")
SWEEP_FROM = 64  # stale entries below this number are not worth a sweep
MAX_LAG = 1.0  # s; a periodic timer that is later than this (the process slept) leaves firings out


def seconds(given: object, call: str) -> float:
    """GIVEN, a number of seconds, as a number that the clock can add. Infinity means no limit.

    A NaN is a ValueError, and what is not a real number a TypeError, a truth value too. CALL is how it was given, for the text: ``f({})``.
    """
    if given.__class__ is float and given == given or given.__class__ is int:
        return given
    from decimal import Decimal  # 3 ms, for those who give neither of these
    from numbers import Real

    if isinstance(given, bool) or not isinstance(given, (Real, Decimal)):
        raise TypeError(f"{call.format(repr(given))}: give a number of seconds, or float('inf') for no limit.")
    number = float(given)
    if number != number:
        raise ValueError(f"{call.format(number)}: this is not a number. Give a number of seconds, or float('inf') for no limit.")
    return number


class Timer:
    """A callback that fires once, or again and again until `cancel`. `call_at` and `call_every` make it."""

    __slots__ = ("fn", "time", "order", "first", "period", "count", "_heap")

    def __init__(self, heap: TimerHeap, time: float, order: int, fn: Callback, period: float | None = None):
        self._heap = heap
        self.fn: Callback | None = fn
        self.time = self.first = time
        self.order = order
        self.period = period
        self.count = 0

    @property
    def active(self) -> bool:
        """True as long as it will fire (again)."""
        return self.fn is not None

    def cancel(self) -> None:
        """Stop the timer. It may be called at any time, in the callback too."""
        if self.fn is not None:
            self.fn = None
            self._heap.went_stale()

    def advance(self, now: float) -> None:
        """Set `time` to that of the next firing, by multiplication, so that rounding errors do not add up."""
        self.count += 1
        self.time = self.first + self.count * self.period
        if self.time < now - MAX_LAG:
            self.count = max(self.count, int((now - self.first) / self.period))
            self.time = self.first + self.count * self.period

    def __repr__(self) -> str:
        every = f" every {self.period:g} s" if self.period else ""
        return f"<timer at {self.time:g} s{every}{'' if self.active else ', cancelled'}>"


class TimerHeap:
    """The timers of one kernel, soonest first."""

    __slots__ = ("entries", "order", "_stale")

    def __init__(self) -> None:
        self.entries: list[Entry] = []
        self.order = 0
        self._stale = 0

    def add(self, time: float, fn: Callback, period: float | None = None) -> Timer:
        """A new timer that calls FN at TIME (s), and from then on every PERIOD seconds if it is given."""
        timer = Timer(self, time, self.order, fn, period)
        self.order += 1
        self.push(timer)
        return timer

    def push(self, timer: Timer) -> None:
        """Enter TIMER with its present time."""
        heappush(self.entries, (timer.time, timer.order, timer, CALLBACK))

    def add_deadline(self, time: float, task: Task[object]) -> None:
        """Wake TASK at TIME (s), unless it was woken before."""
        heappush(self.entries, (time, self.order, task, task.ticket))
        self.order += 1

    def pop(self) -> Entry:
        """Remove and return the first entry, even if it is stale."""
        entry = heappop(self.entries)
        if self._stale and not _counts(entry):
            self._stale -= 1
        return entry

    def went_stale(self) -> None:
        """Note that an entry no longer counts."""
        self._stale += 1
        if self._stale > SWEEP_FROM and self._stale * 2 > len(self.entries):
            self.sweep()

    def sweep(self) -> None:
        """Remove the entries that no longer count. Until then each refers to its task."""
        # In place, because the scheduler holds this very list.
        self.entries[:] = [entry for entry in self.entries if _counts(entry)]
        heapify(self.entries)
        self._stale = 0

    def next_time(self) -> float | None:
        """The time (s) of the first entry that counts, or None."""
        entries = self.entries
        while entries:
            if _counts(entries[0]):
                return entries[0][0]
            self.pop()
        return None


class Timing:
    """The part of the kernel that has timers."""

    __slots__ = ()

    if TYPE_CHECKING:  # what the other parts have
        clock: Clock
        _timers: TimerHeap

        def _wake(self, task: Task[object], woken: bool) -> None: ...
        def _call(self, fn: Callback) -> None: ...

    def call_at(self, time: float, fn: Callback) -> Timer:
        """Call FN in the scheduler when the clock reaches TIME, finite seconds, and return the Timer. FN must not park."""
        if not time < INFINITY:
            raise ValueError(f"A timer needs a finite time, not {time}.")
        return self._timers.add(time, fn)

    def call_every(self, period: float, fn: Callback, first: float | None = None) -> Timer:
        """Call FN every PERIOD seconds, without drift, from the time FIRST on (by default one period from now). Returns the Timer.

        FN must not park. A PERIOD that is not positive and finite is a ValueError.
        """
        if not 0 < period < INFINITY:
            raise ValueError(f"The period of a timer must be more than 0 s and finite, not {period}.")
        if first is None:
            first = self.clock.now() + period
        return self._timers.add(first, fn, period)

    def _fire(self, now: float) -> None:
        """Fire the timers that are due. Timers that the callbacks add fire in the next turn, so no callback keeps the baton for ever."""
        timers = self._timers
        entries, newest = timers.entries, timers.order
        while entries and entries[0][0] <= now and entries[0][1] < newest:
            _, _, what, ticket = timers.pop()
            if ticket != CALLBACK:
                if what.ticket == ticket:
                    self._wake(what, False)
                continue
            fn = what.fn
            if fn is None:
                continue
            if what.period is None:
                what.fn = None
            else:
                what.advance(now)
                timers.push(what)
            self._call(fn)


def _counts(entry: Entry) -> bool:
    what, ticket = entry[2], entry[3]
    return what.fn is not None if ticket == CALLBACK else what.ticket == ticket
