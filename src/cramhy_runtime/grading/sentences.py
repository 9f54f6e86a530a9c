"""What is wrong, in as many words as an exercise lets a student see.

A `Fault` says it three times: with the answer that was expected, without it, and, for checks that are hidden, without anything of what the
check asks.
"""

from __future__ import annotations

from typing import NamedTuple


class Fault(NamedTuple):
    """``hidden``: what kind of thing is wrong. ``plain``: what came of it, but not what was expected. ``whole``: with that, too."""

    hidden: str
    plain: str
    whole: str


def fault(hidden, plain, expected=""):
    """A `Fault`. expected: a sentence about what was expected, which stands behind ``plain``."""
    return Fault(hidden, plain, f"{plain} {expected}".rstrip())


def said(faults, hidden=False, answers=False):
    """The sentences for a student, each once. faults: a list of `Fault`. hidden, answers: whether nothing is shown, or all."""
    words = [each.hidden if hidden else each.whole if answers else each.plain for each in faults]
    return list(dict.fromkeys(words))
