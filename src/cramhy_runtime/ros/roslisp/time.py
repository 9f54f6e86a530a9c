"""Wait and loop by the clock, as roslisp does.

All waits here park, so in virtual time they take no real time (law 5). Source: roslisp.md 9.
"""

from __future__ import annotations

from contextlib import contextmanager

from ... import kernel
from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import MultipleValues, Symbol, one, truth
from cramhy_runtime.lisp_core.functions import function_named
from cramhy_runtime.lisp_core.numbers import need_real
from .. import graph
from . import logging
from .clock import ros_time
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

T = TypeVar("T")


def spin_until_ros_time_valid() -> None:
    """Wait until `ros_time` is above zero. It looks every 0.05 s and warns every 100 looks."""
    looks = 0
    while not ros_time() > 0:
        looks += 1
        if looks % 100 == 0:
            logging.log_text(logging.WARN, ("ROSLISP", "TIME"), "Waiting for valid ros-time before proceeding")
        kernel.sleep(0.05)


def wait_duration(d: float) -> bool:
    """Wait until ``d`` seconds of ROS time have passed; returns T."""
    seconds = float(need_real(d))
    node = graph.active().lisp_node
    if node is None or getattr(node, "simulated_time", None) is None:
        kernel.sleep(seconds)
        return True
    end = ros_time() + seconds
    while ros_time() < end:
        kernel.sleep(0.01)
    return True


def loop_at_most_every(d: float, body: Callable[[], object]) -> NoReturn:
    """Call ``body`` for ever, at most once per ``d`` seconds, the first time at once. Only a non-local exit ends the loop."""
    period = float(need_real(d))
    while True:
        next_time = kernel.now() + period
        body()
        rest = next_time - kernel.now()
        kernel.sleep(rest)  # zero and less yields, so an endless loop can be ended


def spin_until(test: Callable[[], object], increment: float, body: Callable[[], object] | None = None, timeout: float | None = None) -> Any:
    """Call ``test`` every ``increment`` seconds until it is true; returns its values. After each false test, call ``body``.

    After ``timeout`` seconds, returns two values, NIL and T. ``test`` is called at least once.
    """
    end = None if timeout is None else kernel.now() + float(need_real(timeout))
    while True:
        value = test()
        if truth(one(value)):
            return value
        if end is not None and kernel.now() >= end:
            return MultipleValues((None, True))
        if body is not None:
            body()
        pause = float(need_real(increment))
        kernel.sleep(pause if end is None else max(0.0, min(pause, end - kernel.now())))


def with_parallel_thread(function: Callable[[], object] | Symbol, name: str | None, body: Callable[[], T]) -> T:
    """Run ``function`` in a task called ``name`` while ``body`` runs, then end the task. Returns the values of ``body``.

    ``function`` may be a symbol that names the function.
    """
    if isinstance(function, Symbol):
        name = name if name is not None else function.name
        function = function_named(function)
    if not callable(function):
        return type_error(function, "FUNCTION")
    with running_beside(function, str(name)):
        return body()


@contextmanager
def running_beside(function: Callable[[], object], name: str) -> Iterator[None]:
    """``with running_beside(watch, "watcher"):`` a task of its own calls ``function`` while the block runs, and is dead after it."""
    task = kernel.spawn(function, name=name)
    try:
        yield
    finally:
        task.cancel("the block that it ran beside is over")
        with kernel.shield():
            task.join(claim=False)
