"""Designators: symbolic descriptions that are resolved when their meaning is needed. From Python:

    from cramhy_runtime.designators import Motion, motion_grounding, reference

    class Driving(Motion):
        speed: float

    @motion_grounding(Driving)
    def drive_command(motion):
        return ["drive", motion.speed]

    reference(Driving(speed=1.5))        # ["drive", 1.5], or a DesignatorError where nothing is found

The page docs/reasoning-in-python.md teaches it.

Where the parts are: ``classes`` the kinds and their properties · ``protocol`` generic functions for all · ``equating`` chains of
designators for one thing · ``resolution``, ``locations`` from description to thing, ``shared_calls`` by one task for all,
``clause_index`` its clauses by property · ``hints``, ``failure_causes`` why it failed · ``predicates`` for Prolog · ``defaults`` the
first facts, generators and validators · ``plain_printing`` · ``symbols`` the Lisp packages. For Python: ``python_kinds`` making and
reading them, ``python_resolution``, ``python_grounding``, and for type checkers ``signatures``. The notation ``(a motion ...)`` for Lisp
is in ``languages/commonlisp/faces/designators/package.py`` and its neighbours. Reference: designators.md.
"""

from cramhy_runtime import cpl as _cpl  # noqa: F401  the floor below comes first
from . import hints as _hints  # noqa: F401  errors explain themselves with it
from . import predicates as _predicates  # noqa: F401
from .classes import (
    ActionDesignator,
    Designator,
    DesignatorError,
    HumanDesignator,
    LocationDesignator,
    MotionDesignator,
    ObjectDesignator,
    desig_prop_value,
    desig_prop_values,
    make_all_designator,
    make_designator,
)
from .equating import current_desig, desig_equal, first_desig
from .python_grounding import action_grounding, forget, location_generator, location_validator, motion_grounding
from .python_kinds import Action, Human, Location, Motion, Object, every, properties, property_values, replace
from .python_resolution import equate, equate_callback, next_solution, reference, solutions
from .resolution import resolve_designator

__all__ = [
    "Action", "action_grounding", "ActionDesignator", "current_desig", "desig_equal", "desig_prop_value", "desig_prop_values",
    "Designator", "DesignatorError", "equate", "equate_callback", "every", "first_desig", "forget", "Human", "HumanDesignator", "Location",
    "location_generator", "location_validator", "LocationDesignator", "make_all_designator", "make_designator", "Motion",
    "motion_grounding", "MotionDesignator", "next_solution", "Object", "ObjectDesignator", "properties", "property_values", "reference",
    "replace", "resolve_designator", "solutions",
]  # fmt: skip
