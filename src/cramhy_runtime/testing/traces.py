"""Marks that a plan leaves, and assertions about their order.

    def plan():
        mark("reach")
        cpl.par(lambda: (cpl.sleep(1), mark("grasp")), lambda: mark("look"))
        mark("done")

    trace = testing.run(lambda: cpl.top_level(plan)).trace
    assert_order(trace, ("reach", "grasp", "done"), ("reach", "look", "done"))

A plan with branches has more than one right order of events, so a test that compares lists breaks when nothing is wrong. The right thing to
test is a *partial* order: reach before grasp, with anything in between. In Lisp, ``(mark :reach)`` is the same event.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn
from .labels import label

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from cramhy_runtime.cpl.signatures import Name


class Event:
    """A mark: its ``name``, the ``time`` (seconds of virtual time), the label of the ``task`` that left it, its ``number`` in the trace,
    and its ``value``."""

    __slots__ = ("name", "time", "task", "number", "value")

    def __init__(self, name: str, time: float, task: str, number: int, value: Any):
        self.name, self.time, self.task, self.number, self.value = name, time, task, number, value

    def __str__(self) -> str:
        value = "" if self.value is None else f" {self.value}"
        return f"{self.time:8.3f} s  {self.name}{value}  ({self.task})"

    def __repr__(self) -> str:
        return f"<mark {self.name} at {self.time:g} s>"


class Trace:
    """The marks of one run, in the order in which they were left."""

    def __init__(self) -> None:
        self.events: list[Event] = []

    def __iter__(self) -> Iterator[Event]:
        return iter(self.events)

    def __len__(self) -> int:
        return len(self.events)

    @property
    def names(self) -> list[str]:
        """The names, in order."""
        return [event.name for event in self.events]

    def named(self, name: Name) -> list[Event]:
        """The events of one name, a string or a Lisp symbol."""
        name = spelled(name)
        return [event for event in self.events if event.name == name]

    def __str__(self) -> str:
        return "\n".join(map(str, self.events)) or "(no marks)"


def spelled(name: Name) -> str:
    """The name of a mark as tests write it: Lisp symbols and keywords are in lower case."""
    return name.name.lower() if isinstance(name, Symbol) else str(name)


def mark(name: Name, value: object = None) -> None:
    """Leave a mark in the trace of the test that runs; outside of tests do nothing. Returns nil."""
    active = kernel.active()
    trace = getattr(active, "trace", None)
    if trace is not None:
        trace.events.append(Event(spelled(name), active.now(), label(active.current), len(trace), value))


def assert_order(trace: Trace, *chains: Sequence[Name]) -> None:
    """Assert for each chain of names that every event of a name comes before all events of the next name. Each name must occur.

    Raises AssertionError.
    """
    for chain in chains:
        groups = [_some(trace, name) for name in chain]
        for before, after in zip(groups, groups[1:], strict=False):
            last, first = before[-1], after[0]
            if last.number > first.number:
                _fail(trace, f"{first.name} came before {last.name}: it should be {' < '.join(map(spelled, chain))}.", (last, first))


def assert_before(trace: Trace, before: Name, after: Name) -> None:
    """Assert that every event ``before`` comes before every event ``after``. Both must occur. Raises AssertionError."""
    assert_order(trace, (before, after))


def assert_after(trace: Trace, after: Name, before: Name) -> None:
    """Assert that every event ``after`` comes after every event ``before``. Both must occur. Raises AssertionError."""
    assert_order(trace, (before, after))


def assert_concurrent(trace: Trace, *names: Name) -> None:
    """Assert that each pair of names overlaps in time. The span of a name is from its first to its last mark. Each name must occur.

    Mark the beginning and the end of a step with the same name. One mark is a span without length. Raises AssertionError.
    """
    spans = [(name, _some(trace, name)) for name in names]
    for index, (_, one) in enumerate(spans):
        for _, other in spans[index + 1 :]:
            if one[-1].time < other[0].time or other[-1].time < one[0].time:
                first, second = sorted((one, other), key=lambda events: events[0].time)
                _fail(
                    trace,
                    f"{first[0].name} was over at {first[-1].time:g} s, before {second[0].name} began at "
                    f"{second[0].time:g} s: they should overlap.",
                    (first[-1], second[0]),
                )


def assert_never(trace: Trace, *names: Name) -> None:
    """Assert that none of the names was marked. Raises AssertionError."""
    for name in names:
        events = trace.named(name)
        if events:
            _fail(trace, f"{spelled(name)} happened, which it should not.", events)


def assert_times(trace: Trace, name: Name, times: int) -> None:
    """Assert that ``name`` was marked ``times`` times. Raises AssertionError."""
    events = trace.named(name)
    if len(events) != times:
        _fail(trace, f"{spelled(name)} happened {len(events)} times, not {times}.", events)


def _some(trace: Trace, name: Name) -> list[Event]:
    events = trace.named(name)
    if not events:
        known = ", ".join(dict.fromkeys(trace.names)) or "none"
        _fail(trace, f"{spelled(name)} did not happen. Marks that did: {known}.", ())
    return events


def _fail(trace: Trace, text: str, pointed: Sequence[Event]) -> NoReturn:
    lines = [("> " if event in pointed else "  ") + str(event) for event in trace]
    raise AssertionError("\n".join([text, *(lines or ["  (no marks)"])]))
