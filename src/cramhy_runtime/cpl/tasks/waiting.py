"""Waiting: for a fluent to become true, again and again, or for time to pass.

If the value is true at first, it is returned at once. Otherwise the task parks at the fluent; a pulse that leaves the value false does
not even wake it. After a suspension the task looks again and goes on waiting. So it misses a value that was true only meanwhile, and
sees one that is true at the wake-up. Source: cpl.md 2.10, 2.11, 3.9. Repaired: the timed wait keeps its time however often the fluent
pulses, and can be evaporated and suspended like the untimed one.
"""

from __future__ import annotations

from math import inf
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar, overload

from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE
from cramhy_runtime.kernel.budget import budget

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import TRUE_CLASSES, truth
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.kernel.images import Cell

from ..fluents.fluents import Fluent
from ..logging import active_tags, log
from .pausing import pause

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")
TIMEOUT = keyword("TIMEOUT")
user_wait: Cell[Callable[..., Any] | None] = Cell(None)
"""The generic function ``wait-for``, when users have defined methods on it (``languages/commonlisp/faces/cpl/user_methods.py``)."""


def wait_through(generic):
    """Let `wait_for` call ``generic`` from now on, a generic function with methods of users."""
    user_wait.value = generic


@overload
def wait_for(fluent: Fluent[T | None], *, timeout: None = None) -> T: ...
@overload
def wait_for(fluent: Fluent[T | None], *, timeout: float | None) -> T | None: ...
def wait_for(fluent: Any, *, timeout: float | None = None, **ignored: Any) -> Any:
    """Wait until the value of ``fluent`` is true and return it. After ``timeout`` seconds of the kernel's clock return nil.

    A timeout of 0 only tests. An object that is not a fluent is returned if it is true; nil is an error. Source: cpl.md 2.10.
    """
    generic = user_wait.value
    if generic is not None:
        return generic(fluent) if timeout is None else generic(fluent, TIMEOUT, timeout)
    if isinstance(fluent, Fluent):
        value = fluent.read()
        if value is True or value is not None and value is not False and (value.__class__ in TRUE_CLASSES or truth(value)):
            return value
        return wait(fluent, timeout)
    return plain_wait_for(fluent)


def plain_wait_for(fluent, *, timeout=None, **ignored):
    """`wait_for` without methods of users."""
    if not isinstance(fluent, Fluent):
        return fluent if truth(fluent) else error("wait-for called with nil argument.")
    value = fluent.read()
    return value if truth(value) else wait(fluent, timeout)


def wait(fluent: Fluent[object], timeout: float | None) -> Any:
    """Park until the value of ``fluent``, which was not true just now, is true; return it, or nil after ``timeout`` seconds."""
    until = None if timeout is None else kernel.now() + in_seconds(timeout)
    if until is not None and timeout <= 0:
        return None
    if active_tags:
        log("WAIT-FOR", "~s", fluent)
    running = ACTIVE.value
    me = kernel.current() if running is None else running.current
    why = fluent.awaited
    waiters = fluent.waiters
    if not waiters:
        waiters = fluent.waiters = {}
    again = me in waiters  # an ON-SUSPENSION form, say, waits for what its task waits for already
    waiters[me] = True
    try:
        while True:
            in_time = me.kernel.park(why, until)
            value = fluent.read()
            if value is True or value is not None and value is not False and (value.__class__ in TRUE_CLASSES or truth(value)):
                return value
            if not in_time and until is not None and kernel.now() >= until:
                return None
    finally:
        if not again:
            del waiters[me]


def in_seconds(time: Any) -> float:
    """``time``, a real number of Lisp, Python or numpy, as seconds of the kernel's clock. Other objects, and NaN, are a type error."""
    if time.__class__ is not float and time.__class__ is not int and (isinstance(time, (bool, str)) or not hasattr(time, "__float__")):
        return type_error(time, "REAL")
    try:
        seconds = float(time)
    except OverflowError:
        return inf if time > 0 else -inf
    except (TypeError, ValueError):  # an array of several, say
        return type_error(time, "REAL")
    if seconds != seconds:  # NaN
        return type_error(time, "REAL", "\n(NaN is not a number: a wait of so many seconds would never end, or end at once.)")
    return seconds


def whenever(fluent: Fluent[object], body: Callable[[], object]) -> NoReturn:
    """Wait for ``fluent`` and call ``body``, again and again. In Lisp, ``(return ...)`` leaves it, through the compiler's block.

    Source: cpl.md 2.11.
    """
    while True:
        if user_wait.value is None and isinstance(fluent, Fluent):  # as `wait_for` does
            value = fluent.read()
            if value is None or value is not True and not truth(value):
                wait(fluent, None)
        else:
            wait_for(fluent)
        body()
        budget.left = left = budget.left - 1  # as `kernel.checkpoint` does
        if left < 0:
            kernel.slice_over()


def sleep_star(seconds: float) -> None:
    """Sleep for ``seconds``, any real, of the kernel's clock. Returns nil. Time spent suspended counts as slept. Source: cpl.md 3.9."""
    length = in_seconds(seconds)
    if not length > 0:
        kernel.yield_()
        return
    until = kernel.now() + length
    while pause(lambda: f"the time {until:g} s (sleep {seconds})", until) or kernel.now() < until:
        pass


sleep = sleep_star
