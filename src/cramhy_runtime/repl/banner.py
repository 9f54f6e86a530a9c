"""The two lines that a prompt begins with on a terminal: which program this is, and how to go on. They fit into 40 columns."""

from __future__ import annotations

import sys

from cramhy_runtime import __version__


def wanted() -> bool:
    """Whether somebody sits there: standard input and output are terminals."""
    return all(file is not None and file.isatty() for file in (sys.stdin, sys.stdout))


def of_lisp() -> str:
    """The banner of a prompt of Common Lisp."""
    return f"cramhy {__version__}, the plan language of CRAM\nhelp tells what to type; exit leaves"


def of_hy() -> str:
    """The banner of a prompt of Hy."""
    import hy

    return f"cramhy {__version__} in Hy {hy.__version__}\n(in-package :name) leads to Common Lisp"


__all__ = ["of_hy", "of_lisp", "wanted"]
