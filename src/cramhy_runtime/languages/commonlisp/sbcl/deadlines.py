"""``sb-ext:with-timeout`` and ``sb-sys:with-deadline``: bodies that may take only so long, by the kernel's clock.

A timeout reaches the body wherever it is: at its next waiting point, or at the next turn of a loop. A deadline reaches it only where it
waits. Both are conditions that are signalled there, before anything unwinds, with restarts that go on with the wait.

In virtual time the clock stands still while code computes, so a loop that never waits has no timeout; in wall time it has.
Source: SBCL's manual, chapter 12; texts are SBCL's.
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import ask_value, cerror, error, restart_case, type_error
from cramhy_runtime.lisp_core.condition_types import SeriousCondition
from cramhy_runtime.lisp_core.data import truth
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.lisp_core.restarts import find_restart, invoke_restart
from cramhy_runtime.kernel import tasks
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

AGAIN = 0.01
"""Seconds after which a deadline that found its thread at work looks again whether it waits."""
DEFER, CANCEL = "SB-SYS::DEFER-DEADLINE", "SB-SYS::CANCEL-DEADLINE"


class Timeout(SeriousCondition):
    """A form took longer than it may."""

    lisp_name = "SB-EXT::TIMEOUT"
    initargs = {"SECONDS": "seconds"}
    seconds: Any = None
    what = "Timeout occurred"

    def report(self) -> str:
        """SBCL's text."""
        if self.seconds is None:
            return f"{self.what}."
        return f"{self.what} after {princ_to_string(self.seconds)} second{'' if self.seconds == 1 else 's'}."


class IoTimeout(Timeout):
    """Reading or writing took longer than it may."""

    lisp_name = "SB-SYS::IO-TIMEOUT"


class DeadlineTimeout(Timeout):
    """A wait reached the deadline of the form around it."""

    lisp_name = "SB-SYS::DEADLINE-TIMEOUT"
    what = "A deadline was reached"


def _seconds(thing: Any) -> float:
    return float(thing) if is_real(thing) else type_error(thing, "REAL")


def call_with_timeout(expires: Any, body: Any) -> object:
    """The work of ``with-timeout``: the values of ``body()``; after ``expires`` seconds the condition TIMEOUT is signalled in it."""
    seconds = _seconds(expires)
    if not seconds > 0:
        return body()
    task, running = kernel.current(), [True]

    def expire() -> None:
        if running:
            cerror("Continue", Timeout(seconds=expires))

    timer = kernel.call_at(kernel.now() + seconds, lambda: task.interject(expire))
    try:
        return body()
    finally:
        running.clear()
        timer.cancel()


class Deadline:
    """A deadline of ``task``: the moment ``at``. ``outer`` is the one around it."""

    def __init__(self, task: kernel.Task[object], seconds: Any, outer: Deadline | None) -> None:
        self.task, self.seconds, self.outer = task, seconds, outer
        self.at = kernel.now() + max(_seconds(seconds), 0.0)
        self.timer: kernel.Timer | None = None
        self.over = False

    def arm(self) -> None:
        """Look at the thread when the moment comes."""
        self.timer = kernel.call_at(max(self.at, kernel.now()), self._reached)

    def disarm(self) -> None:
        """Look at it no more."""
        if self.timer is not None:
            self.timer.cancel()
        self.timer = None

    def _reached(self) -> None:
        if self.task.state is tasks.PARKED and not self.task.shielded:
            self.task.interject(self._signal)
        else:
            self.timer = kernel.call_at(kernel.now() + AGAIN, self._reached)

    def _signal(self) -> None:
        if self.timer is None or self.over:
            return
        self.timer = None  # a deadline is signalled once, unless a handler defers it
        signal_deadline(self)

    def defer(self, seconds: Any) -> None:
        """Let the thread have SECONDS more, from now on."""
        self.disarm()
        self.seconds, self.at = seconds, kernel.now() + max(_seconds(seconds), 0.0)
        self.arm()

    def cancel(self) -> None:
        """The form has all the time that it wants."""
        self.disarm()
        self.over = True


def _current() -> Deadline | None:
    return getattr(kernel.current().local, "deadline", None)


def call_with_deadline(body: Any, *, seconds: Any = None, override: object = None) -> object:
    """The work of ``with-deadline``: the values of ``body()``, in which waiting beyond ``seconds`` signals DEADLINE-TIMEOUT.

    An outer deadline that comes first counts, unless ``override``. Without seconds: only that outer ones do not count, if ``override``.
    """
    task, outer = kernel.current(), _current()
    replaces = truth(override)
    if seconds is None:
        inner = None
    else:
        inner = Deadline(task, seconds, outer)
        if outer is not None and not outer.over and not replaces and outer.at <= inner.at:
            return body()
    if inner is None and not replaces:
        return body()
    if outer is not None and replaces:
        outer.disarm()
    task.local.deadline = inner
    if inner is not None:
        inner.arm()
    try:
        return body()
    finally:
        if inner is not None:
            inner.cancel()
        task.local.deadline = outer
        if outer is not None and replaces and not outer.over:
            outer.arm()


@contextmanager
def put_off(until: float | None) -> Iterator[tuple[Deadline | None, float | None]]:
    """``with put_off(until) as (deadline, first):`` signals no deadline in the block, which waits until ``first`` at most.

    That is when the next deadline is reached, or ``until``, if that is earlier. In cleanup no deadline counts.
    """
    reached = _current()
    while reached is not None and reached.timer is None:
        reached = reached.outer
    if reached is None or kernel.current().shielded or until is not None and until <= reached.at:
        yield None, until
        return
    reached.disarm()
    try:
        yield reached, reached.at
    finally:
        reached.arm()


def signal_deadline(deadline: Deadline | None = None) -> None:
    """``sb-sys:signal-deadline``: signal that the deadline is reached; restarts defer or cancel it, and the wait goes on."""
    reached = _current() if deadline is None else deadline
    if reached is None:
        return
    restart_case(
        [
            (sym(DEFER), reached.defer, "Defer the deadline for SECONDS more.", ask_value),
            (sym(CANCEL), reached.cancel, "Cancel the deadline and continue."),
        ],
        lambda: error(DeadlineTimeout(seconds=reached.seconds)),
    )


def defer_deadline(seconds: Any, condition: Any = None) -> None:
    """``sb-sys:defer-deadline``: call the restart of that name, if there is one."""
    if find_restart(sym(DEFER), condition) is not None:
        invoke_restart(find_restart(sym(DEFER), condition), seconds)


def cancel_deadline(condition: Any = None) -> None:
    """``sb-sys:cancel-deadline``: call the restart of that name, if there is one."""
    if find_restart(sym(CANCEL), condition) is not None:
        invoke_restart(find_restart(sym(CANCEL), condition))


def wait_until(test: Any, *, timeout: Any = None) -> bool | None:
    """The work of ``sb-ext:wait-for``: wait until ``test()`` is true; T, or nil after ``timeout`` seconds. It is asked again and again."""
    until = None if timeout is None else kernel.now() + max(_seconds(timeout), 0.0)
    pause = 0.001
    while not truth(test()):
        left = pause if until is None else min(pause, until - kernel.now())
        if left <= 0:
            return None
        kernel.sleep(left)
        pause = min(2 * pause, 0.1)
    return True
