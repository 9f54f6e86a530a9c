"""Where running motions go: the places in the world that their designators name, for the marks of a page.

A designator is written by the user, so its places are looked for where one would look: below a property such as ``goal``, ``target`` or
``location``. A place is a list of two numbers or more, a vector, a pose, or a location designator that has been resolved. Nothing is
resolved for that, and no function of the user's is called: whoever looks on changes nothing.
"""

from __future__ import annotations

import math
from itertools import islice

from ..designators.classes import Designator
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.numbers import is_real
from ..transforms.poses import Pose, Transform
from ..transforms.vectors import Vector3

PROPERTIES = frozenset(
    ("GOAL", "TARGET", "TO", "LOCATION", "DESTINATION", "POSE", "POSITION", "POINT", "COORDINATES", "GOAL-POSE", "TARGET-POSE")
)
"""Names of properties that say where something is to go, or to be."""
DEEPEST = 6
"""Designators within designators that are looked into."""
LONGEST = 64
"""Elements of a list that are looked at; a list of the user's may be a circle."""


def goals(designator):
    """The places that ``designator`` names, pairs of coordinates in metres, in the order of its properties; none twice."""
    return tuple(dict.fromkeys(_places(designator, DEEPEST)))


def _places(designator, depth):
    if not isinstance(designator, Designator) or not depth:
        return
    for pair in islice(_elements(designator.description), LONGEST):
        parts = list(islice(_elements(pair), 2))
        if len(parts) < 2 or not isinstance(parts[0], Symbol):
            continue
        name, value = parts
        if isinstance(value, Designator):
            found = _place(_solution(value))
            yield from [found] if found else _places(value, depth - 1)
        elif name.name in PROPERTIES and (found := _place(value)):
            yield found


def _solution(designator):
    """What a designator was resolved to, it or one that it was equated with later; ``None`` if it has not been."""
    found = designator.current_solution
    for _ in range(LONGEST):
        if designator.successor is None:
            break
        designator = designator.successor
        found = designator.current_solution or found
    return found


def _place(value):
    """(x, y) of something that is a place, or ``None``."""
    if isinstance(value, Pose):
        value = value.origin
    elif isinstance(value, Transform):
        value = value.translation
    if isinstance(value, Vector3):
        return _finite(value.components)
    numbers = list(islice(_elements(value), LONGEST))
    if numbers and isinstance(numbers[0], (Cons, list, tuple, Vector3)):  # a pose as a list: ((x y z) (x y z w))
        return _place(numbers[0])
    return _finite(numbers) if len(numbers) >= 2 and all(map(is_real, numbers[:2])) else None


def _elements(value):
    return value if isinstance(value, (Cons, list, tuple)) else ()


def _finite(numbers):
    try:
        x, y = map(float, numbers[:2])
    except OverflowError:
        return None
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None
