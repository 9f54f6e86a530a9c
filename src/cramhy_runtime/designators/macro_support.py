"""What the macros of the designators call, as functions of the package CRAMHY."""

from __future__ import annotations

from ..lisp.faces import define_face
from ..lisp.objects.classes import find_class
from ..lisp.packages import keyword
from .symbols import sym
from . import classes, language_support, locations, properties_package


def register_designator_class(type_, class_name):
    """``(register-designator-class type class-name)``, both unevaluated. The class may be defined later."""
    return classes.register_designator_class(keyword(type_.name), find_class(class_name, False) or class_name)


SHAPES = """
(a type (key value)...)
(all types (key value)...)
(an type (key value)...)
(register-designator-class type class)
(register-location-generator priority function ["documentation"])
(register-location-validation-function priority function ["documentation"])
(with-desig-props (property...) designator form...)
(with-designator-solution-filter filter form...)
(with-equate-callback (designator callback) form...)
(cpl-desig-supp::with-designators ((name type properties)...) form...)
(cpl-desig-supp::with-equate-fluent (designator fluent) form...)
""".strip().splitlines()
"""How the macros are written, for the report of a call that has another shape."""


def define():
    """Enter the functions into CRAMHY, and let the names of the macros know how they are written."""
    for shape in SHAPES:
        name = shape.split()[0].strip("(").upper()
        symbol = sym(name if "::" in name else f"DESIG::{name}")
        symbol.compiler_data = {**(symbol.compiler_data or {}), "shape": shape.replace("cpl-desig-supp::", "")}
    define_face("CRAMHY", functions={
        "register-designator-class": register_designator_class,
        "register-location-generator": locations.register_location_generator,
        "register-location-validation-function": locations.register_location_validation_function,
        "with-designator-solution-filter": locations.with_designator_solution_filter,
        "define-designator-package": properties_package.define_designator_package,
        "create-designator": language_support.create_designator,
        "with-designators-node": lambda names, body: language_support.with_designators(body, names),
        "with-equate-fluent": language_support.with_equate_fluent,
    })
