"""The turtles' world: their places, moves and the walls.

One tick is always 16 ms, even if the clock differs. The heading turns first, then the turtle moves along the new heading
(semi-implicit Euler), then the walls stop it. Positions are doubles, and y counts down from the top as on the screen; values in
messages are rounded to 32 bits. π is the constant of the original, 3.14159265, which decides whether half a turn becomes positive
or negative. A command lasts for one second. Source: turtlesim.md 2, 4, 5, 6.
"""

from __future__ import annotations

import math
import struct

from cramhy_runtime.lisp_core.floats import to_float32
from .dimensions import EXTENT
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from .canvas import Canvas
    from .signatures import Colour


_five_singles = struct.Struct("<5f")
_cos, _sin, _floor, _sqrt = math.cos, math.sin, math.floor, math.sqrt


TICK = 0.016
COMMAND_LIFETIME = 1.0
PI = 3.14159265
TWO_PI = 2.0 * PI
DEFAULT_PEN = (179, 184, 255)


class Turtle:
    """One turtle. Attributes ``x``, ``y``: in metres on the screen (y down). ``heading``: in radians.

    The argument ``y`` is in metres of the world (y up). ``number``: of its drawing. ``canvas``: the paper. ``warn(text)`` is called when
    the turtle hits a wall. ``segment``: the beginning of the last update's line until `draw` has drawn it, or ``None``.
    """

    __slots__ = (
        "name",
        "number",
        "x",
        "y",
        "heading",
        "forward",
        "sideways",
        "turn",
        "commanded",
        "pen_on",
        "pen_colour",
        "pen_width",
        "teleports",
        "canvas",
        "warn",
        "at_rest",
        "_pose",
        "segment",
    )

    def __init__(self, name: str, number: int, x: float, y: float, heading: float, canvas: Canvas, warn: Callable[[str], object]):
        self.name, self.number = name, number
        self.x, self.y, self.heading = x, EXTENT - y, heading
        self.forward = self.sideways = self.turn = 0.0
        self.commanded = -math.inf
        self.pen_on, self.pen_width = True, 3
        self.pen_colour: Colour = DEFAULT_PEN
        self.teleports: list[tuple[float, float, float, bool]] = []
        self.canvas, self.warn = canvas, warn
        self.at_rest = False
        self._pose: tuple[float, ...] | None = None
        self.segment: tuple[float, float] | None = None

    def command(self, forward: float, sideways: float, turn: float, now: float) -> None:
        """Set the velocity: ``forward`` and ``sideways`` in m/s, ``turn`` in rad/s, at the time ``now`` in seconds."""
        self.forward, self.sideways, self.turn, self.commanded = forward, sideways, turn, now
        self.at_rest = False

    def teleport_absolute(self, x: float, y: float, heading: float) -> None:
        """Move to (x, y), in metres of the world (y up), with ``heading`` in radians, at the next update."""
        self.teleports.append((x, y, heading, True))
        self.at_rest = False

    def teleport_relative(self, linear: float, angular: float) -> None:
        """Turn by ``angular`` radians, then move by ``linear`` metres, at the next update."""
        self.teleports.append((linear, 0.0, angular, False))
        self.at_rest = False

    def push(self, x: float, y: float, angle: float) -> None:
        """Shove the turtle by (x, y), in metres of the world (y up), and turn it by ``angle`` radians. The pen draws nothing."""
        self.x, self.y = min(max(self.x + x, 0.0), EXTENT), min(max(self.y - y, 0.0), EXTENT)
        self.heading = _wrap(self.heading + angle)
        self._pose, self.at_rest = None, False

    def set_pen(self, red: int, green: int, blue: int, width: int, off: object) -> None:
        """Set colour (0 to 255 each) and width (pixels) of the pen, or switch it ``off``.

        With ``off``, colour and width stay as they are (turtlesim.md 7.1).
        """
        self.pen_on = not off
        if not off:
            self.pen_colour, self.pen_width = (red, green, blue), width or 1

    def update(self, now: float) -> None:
        """Move for one tick, up to the walls. `draw` draws the line later, after the colour was read. ``now``: in seconds."""
        if self.at_rest:
            return
        if self.teleports:
            self._teleport()
        if now - self.commanded > COMMAND_LIFETIME:
            self.forward = self.sideways = self.turn = 0.0
        forward, sideways = self.forward, self.sideways
        old_x, old_y, old_heading = self.x, self.y, self.heading
        heading = old_heading + self.turn * TICK
        if not -PI <= heading < PI:  # in this range the wrap of the original does nothing
            heading = _wrap(heading)
        if forward or sideways:
            cosine, sine = _direction(heading)
            x = old_x + (cosine * forward - sine * sideways) * TICK
            y = old_y - (cosine * sideways + sine * forward) * TICK
        else:
            x, y = old_x, old_y
        if x < 0.0 or x > EXTENT or y < 0.0 or y > EXTENT:
            self.warn(f"Oh no! I hit the wall! (Clamping from [x={x:f}, y={y:f}])")
            x, y = min(max(x, 0.0), EXTENT), min(max(y, 0.0), EXTENT)
        self.x, self.y, self.heading = x, y, heading
        self._pose = None
        if x != old_x or y != old_y:
            self.segment = (old_x, old_y)
        elif not forward and not sideways and not self.turn and heading == old_heading:
            self.at_rest = True

    def draw(self) -> None:
        """Draw the line of the last update, if the pen is on."""
        segment = self.segment
        if segment is not None:
            self.segment = None
            if self.pen_on:
                self._line(segment[0], segment[1], self.x, self.y)

    def pose(self) -> tuple[float, float, float, float, float]:
        """The published values (x, y up, heading, speed, turn), rounded to 32 bits. The speed is never negative.

        Units: metres, radians, m/s, rad/s.
        """
        if self._pose is None:
            speed = _sqrt(self.forward * self.forward + self.sideways * self.sideways)
            values = (self.x, EXTENT - self.y, self.heading, speed, self.turn)
            try:
                self._pose = _five_singles.unpack(_five_singles.pack(*values))
            except OverflowError:
                self._pose = tuple(to_float32(value) for value in values)
        return self._pose  # type: ignore[return-value]  # of five

    def colour(self) -> Colour:
        """The colour (r, g, b) of the paper under the turtle's centre."""
        return self.canvas.pixel(self.x, self.y)

    def _teleport(self) -> None:
        teleports, self.teleports = self.teleports, []
        for x, y, heading, absolute in teleports:
            old_x, old_y = self.x, self.y
            if absolute:
                self.x, self.y, self.heading = x, max(0.0, EXTENT - y), heading
            else:
                self.heading += heading
                cosine, sine = _direction(self.heading)
                self.x += cosine * x
                self.y -= sine * x
            if self.pen_on:
                self._line(old_x, old_y, self.x, self.y)

    def _line(self, old_x: float, old_y: float, x: float, y: float) -> None:
        self.canvas.line(x, y, old_x, old_y, self.pen_colour, self.pen_width)


def _direction(heading: float) -> tuple[float, float]:
    """Cosine and sine as in C++: not-a-number where Python raises an error."""
    try:
        return _cos(heading), _sin(heading)
    except ValueError:
        return math.nan, math.nan


def _wrap(heading: float) -> float:
    if heading - heading != 0.0:
        return math.nan
    return heading - TWO_PI * _floor((heading + PI) / TWO_PI)
