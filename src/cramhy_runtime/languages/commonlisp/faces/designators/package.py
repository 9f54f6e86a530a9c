"""The faces of the designators: CRAM-DESIGNATORS, CRAM-DESIGNATOR-PROPERTIES, CRAM-LANGUAGE-DESIGNATOR-SUPPORT (designators.md 11)."""

from __future__ import annotations

from ...packages.face_definition import define_face
from ...syntax.operator_macros import export
from ....operators import DESIGNATORS
from cramhy_runtime.cpl.task_variables import define_task_state
from cramhy_runtime.utilities.symbols import CUT
from cramhy_runtime.designators import classes, equating, locations, resolution
from . import language_support, macro_support, readers, syntax
from cramhy_runtime.designators import defaults as _defaults  # noqa: F401  the predicates and the generators that come along
from cramhy_runtime.designators.symbols import sym

FUNCTIONS = {
    classes: "copy-designator merge-desig-descriptions extend-designator-properties update-designator-properties "
    "make-effective-designator desig-prop-value desig-prop-values get-all-designators make-designator",
    equating: "equate desig-equal first-desig current-desig newest-effective-designator get-equal-designators designator-solutions "
    "register-equate-callback unregister-equate-callback",
    resolution: "reference resolve-designator next-solution designator-solutions-equal designator-pose designator-distance "
    "loc-desig-location",
    locations: "list-location-generators list-location-validation-functions delete-location-generator-function "
    "delete-location-validation-function enable-location-generator-function disable-location-generator-function "
    "enable-location-validation-function disable-location-validation-function validate-location-designator-solution "
    "next-filtered-designator-solution",
    readers: "description properties parent successor effective quantifier object-pose object-color object-identifier designator",
}

INTERNAL = {
    "make-all-designator": classes.make_all_designator,
    "present": syntax.present,
    "global-value": syntax.global_value,
    "value-of": syntax.value_of,
    "location-prolog-generator": locations.location_prolog_generator,
    "filter-solution": locations.filter_solution,
    "location-prolog-validator": locations.location_prolog_validator,
}

EXPORTED = """designator-id-mixin equate-notification-mixin object-designator action-designator motion-designator location-designator
    human-designator object-designator-data designator-error action-grounding motion-grounding location-grounding desig-reference
    designator-groundings current-designator loc-desig? obj-desig? action-desig? motion-desig? desig-prop desig-class desig-timestamp
    desig-description effective-designator desig-value desig-location-prop equated-desigs *default-role*
    *designator-pprint-description* *location-generator-max-retries* data desig action object location human accept-solution
    reject-solution register-object-desig-resolver resolve-object-desig assert-desig-binding retract-desig-binding"""


def define_faces():
    """Declare the packages. Those of Prolog and CPL must exist."""
    CUT.export(CUT.intern("TIMESTAMP"))
    desig = define_face(
        "CRAM-DESIGNATORS",
        ["DESIG"],
        use=["COMMON-LISP", "CRAM-PROLOG", "CRAM-UTILITIES"],
        functions={**FUNCTIONS, **INTERNAL},
        export=EXPORTED,
        internal=" ".join(INTERNAL),
        imports={"CRAM-UTILITIES": "timestamp", "CRAM-PROLOG": "object-id", "COMMON-LISP": "when"},
    )
    define_task_state(desig, "*DESIGNATORS*", readers.table_of_designators, readers.forget_designators)
    sym("CUT::TIMESTAMP").function = readers.timestamp
    readers.open_readers()
    define_face("CRAM-DESIGNATOR-PROPERTIES", ["DESIG-PROPS"], use=["COMMON-LISP"])
    define_face(
        "CRAM-LANGUAGE-DESIGNATOR-SUPPORT",
        ["CPL-DESIG-SUPP"],
        use=["CRAM-LANGUAGE"],
        functions={language_support: "register-designator-create-function"},
    )
    export(DESIGNATORS)
    macro_support.define()
    return desig


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_faces()
