"""Timers of SB-EXT: functions that are called at a time of the kernel's clock, once or again and again.

A timer's function runs in a thread, as SBCL's does: in the one that made the timer, whose next waiting point or turn of a loop it
interrupts, in another one, or in a new one for each call. Source: SBCL's manual, chapter 12.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import NO_VALUES, boolean, list_from, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string, print_unreadable
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.threads import Thread, thread_of
from cramhy_runtime.utilities.wait_queue import need

from ..evaluation.universal_time import get_universal_time

_scheduled: dict[Timer, bool] = per_image({})


class Timer:
    """``function`` is called in ``thread``, a `Thread`, or in a new one. ``running`` is the kernel's timer when it is scheduled."""

    lisp_name = "SB-EXT::TIMER"

    def __init__(self, function: Any, name: object, thread: Thread | None) -> None:
        self.function, self.name, self.thread = function, name, thread
        self.running: kernel.Timer | None = None
        self.time = 0.0

    def fire(self) -> None:
        """Have the function called. The scheduler calls this, so nothing here may wait."""
        if self.running is None or self.running.period is None:
            self.stop()
        if self.thread is None:
            active = kernel.active()
            kernel.spawn(self.function, name=f"timer {self.name or ''}".rstrip(), parent=active.main)
        elif not self.thread.task.dead:
            self.thread.task.interject(self.function)

    def stop(self) -> None:
        """Schedule it no more."""
        if self.running is not None:
            self.running.cancel()
        self.running = None
        _scheduled.pop(self, None)


def _timer(thing: object) -> Timer:
    return need(thing, Timer, "SB-EXT:TIMER")


def make_timer(function: Any, *, name: object = None, thread: Any = "here") -> Timer:
    """``sb-ext:make-timer``: a timer that calls ``function`` in ``thread``; by default the one that makes it, with T or nil a new one."""
    if thread == "here":
        runs_in = thread_of(kernel.current())
    else:
        runs_in = None if thread is None or thread is True else need(thread, Thread, "(OR BOOLEAN SB-THREAD:THREAD)")
    return Timer(function_of(function), name, runs_in)


def schedule_timer(timer: Any, time: Any, *, repeat_interval: Any = None, absolute_p: object = None, catch_up: object = None) -> object:
    """``sb-ext:schedule-timer``: call its function in ``time`` seconds, with ``absolute-p`` at that universal time; then every
    ``repeat-interval`` seconds. One that was scheduled already is scheduled anew. No values."""
    if not is_real(time):
        type_error(time, "NUMBER")
    if repeat_interval is not None and not (is_real(repeat_interval) and repeat_interval > 0):
        type_error(repeat_interval, "(OR NULL (REAL (0)))")
    _timer(timer).stop()
    delay = float(time - get_universal_time() if truth(absolute_p) else time)
    first = kernel.now() + max(delay, 0.0)
    timer.time = first
    if repeat_interval is None:
        timer.running = kernel.call_at(first, timer.fire)
    else:
        timer.running = kernel.call_every(float(repeat_interval), timer.fire, first)
    _scheduled[timer] = True
    return NO_VALUES


def unschedule_timer(timer: Any) -> object:
    """``sb-ext:unschedule-timer``: its function is called no more. No values."""
    _timer(timer).stop()
    return NO_VALUES


def timer_name(timer: Any) -> object:
    """``sb-ext:timer-name``"""
    return _timer(timer).name


def timer_scheduled_p(timer: Any, *, delta: Any = 0) -> bool | None:
    """``sb-ext:timer-scheduled-p``: whether its function will be called, in ``delta`` seconds or later."""
    running = _timer(timer).running
    return boolean(running is not None and running.active and running.time >= kernel.now() + float(delta))


def list_all_timers() -> object:
    """``sb-ext:list-all-timers``: those that are scheduled, the next one first."""
    living = [timer for timer in _scheduled if timer.running is not None and timer.running.active]
    return list_from(sorted(living, key=lambda timer: timer.running.time))


def _print(timer: Timer, stream: Any) -> None:
    print_unreadable(timer, stream, None if timer.name is None else prin1_to_string(timer.name), type_=True, identity=True)


define_printer(Timer, _print)
