"""The rows of the table: how long a thing takes, its goal, and what others need for it.

A `Row` is measured in a worker process (``worker.py``), which has one session. The same rows serve ``table.py``, which prints them
beside their goals and peers, and ``compare.py``, which runs two commits in lock step. So what a row calls must be there in both.

The modules: `plans`, `reasoning`, `lisp`, `watching`, `processes`, `tabs` have the rows, `peers` what other libraries need.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """``prepare(session)`` gives ``work(count)``, which does the thing ``count`` times.

    Work that measures by itself returns the processor seconds of all; other work returns ``None`` and is timed from outside.

    ``goal``: in ``unit``, at most this; a pair is for threads and greenlets. ``flat``: the name of a row and a factor; the goal is that
    row's figure times the factor. ``times``: the unit is how often Python needs it, measured by ``peer``, a function without arguments.
    ``cram``: what CRAM on SBCL was measured to need, in ``unit``. ``others``: a function of `peers` that gives a text.
    """

    name: str
    prepare: Callable
    count: int = 1
    goal: float | tuple[float, float] | None = None
    unit: str = "us"
    cram: str = "-"
    others: Callable | None = None
    backends: tuple[str, ...] = ("threads",)
    flat: tuple[str, float] | None = None
    times: Callable | None = None
    slow: bool = False  # a round takes more than a second


BOTH = ("threads", "greenlet")
SCALES = {"us": 1e6, "ms": 1e3, "s": 1.0}


def rows():
    """All rows, in the order of the table."""
    from . import lisp, plans, reasoning, watching

    return [*plans.ROWS, *reasoning.ROWS, *lisp.ROWS, *watching.ROWS]


_evaluated = set()  # by the worker that this is


def lisp_function(definitions, name):
    """A ``prepare`` for a Lisp function of one argument, the count."""

    def prepare(session):
        session.package = "CRAM-USER"
        if definitions not in _evaluated:
            session.evaluate_text(definitions)
            _evaluated.add(definitions)
        return session.evaluate_text(f"#'{name}")[0]

    return prepare
