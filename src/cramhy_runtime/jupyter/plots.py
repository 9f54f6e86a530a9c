"""Fluents over time: their values while a notebook watches them, drawn as SVG.

``%watch *distance*`` begins it. The values are read at the ends of instants, as the live page reads them, so a plan does the same things
watched and unwatched. Numbers become step lines, since a fluent keeps its value until it gets another; each number in a message of ROS has
a line of its own. Other values become pieces of a band with their text.
"""

from __future__ import annotations

import math
from html import escape

from cramhy_runtime import kernel
from cramhy_runtime.cpl.fluents.fluents import Fluent, peek_value
from cramhy_runtime.cpl.fluents.nets import Net
from cramhy_runtime.cpl.tree.tree_report import short
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import guarded
from cramhy_runtime.ros.messages import RosMessage

MOST_VALUES = 4000
"""Values that are kept of one fluent; with more, every second one of them is left out."""
MOST_LINES = 6
"""Numbers of one message that are drawn."""
WIDTH, HEIGHT, BAND = 560, 130, 26
LEFT, RIGHT, ABOVE, BELOW = 64, 12, 22, 18
COLOURS = ["#1f77b4", "#d95f02", "#2e8b57", "#7b3fb0", "#c62828", "#6b5b4b"]


class Series:
    """The values of one fluent: ``samples``, pairs of a time in seconds and a value, the oldest first."""

    def __init__(self, fluent):
        self.fluent = fluent
        self.samples = []
        self._pulses = None
        self._every = 1  # of so many changes one is kept
        self._left = 0

    @property
    def name(self):
        """The fluent's name as text."""
        name = self.fluent.name
        return str(symbol_name(name)) if hasattr(name, "name") else str(name)

    def take(self, now):
        """Note the value at the time ``now`` if it is another than before; whether it is."""
        fluent = self.fluent
        if not isinstance(fluent, Net) and fluent.pulses == self._pulses:
            return False
        self._pulses = fluent.pulses
        value = kept(guarded(lambda: one(peek_value(fluent)), lambda problem: f"(no value: {type(problem).__name__})"))
        if self.samples and self.samples[-1][1] == value:
            return False
        self._left -= 1
        if self.samples and self.samples[-1][0] == now:
            self.samples[-1] = (now, value)
        elif self._left <= 0:
            self._left = self._every
            self.samples.append((now, value))
        if len(self.samples) > MOST_VALUES:
            self.samples[:-1] = self.samples[:-1:2]
            self._every *= 2
        return True


def kept(value):
    """What is kept of a value: a number, a dictionary of numbers, or a text."""
    if is_real(value) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return math.inf if value > 0 else -math.inf
    if isinstance(value, RosMessage) and (found := dict(numbers(value))):
        return found
    return short(value)


def numbers(message, before=""):
    """(name, number) of the numbers in a message and in the messages in it, the first `MOST_LINES`."""
    found = []
    for name in message.field_names:
        value = getattr(message, name)
        if isinstance(value, RosMessage):
            found += numbers(value, f"{before}{name}.")
        elif is_real(value) and not isinstance(value, bool):
            found.append((f"{before}{name}", float(value)))
    return found[:MOST_LINES]


class Watched:
    """The fluents that a notebook watches. Its methods are called with the baton."""

    def __init__(self):
        self.series = []
        self.changed = False

    def watch(self, values):
        """Watch the fluents ``values`` from now on. Other values are a `ValueError`."""
        for value in values:
            if not isinstance(value, Fluent):
                raise ValueError(f"%watch is for fluents, and {short(value)} is none. Give it forms whose values are fluents.")
        if not values:
            raise ValueError("%watch is for fluents: give it forms whose values are fluents, or off.")
        if not self.series:
            kernel.active().watch_instants(self.take)
        known = {id(each.fluent) for each in self.series}
        self.series += [Series(value) for value in dict.fromkeys(values) if id(value) not in known]
        self.take()

    def end(self):
        """Watch nothing more."""
        self.series = []
        kernel.active().unwatch_instants(self.take)

    def take(self):
        """Note the values of now."""
        now = kernel.now()
        for each in self.series:
            self.changed |= each.take(now)

    def of(self, fluent):
        """The `Series` of a fluent that has changed while it was watched, or ``None``."""
        return next((each for each in self.series if each.fluent is fluent and len(each.samples) > 1), None)

    def picture(self):
        """The mime bundle of all of them."""
        names = ", ".join(each.name for each in self.series)
        return {"image/svg+xml": svg(self.series, kernel.now()), "text/plain": f"fluents over time: {names}"}


# ---------------------------------------------------------------------------------------------------------------- drawing


def svg(series, now):
    """The SVG of some `Series`, one below the other, with one axis of time that ends at ``now``, in seconds."""
    begin = min((each.samples[0][0] for each in series if each.samples), default=now)
    end = max(now, begin + 1e-3)
    parts, top = [], 0
    for each in series:
        drawn, height = panel(each, begin, end)
        parts.append(f'<g transform="translate(0 {top})">{drawn}</g>')
        top += height
    title = escape(", ".join(each.name for each in series))
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {top + BELOW}" width="{WIDTH}" height="{top + BELOW}" role="img"'
    style = 'font-family="sans-serif" font-size="11" fill="#333"'
    times = _text(LEFT, top + 12, _number(begin) + " s") + _text(WIDTH - RIGHT, top + 12, _number(end) + " s", "end")
    return f'{head} {style}>\n<title>{title}</title><rect width="100%" height="100%" fill="#fff"/>{"".join(parts)}{times}</svg>\n'


def panel(series, begin, end):
    """(the SVG of one `Series` between two times, its height)."""
    lines = as_lines(series.samples)
    across = (WIDTH - LEFT - RIGHT) / (end - begin)
    bands = not lines
    height = ABOVE + (BAND if bands else HEIGHT - ABOVE - 8) + 8
    legend = [] if bands or list(lines) == [""] else list(lines)
    parts = [_text(LEFT, 15, series.name, more=' font-weight="bold"')]
    place = LEFT + 7 * len(series.name) + 20
    for number, label in enumerate(legend):
        parts.append(_text(place, 15, label, more=f' fill="{COLOURS[number % len(COLOURS)]}"'))
        place += 7 * len(label) + 12
    draw = _bands if bands else _steps
    parts.append(draw(series.samples if bands else lines, lambda time: LEFT + (time - begin) * across, end))
    return "".join(parts), height


def as_lines(samples):
    """The samples as step lines, a dictionary of a label and its points; empty if there are values that are not numbers."""
    lines = {}
    for time, value in samples:
        if isinstance(value, str) and value != "NIL":  # a fluent without a value yet is NIL
            return {}
        for label, number in value.items() if isinstance(value, dict) else [("", value)] if not isinstance(value, str) else []:
            lines.setdefault(label, []).append((time, number))
    return lines


def _steps(lines, x, end):
    finite = [number for points in lines.values() for _, number in points if math.isfinite(number)]
    low, high = min(finite, default=0.0), max(finite, default=1.0)
    if high - low < 1e-9:
        low, high = low - 0.5, high + 0.5
    up = (HEIGHT - ABOVE - 16) / (high - low)

    def y(number):
        return HEIGHT - 8 - (min(max(number, low), high) - low) * up

    box = f'<path d="M{LEFT} {ABOVE}V{HEIGHT - 8}H{WIDTH - RIGHT}" fill="none" stroke="#999"/>'
    parts = [box, _text(LEFT - 4, y(high) + 4, _number(high), "end"), _text(LEFT - 4, y(low) + 4, _number(low), "end")]
    for number, points in enumerate(lines.values()):
        drawn = [point for point in points if not math.isnan(point[1])]
        if drawn:
            path = f"M{x(drawn[0][0]):.1f} {y(drawn[0][1]):.1f}" + "".join(f"H{x(time):.1f}V{y(value):.1f}" for time, value in drawn[1:])
            parts.append(f'<path d="{path}H{x(end):.1f}" fill="none" stroke="{COLOURS[number % len(COLOURS)]}" stroke-width="1.5"/>')
    return "".join(parts)


def _bands(samples, x, end):
    parts, known = [], list(dict.fromkeys(text if isinstance(text, str) else str(text) for _, text in samples))
    for (time, value), (until, _) in zip(samples, [*samples[1:], (end, None)]):
        text, left = str(value), x(time)
        wide = max(x(until) - left, 1.0)
        colour = COLOURS[known.index(text) % len(COLOURS)]
        shade = 'fill-opacity=".2"'
        parts.append(f'<rect x="{left:.1f}" y="{ABOVE}" width="{wide:.1f}" height="{BAND}" fill="{colour}" {shade} stroke="{colour}"/>')
        if fits := text[: int((wide - 6) / 6.5)]:
            parts.append(_text(left + 4, ABOVE + 17, fits if fits == text else f"{fits[:-1]}…"))
    return "".join(parts)


def _text(x, y, text, anchor="start", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{escape(text)}</text>'


def _number(value):
    return f"{value:.4g}"
