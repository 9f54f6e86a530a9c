"""Types of the arguments in this room. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypedDict

from .node import Turtlesim

Colour = tuple[int, int, int]
"""Red, green and blue, from 0 to 255."""
Point = tuple[float, float]
Stroke = tuple[float, float, float, float, Colour, int]
"""x1, y1, x2, y2, the colour and the width of the pen."""
TimedStroke = tuple[int, float, float, float, float, Colour, int]
"""A stroke with the tick of its drawing in front."""
Polyline = tuple[Colour, int, list[Point]]
Sample = tuple[int, float, float, float]
"""Tick, x, y, heading."""
Era = tuple[int, Colour, list[TimedStroke]]
"""The tick of a clear, the background, and the strokes until the next clear."""


class Path(TypedDict):
    """A filled path of a drawing: path data with absolute M, L, C and Z only, and a colour as ``#rrggbb``."""

    d: str
    fill: str


class Shape(TypedDict):
    """The drawing of a turtle."""

    name: str
    shell: str
    paths: list[Path]


Observer = Callable[[Turtlesim, list[Stroke]], object]
Listener = Callable[[str, str, tuple[float, ...]], tuple[float, ...] | None]
"""Gets the kind, the turtle's name and the values; see `Turtlesim`."""


class Page(Protocol):
    """The page of a session. url: its address, with the token. port: where it is. seen: whether a browser was opened for it."""

    url: str
    port: int
    seen: bool


Opener = Callable[[bool, bool], Page]
