"""The ground that reasoning from Python stands on: it needs no plan, no session and no kernel, and works in any of them.

What is called on the way may need some of it: a function of Lisp the package COMMON-LISP, a list that is computed when it is looked at,
or a designator, a task that computes it. So whatever Python asks is asked inside of `reasoning`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from .. import kernel
from ..lisp import package as lisp_package


@contextmanager
def reasoning() -> Iterator[None]:
    """While the block runs there are the functions of Lisp and a kernel: the active one, or one for the moment."""
    lisp_package.fill()
    with kernel.at_hand():
        yield
