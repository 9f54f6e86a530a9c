"""Tracing: recording what fluents were, and when, while a plan runs.

It is a switch for all, off at first, and costs nothing while it is off. While it is on, each pulse of a fluent during an episode is
recorded, and its value at the beginning: that is the beginning of the episode for the fluents that there are, the *global* ones, and
the moment of its making for one that the plan makes; so the statuses of the plan's tasks are recorded, too. ``make-fluent`` may keep a
fluent out, ``:allow-tracing nil``, or have at most so many changes a second recorded, ``:max-tracing-freq``. Nets, which
are computed from what is traced, are not traced themselves. A fluent is known by its name; the records of equally named ones are merged.

Times are rounded to the millisecond. What changes twice in one gets times between, so that the records of a name are in order, one
moment for one value. Source: projection-and-events.md C2.

Where the global fluents are: nobody keeps a list while tracing is off. When it is switched on the garbage collector is asked for
all living fluents, from then on `on_make_fluent_hook` tells of new ones.

Repaired: the last change that a limit of frequency held back is recorded when the episode ends.
"""

from __future__ import annotations

import math
from weakref import WeakSet, ref

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.cpl.tree import finished_plans
from ..cpl.current import current_task
from cramhy_runtime.cpl.tasks.task_observers import follow
from cramhy_runtime.cpl.fluents.fluents import living_fluents, tracing_options
from ..cpl.hooks import on_make_fluent_hook
from cramhy_runtime.lisp_core.conditions import Condition, warn
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from, one, truth
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from ..utilities.small_functions import current_timestamp
from . import symbols  # noqa: F401  the package must exist
from .knowledge import episode_of

MILLISECOND, STEP = 0.001, 0.0001

durable_copy = generic(
    "CRAM-EXECUTION-TRACE::DURABLE-COPY",
    "(obj)",
    documentation="""
A snapshot of ``obj`` for the trace: a list is copied one level deep, anything else is itself. Add methods for what is changed in place.""",
)


@durable_copy.method(object)
def _itself(obj):
    return obj


@durable_copy.method(Cons)
def _copied(obj):
    cars = []
    while isinstance(obj, Cons):
        cars.append(obj.car)
        obj = obj.cdr
    return list_from(cars, obj)


class TracedFluent:
    """One record: the fluent called ``name`` got the value ``traced_value`` at ``timestamp`` (seconds)."""

    __slots__ = ("name", "traced_value", "timestamp")
    lisp_name = "CRAM-EXECUTION-TRACE::TRACED-FLUENT"
    initargs = {"NAME": "name", "TRACED-VALUE": "traced_value", "TIMESTAMP": "timestamp"}

    def __init__(self, name=None, traced_value=None, timestamp=None):
        self.name, self.traced_value, self.timestamp = name, traced_value, timestamp


def distinct(time, last):
    """The time to be recorded for something at ``time`` when there is a record of ``last`` already: later, and within its millisecond."""
    time = round(time, 3)
    if time > last:
        return float(time)
    end = math.floor(last / MILLISECOND + 1 + 1e-6) * MILLISECOND
    later = last + min(STEP, (end - last) / 10)
    return float(later if later > last else math.nextafter(last, math.inf))


class Recorder:
    """Records what happens to fluents during one episode. It holds no fluent alive."""

    def __init__(self, episode):
        self.episode = episode
        self.watched = []  # (weak reference to a fluent, name of the callback)
        self.held_back = {}  # name → (value, time) that came too early for the limit of its fluent

    def watch(self, fluent):
        """Record what ``fluent`` is now, and each of its pulses from now on, unless it was made not to be traced."""
        allowed, frequency = tracing_options.get(fluent, (True, None))
        if not truth(allowed):
            return
        name, interval = fluent.name, None if frequency is None else 1 / float(frequency)
        try:
            self.record(name, fluent.peek())
        except (Condition, Exception) as problem:  # a fluent of the user's, whose value cannot be computed yet
            warn("The fluent ~a has no value that could be traced yet: ~a", name, problem)
        key = Symbol("TRACE")
        if fluent.callbacks is None:
            fluent.callbacks = {}
        fluent.callbacks[key] = (
            (lambda value: self.record(name, value)) if interval is None else (lambda value: self.record_seldom(name, value, interval))
        )
        self.watched.append((ref(fluent), key))

    def record(self, name, value, time=None):
        records = self.episode.traces.setdefault(name, [])
        time = current_timestamp() if time is None else time
        records.append(TracedFluent(name, one(durable_copy(value)), distinct(time, records[-1].timestamp if records else -math.inf)))

    def record_seldom(self, name, value, interval):
        records, now = self.episode.traces.get(name), current_timestamp()
        if records and now - records[-1].timestamp < interval - 1e-9:
            self.held_back[name] = (one(durable_copy(value)), now)
        else:
            self.held_back.pop(name, None)
            self.record(name, value)

    def stop(self):
        """Record no more."""
        for reference, key in self.watched:
            fluent = reference()
            if fluent is not None and fluent.callbacks:
                fluent.callbacks.pop(key, None)
        for name, (value, time) in self.held_back.items():
            self.record(name, value, time)
        self.watched, self.held_back = [], {}
        self.episode.recorder = None


def trace_status(task):
    """Of each task of a traced plan that starts: it makes its status fluent, which is traced then."""
    task.status_fluent  # noqa: B018  asking makes it


class Tracing:
    """The switch, and what is to be done while it is on. An observer of plans (``past_plans``)."""

    def __init__(self):
        self.on = False
        self.globals = WeakSet()
        self.recorders = []
        self.saving = None  # called with each episode that ended (auto_tracing)

    # -------------------------------------------------------------------------------------------------------- the switch

    def enable(self):
        if self.on:
            return
        self.on = True
        self.globals.update(living_fluents())
        on_make_fluent_hook.add(lambda *arguments: self.new_fluent(arguments[0]), "EPISODE-KNOWLEDGE")
        self.observe()
        root = _root_of_current_plan()
        if root is not None:
            self.begins(root, None)

    def disable(self):
        self.on = False
        on_make_fluent_hook.remove("EPISODE-KNOWLEDGE")
        for recorder in list(self.recorders):
            self.finish(recorder)
        self.globals.clear()
        self.observe()

    def observe(self):
        if self.on or self.saving is not None:
            finished_plans.observe(self)
        else:
            finished_plans.observe_no_more(self)

    # ----------------------------------------------------------------------------------------------------------- fluents

    def new_fluent(self, fluent):
        """A fluent was made by ``make-fluent``: by a plan that is traced, or for all."""
        root = _root_of_current_plan()
        recorder = None if root is None else episode_of(root).recorder
        if recorder is not None:
            recorder.watch(fluent)
            return
        self.globals.add(fluent)
        for recorder in self.recorders:
            recorder.watch(fluent)

    # ------------------------------------------------------------------------------------------------------------- plans

    def begins(self, task, name):
        if not self.on:
            return
        follow(task, trace_status)
        episode = episode_of(task)
        recorder = episode.recorder = Recorder(episode)
        self.recorders.append(recorder)
        for fluent in sorted(self.globals, key=lambda fluent: fluent.number):
            recorder.watch(fluent)

    def beside(self, task):
        """Process modules are no plan; their fluents are traced as all others are."""

    def made(self, task):
        if self.on:
            trace_status(task)

    def ended(self, task, name):
        recorder = task.__dict__["episode"].recorder if "episode" in task.__dict__ else None
        if recorder is not None:
            self.finish(recorder)
        if self.saving is not None:
            self.saving(episode_of(task))

    def finish(self, recorder):
        recorder.stop()
        if recorder in self.recorders:
            self.recorders.remove(recorder)


tracing = per_image(Tracing())


def _root_of_current_plan():
    task = current_task() if kernel.active() is not None else None
    while task is not None and task.parent is not None:
        task = task.parent
    return task


def enable_fluent_tracing():
    """Trace fluents from now on; returns t."""
    tracing.enable()
    return True


def disable_fluent_tracing():
    """Trace no fluents any more; what was recorded stays. Returns nil."""
    tracing.disable()


def fluent_tracing_enabled():
    return True if tracing.on else None
