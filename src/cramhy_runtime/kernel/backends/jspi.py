"""Stacks that are WebAssembly's: for a browser's tab, and Node, where Python has neither threads nor greenlets.

JavaScript Promise Integration (JSPI) suspends a WebAssembly stack until a promise is resolved, and the event loop goes on meanwhile. So a
carrier is a call that JavaScript made of us, and its turn is a promise: to give the baton away is to resolve the promise of the other
and to wait for one's own. The half of this that only JavaScript can do is `stacks.mjs`.

Three things differ from threads and greenlets.

* Only what waits for a promise lets others run. A call that blocks otherwise, such as `lock.acquire`, stops everything.
* Messages, a click and Ctrl-C come by the event loop. It gets a turn every 25 ms, when the baton is handed over or a slice ends
  (`JspiBackend.breathe`).
* Nobody may look at the frames of a suspended stack. Between two frames of which C called one from the other stands a frame in C's own
  part of the stack, and other code lies there while the stack is suspended. So the stack itself is woken, copies what reports read of
  its frames (`Seen`), and gives the baton back.

The collector of Python 3.14 looks at these frames, too (pyodide#6464). `cramhy_runtime.browser.pyodide_files` mends Pyodide for that.
"""

from __future__ import annotations

import _thread
import asyncio
import sys
import time
from collections import deque

from ..clocks import LONGEST_WAIT
from ..errors import NoStack
from ..typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from ..scheduler import Kernel
    from ..tasks import Task

    Job = Callable[[Any], Any]  # of a carrier; it returns the carrier that goes on, or None

try:
    from cramhy_host import host
    from pyodide.ffi import can_run_sync, run_sync
except ImportError:
    host = None  # this is not WebAssembly: the module can be imported, and makes no back end

KEEP = 256  # idle stacks that one kernel keeps
MOST = 8_000 if host is None else host.most
"""Stacks at a time. It is the browser's matter; see ``stacks.mjs``."""
FULL = f"There is room for {MOST:,} tasks at a time in a browser, and all of it is taken. End some tasks before you start more."

_stacks = 0  # that are not over, of all kernels


# ---------------------------------------------------------------------------------------------------------------- waiting for promises

_ensure_future = asyncio.ensure_future
_awaited: Any = None  # the promise that `wait_for` is about to wait for


def _as_it_is(awaitable: Any, *, loop: Any = None) -> Any:
    """`asyncio.ensure_future`, but the promise of `wait_for` stays a promise.

    `run_sync` gives whatever it waits for to this function, which would make a task of asyncio's and take four turns of the event loop for
    it: 100 us a switch instead of 7.
    """
    return awaitable if awaitable is _awaited else _ensure_future(awaitable, loop=loop)


if host is not None:
    asyncio.ensure_future = _as_it_is  # type: ignore[assignment]


def wait_for(promise: Any) -> Any:
    """Suspend this stack until ``promise``, of JavaScript, is resolved, and return what it gives. A rejection is raised."""
    global _awaited
    _awaited = promise
    return run_sync(promise)


# ---------------------------------------------------------------------------------------------------------------- stacks


class Carrier:
    """A stack with its turn."""

    __slots__ = ("backend", "job", "started", "suspended", "ident", "_turn", "_asker", "_seen", "_counts")
    direct = False

    def __init__(self, backend: JspiBackend, job: Job | None):
        self.backend = backend
        self.job: Any = job  # as for `Job`; None while it waits for one
        self.started = self.suspended = self._counts = False
        self.ident = backend.ident
        self._turn = host.Turn.new()
        self._asker: Any = None  # the turn of whoever wants to know where it stands
        self._seen: Seen | None = None  # the answer

    def wake(self) -> None:
        """Give it the baton as soon as the present stack is suspended or has ended."""
        if self.started:
            self._turn.give()
        else:
            self.started = True
            host.launch(self._life)

    def wait(self) -> None:
        """Suspend this stack until another one wakes it."""
        self.suspended = True
        wait_for(self._turn.turn)
        while self._asker is not None:
            asker, self._asker = self._asker, None
            self._seen = seen(sys._getframe(1))
            asker.give()
            wait_for(self._turn.turn)
        self.suspended = False

    def look(self) -> Seen | None:
        """The innermost frame of this suspended stack, as `Seen`. None if another stack is looking at it."""
        if self._asker is not None:
            return None
        mine = self._asker = host.Turn.new()
        answered = mine.turn
        self._turn.give()
        wait_for(answered)
        found, self._seen = self._seen, None
        return found

    def take_place(self) -> None:
        """Take one of the `MOST` places. If there is none left, it is `NoStack`."""
        global _stacks
        if _stacks >= MOST:
            raise NoStack from RuntimeError(FULL)
        _stacks += 1
        self._counts = True

    def leave_place(self) -> None:
        """Give the place back. Does nothing a second time."""
        global _stacks
        if self._counts:
            self._counts = False
            _stacks -= 1

    def _life(self) -> None:
        """Do a job, hand the baton on, and again: the bottom of the stack."""
        idle = self.backend.idle
        try:
            while True:
                job, self.job = self.job, None
                successor = job(self)
                job = None
                keep = not self.backend.closed and len(idle) < KEEP
                if keep:
                    idle.append(self)
                if successor is not None:
                    successor.wake()
                    successor = None
                if not keep:
                    return
                wait_for(self._turn.turn)
                if self.job is None:
                    return
        finally:
            self.leave_place()


class Seen:
    """What reports read of a frame, copied while its stack was awake."""

    __slots__ = ("f_code", "f_lineno", "f_lasti", "f_back")

    def __init__(self, frame: FrameType):
        self.f_code, self.f_lineno, self.f_lasti = frame.f_code, frame.f_lineno, frame.f_lasti
        self.f_back: Seen | None = None


def seen(frame: FrameType) -> Seen:
    """FRAME, which must be of the running stack, and the frames around it, as `Seen`."""
    innermost = last = Seen(frame)
    around = frame.f_back
    while around is not None:
        outer = last.f_back = Seen(around)
        last, around = outer, around.f_back
    return innermost


# ---------------------------------------------------------------------------------------------------------------- the back end


class JspiBackend:
    """See the interface in `backends`."""

    name = "jspi"
    calls_back = True  # a task that is outside can be called back, for its call is on a stack of its own

    def __init__(self) -> None:
        if host is None:
            raise ImportError(
                'The back end "jspi" needs Pyodide, with the file stacks.mjs given to it as the module cramhy_host. '
                'Choose "auto", "threads" or "greenlet".'
            )
        self.idle: deque[Carrier] = deque()
        self.closed = False
        self.ident = _thread.get_ident()

    def adopt(self, kernel: Kernel) -> Carrier:
        carrier = Carrier(self, None)
        carrier.started = True
        return carrier

    def carrier(self, job: Job) -> Carrier:
        if self.idle:
            carrier = self.idle.pop()
            carrier.job = job
            return carrier
        carrier = Carrier(self, job)
        carrier.take_place()
        return carrier

    def transfer(self, mine: Carrier, other: Carrier) -> None:
        other.wake()
        mine.wait()

    def run_blocking(self, kernel: Kernel, task: Task[object], call: Callable[[], Any]) -> Any:
        """Run CALL on another stack. It begins, and goes on, whenever the others wait or the event loop has its turn."""
        outcome: list[Any] = []

        def outside(carrier: Carrier) -> None:
            try:
                outcome[:] = call(), None
            except BaseException as exception:
                outcome[:] = None, exception
            kernel.post(lambda: kernel.comes_back(task, visit))

        helper = self.carrier(outside)
        visit = kernel.leave(task)
        helper.wake()
        kernel.hand_over(task)
        if not outcome:
            return None  # called back early: the interrupt is raised as soon as we return
        result, exception = outcome
        if exception is not None:
            raise exception
        return result

    def frame(self, carrier: Carrier) -> Any:
        if not can_run_sync():
            return None  # the event loop asks, which stands on none of our stacks and cannot wait for an answer
        return carrier.look() if carrier.suspended else sys._getframe()

    def bell(self) -> Any:
        return Bell()

    def breathe(self) -> None:
        if host.due() and can_run_sync():
            wait_for(host.tick)

    def close(self) -> None:
        self.closed = True
        while self.idle:
            carrier = self.idle.pop()
            carrier.leave_place()
            carrier.wake()  # finds no job, and ends as soon as this stack is suspended

    def forsake(self, carrier: Carrier) -> None:
        """Do nothing: a stack that waits for ever takes memory, and one of the `MOST` places."""


class Bell:
    """As the `Bell` of `clocks`, for the one thread that there is: JavaScript rings it between two turns."""

    __slots__ = ("waited", "_host")

    def __init__(self) -> None:
        self._host = host.Bell.new()
        self.waited = 0.0

    def ring(self) -> None:
        """Wake the waiting stack, or let the next wait return at once."""
        self._host.ring()

    def wait(self, timeout: float | None = None) -> None:
        """Wait until the bell rings, at most TIMEOUT seconds. It may return early."""
        if timeout is None or timeout > LONGEST_WAIT:
            timeout = LONGEST_WAIT
        if timeout > 0:
            began = time.monotonic()
            self._host.milliseconds = timeout * 1000
            wait_for(self._host.rings)
            self.waited += time.monotonic() - began
