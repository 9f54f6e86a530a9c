"""Which pages are walked after which, at a door. A walk goes through all pages in one folder, so each page meets what others have left there.

In a tab and in notebooks each page has a session of its own, as in ``cramhy learn``: the folder is what pages share. The short form walks
each page once at each door, in an order that a seed gives, in the languages by turns, so that two doors together have each page in both.
By `make soak` each page comes after each other one, in both languages.
"""

from __future__ import annotations

import random

from cramhy_runtime.course import contents
from systems import SOAK

LANGUAGES = ("lisp", "hy")
WITHOUT_ROBOT = [name for name in contents.NAMES if name not in contents.WITH_ROBOT]


def orders(names, language, door):
    """Lists of names of pages: walks at a door."""
    if SOAK:
        return [[name for other in names if other != first for name in (first, other)] for first in names]
    odd = (LANGUAGES.index(language) + len(door)) % 2
    mixed = random.Random(f"{door} {language}").sample(names, len(names))
    return [[name for name in mixed if names.index(name) % 2 == odd]]
