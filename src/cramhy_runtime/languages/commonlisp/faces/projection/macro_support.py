"""What the macros of CRAM-PROJECTION call, as functions of the package CRAMHY: lists come as Lisp lists."""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import python_list
from ....operators import PROJECTION
from ...packages.face_definition import define_meanings
from cramhy_runtime.projection import clocks, environments


def define_projection_environment(name, variables, modules, startup, shutdown):
    """``variables`` is a list of lists (symbol function)."""
    return environments.define_projection_environment(
        name, [tuple(pair) for pair in python_list(variables)], python_list(modules), startup, shutdown
    )


def define():
    """Enter the functions into CRAMHY."""
    define_meanings(PROJECTION, environments, clocks, adapters=sys.modules[__name__])
