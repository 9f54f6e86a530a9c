"""Our own turtles: fourteen drawings, each a pile of filled outlines in a box of one by one.

The original has fourteen little pictures of turtles. This module has our own, as vector paths; the pictures of this room
(`pictures`) and the live page both use them. The box is one metre of the world wide, with the turtle's position in the middle. x
goes ahead along the heading (the head looks to +x), y goes to the turtle's *right*, as on a screen when the turtle looks to the
right. So a picture has its place on the paper of 500 by 500 pixels at ``translate(x, y) rotate(-theta) scale(45)``.
Source of the number and the size of the pictures: turtlesim.md 2, 3, 9.
"""

from __future__ import annotations

import math
from functools import cache

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Shape

OUTLINE, WHITE, PUPIL = "#1b2a24", "#ffffff", "#14181c"
EDGE = 0.02
"""Width of the dark outline around each shape, in metres."""
_ROUND = 0.5522847498
"""Distance of the control points from the ends of a Bézier curve for a quarter of a circle."""


def shapes() -> list[Shape]:
    """The drawings, in the order in which turtles get them: turtle number ``n`` has ``shapes()[n % 14]``.

    Result: a list of ``{"name": str, "shell": "#rrggbb", "paths": [{"d": path data, "fill": "#rrggbb"}, ...]}``, ready for JSON.
    Paint the paths in that order. The path data have only absolute ``M``, ``L``, ``C`` and ``Z``.
    """
    return [
        {"name": name, "shell": shell, "paths": [{"d": d, "fill": fill} for d, fill in _paths(number)]}
        for number, (name, _, _, shell, _, _, _) in enumerate(PICTURES)
    ]


@cache
def _paths(number):
    """The (path data, colour) of one drawing, the lowest layer first."""
    _, body, pattern, shell, second, skin, rim = PICTURES[number]
    limbs, back = body()
    head = _ellipse(0.36, 0.0, 0.12, 0.105)
    under = [*limbs, head]
    paths = [(_swollen(points), OUTLINE) for points in (*under, back)]
    paths += [(points, skin) for points in under]
    for side in (-1, 1):
        paths.append((_ellipse(0.4, 0.062 * side, 0.036, 0.034), WHITE))
        paths.append((_ellipse(0.413, 0.064 * side, 0.019, 0.019), PUPIL))
    paths += [(back, rim), (_shrunk(back, 0.86), shell)]
    paths += [(points, colour) for points, colour in pattern(shell, second, back)]
    return [(_data(points), colour) for points, colour in paths]


# --------------------------------------------------------------------------------- outlines: lists of cubic Bézier segments
# An outline is (start, [(control, control, end), ...]); a straight side has its controls on the line.


def _ellipse(x, y, along, across, turn=0.0):
    cosine, sine = math.cos(turn), math.sin(turn)

    def at(u, v):
        u, v = u * along, v * across
        return x + u * cosine - v * sine, y + u * sine + v * cosine

    k = _ROUND
    quarters = [((1, k), (k, 1), (0, 1)), ((-k, 1), (-1, k), (-1, 0)), ((-1, -k), (-k, -1), (0, -1)), ((k, -1), (1, -k), (1, 0))]
    return at(1, 0), [tuple(at(*point) for point in quarter) for quarter in quarters]


def _smooth(*points):
    """A closed Catmull-Rom curve through the points."""
    count, segments = len(points), []
    for index in range(count):
        before, start, end, after = (points[(index + step) % count] for step in (-1, 0, 1, 2))
        segments.append(
            (
                (start[0] + (end[0] - before[0]) / 6, start[1] + (end[1] - before[1]) / 6),
                (end[0] - (after[0] - start[0]) / 6, end[1] - (after[1] - start[1]) / 6),
                end,
            )
        )
    return points[0], segments


def _polygon(*points):
    return points[0], [(start, end, end) for start, end in zip(points, (*points[1:], points[0]))]


def _regular(x, y, radius, corners, turn=0.0):
    return _polygon(
        *[
            (x + radius * math.cos(turn + 2 * math.pi * step / corners), y + radius * math.sin(turn + 2 * math.pi * step / corners))
            for step in range(corners)
        ]
    )


def _mirrored(outline):
    start, segments = outline
    return (start[0], -start[1]), [tuple((x, -y) for x, y in segment) for segment in segments]


def _both(*outlines):
    """The outlines and their mirror images on the other side of the turtle."""
    return [each for outline in outlines for each in (outline, _mirrored(outline))]


def _moved(outline, move):
    start, segments = outline
    return move(start), [tuple(move(point) for point in segment) for segment in segments]


def _middle(outline):
    ends = [segment[2] for segment in outline[1]]
    return sum(x for x, _ in ends) / len(ends), sum(y for _, y in ends) / len(ends)


def _shrunk(outline, factor):
    x, y = _middle(outline)
    return _moved(outline, lambda point: (x + (point[0] - x) * factor, y + (point[1] - y) * factor))


def _swollen(outline):
    """The outline, `EDGE` further out on all sides, also on sides that bend inwards, as on a flipper."""
    start, segments = outline
    starts = [start, *(segment[2] for segment in segments[:-1])]
    area = sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(starts, [*starts[1:], start]))
    side = math.copysign(EDGE, area)

    def normal(begin, end):
        along_x, along_y = end[0] - begin[0], end[1] - begin[1]
        length = math.hypot(along_x, along_y)
        return along_y / length * side, -along_x / length * side

    def moved(point, before, after):
        """The corner moved so far that both its sides are `EDGE` further out; a pointed corner moves a little less."""
        share = EDGE**2 / (EDGE**2 + max(before[0] * after[0] + before[1] * after[1], 0.0))
        return point[0] + (before[0] + after[0]) * share, point[1] + (before[1] + after[1]) * share

    # The directions in which each segment sets out and arrives. The controls of a straight side lie on its ends.
    out = [normal(begin, first if first != begin else second) for begin, (first, second, _) in zip(starts, segments)]
    arriving = [normal(second if second != end else first, end) for first, second, end in segments]
    corners = [moved(point, arriving[index - 1], out[index]) for index, point in enumerate(starts)]
    swollen = []
    for index, (first, second, end) in enumerate(segments):
        corner, following = corners[index], corners[(index + 1) % len(segments)]
        if second == end:
            swollen.append((corner, following, following))
        else:
            swollen.append((moved(first, out[index], out[index]), moved(second, arriving[index], arriving[index]), following))
    return corners[0], swollen


def _data(outline):
    start, segments = outline
    text = [f"M{_number(start[0])} {_number(start[1])}"]
    for first, second, end in segments:
        if second == end:
            text.append(f"L{_number(end[0])} {_number(end[1])}")
        else:
            text.append("C" + " ".join(_number(value) for point in (first, second, end) for value in point))
    return "".join(text) + "Z"


def _number(value):
    return f"{round(value, 3) + 0.0:g}"


# ------------------------------------------------------------------------------------------------- bodies: (limbs, shell)


def _pond():
    """Four sturdy legs and a pointed tail."""
    legs = _both(_ellipse(0.21, 0.27, 0.125, 0.08, 0.75), _ellipse(-0.25, 0.255, 0.12, 0.08, 2.35))
    tail = _smooth((-0.3, -0.05), (-0.47, 0.0), (-0.3, 0.05))
    return [*legs, tail], _ellipse(-0.03, 0.0, 0.33, 0.275)


def _sea():
    """Long flippers in front, short ones behind, a shell like a drop."""
    flippers = _both(
        _smooth((0.13, 0.17), (0.25, 0.2), (0.27, 0.33), (0.13, 0.46), (0.02, 0.48), (0.1, 0.36)),
        _smooth((-0.27, 0.1), (-0.36, 0.2), (-0.47, 0.24), (-0.43, 0.13), (-0.36, 0.06)),
    )
    back = _smooth(
        (0.29, 0.0),
        (0.25, 0.15),
        (0.1, 0.25),
        (-0.12, 0.215),
        (-0.32, 0.08),
        (-0.4, 0.0),
        (-0.32, -0.08),
        (-0.12, -0.215),
        (0.1, -0.25),
        (0.25, -0.15),
    )
    return flippers, back


def _dome():
    """A high round shell with four toes under it."""
    toes = _both(_ellipse(0.2, 0.26, 0.09, 0.075), _ellipse(-0.26, 0.24, 0.09, 0.075))
    tail = _smooth((-0.32, -0.04), (-0.43, -0.02), (-0.43, 0.02), (-0.32, 0.04))
    return [*toes, tail], _ellipse(-0.03, 0.0, 0.325, 0.315)


def _robot():
    """Four wheels, an aerial and a case with cut corners."""
    wheels = _both(
        _polygon((0.08, 0.24), (0.3, 0.24), (0.3, 0.37), (0.08, 0.37)), _polygon((-0.32, 0.24), (-0.1, 0.24), (-0.1, 0.37), (-0.32, 0.37))
    )
    aerial = [_polygon((-0.3, -0.015), (-0.44, -0.015), (-0.44, 0.015), (-0.3, 0.015)), _ellipse(-0.445, 0.0, 0.035, 0.035)]
    back = _polygon((0.28, 0.13), (0.18, 0.27), (-0.24, 0.27), (-0.34, 0.17), (-0.34, -0.17), (-0.24, -0.27), (0.18, -0.27), (0.28, -0.13))
    return [*wheels, *aerial], back


# ----------------------------------------------------------------------------------------------- patterns of the shell


def _plates(shell, second, back):
    """A six-cornered plate in the middle and six around it."""
    x, y = _middle(back)
    yield _regular(x, y, 0.105, 6), second
    for step in range(6):
        angle = math.pi / 6 + step * math.pi / 3
        yield _regular(x + 0.19 * math.cos(angle), y + 0.165 * math.sin(angle), 0.06, 6, angle), second


def _diamonds(shell, second, back):
    x, y = _middle(back)
    for ahead in (-0.17, 0.0, 0.17):
        size = 0.1 if ahead == 0.0 else 0.08
        yield _polygon((x + ahead + size * 0.8, y), (x + ahead, y + size), (x + ahead - size * 0.8, y), (x + ahead, y - size)), second
    for outline in _both(
        _polygon((x + 0.15, 0.13), (x + 0.085, 0.185), (x + 0.02, 0.13), (x + 0.085, 0.075)),
        _polygon((x - 0.02, 0.13), (x - 0.085, 0.185), (x - 0.15, 0.13), (x - 0.085, 0.075)),
    ):
        yield outline, second


def _rings(shell, second, back):
    for factor, colour in ((0.68, second), (0.5, shell), (0.32, second)):
        yield _shrunk(back, factor), colour


def _bands(shell, second, back):
    x, y = _middle(back)
    for ahead, half in ((0.15, 0.15), (0.03, 0.19), (-0.09, 0.18), (-0.2, 0.12)):
        yield _smooth((x + ahead + 0.03, y), (x + ahead + 0.005, y + half), (x + ahead - 0.03, y), (x + ahead + 0.005, y - half)), second


def _spots(shell, second, back):
    x, y = _middle(back)
    for ahead, aside, radius in (
        (0.0, 0.0, 0.075),
        (0.15, 0.07, 0.048),
        (0.13, -0.1, 0.04),
        (-0.02, 0.15, 0.045),
        (-0.04, -0.15, 0.05),
        (-0.16, 0.06, 0.042),
        (-0.17, -0.07, 0.05),
    ):
        yield _ellipse(x + ahead, y + aside, radius, radius), second


def _star(shell, second, back):
    x, y = _middle(back)
    yield (
        _polygon(
            *[
                (x + radius * math.cos(step * math.pi / 5), y + radius * math.sin(step * math.pi / 5))
                for step in range(10)
                for radius in (0.19 if step % 2 == 0 else 0.08,)
            ]
        ),
        second,
    )


def _petals(shell, second, back):
    x, y = _middle(back)
    for step in range(6):
        angle = step * math.pi / 3
        yield _ellipse(x + 0.115 * math.cos(angle), y + 0.115 * math.sin(angle), 0.085, 0.045, angle), second
    yield _ellipse(x, y, 0.04, 0.04), WHITE


def _panel(shell, second, back):
    """A dial, three lamps and a grille."""
    x, y = _middle(back)
    yield _ellipse(x + 0.08, y, 0.095, 0.095), second
    yield _ellipse(x + 0.08, y, 0.055, 0.055), shell
    for ahead in (-0.08, -0.13, -0.18):
        yield _polygon((x + ahead, y - 0.13), (x + ahead + 0.025, y - 0.13), (x + ahead + 0.025, y + 0.13), (x + ahead, y + 0.13)), second
    for aside in (-0.15, 0.15):
        yield _ellipse(x + 0.17, y + aside, 0.024, 0.024), WHITE


PICTURES: tuple[tuple[str, Callable[..., object], Callable[..., object], str, str, str, str], ...] = (
    # name, body, pattern, shell, pattern's colour, skin, rim
    ("meadow", _pond, _plates, "#3f8f4f", "#2b6b3a", "#8fce7a", "#28562f"),
    ("bolt", _robot, _panel, "#c9d2da", "#e0803a", "#59636e", "#7d8892"),
    ("reef", _sea, _plates, "#1f9d9b", "#13706f", "#8fe0cf", "#0e5453"),
    ("amber", _pond, _diamonds, "#e0a02e", "#9c5f14", "#e9c98f", "#7c4a10"),
    ("spark", _dome, _star, "#2b2f77", "#ffd447", "#f2b880", "#191b4d"),
    ("ember", _dome, _petals, "#c8402f", "#f08a4b", "#f0b39a", "#7d2118"),
    ("groove", _pond, _rings, "#8a4fbf", "#d69be8", "#cdb7e8", "#552b7d"),
    ("foam", _sea, _spots, "#5f9bd8", "#e3f1fb", "#b5d8c2", "#2f5f94"),
    ("fern", _sea, _bands, "#7a9a2c", "#4c6614", "#c9d87f", "#3c5010"),
    ("jade", _dome, _plates, "#22a06b", "#8fe3b4", "#c7e9b0", "#0f5f3e"),
    ("motor", _robot, _panel, "#e05a4e", "#ffd166", "#4a4458", "#8e2f28"),
    ("berry", _pond, _spots, "#b8336a", "#f6c1d5", "#d9a0b4", "#741a3f"),
    ("cinder", _dome, _bands, "#6b6f78", "#3b3f47", "#b9bfa6", "#3a3d44"),
    ("snow", _sea, _star, "#f1f3f5", "#4aa3df", "#9fc3c9", "#8fa3b3"),
)
