"""Projection: running a plan in an imagined world. From Python:

    from cramhy_runtime import projection as proj

    proj.define_projection_environment(KITCHEN, variables=[(ROBOT_POSE, lambda: start)], modules=[(NAVIGATION, IMAGINED_NAVIGATION)])
    proj.with_projection_environment(KITCHEN, lambda: cpl.top_level(plan)).result     # the list of the plan's values

Where the parts are: ``environments`` imagined worlds, and running a body in one · ``clocks`` their time · ``own_modules`` their process
modules · ``python`` projection for Python · ``symbols`` the Lisp package. Reference: projection-and-events.md part A.
"""

from .clocks import LinearClock, PartiallyOrderedClock, clock_time, clock_wait, with_partially_ordered_clock_disabled
from .environments import define_projection_environment, define_special_projection_variable, with_projection_environment

__all__ = [
    "clock_time", "clock_wait", "define_projection_environment", "define_special_projection_variable", "LinearClock",
    "PartiallyOrderedClock", "with_partially_ordered_clock_disabled", "with_projection_environment",
]  # fmt: skip
