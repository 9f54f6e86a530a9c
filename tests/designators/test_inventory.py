"""The names of the designator packages: whether they are exported, what they name, their lambda lists (designators.md 1, 2, 10, 11)."""

import pytest

from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.data import UNBOUND, UndefinedFunction
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import lambda_list_of
from cramhy_runtime.languages.commonlisp.syntax.macros import ensure_loaded
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP, find_package
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.types.types import is_known_type
from cramhy_runtime.prolog.engine.database import functors

boot()
ensure_loaded()
DESIG, PROPS, SUPPORT = (find_package(name) for name in ("DESIG", "DESIG-PROPS", "CPL-DESIG-SUPP"))

CLASSES = """designator designator-id-mixin equate-notification-mixin object-designator action-designator motion-designator
    location-designator human-designator object-designator-data designator-error"""
MACROS = """a an all when register-designator-class with-desig-props with-equate-callback register-location-generator
    register-location-validation-function with-designator-solution-filter"""
GENERIC = """reset make-designator equate desig-equal first-desig current-desig reference next-solution resolve-designator
    designator-solutions-equal designator-pose designator-distance register-equate-callback unregister-equate-callback"""
READERS = """timestamp description properties parent successor effective quantifier object-id object-pose object-color object-identifier
    designator"""
FUNCTIONS = """copy-designator merge-desig-descriptions extend-designator-properties rename-designator-property-key make-effective-designator
    newest-effective-designator designator-solutions desig-prop-value desig-prop-values get-equal-designators update-designator-properties
    list-location-generators list-location-validation-functions loc-desig-location delete-location-generator-function
    delete-location-validation-function enable-location-generator-function disable-location-generator-function
    enable-location-validation-function disable-location-validation-function validate-location-designator-solution
    next-filtered-designator-solution get-all-designators
    resolve-location-designator-through-generators-and-validators"""
PREDICATES = """action-grounding motion-grounding location-grounding desig-reference designator-groundings current-designator loc-desig?
    obj-desig? action-desig? motion-desig? desig-prop desig-class desig-timestamp desig-description effective-designator desig-value
    desig-location-prop equated-desigs desig-equal newest-effective-designator designator"""
VARIABLES = "*default-role* *designator-pprint-description* *location-generator-max-retries* *print-location-validation-function-results*"
ONLY_SYMBOLS = """data desig action object location human accept-solution reject-solution register-object-desig-resolver
    resolve-object-desig assert-desig-binding retract-desig-binding"""
NOT_IN_THIS_VERSION = "the some next-different-solution *retries* desig-prop-function"

LAMBDA_LISTS = {
    "make-designator": "(CLASS DESCRIPTION &OPTIONAL PARENT)",
    "copy-designator": "(OLD-DESIGNATOR &KEY NEW-DESCRIPTION)",
    "merge-desig-descriptions": "(DESIGNATOR NEW-DESCRIPTION)",
    "extend-designator-properties": "(DESIGNATOR PROPERTY-EXTENSION)",
    "update-designator-properties": "(NEW-PROPERTIES OLD-PROPERTIES)",
    "make-effective-designator": "(PARENT &KEY NEW-PROPERTIES DATA-OBJECT TIMESTAMP)",
    "desig-prop-value": "(DESIG PROP-NAME)",
    "desig-prop-values": "(DESIGNATOR PROPERTY-NAME)",
    "equate": "(PARENT SUCCESSOR)",
    "desig-equal": "(DESIG-1 DESIG-2)",
    "first-desig": "(DESIG)",
    "current-desig": "(DESIG)",
    "newest-effective-designator": "(DESIG)",
    "get-equal-designators": "(D)",
    "designator-solutions": "(DESIG &OPTIONAL FROM-ROOT)",
    "register-equate-callback": "(DESIGNATOR CALLBACK)",
    "unregister-equate-callback": "(DESIGNATOR CALLBACK)",
    "reference": "(DESIG &OPTIONAL ROLE)",
    "resolve-designator": "(DESIG ROLE)",
    "next-solution": "(DESIG)",
    "designator-solutions-equal": "(SOLUTION-1 SOLUTION-2)",
    "designator-pose": "(DESIG)",
    "designator-distance": "(DESIG-1 DESIG-2)",
    "list-location-generators": "NIL",
    "list-location-validation-functions": "NIL",
    "delete-location-generator-function": "(FUNCTION-NAME)",
    "delete-location-validation-function": "(FUNCTION-NAME)",
    "enable-location-generator-function": "(FUNCTION-NAME)",
    "disable-location-generator-function": "(FUNCTION-NAME)",
    "enable-location-validation-function": "(FUNCTION-NAME)",
    "disable-location-validation-function": "(FUNCTION-NAME)",
    "validate-location-designator-solution": "(DESIGNATOR SOLUTION)",
    "next-filtered-designator-solution": "(DESIGNATOR FILTER)",
    "loc-desig-location": "(LOC-DESIG)",
    "get-all-designators": "NIL",
    "reset": "(DESIG)",
    "rename-designator-property-key": "(DESIGNATOR OLD-PROPERTY NEW-PROPERTY)",
    "resolve-location-designator-through-generators-and-validators": "(DESIG)",
}


@pytest.fixture(autouse=True, params=["once"])
def fresh_kernel():
    """Names need no back end."""


def symbol(name, package=DESIG):
    found, status = package.lookup(name.upper())
    assert status == "external", name
    return found


def test_the_classes():
    for name in CLASSES.split():
        assert is_known_type(symbol(name)), name


def test_the_macros():
    for name in MACROS.split():
        assert symbol(name).macro is not None or symbol(name) is COMMON_LISP.external["WHEN"], name


def test_the_generic_functions_and_what_becomes_one_when_a_method_is_defined():
    for name in GENERIC.split():
        assert isinstance(symbol(name).function, GenericFunction), name
    for name in READERS.split():
        assert not isinstance(symbol(name).function, UndefinedFunction), name


def test_the_functions_and_variables():
    for name in FUNCTIONS.split():
        assert symbol(name).function.__class__ is not UndefinedFunction, name
    for name in VARIABLES.split():
        assert symbol(name).special and symbol(name).value is not UNBOUND, name


def test_the_predicates():
    for name in PREDICATES.split():
        assert symbol(name) in functors and functors[symbol(name)].defined, name


def test_the_symbols_that_name_nothing():
    for name in ONLY_SYMBOLS.split():
        found = symbol(name)
        assert found.macro is None and isinstance(found.function, UndefinedFunction) and found.value is UNBOUND, name


def test_nothing_else_is_exported():
    listed = f"{CLASSES} {MACROS} {GENERIC} {READERS} {FUNCTIONS} {PREDICATES} {VARIABLES} {ONLY_SYMBOLS}".upper().split()
    assert set(DESIG.external) == set(listed)


def test_the_other_two_packages():
    assert symbol("def-desig-package", PROPS).macro is not None
    assert symbol("with-designators", SUPPORT).macro is not None and symbol("with-equate-fluent", SUPPORT).macro is not None
    assert symbol("register-designator-create-function", SUPPORT).function.__class__ is not UndefinedFunction
    assert set(SUPPORT.external) == {"WITH-DESIGNATORS", "WITH-EQUATE-FLUENT", "REGISTER-DESIGNATOR-CREATE-FUNCTION"}
    assert {package.name for package in DESIG.use} == {"COMMON-LISP", "CRAM-PROLOG", "CRAM-UTILITIES"}


def test_names_that_belong_to_other_packages():
    assert symbol("timestamp") is find_package("CRAM-UTILITIES").external["TIMESTAMP"]
    assert symbol("object-id") is find_package("CRAM-PROLOG").external["OBJECT-ID"]
    assert all(DESIG.lookup(name.upper())[1] != "external" for name in NOT_IN_THIS_VERSION.split())


@pytest.mark.parametrize("name, lambda_list", LAMBDA_LISTS.items())
def test_lambda_lists(name, lambda_list):
    assert prin1_to_string(lambda_list_of(symbol(name).function)).replace("#:", "") == lambda_list
