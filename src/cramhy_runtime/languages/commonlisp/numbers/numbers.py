"""Numbers: the table of this folder. Arithmetic, rounding, irrational functions, bits and random numbers have a module each."""

from __future__ import annotations

from . import arithmetic, bits, irrational, random_state, rounding
from .arithmetic import add2, div2, ge2, gt2, le2, lt2, mul2, num_eq2, num_ne2, sub2  # noqa: F401  for compiled code
from .random_state import RANDOM_STATE, seed_random  # noqa: F401

MODULES = (arithmetic, rounding, irrational, bits, random_state)
"""Each has LISP_NAMES; arithmetic has LISP_FUNCTIONS, the operators whose names are no Python names."""

CONSTANTS = {**irrational.CONSTANTS, **bits.CONSTANTS}
VARIABLES = {**CONSTANTS, "*RANDOM-STATE*": RANDOM_STATE.value}
"""All variables by Lisp name; those in CONSTANTS are constant."""
