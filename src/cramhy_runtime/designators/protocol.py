"""What one can ask of any designator, as generic functions: their names, before any kind of designator has methods on them.

The methods stand with the kinds: equating in ``equating.py``, resolving in ``resolution.py``. Source: designators.md sections 6, 7.
"""

from __future__ import annotations

from cramhy_runtime.ground.dispatch.generic_functions import generic
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from . import symbols  # noqa: F401  the packages must exist

if TYPE_CHECKING:
    from cramhy_runtime.ground.signatures import GenericOf
    from .classes import Designator

equate: GenericOf[[Designator, Designator], Designator] = generic(
    "DESIG::EQUATE",
    "(parent successor)",
    documentation="""
Join the chains of the two and return the successor; an error if they are one already.""",
)
reference: GenericOf[..., Any] = generic(
    "DESIG::REFERENCE",
    "(desig &optional role)",
    documentation="""
What the designator stands for, always the same object; a designator-error if that cannot be found.""",
)
next_solution: GenericOf[[Designator], Designator | None] = generic(
    "DESIG::NEXT-SOLUTION",
    "(desig)",
    documentation="""
A designator for the next possibility, equated to this one, or nil. For locations always the same object.""",
)
designator_solutions_equal = generic(
    "DESIG::DESIGNATOR-SOLUTIONS-EQUAL",
    "(solution-1 solution-2)",
    documentation="""
Whether two solutions are the same: strings without case, lists by equal, arrays by equalp, else eql.""",
)
