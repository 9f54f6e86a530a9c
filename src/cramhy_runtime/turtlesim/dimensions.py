"""The size of the world: the paper in pixels, the metre in pixels, and the paper in metres (turtlesim.md 2)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.floats import to_float32

SIZE = 500
"""Pixels of the paper, in both directions."""
METRE = 45
"""Pixels per metre: the height of a turtle's picture."""
EXTENT = to_float32((SIZE - 1) / METRE)
"""Width and height of the world in metres: 11.088889122009277."""
CENTRE = to_float32(EXTENT / 2)
"""Both coordinates of the first turtle's place, in metres: 5.544444561004639."""
DRAWINGS = 14
"""The number of drawings of turtles (`drawing`). New turtles get them in turn."""
