"""The paper: 500 by 500 pixels. The pens draw on them and the colour sensors read them.

Lines set the same pixels as in Qt's raster painter without anti-aliasing. A line of width w with square caps is a rectangle that
reaches w/2 beyond its ends and to its sides. A pixel is painted if its centre is inside; a centre on the border counts on the
side of greater coordinates. Measured sensor readings of the original (turtle-facts.txt, section 7) agree with that.

Lines are kept, and drawn only when pixels are read, so a run without a viewer does not wait for its drawing. Source: turtlesim.md 7.
"""

from __future__ import annotations

from math import ceil, floor, hypot, inf

from .strokes import PIECE, Ink
from .dimensions import METRE, SIZE
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .signatures import Colour, Polyline, Stroke


_CENTRE = 0.5 - 2.0**-7  # of a pixel, from its corner; a little less than half, which decides about centres on the border
_LEVEL = 1e-12
_LAST, _ROW = SIZE - 1, SIZE * 3
_MOST_LINES = PIECE  # a quarter of a minute of driving
_AS_DRAWN = 20_000  # five minutes of driving without a clear: what is drawn later is thinned out, which takes as long as the drawing


class Canvas:
    """The image of the trails. Coordinates are metres on the screen, x to the right and y down; colours are (r, g, b).

    ``background``: the colour of the paper. ``clears``: how often the paper was filled with it. ``news``: ``None``, or a list that
    gets every new line, for observers of the pens (`Turtlesim.observe`).
    """

    def __init__(self, background: Iterable[int] = (69, 86, 255)):
        self._pixels = bytearray()
        self.news: list[Stroke] | None = None
        self.clears = -1
        self.clear(background)

    def clear(self, background: Iterable[int]) -> None:
        """Fill the paper with ``background``, a colour (r, g, b)."""
        self.background: Colour = tuple(background)  # type: ignore[assignment]  # of three
        self._pixels[:] = bytes(self.background) * (SIZE * SIZE)
        self._lines: list[Stroke] = []
        self._drawn = 0
        self._ink = Ink()
        self.clears += 1
        if self.news:
            self.news.clear()

    def line(self, x0: float, y0: float, x1: float, y1: float, colour: Colour, width: int) -> None:
        """Draw a line from (x0, y0) to (x1, y1), in metres on the screen. ``width``: in pixels; 0 means 1."""
        line = (x0, y0, x1, y1, colour, width)
        self._lines.append(line)
        if self.news is not None:
            self.news.append(line)
        if len(self._lines) > _MOST_LINES:
            self.flush()
            (self._ink.take if len(self._ink) < _AS_DRAWN else self._ink.take_thinned)(self._lines)
            self._lines, self._drawn = [], 0

    def flush(self) -> None:
        """Draw the kept lines into the pixels."""
        lines, begin = self._lines, self._drawn
        self._drawn = len(lines)
        for index in range(begin, len(lines)):
            self._draw(*lines[index])

    def strokes(self) -> list[Stroke]:
        """All lines since the last clear, as from `Ink.strokes`: for observers that come later."""
        return self._all_ink().strokes()

    def polylines(self) -> list[Polyline]:
        """All lines since the last clear, as from `Ink.polylines`: for pictures without pixels."""
        return self._all_ink().polylines()

    def _all_ink(self) -> Ink:
        ink = self._ink.copy()
        ink.take(self._lines)
        return ink

    def pixel(self, x: float, y: float) -> Colour:
        """The colour (r, g, b) of the paper's pixel nearest to (x, y), in metres on the screen; halves round up."""
        if self._drawn < len(self._lines):
            self.flush()
        if x != x or y != y:
            return self.background
        x, y = x * METRE, y * METRE
        column = (floor(x + 0.5) if x > 0.0 else 0) if x < _LAST else _LAST
        row = (floor(y + 0.5) if y > 0.0 else 0) if y < _LAST else _LAST
        start = (row * SIZE + column) * 3
        return tuple(self._pixels[start : start + 3])  # type: ignore[return-value]  # of three

    def rgb(self) -> bytes:
        """All pixels as bytes, row by row from the top."""
        self.flush()
        return bytes(self._pixels)

    def _draw(self, x0: float, y0: float, x1: float, y1: float, colour: Colour, width: int) -> None:
        x0, y0, x1, y1 = x0 * METRE, y0 * METRE, x1 * METRE, y1 * METRE
        along_x, along_y = x1 - x0, y1 - y0
        length = hypot(along_x, along_y)
        if not length < inf:  # infinite or not a number: nowhere on the paper
            return
        if length:
            along_x, along_y = along_x / length, along_y / length
        else:
            along_x, along_y = 1.0, 0.0
        half = (width or 1) / 2
        across_x, across_y = abs(along_x), abs(along_y)
        reach = half * (across_x + across_y) + _CENTRE
        top, bottom = (y0 - reach, y1 + reach) if y0 < y1 else (y1 - reach, y0 + reach)
        bottom -= 2 * _CENTRE
        top, bottom = ceil(top) if top > 0.0 else 0, floor(bottom) if bottom < _LAST else _LAST
        paint, pixels = bytes(colour), self._pixels
        if across_x < _LEVEL or across_y < _LEVEL:
            left, right = (x0, x1) if x0 < x1 else (x1, x0)
            left, right = left - half - _CENTRE, right + half - _CENTRE
            left, right = ceil(left) if left > 0.0 else 0, floor(right) if right < _LAST else _LAST
            if left <= right:
                paint *= right - left + 1
                for start in range((top * SIZE + left) * 3, (bottom * SIZE + left) * 3 + 1, _ROW):
                    pixels[start : start + len(paint)] = paint
            return
        # A pixel at (u, v) from the start is painted when it lies within the length and within the width of the line:
        # -half <= along_x u + along_y v <= length + half, and -half <= along_x v - along_y u <= half. In a row v is fixed,
        # so each of the two leaves an interval of u, from_end to to_end and from_side to to_side, that moves on from row to row.
        slope, tilt = along_y / along_x, along_x / along_y
        v, origin = top + _CENTRE - y0, x0 - _CENTRE
        from_end, to_end = -half / along_x + origin, (length + half) / along_x + origin
        if from_end > to_end:
            from_end, to_end = to_end, from_end
        from_side, to_side = origin - half / across_y, origin + half / across_y
        start = top * _ROW
        for row in range(bottom - top + 1):
            w = v + row
            turned, shifted = slope * w, tilt * w
            left, side = from_end - turned, from_side + shifted
            if side > left:
                left = side
            right, side = to_end - turned, to_side + shifted
            if side < right:
                right = side
            first = ceil(left) if left > 0.0 else 0
            count = (floor(right) if right < _LAST else _LAST) - first + 1
            if count > 0:
                place = start + 3 * first
                pixels[place : place + 3 * count] = paint * count
            start += _ROW
