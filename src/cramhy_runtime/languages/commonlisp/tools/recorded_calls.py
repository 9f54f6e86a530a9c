"""Calls that are recorded while they happen, for those who look at them afterwards: who called what, with which values, and what came back.

A function is recorded as ``trace`` watches it, but nothing is printed. A call that a recorded function makes, also in a branch of a
plan that it starts, is recorded as a part of it. The values themselves are kept, not their texts, so that they can be inspected.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import all_values
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.kernel.images import per_image

from . import tracing

MOST = 20_000
"""Calls that are kept. Later ones run without being recorded."""
INSIDE, LEFT = "still inside", "exited non-locally"

_calls: list = per_image([])


class RecordedCall:
    """A call. number: in the order in which the calls began. name: of the function. arguments: its values, a list. outer: the
    `RecordedCall` that made it, or ``None``. outcome: `INSIDE`, `LEFT`, or the values, a list. began: seconds of the session's clock.
    """

    def __init__(self, name, arguments, outer):
        self.number, self.name, self.arguments, self.outer = len(_calls), name, arguments, outer
        self.outcome, self.inner, self.began, self.task = INSIDE, [], kernel.now(), kernel.current().name
        if outer is not None:
            outer.inner.append(self)
        _calls.append(self)

    def __repr__(self):
        return f"call {self.number} of {prin1_to_string(self.name)}"

    @property
    def ended(self):
        """Whether it has returned, or was left."""
        return self.outcome is not INSIDE


def _around():
    """The recorded call that the current task is in, or else the task above it."""
    task = kernel.current()
    while task is not None:
        found = getattr(task._local, "recorded_call", None)
        if found is not None:
            return found
        task = task.parent
    return None


class Recorder(tracing.Trace):
    """Records the calls of one function."""

    prints = False

    def watch(self, function, arguments, keywords):
        if len(_calls) >= MOST:
            return function(*arguments, **keywords)
        local = kernel.current().local
        before = getattr(local, "recorded_call", None)
        call = local.recorded_call = RecordedCall(self.name, list(arguments), _around())
        try:
            result = function(*arguments, **keywords)
            call.outcome = all_values(result)
        finally:
            local.recorded_call = before
            if not call.ended:
                call.outcome = LEFT
        return result


def record(name):
    """Record the calls of the function called ``name`` from now on; whether there is one."""
    return tracing.install(Recorder(name, {}))


def names():
    """The names of the functions whose calls are recorded."""
    return [entry.name for entry in tracing.watching() if isinstance(entry, Recorder)]


def is_recorded(name):
    """Whether the calls of the function called ``name`` are recorded."""
    return isinstance(tracing.entry_of(name), Recorder)


def calls():
    """The `RecordedCall`s, the oldest first."""
    return _calls


def forget():
    """Forget all calls."""
    _calls.clear()


__all__ = ["INSIDE", "LEFT", "MOST", "RecordedCall", "Recorder", "calls", "forget", "is_recorded", "names", "record"]
