"""The turtles' drawings in pixels: the vector paths of `drawing`, filled with Pillow, with smooth edges.

Each sprite is painted eight times as large, then reduced, once per drawing and whole degree of heading.
"""

from __future__ import annotations

import math
import re
from functools import cache, lru_cache

from . import drawing
from .dimensions import DRAWINGS, METRE, SIZE
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

    from .signatures import Point


_FINER = 8
_STEPS = 8  # straight pieces per Bézier curve
MARGIN = 0.6
"""Metres from the middle of a turtle to the edge of its sprite."""


def outlines(data: str) -> list[list[Point]]:
    """The polygons ``[(x, y), ...]`` of path data from `drawing`, as a list."""
    found: list[list[Any]] = []
    for command, numbers in re.findall(r"([MLCZ])([^MLCZ]*)", data):
        values = [float(number) for number in numbers.split()]
        points = list(zip(values[::2], values[1::2]))
        if command == "M":
            found.append(points)
        elif command == "L":
            found[-1] += points
        elif command == "C":
            controls = (found[-1][-1], *points)
            for step in range(1, _STEPS + 1):
                t = step / _STEPS
                parts = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
                found[-1].append(tuple(sum(part * point[axis] for part, point in zip(parts, controls)) for axis in (0, 1)))
    return found


@cache
def _polygons(number: int) -> list[tuple[list[Point], str]]:
    shapes = drawing.shapes()
    return [(outline, path["fill"]) for path in shapes[number % len(shapes)]["paths"] for outline in outlines(path["d"])]


@lru_cache(maxsize=1024)
def sprite(number: int, degrees: int) -> Picture:
    """The drawing ``number`` for a heading of ``degrees``, as a square Pillow image with transparency."""
    from PIL import Image, ImageDraw

    size = 2 * math.ceil(MARGIN * METRE)
    scale, middle = METRE * _FINER, size * _FINER / 2
    cosine, sine = math.cos(math.radians(degrees)), -math.sin(math.radians(degrees))
    image = Image.new("RGBA", (size * _FINER, size * _FINER), (0, 0, 0, 0))
    pen = ImageDraw.Draw(image)
    for outline, fill in _polygons(number):
        pen.polygon([(middle + scale * (x * cosine - y * sine), middle + scale * (x * sine + y * cosine)) for x, y in outline], fill=fill)
    return image.resize((size, size), Image.Resampling.BOX)


def put(image: Picture, number: int, x: float, y: float, heading: float) -> None:
    """Paint a turtle on a Pillow image of the window.

    ``number``: of its drawing. ``x``, ``y``: in metres on the screen (y down). ``heading``: in radians. A turtle far outside, or with a
    coordinate that is not a number, is not painted.
    """
    if not (abs(x) < 2 * SIZE and abs(y) < 2 * SIZE and math.isfinite(heading)):
        return
    picture = sprite(number % DRAWINGS, round(math.degrees(heading)) % 360)
    corner = tuple(math.floor(value * METRE + 0.5) - picture.width // 2 for value in (x, y))
    image.paste(picture, corner, picture)
