"""Openings: each file offers shorter code for something, under the names of its passes (``passes.py``), and says what that buys.

They are entered in this order, in which the openings of one symbol are asked.
"""

from __future__ import annotations

from ..generator import calls, exits, functions as definitions, values  # noqa: F401  the plain code, which is there first
from ..arithmetic import comparisons, elements, functions, sums, versions  # noqa: F401
from ..passes import from_environment, switch
from . import (  # noqa: F401
    characters,
    checks,
    errors,
    hash_tables,
    keywords,  # noqa: F401  after what knows the object
    lists,
    loops,
    objects,
    places,
    predicates,
    several,
    texts,
    vectors,
)

switch(from_environment())
