"""What the macros of CRAM-PROJECTION call, as functions of the package CRAMHY: lists come as Lisp lists."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import python_list
from ...packages.face_definition import define_face
from cramhy_runtime.projection import clocks, environments


def define_environment(name, variables, modules, startup, shutdown):
    """``variables`` is a list of lists (symbol function)."""
    return environments.define_projection_environment(
        name, [tuple(pair) for pair in python_list(variables)], python_list(modules), startup, shutdown
    )


def define():
    """Enter the functions into CRAMHY."""
    define_face(
        "CRAMHY",
        functions={
            "define-projection-environment": define_environment,
            "define-special-projection-variable": environments.define_special_projection_variable,
            "with-projection-environment": environments.with_projection_environment,
            "with-partially-ordered-clock-disabled": clocks.with_partially_ordered_clock_disabled,
        },
    )
