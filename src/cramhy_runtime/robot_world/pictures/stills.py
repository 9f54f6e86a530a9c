"""A picture of a world as a file."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from cramhy_runtime import storage
from cramhy_runtime.lisp_core.condition_types import SimpleError, SimpleFileError
from cramhy_runtime.lisp_core.conditions import error

from .drawing import draw
from .views import overview

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

    from ..world import World
    from .views import View

WIDTH, HEIGHT = 640, 480  # pixels
SMOOTH = 2
"""How many times as many pixels are drawn in each direction as are written where edges are, so that these are smooth."""


def picture(world: World, view: View | None = None, width: int = WIDTH, height: int = HEIGHT, smooth: int = SMOOTH) -> Picture:
    """A Pillow image of a world, by default of all of it. Errors: ValueError, for a size that is none."""
    from PIL import Image

    colours = draw(world, view or overview(world), width, height, smooth).colours
    return Image.fromarray(np.round(colours * 255).astype(np.uint8))


def save(world: World, path: str, view: View | None = None, width: int = WIDTH, height: int = HEIGHT, called: str | None = None) -> None:
    """Write a picture of ``world`` to the PNG file ``path``. called: the user's spelling of its name.

    Errors: a file-error when it cannot be written, and then an old file is as it was; simple errors for another kind of file, and for no
    such size.
    """
    called = called or path
    if not path.lower().endswith(".png"):
        movie = " An animation of a run, .gif, is made by btr:with-movie." if path.lower().endswith(".gif") else ""
        error(SimpleError("~a", f"What kind of picture is {called} to be? The name of a picture of a world ends in .png.{movie}"))
    try:
        made = picture(world, view, width, height)
    except ValueError as problem:
        error(SimpleError("~a", f"The picture {called} cannot be drawn: {problem}"))
    write(made, path, called, "PNG")


def write(made: Picture, path: str, called: str, kind: str, **options: object) -> None:
    """Write a Pillow image to a file, whole or not at all. Errors: a file-error."""
    data = BytesIO()
    made.save(data, kind, **options)
    try:
        storage.write_whole(path, data.getvalue(), durable=False)
    except OSError as problem:
        error(SimpleFileError(called, "~a", f"The picture {called} cannot be written: {storage.why(problem)}"))
