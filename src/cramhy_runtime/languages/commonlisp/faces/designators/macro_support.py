"""What the macros of the designators call, as functions of the package CRAMHY."""

from __future__ import annotations

import sys

from ....operators import DESIGNATORS
from ...packages.face_definition import define_face, define_meanings
from ...objects.classes import find_class
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.designators import classes, locations
from . import language_support, properties_package


def register_designator_class(type_, class_name):
    """``(register-designator-class type class-name)``, both unevaluated. The class may be defined later."""
    return classes.register_designator_class(keyword(type_.name), find_class(class_name, False) or class_name)


def define():
    """Enter the functions into CRAMHY."""
    define_meanings(DESIGNATORS, locations, properties_package, language_support, adapters=sys.modules[__name__])
    define_face("CRAMHY", functions={language_support: "create-designator"})
