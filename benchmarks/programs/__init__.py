"""Small programs in Common Lisp, each beside the Python that a programmer would write by hand for the same.

The folder has a module for each kind: numbers, data, objects, control. A program's result in Lisp and in Python is the same, which
`tests/test_benchmarks.py` checks. Peers are plain Python of the standard library: lists for vectors, objects with ``__slots__`` for
structures, f-strings for ``format``, ``functools.singledispatch`` and method calls for generic functions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Program:
    """``lisp`` defines; ``call``, a form, is what is measured; ``python(*arguments)`` is the peer, with the numbers of the call.

    ``goal``: how many times the peer's time ours may be.
    """

    name: str
    lisp: str
    call: str
    python: Callable
    goal: float = 4.0

    @property
    def function(self):
        """The name of the Lisp function that is called."""
        return self.call.strip("()").split()[0]

    @property
    def arguments(self):
        """The integers that it is called with."""
        return [int(word) for word in self.call.strip("()").split()[1:]]


def programs():
    """All programs, in the order of the table."""
    from . import control, data, floats, numbers, objects

    return [*numbers.PROGRAMS, *floats.PROGRAMS, *data.PROGRAMS, *objects.PROGRAMS, *control.PROGRAMS]
