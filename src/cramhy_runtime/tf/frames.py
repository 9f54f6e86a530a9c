"""Names of frames. tf takes ``/map`` and ``map`` for the same frame. Source: cl-transforms.md 5."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import LispString
from cramhy_runtime.kernel.typing_names import Any


def unslash_frame(frame: Any) -> str:
    """``frame``, a string, without slashes and blanks at its ends; NIL stays NIL."""
    if frame.__class__ is str:
        return frame.strip("/ ")
    if frame is None:
        return None
    if not isinstance(frame, (str, LispString)):
        return type_error(frame, "STRING", "\nwhen binding CL-TRANSFORMS-STAMPED::FRAME")
    return str(frame).strip("/ ")


def resolve_frame(prefix: str | None, frame_name: str) -> str:
    """``frame_name`` below ``prefix``: ``"pre/map"``; without a prefix (NIL) ``"/map"``."""
    return f"{unslash_frame(prefix) or ''}/{unslash_frame(frame_name)}"
