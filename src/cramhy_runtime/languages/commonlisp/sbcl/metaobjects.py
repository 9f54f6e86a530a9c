"""More of SB-MOP: what programs ask about classes, slots, methods and generic functions; SB-PCL has the same names.

What users may change by methods is in `objects.metaclasses` and `objects.metafunctions`. Source: chapters 5 and 6 of the MOP.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import boolean, list_from, lisp_list, one
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction, all_generic_functions
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.lisp_core.dispatch.methods import EqlSpecializer
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import ensure_package, sym
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.wait_queue import need

from ..objects import metaclasses, metafunctions
from ..objects.class_definition import default_initargs
from ..objects.class_objects import DirectSlot, Slot, SlotDefinition
from ..objects.classes import ConditionClass, alias_class, class_of
from ..objects.protocol import allocate_instance
from ..packages.face_definition import define_face
from ..types.types import define_own_type


def class_default_initargs(class_: Any) -> object:
    """``sb-mop:class-default-initargs``: a list of (initarg, form, function); the form is not kept, so nil stands for it."""
    return list_from([lisp_list(key, None, thunk) for key, thunk in default_initargs(class_).items()])


def class_direct_default_initargs(class_: Any) -> object:
    """``sb-mop:class-direct-default-initargs``: as `class_default_initargs`, those of the class itself."""
    return list_from([lisp_list(key, None, thunk) for key, thunk in vars(class_).get("lisp_default_initargs", ())])


_prototypes: dict[type, object] = {}


def class_prototype(class_: Any) -> object:
    """``sb-mop:class-prototype``: an instance of the class, always the same, whose slots are unbound."""
    if class_ not in _prototypes:
        _prototypes[class_] = one(allocate_instance(class_))
    return _prototypes[class_]


def slot_definition_location(slot: Any) -> object:
    """``sb-mop:slot-definition-location``: the name of the Python attribute that holds the slot."""
    return getattr(slot, "attribute", None)


def classp(thing: object) -> object:
    """``sb-pcl:classp``: whether ``thing`` is a class."""
    return boolean(isinstance(thing, type))


def _generic_function(thing: Any) -> GenericFunction:
    return need(thing, GenericFunction, "GENERIC-FUNCTION")


def method_lambda_list(method: Any) -> object:
    """``sb-mop:method-lambda-list``: that of its generic function, where the method's own is not kept."""
    own = getattr(method, "lambda_list", None)
    return method.generic_function.lambda_list if own is None and method.generic_function is not None else own


def generic_function_method_combination(function: Any) -> object:
    """``sb-mop:generic-function-method-combination``: the name of the combination, and its options."""
    found = _generic_function(function)
    return lisp_list(getattr(found.combination, "name", None), *found.combination_options)


def generic_function_argument_precedence_order(function: Any) -> object:
    """``sb-mop:generic-function-argument-precedence-order``"""
    found = _generic_function(function)
    order = found.precedence if found.precedence is not None else range(found.shape.required)
    return list_from([found.shape.names[index] for index in order])


def generic_function_declarations(function: Any) -> None:
    """``sb-mop:generic-function-declarations``: none are kept."""
    _generic_function(function)


def intern_eql_specializer(value: object) -> EqlSpecializer:
    """``sb-mop:intern-eql-specializer``"""
    return EqlSpecializer(value)


def specializer_direct_methods(specializer: Any) -> object:
    """``sb-mop:specializer-direct-methods``: the methods of all generic functions that name the specializer."""
    return list_from([method for function in all_generic_functions for method in function.methods if specializer in method.specializers])


def specializer_direct_generic_functions(specializer: Any) -> object:
    """``sb-mop:specializer-direct-generic-functions``"""
    return list_from(
        [function for function in all_generic_functions if any(specializer in method.specializers for method in function.methods)]
    )


NAMES = """class-default-initargs class-direct-default-initargs class-prototype slot-definition-location
method-lambda-list generic-function-method-combination
generic-function-argument-precedence-order generic-function-declarations intern-eql-specializer specializer-direct-methods
specializer-direct-generic-functions"""
OF_CLASSES = {
    "validate-superclass": "(class superclass)",
    "ensure-class-using-class": "(class name &rest initargs &key &allow-other-keys)",
    "direct-slot-definition-class": "(class &rest initargs &key &allow-other-keys)",
    "effective-slot-definition-class": "(class &rest initargs &key &allow-other-keys)",
    "finalize-inheritance": "(class)",
    "class-finalized-p": "(class)",
    "compute-class-precedence-list": "(class)",
    "compute-slots": "(class)",
    "compute-effective-slot-definition": "(class name direct-slot-definitions)",
    "compute-default-initargs": "(class)",
    "slot-value-using-class": "(class instance slot)",
    "slot-boundp-using-class": "(class instance slot)",
    "slot-makunbound-using-class": "(class instance slot)",
}
"""The functions by which classes of users' metaclasses are made, and their slots reached: their lambda lists."""
OF_FUNCTIONS = {
    "compute-discriminating-function": "(generic-function)",
    "compute-applicable-methods-using-classes": "(generic-function classes)",
    "compute-effective-method": "(generic-function method-combination methods)",
    "make-method-lambda": "(generic-function method lambda-expression environment)",
    "generic-function-method-class": "(generic-function)",
    "find-method-combination": "(generic-function name options)",
    "accessor-method-slot-definition": "(method)",
    "reader-method-class": "(class direct-slot &rest initargs)",
    "writer-method-class": "(class direct-slot &rest initargs)",
    "add-dependent": "(metaobject dependent)",
    "remove-dependent": "(metaobject dependent)",
    "map-dependents": "(metaobject function)",
    "update-dependent": "(metaobject dependent &rest initargs)",
    "add-direct-method": "(specializer method)",
    "remove-direct-method": "(specializer method)",
    "add-direct-subclass": "(class subclass)",
    "remove-direct-subclass": "(class subclass)",
}
"""The same for functions, methods and those who are told of changes."""
PLAIN = """method-function set-funcallable-instance-function extract-lambda-list extract-specializer-names standard-instance-access
ensure-generic-function-using-class"""
OF_COMMON_LISP = """add-method allocate-instance built-in-class class class-name compute-applicable-methods ensure-generic-function
function generic-function make-instance
method method-combination method-qualifiers remove-method standard-class standard-generic-function standard-method standard-object"""
CLASSES = """eql-specializer forward-referenced-class funcallable-standard-class funcallable-standard-object metaobject specializer
slot-definition direct-slot-definition effective-slot-definition standard-slot-definition standard-direct-slot-definition
standard-effective-slot-definition standard-accessor-method standard-reader-method standard-writer-method"""


_SLOT_CLASSES = {
    SlotDefinition: "STANDARD-SLOT-DEFINITION",
    DirectSlot: "DIRECT-SLOT-DEFINITION STANDARD-DIRECT-SLOT-DEFINITION",
    Slot: "EFFECTIVE-SLOT-DEFINITION STANDARD-EFFECTIVE-SLOT-DEFINITION",
}


def _open(function: Any, name: str, lambda_list: str) -> None:
    """Let users define methods on ``function``, the function of ``name``."""
    if not hasattr(function, "opening"):
        open_to_methods(function, name, lambda_list, *[None] * len(lambda_list.strip("()").partition("&")[0].split()))


def define() -> None:
    """Complete SB-MOP, and make SB-PCL of it."""
    this = sys.modules[__name__]
    package = define_face(
        "SB-MOP",
        functions={
            this: NAMES,
            metaclasses: f"ensure-class {' '.join(OF_CLASSES)}",
            metafunctions: f"{PLAIN} {' '.join(OF_FUNCTIONS)}",
            "funcallable-standard-instance-access": metafunctions.standard_instance_access,
        },
        imports={"COMMON-LISP": OF_COMMON_LISP},
        export=CLASSES,
    )
    for module, table in ((metaclasses, OF_CLASSES), (metafunctions, OF_FUNCTIONS)):
        for name, lambda_list in table.items():
            _open(getattr(module, name.replace("-", "_")), f"SB-MOP::{name.upper()}", lambda_list)
    for name in ("STANDARD-INSTANCE-ACCESS", "FUNCALLABLE-STANDARD-INSTANCE-ACCESS"):
        package.intern(name).setf_function = metafunctions.set_standard_instance_access
    _open(metaclasses.set_slot_value_using_class, "(setf SB-MOP::SLOT-VALUE-USING-CLASS)", "(new-value class instance slot)")
    for cls, names in _SLOT_CLASSES.items():
        for name in names.split():
            alias_class(package.intern(name), cls)
    pcl = ensure_package("SB-PCL")
    symbol = pcl.intern("CLASSP")
    symbol.function = lispify(classp)
    pcl.export(symbol)
    define_own_type(sym("SB-PCL::CONDITION-CLASS"), lambda thing: isinstance(thing, type) and class_of(thing) is ConditionClass)
    for symbol in list(package.external.values()):
        name = getattr(symbol, "name", None)
        if name is not None and not pcl.present(name):
            pcl.import_symbol(symbol)
            pcl.export(symbol)
