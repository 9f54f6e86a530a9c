"""Pictures of the present window: paper and turtles in pixels, or as vectors.

The PNG shows the paper pixel by pixel, as the colour sensors read it. The SVG shows the same lines as vectors, with square caps, and
can be printed at any size. `pictures` chooses the kind of picture by the ending of the file, also of moving ones.
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
    """Write the window to ``path``, as a PNG file of 500 by 500 pixels. Errors: `OSError`."""
    with storage.writing(path) as file:
        save_image(picture(simulator), file, "PNG")


def save_image(image: Picture, file: BinaryIO, kind: str, **options: Any) -> None:
    """Write a Pillow image to the open ``file``. ``kind``, ``options``: as for Pillow's ``save``. Errors: `OSError`, with its number.

    Pillow itself would write to the file's descriptor, and its error would not say the reason.
    """
    image.save(_Sink(file), kind, **options)


class _Sink:
    """A file without a descriptor."""

    def __init__(self, file: BinaryIO):
        self.write, self.flush, self.tell, self.seek = file.write, file.flush, file.tell, file.seek


def picture(simulator: Turtlesim) -> Picture:
    """The window as a Pillow image: the paper, and the turtles in the order of their names (turtlesim.md 9)."""
    from PIL import Image

    image = Image.frombytes("RGB", (SIZE, SIZE), simulator.canvas.rgb())
    for turtle in simulator.turtles.values():
        sprites.put(image, turtle.number, turtle.x, turtle.y, turtle.heading)
    return image


def still_svg(simulator: Turtlesim, path: str) -> None:
    """Write the window to ``path``, as an SVG file (`svg`). Errors: `OSError`."""
    storage.write_whole(path, svg(simulator))


def title(simulator: Turtlesim) -> str:
    """What the window is called: by the turtles that are in it."""
    return f"turtlesim: {', '.join(simulator.turtles) or 'no turtle'}"


def svg(simulator: Turtlesim) -> str:
    """The window as an SVG document. Lines become straight if that moves them by at most a fifth of a pixel."""
    parts = [svg_head(title(simulator)), svg_paper(simulator.canvas.background)]
    for colour, width, points in simulator.canvas.polylines():
        parts.append(svg_line(colour, width, points))
    for turtle in simulator.turtles.values():
        if math.isfinite(turtle.x + turtle.y + turtle.heading):
            place = f"translate({turtle.x * METRE:.2f} {turtle.y * METRE:.2f}) rotate({-math.degrees(turtle.heading):.1f})"
            parts.append(f'<g transform="{place}"><title>{escape(turtle.name)}</title>{svg_turtle(turtle.number)}</g>')
    return "\n".join([*parts, "</svg>\n"])


def svg_head(title: str) -> str:
    """The beginning of an SVG document of the window, with ``title`` as plain text."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" width="{SIZE}" height="{SIZE}" role="img">\n'
        f"<title>{escape(title)}</title>"
    )


def svg_paper(background: Colour) -> str:
    """The paper as an SVG element, in the colour ``background``."""
    return f'<rect width="{SIZE}" height="{SIZE}" fill="{hexadecimal(background)}"/>'


def svg_line(colour: Colour, width: int, points: Sequence[Any], more: str = "") -> str:
    """A polyline of a pen, as an SVG element.

    ``width``: in pixels. ``points``: tuples that begin with x and y, in metres on the screen. ``more``: further attributes, as text.
    """
    data = "M" + "L".join(f"{x * METRE:.1f} {y * METRE:.1f}" for x, y in (point[:2] for point in points))
    if len(points) == 2 and points[0][:2] == points[1][:2]:
        data += "h.01"  # a dot: renderers leave out a line without a length, caps and all
    return (
        f'<path d="{data}" fill="none" stroke="{hexadecimal(colour)}" stroke-width="{max(width, 1)}" '
        f'stroke-linecap="square" stroke-linejoin="round"{more}/>'
    )


def svg_turtle(number: int) -> str:
    """The drawing ``number`` of a turtle as an SVG element, looking to the right, around the origin, in pixels."""
    paths = drawing.shapes()[number % DRAWINGS]["paths"]
    return f'<g transform="scale({METRE})">' + "".join(f'<path d="{path["d"]}" fill="{path["fill"]}"/>' for path in paths) + "</g>"


def hexadecimal(colour: Colour) -> str:
    """``colour`` as ``#rrggbb``."""
    return "#{:02x}{:02x}{:02x}".format(*colour)
