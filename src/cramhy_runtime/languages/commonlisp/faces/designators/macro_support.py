"""What the macros of the designators call, as functions of the package CRAMHY."""

from __future__ import annotations

from ...packages.face_definition import define_face
from ...objects.classes import find_class
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.designators import classes, locations
from . import language_support, properties_package


def register_designator_class(type_, class_name):
    """``(register-designator-class type class-name)``, both unevaluated. The class may be defined later."""
    return classes.register_designator_class(keyword(type_.name), find_class(class_name, False) or class_name)


def define():
    """Enter the functions into CRAMHY."""
    define_face(
        "CRAMHY",
        functions={
            "register-designator-class": register_designator_class,
            "register-location-generator": locations.register_location_generator,
            "register-location-validation-function": locations.register_location_validation_function,
            "with-designator-solution-filter": locations.with_designator_solution_filter,
            "define-designator-package": properties_package.define_designator_package,
            "create-designator": language_support.create_designator,
            "with-designators-node": lambda names, body: language_support.with_designators(body, names),
            "with-equate-fluent": language_support.with_equate_fluent,
        },
    )
