"""Where the value of a node goes: into an expression, to a name, out of the function, or nowhere."""

from __future__ import annotations

from .core import NONE, TRUE

__all__ = ["NONE", "TRUE"]


class Destination:
    """Where a value goes. ``multiple``: all values are wanted, not only the first. ``raw``: singles come as Python's floats.

    through: a function (generator, expression) of what is returned, which gives what is returned instead.
    """

    __slots__ = ("kind", "name", "multiple", "raw", "through")

    def __init__(self, kind, name=None, multiple=False, raw=False, through=None):
        self.kind, self.name, self.multiple, self.raw, self.through = kind, name, multiple, raw, through


EFFECT = Destination("effect")
VALUE = Destination("value")
RAW = Destination("value", raw=True)
VALUES = Destination("value", multiple=True)
FIRST_OF_VALUES = Destination("value", multiple=True)
"""The first value is wanted, and who wants it takes it out of several: so it need not be done before."""
RETURN = Destination("return", multiple=True)
