"""Moving pictures: the replay of a `History`, as an SVG file for any browser, or as a GIF.

The SVG is one file without scripts or external parts. SMIL animations move the turtles and draw the lines (``stroke-dashoffset``).
All are as long as the whole replay, which repeats. A viewer without animation shows the last picture. The GIF has twenty frames a
second, painted pixel by pixel like the paper itself; frames without a change take no room.

By default, a replay takes at most `LONGEST` seconds: longer histories run two, three, ... times as fast. The last picture stays for
`REST` seconds.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from html import escape

from .. import storage
from . import sprites, stills
from .canvas import Canvas
from .strokes import thinned_by
from .dimensions import EXTENT, METRE, SIZE
from .world import TICK
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .history import History


LONGEST = 30.0
UTMOST = 600.0
"""The longest allowed replay, in seconds: a GIF can show one picture for ten minutes at most, and it has twenty a second."""
REST = 2.0
FRAME = 0.05
_CLOSE, _TURNED, _SHARP = 0.015, 0.05, 0.005
"""The allowed error of a turtle's place, in metres, of its heading, in radians, and of a line, in metres."""


def speed_for(history: History, speed: float | None = None) -> float:
    """The speed of a replay, in seconds of plan time per second: ``speed``, or if it is ``None``, the default (see the module)."""
    return speed or max(1.0, math.ceil(history.ticks * TICK / LONGEST))


# --------------------------------------------------------------------------------------------------------------------- SVG


def write_svg(history: History, path: str, speed: float | None = None) -> None:
    """Write the replay of ``history`` to ``path``, as an animated SVG. ``speed``: see `speed_for`. Errors: `OSError`."""
    speed = speed_for(history, speed)
    writer = _Writer(history.ticks * TICK / speed + REST, speed)
    names = sorted({track.name for track in history.tracks})
    title = escape(f"turtlesim: {', '.join(names)}; {history.ticks * TICK:.0f} s" + (f", {speed:g} times as fast" if speed != 1 else ""))
    parts = [stills.svg_head(title)]
    eras = history.eras()
    for index, (begin, background, strokes) in enumerate(eras):
        end = eras[index + 1][0] if index + 1 < len(eras) else None
        shown = writer.shown(begin, end)
        lines = [writer.line(*polyline) for polyline in _polylines(strokes)]
        parts.append(f"<g{shown[0]}>{shown[1]}{stills.svg_paper(background)}\n" + "\n".join(lines) + "</g>")
    for track in sorted(history.tracks, key=lambda track: track.name):
        if track.ticks:
            parts.append(writer.turtle(track))
    storage.write_whole(path, "\n".join([*parts, "</svg>\n"]))


class _Writer:
    """Elements with their animations, all ``length`` seconds long."""

    def __init__(self, length, speed):
        self.length, self.speed = length, speed

    def share(self, tick):
        """The place of a tick in the replay, between 0 and 1."""
        return min(tick * TICK / self.speed / self.length, 1.0)

    def animation(self, element, attribute, moments, more=""):
        """An animation of ``attribute``. ``moments``: [(share, value), ...] in order.

        The first value holds from the beginning, the last one to the end.
        """
        moments = [(0.0, moments[0][1]), *moments, (1.0, moments[-1][1])]
        times = ";".join(f"{share:.5f}".rstrip("0").rstrip(".") for share, _ in moments)
        values = ";".join(value for _, value in moments)
        return (
            f'<{element} attributeName="{attribute}"{more} dur="{self.length:.2f}s" repeatCount="indefinite" '
            f'keyTimes="{times}" values="{values}"/>'
        )

    def shown(self, begin, end):
        """(attribute, animation) of an element that is there from one tick to another, or to the end."""
        if begin == 0 and end is None:
            return "", ""
        moments = [(0.0, "none" if begin else "inline")]
        if begin:
            moments.append((self.share(begin), "inline"))
        if end is not None:
            moments.append((self.share(end), "none"))
        return ' display="none"' * (end is not None), self.animation("animate", "display", moments, ' calcMode="discrete"')

    def line(self, colour, width, points):
        """A polyline drawn in the course of the replay. ``points``: [(x, y, tick), ...], in metres on the screen."""
        begin = points[0][2]
        attribute, animations = self.shown(begin, None)
        way, moments = 0.0, [(self.share(begin), 0.0)]
        for (x1, y1, _), (x2, y2, tick) in zip(points, points[1:]):
            way += math.hypot(x2 - x1, y2 - y1) * METRE
            moments.append((self.share(tick), way))
        if way > 1.0 and moments[-1][0] > moments[0][0]:
            attribute += f' pathLength="{way:.1f}" stroke-dasharray="{way:.1f} {way + 50:.1f}"'
            animations += self.animation("animate", "stroke-dashoffset", [(share, f"{way - gone:.1f}") for share, gone in moments])
        drawn = stills.svg_line(colour, width, points, attribute)
        return drawn.replace("/>", f">{animations}</path>") if animations else drawn

    def turtle(self, track):
        """A turtle that moves along its track."""
        way = _moved(track.samples())
        attribute, animations = self.shown(track.begin, track.end)
        places = [(self.share(tick), f"{x * METRE:.1f} {y * METRE:.1f}") for tick, x, y, _ in way]
        turns = [(self.share(tick), f"{-math.degrees(heading):.1f}") for tick, _, _, heading in way]
        transform = ' type="{}"'
        return (
            f'<g transform="translate({places[-1][1]})"{attribute}><title>{escape(track.name)}</title>{animations}'
            + (self.animation("animateTransform", "transform", places, transform.format("translate")) if len(way) > 1 else "")
            + f'<g transform="rotate({turns[-1][1]})">'
            + (self.animation("animateTransform", "transform", turns, transform.format("rotate")) if len(way) > 1 else "")
            + f"{stills.svg_turtle(track.number)}</g></g>"
        )


def _moved(samples):
    """The samples of a track, without jumps of the heading by a whole turn, and without those on an even way between others."""
    unwrapped, heading = [], samples[0][3]
    for tick, x, y, wrapped in samples:
        heading += (wrapped - heading + math.pi) % (2 * math.pi) - math.pi
        unwrapped.append((tick, x, y, heading))
    return _evenly(unwrapped, (_CLOSE, _CLOSE, _TURNED))


def _evenly(samples, tolerances):
    """The samples (tick, value, ...) without those that differ less than the tolerances from an even change between others."""
    return thinned_by(lambda begin, end: _passes(samples, begin, end, tolerances), samples, 64)


def _passes(samples, begin, end, tolerances):
    first, last = samples[begin], samples[end]
    span = last[0] - first[0]
    for index in range(begin + 1, end):
        there = samples[index]
        share = (there[0] - first[0]) / span if span else 0.0
        for axis, tolerance in enumerate(tolerances, 1):
            if not abs(first[axis] + share * (last[axis] - first[axis]) - there[axis]) <= tolerance:
                return False
    return True


def _polylines(strokes):
    """[(colour, width, [(x, y, tick), ...]), ...], in metres on the screen: connected strokes, thinned in place and time."""
    found, ending = [], {}
    for tick, x1, y1, x2, y2, colour, width in strokes:
        points = ending.pop((x1, y1, colour, width), None)
        if points is None or points[-1][0] < tick - 1:
            points = [(max(tick - 1, 0), x1, EXTENT - y1)]
            found.append((colour, width, points))
        points.append((tick, x2, EXTENT - y2))
        ending[x2, y2, colour, width] = points
    return [(colour, width, [(x, y, tick) for tick, x, y in _evenly(points, (_SHARP, _SHARP))]) for colour, width, points in found]


# --------------------------------------------------------------------------------------------------------------------- GIF


def write_gif(history: History, path: str, speed: float | None = None) -> None:
    """Write the replay of ``history`` to ``path``, as a GIF that repeats. ``speed``: see `speed_for`. Errors: `OSError`."""
    moments = _moments(history, speed_for(history, speed))
    palette = _palette(history, [*moments[:: max(len(moments) // 6, 1)][:6], moments[-1]])
    frames = (image.quantize(palette=palette, dither=0) for image in _painted(history, moments))
    first = next(frames)
    with storage.writing(path) as file:
        stills.save_image(
            first,
            file,
            "GIF",
            save_all=True,
            append_images=frames,
            duration=[round(moment[3] * 1000) for moment in moments],
            loop=0,
            disposal=1,
            optimize=False,
        )


def _palette(history, moments):
    """A palette with the colours of some frames."""
    from PIL import Image

    sheet = Image.new("RGB", (SIZE, SIZE * len(moments)))
    for index, image in enumerate(_painted(history, moments)):
        sheet.paste(image, (0, SIZE * index))
    return sheet.quantize(256, method=Image.Quantize.MEDIANCUT, dither=0)


def _moments(history, speed):
    """[[era, number of its strokes, turtles, seconds], ...]: the frames, each with the time that it is shown."""
    step = FRAME * speed / TICK
    eras = history.eras()
    tracks = [(track, track.samples()) for track in sorted(history.tracks, key=lambda track: track.name) if track.ticks]
    moments, era = [], 0
    for frame in range(math.ceil(history.ticks / step) + 1):
        tick = min(frame * step, history.ticks)
        while era + 1 < len(eras) and eras[era + 1][0] <= tick:
            era += 1
        drawn = bisect_left(eras[era][2], (tick + 1e-9,))
        turtles = [
            (track.number, *_place(samples, tick))
            for track, samples in tracks
            if track.begin <= tick and (track.end is None or tick < track.end)
        ]
        if moments and moments[-1][:3] == [era, drawn, turtles]:
            moments[-1][3] += FRAME
        else:
            moments.append([era, drawn, turtles, FRAME])
    moments[-1][3] += REST
    return moments


def _painted(history, moments):
    """Yield the Pillow images of ``moments``, in order."""
    from PIL import Image

    eras = history.eras()
    canvas, at, done = Canvas(eras[0][1]), 0, 0
    for era, drawn, turtles, _ in moments:
        if era != at:
            canvas.clear(eras[era][1])
            at, done = era, 0
        for _, x1, y1, x2, y2, colour, width in eras[era][2][done:drawn]:
            canvas.line(x2, EXTENT - y2, x1, EXTENT - y1, colour, width)
        done = drawn
        image = Image.frombytes("RGB", (SIZE, SIZE), canvas.rgb())
        for turtle in turtles:
            sprites.put(image, *turtle)
        yield image


def _place(samples, tick):
    """(x, y, heading) at a tick: of the last sample, or on the way to the next one."""
    index = bisect_left(samples, (tick + 1e-9,))
    if index == 0:
        return samples[0][1:]
    first = samples[index - 1]
    if index == len(samples):
        return first[1:]
    last = samples[index]
    share = (tick - first[0]) / (last[0] - first[0])
    turn = (last[3] - first[3] + math.pi) % (2 * math.pi) - math.pi
    return first[1] + share * (last[1] - first[1]), first[2] + share * (last[2] - first[2]), first[3] + share * turn
