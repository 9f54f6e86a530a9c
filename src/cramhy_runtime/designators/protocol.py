"""The generic functions for any designator, without their methods.

The methods are with their subjects: equating in ``equating.py``, resolving in ``resolution.py``. Source: designators.md sections 6, 7.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from . import symbols  # noqa: F401  the packages must exist

if TYPE_CHECKING:
    from cramhy_runtime.lisp_core.signatures import GenericOf
    from .classes import Designator

equate: GenericOf[[Designator, Designator], Designator] = generic(
    "DESIG::EQUATE",
    "(parent successor)",
    documentation="""
Join the chains of the two designators and return the successor. If they are in one chain already, it is an error.""",
)
reference: GenericOf[..., Any] = generic(
    "DESIG::REFERENCE",
    "(desig &optional role)",
    documentation="""
The object that the designator stands for, always the same one. If it cannot be found, signals a designator-error.""",
)
next_solution: GenericOf[[Designator], Designator | None] = generic(
    "DESIG::NEXT-SOLUTION",
    "(desig)",
    documentation="""
A designator for the next solution, equated to this one, or nil. For a location it is always the same object.""",
)
designator_solutions_equal = generic(
    "DESIG::DESIGNATOR-SOLUTIONS-EQUAL",
    "(solution-1 solution-2)",
    documentation="""
Whether two solutions are the same: strings ignoring case, lists by equal, arrays by equalp, other objects by eql.""",
)
