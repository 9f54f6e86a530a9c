"""Designators: symbolic descriptions that are resolved when their meaning is needed. Usable from Python:

    from cramhy_runtime.designators import Motion, motion_grounding, reference

    class Driving(Motion):
        speed: float

    @motion_grounding(Driving)
    def drive_command(motion):
        return ["drive", motion.speed]

    reference(Driving(speed=1.5))        # ["drive", 1.5], or a DesignatorError where nothing is found

The page docs/reasoning-in-python.md tells the whole story.

``classes`` the kinds and their properties · ``protocol`` what one can ask of them · ``equating`` chains of designators for one
thing · ``resolution``, ``locations`` from description to thing · ``hints`` why not · ``predicates`` for Prolog · ``plain_printing``.
Python's face: ``python_kinds`` making and reading them, ``python_resolution``, ``python_grounding``. The Lisp face, with the notation
``(a motion ...)``, is ``languages/commonlisp/faces/designators/package.py`` and its neighbours. Reference: designators.md.
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
