"""The paper: 500 by 500 pixels that the pens draw on and the colour sensors read.

Pixels are set as Qt's raster painter sets them without anti-aliasing: a line of width w with square caps is a rectangle that
reaches w/2 beyond its ends and to its sides, and a pixel is painted when its centre lies inside; a centre on the border counts
on the side of greater coordinates. Measured sensor readings of the original (turtle-facts.txt, section 7) agree with that.

Lines are kept until somebody looks: a run that nobody watches does not wait for its drawing. Source: turtlesim.md 7.
"""

from __future__ import annotations

import math

SIZE = 500
METRE = 45
"""Pixels per metre: the height of the turtle's picture."""
_CENTRE = 0.5 - 2.0**-7  # of a pixel, from its corner; a little less than half, which decides about centres on the border
_MOST_PENDING = 512


class Canvas:
    """The path image. Coordinates are pixels, x to the right and y down; colours are (r, g, b)."""

    def __init__(self, background=(69, 86, 255)):
        self._pixels = bytearray(bytes(background) * (SIZE * SIZE))
        self._pending = []
        self.background = tuple(background)
        self.version = 0

    def clear(self, background):
        """Fill everything with ``background``."""
        self._pending.clear()
        self.background = tuple(background)
        self._pixels[:] = bytes(background) * (SIZE * SIZE)
        self.version += 1

    def line(self, x0, y0, x1, y1, colour, width):
        """Draw a line; a width of 0 is a width of 1."""
        self._pending.append((x0, y0, x1, y1, colour, width))
        self.version += 1
        if len(self._pending) > _MOST_PENDING:
            self.flush()

    def flush(self):
        """Draw the lines that were kept."""
        pending, self._pending = self._pending, []
        for line in pending:
            self._draw(*line)

    def pixel(self, x, y):
        """The colour at (x, y), rounded to the nearest pixel, halves up; outside of the paper the nearest pixel on it."""
        if self._pending:
            self.flush()
        if x != x or y != y:
            return self.background
        column = min(max(math.floor(min(max(x, 0.0), SIZE) + 0.5), 0), SIZE - 1)
        row = min(max(math.floor(min(max(y, 0.0), SIZE) + 0.5), 0), SIZE - 1)
        start = (row * SIZE + column) * 3
        return tuple(self._pixels[start : start + 3])

    def rgb(self):
        """All pixels as bytes, row by row from the top."""
        self.flush()
        return bytes(self._pixels)

    def _draw(self, x0, y0, x1, y1, colour, width):
        along_x, along_y = x1 - x0, y1 - y0
        length = math.hypot(along_x, along_y)
        if not length < math.inf:  # infinite or not a number: nowhere on the paper
            return
        if length:
            along_x, along_y = along_x / length, along_y / length
        else:
            along_x, along_y = 1.0, 0.0
        half = max(width, 1) / 2
        reach = half * (abs(along_x) + abs(along_y))
        top = max(math.ceil(min(y0, y1) - reach - _CENTRE), 0)
        bottom = min(math.floor(max(y0, y1) + reach - _CENTRE), SIZE - 1)
        paint, pixels = bytes(colour), self._pixels
        for row in range(top, bottom + 1):
            across = row + _CENTRE - y0
            # Both conditions are linear in x: -half <= u <= length + half along the line, -half <= v <= half beside it.
            low, high = -math.inf, math.inf
            for slope, offset, least, most in (
                (along_x, across * along_y, -half, length + half),
                (-along_y, across * along_x, -half, half),
            ):
                if slope > 1e-12:
                    low, high = max(low, (least - offset) / slope), min(high, (most - offset) / slope)
                elif slope < -1e-12:
                    low, high = max(low, (most - offset) / slope), min(high, (least - offset) / slope)
                elif not least <= offset <= most:
                    low, high = 1.0, 0.0
            if low > high:
                continue
            left = max(math.ceil(max(x0 + low, -1.0) - _CENTRE), 0)
            right = min(math.floor(min(x0 + high, SIZE + 1.0) - _CENTRE), SIZE - 1)
            if left <= right:
                start = (row * SIZE + left) * 3
                pixels[start : start + 3 * (right - left + 1)] = paint * (right - left + 1)


SHELLS = [(46, 125, 50), (178, 102, 34), (0, 121, 107), (142, 36, 170), (198, 40, 40), (93, 64, 55)]
"""Colours of the turtles, in order of spawning."""


def picture(canvas, turtles):
    """A Pillow image of the window: the paper, and on it every turtle as (x, y in pixels, heading in radians, number)."""
    from PIL import Image

    image = Image.frombytes("RGB", (SIZE, SIZE), canvas.rgb())
    for x, y, heading, number in turtles:
        if abs(x) < 10 * SIZE and abs(y) < 10 * SIZE:
            _draw_turtle(image, x, y, heading, SHELLS[number % len(SHELLS)])
    return image


def _draw_turtle(image, x, y, heading, shell):
    """Our own turtle, 45 pixels long, seen from above, head in the direction of ``heading``."""
    from PIL import ImageDraw

    pen = ImageDraw.Draw(image)
    cosine, sine = math.cos(heading), -math.sin(heading)

    def blob(forward, sideways, radius_x, radius_y, colour):
        outline = []
        for step in range(24):
            angle = step * math.pi / 12
            u, v = forward + radius_x * math.cos(angle), sideways + radius_y * math.sin(angle)
            outline.append((x + u * cosine - v * sine, y + u * sine + v * cosine))
        pen.polygon(outline, fill=colour)

    skin = tuple(min(255, part + 70) for part in shell)
    for forward in (9, -10):
        for sideways in (-13, 13):
            blob(forward, sideways, 5, 4, skin)
    blob(18, 0, 6, 5, skin)
    blob(-19, 0, 4, 2, skin)
    blob(0, 0, 15, 13, shell)
    blob(0, 0, 9, 7, tuple(min(255, part + 30) for part in shell))
    for sideways in (-2, 2):
        blob(20, sideways, 1, 1, (0, 0, 0))


def save_png(path, canvas, turtles=()):
    """Write the window as a PNG file."""
    picture(canvas, turtles).save(path, "PNG")
