"""The pace of virtual time for spectators: slower than the machine could go, paused, or step by step.

A virtual clock jumps. Users of the page want to see the turtle drive, so the clock asks its pace, if there is one, before it
jumps: `Pace.reach` waits for the wall clock as long as the speed demands, and says how far plan time may go. A message from
outside ends the wait early, as with the wall clock. While it is paused, time passes only by steps; tasks that are runnable at
this instant still run. A plan does the same things in the same order at every speed (law 5).

While the prompt waits for the next form, virtual time stands still. It goes on as far as a step reaches, and as long as a
`TimeWanted` is open, such as for a request to the simulator, which answers in its next tick.
"""

from __future__ import annotations

import math
import time

from .errors import KernelError
from .tasks import BLOCKED
from .typing_names import TYPE_CHECKING, Any, Literal, Self

if TYPE_CHECKING:
    from collections.abc import Callable

    from .scheduler import Kernel
    from .signatures import Callback

FORGOTTEN = 0.25  # s; who is further behind than that does not hurry to catch up


class Pace:
    """The pace of a kernel's time. Call its methods with the baton: in a task, or in a function posted to the kernel.

    ``speed`` is in plan seconds per second of wall time, or ``None`` for as fast as the machine computes. ``on_change`` are functions of
    no arguments, called after each change.
    """

    def __init__(self, kernel: Kernel, os_clock: Callable[[], float] = time.monotonic, wait: Callable[[float], object] | None = None):
        self._kernel, self._os_clock = kernel, os_clock
        self._wait = wait or kernel.wait_for_message
        self._speed: float | None = None
        self.paused = False
        self.waits = not self.virtual  # whether `reach` may wait: plan time is paused, or has a speed
        self.on_change: list[Callback] = []
        self._step_end = -math.inf
        self._anchor: tuple[float, float] | None = None  # (wall, plan): since then the speed has been what it is

    @property
    def virtual(self) -> bool:
        """Whether time is virtual, so that its pace can be changed."""
        return self._kernel.clock.virtual

    @property
    def speed(self) -> float | None:
        """Plan seconds per second of wall time; ``None`` is as fast as the machine computes."""
        return self._speed if self.virtual else 1.0

    @property
    def busy(self) -> bool:
        """Whether the main task does something, and does not only wait at the prompt."""
        return self._kernel.main.state is not BLOCKED

    def pause(self) -> None:
        """Let plan time stand still. In wall time it is a KernelError."""
        self._change(paused=True)

    def resume(self) -> None:
        """Let plan time pass again. In wall time it is a KernelError."""
        self._change(paused=False)

    def set_speed(self, speed: float | None) -> None:
        """Set the speed: plan seconds per second, above zero; ``None`` or infinity is as fast as the machine computes.

        Other numbers are a ValueError. In wall time it is a KernelError.
        """
        if speed is not None and not speed > 0:
            raise ValueError(f"A speed is a number above zero, in plan seconds per second, but not {speed}.")
        self._change(_speed=None if speed is None or speed == math.inf else float(speed))

    def step(self, seconds: float) -> None:
        """Let SECONDS of plan time pass, at once, and pause. It works while the prompt waits, too.

        SECONDS that are not positive and finite are a ValueError. In wall time it is a KernelError.
        """
        if not 0 < seconds < math.inf:
            raise ValueError(f"A step takes a time above zero, in seconds, but not {seconds}.")
        start = max(self._kernel.now(), self._step_end)
        self._change(paused=True)
        self._step_end = start + seconds
        self._kernel.call_at(self._step_end, self._tell)  # something is due at its end, so the clock has somewhere to go

    def reach(self, now: float, when: float) -> float:
        """How far plan time may go from NOW towards WHEN, after a wait. A message from outside ends the wait."""
        if self.paused:
            if now >= self._step_end:
                self._wait(math.inf)
                return now
            return min(when, self._step_end)
        if self.speed is None:
            return when
        wall = self._os_clock()
        if self._anchor is None:
            self._anchor = (wall, now)
        wall_start, plan_start = self._anchor
        due = wall_start + (when - plan_start) / self.speed
        if wall - due > FORGOTTEN:  # time stood still at the prompt, or the machine was busy: from here on as if it began now
            wall_start, plan_start = self._anchor = (wall, now)
            due = wall + (when - now) / self.speed
        if due > wall:
            self._wait(due - wall)
            passed = plan_start + (self._os_clock() - wall_start) * self.speed
            return min(when, max(now, passed))
        return when

    def clock_changed(self) -> None:
        """Called when time is of the other kind from now on."""
        self.paused = False
        self._step_end, self._anchor = -math.inf, None
        self._tell()

    @property
    def time_is_wanted(self) -> bool:
        """Whether time passes even though the prompt waits."""
        return self._kernel.clock.wanted > 0 or self._kernel.now() < self._step_end

    def _change(self, **changes: Any) -> None:
        if not self.virtual:
            raise KernelError(
                "Time is the wall's here, which cannot be paused, stepped or sped up. It can in a session that was started "
                "with --time virtual."
            )
        for name, value in changes.items():
            setattr(self, name, value)
        self.waits = self.paused or self.speed is not None
        self._step_end, self._anchor = -math.inf, None
        self._tell()

    def _tell(self) -> None:
        for function in list(self.on_change):
            function()


class TimeWanted:
    """A context manager. While it is open, virtual time passes at the prompt, too. Enter and leave it with the baton."""

    __slots__ = ("_kernel",)

    def __init__(self, kernel: Kernel):
        self._kernel = kernel

    def __enter__(self) -> Self:
        self._kernel.clock.wanted += 1
        return self

    def __exit__(self, *_: object) -> Literal[False]:
        self._kernel.clock.wanted -= 1
        return False
