"""Designators: symbolic descriptions that are resolved when their meaning is needed. Usable from Python:

    from cramhy_runtime import designators as desig
    from cramhy_runtime.lisp.data import lisp_list
    from cramhy_runtime.lisp.packages import keyword

    motion = desig.make_designator(keyword("MOTION"), lisp_list(lisp_list(keyword("TYPE"), keyword("DRIVING"))))
    desig.reference(motion)        # the first solution of motion-grounding, or a DesignatorError

``classes`` the kinds and their properties · ``protocol`` what one can ask of them · ``equating`` chains of designators for one
thing · ``resolution``, ``locations`` from description to thing · ``hints`` why not · ``predicates`` for Prolog · ``syntax`` the
notation ``(a motion ...)`` · ``printing`` · ``language_support`` with-designators · ``package`` the Lisp faces. Reference:
designators.md.
"""

from .. import cpl as _cpl  # noqa: F401  the floor below comes first
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
from .equating import current_desig, desig_equal, equate, first_desig
from .resolution import next_solution, reference, resolve_designator

__all__ = [
    "ActionDesignator", "current_desig", "desig_equal", "desig_prop_value", "desig_prop_values", "Designator",
    "DesignatorError", "equate", "first_desig", "HumanDesignator", "LocationDesignator", "make_all_designator",
    "make_designator", "MotionDesignator", "next_solution", "ObjectDesignator", "reference", "resolve_designator",
]  # fmt: skip
