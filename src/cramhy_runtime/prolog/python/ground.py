"""The ground that reasoning from Python stands on: it needs no plan, no session and no kernel, and works in any of them.

What is called on the way may need a kernel: a list that is computed when it is looked at, or a designator, which a task computes. So
whatever Python asks is asked inside of `reasoning`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cramhy_runtime import kernel


@contextmanager
def reasoning() -> Iterator[None]:
    """While the block runs there is a kernel: the active one, or one for the moment."""
    with kernel.at_hand():
        yield
