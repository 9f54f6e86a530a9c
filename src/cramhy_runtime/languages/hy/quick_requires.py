"""``(require ...)`` of Hy without a look at every source file on the stack.

When a compiled file of Hy is imported, each of its ``require`` calls a function of `hy.macros`, which asks `inspect.stack` for the caller's
frame. That describes all frames, and reads the lines of each: 10 ms in a small program, 100 ms in one with many modules. hyrule alone has
45 of them. `install` gives `hy.macros` a `stack` with the two frames that it looks at.
"""

from __future__ import annotations

import inspect
import sys
from types import FrameType
from typing import Any

import hy.macros


class _Inspect:
    """`inspect` for `hy.macros`."""

    def __getattr__(self, name: str) -> Any:
        return getattr(inspect, name)

    @staticmethod
    def stack(context: int = 1) -> list[tuple[FrameType]]:
        """What calls this, and the caller of that, each as a tuple that begins with the frame, as the entries of `inspect.stack` do."""
        frame = sys._getframe(1)
        return [(each,) for each in (frame, frame.f_back) if each is not None]


def install() -> None:
    """Let Hy find the file that requires macros in this way from now on."""
    hy.macros.inspect = _Inspect()  # type: ignore[attr-defined]
