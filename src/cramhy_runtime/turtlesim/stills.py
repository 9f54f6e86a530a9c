"""Pictures of the window as it is now: paper and turtles in pixels, or as vectors.

The PNG shows the paper pixel by pixel, as the colour sensors read it. The SVG shows the same lines as vectors, square caps and all, and
may be printed at any size. Which kind of picture a file gets, pictures that move too, says `pictures`.
"""

from __future__ import annotations

import math
from html import escape

from .. import storage
from . import drawing, sprites
from .dimensions import DRAWINGS, METRE, SIZE
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import BinaryIO

    from PIL.Image import Image as Picture

    from .node import Turtlesim
    from .signatures import Colour


def still_png(simulator: Turtlesim, path: str) -> None:
    """Write what the window shows as a PNG file of 500 by 500 pixels."""
    with storage.writing(path) as file:
        save_image(picture(simulator), file, "PNG")


def save_image(image: Picture, file: BinaryIO, kind: str, **options: Any) -> None:
    """Write a Pillow image to the open ``file``. Errors: `OSError`, with its number.

    Pillow itself writes to the number of a file that has one, and its error then does not say why it could not.
    """
    image.save(_Sink(file), kind, **options)


class _Sink:
    """A file without a number."""

    def __init__(self, file: BinaryIO):
        self.write, self.flush, self.tell, self.seek = file.write, file.flush, file.tell, file.seek


def picture(simulator: Turtlesim) -> Picture:
    """What the window shows, as a Pillow image: the paper, and the turtles in the order of their names (turtlesim.md 9)."""
    from PIL import Image

    image = Image.frombytes("RGB", (SIZE, SIZE), simulator.canvas.rgb())
    for turtle in simulator.turtles.values():
        sprites.put(image, turtle.number, turtle.x, turtle.y, turtle.heading)
    return image


def still_svg(simulator: Turtlesim, path: str) -> None:
    """Write what the window shows as an SVG file; lines that lie within a fifth of a pixel of a straight one are made straight."""
    parts = [svg_head(f"turtlesim: {', '.join(simulator.turtles) or 'no turtle'}"), svg_paper(simulator.canvas.background)]
    for colour, width, points in simulator.canvas.polylines():
        parts.append(svg_line(colour, width, points))
    for turtle in simulator.turtles.values():
        if math.isfinite(turtle.x + turtle.y + turtle.heading):
            place = f"translate({turtle.x * METRE:.2f} {turtle.y * METRE:.2f}) rotate({-math.degrees(turtle.heading):.1f})"
            parts.append(f'<g transform="{place}"><title>{escape(turtle.name)}</title>{svg_turtle(turtle.number)}</g>')
    storage.write_whole(path, "\n".join([*parts, "</svg>\n"]))


def svg_head(title: str) -> str:
    """The beginning of an SVG document of the window."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" width="{SIZE}" height="{SIZE}" role="img">\n'
        f"<title>{escape(title)}</title>"
    )


def svg_paper(background: Colour) -> str:
    return f'<rect width="{SIZE}" height="{SIZE}" fill="{hexadecimal(background)}"/>'


def svg_line(colour: Colour, width: int, points: Sequence[Any], more: str = "") -> str:
    """A polyline of a pen; ``points`` in metres on the screen."""
    data = "M" + "L".join(f"{x * METRE:.1f} {y * METRE:.1f}" for x, y in (point[:2] for point in points))
    if len(points) == 2 and points[0][:2] == points[1][:2]:
        data += "h.01"  # a dot: renderers leave out a line without a length, caps and all
    return (
        f'<path d="{data}" fill="none" stroke="{hexadecimal(colour)}" stroke-width="{max(width, 1)}" '
        f'stroke-linecap="square" stroke-linejoin="round"{more}/>'
    )


def svg_turtle(number: int) -> str:
    """The drawing of a turtle that looks to the right, around the origin, in pixels."""
    paths = drawing.shapes()[number % DRAWINGS]["paths"]
    return f'<g transform="scale({METRE})">' + "".join(f'<path d="{path["d"]}" fill="{path["fill"]}"/>' for path in paths) + "</g>"


def hexadecimal(colour: Colour) -> str:
    return "#{:02x}{:02x}{:02x}".format(*colour)
