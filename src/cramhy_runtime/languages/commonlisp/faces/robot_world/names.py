"""What Lisp writes for names of things and for colours, in the terms of the room ``robot_world``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.lisp_core.packages import is_symbol

if TYPE_CHECKING:
    from cramhy_runtime.lisp_core.data import Symbol


def name_of(designator: Symbol | str) -> Symbol | str:
    """The name of a thing: a symbol, or a string of any class."""
    return designator if is_symbol(designator) else str(designator)


def colour_of(colour: Any) -> tuple[float, float, float, float]:
    """Red, green, blue and how far it can be seen through, of a list of three or four numbers; grey of nil."""
    parts = [float(part) for part in python_list(colour)] if colour is not None else [0.5, 0.5, 0.5]
    return (*parts, 1.0) if len(parts) == 3 else tuple(parts)
