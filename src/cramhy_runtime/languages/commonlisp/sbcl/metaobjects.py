"""More of SB-MOP: what programs ask about classes, slots, methods and generic functions; SB-PCL has the same names.

The protocol cannot be changed by methods on it: classes, slots and dispatch are as they are. Of its functions, users may define methods on
``validate-superclass``, which programs do to allow what is allowed here anyway. Source: chapters 5 and 6 of the MOP.
"""

from __future__ import annotations

import sys

from cramhy_runtime.ground.data import list_from, lisp_list, one
from cramhy_runtime.ground.dispatch.generic_functions import GenericFunction, all_generic_functions, generic
from cramhy_runtime.ground.dispatch.methods import EqlSpecializer
from cramhy_runtime.ground.packages import ensure_package, sym
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.wait_queue import need

from ..objects import protocol, slots
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


def compute_slots(class_: Any) -> object:
    """``sb-mop:compute-slots``: the slots of instances of the class, as they are. Methods on it change what programs get that ask."""
    return protocol.class_slots(class_)


def slot_definition_location(slot: Any) -> object:
    """``sb-mop:slot-definition-location``: the name of the Python attribute that holds the slot."""
    return getattr(slot, "attribute", None)


def slot_value_using_class(class_: Any, instance: Any, slot: Any) -> object:
    """``sb-mop:slot-value-using-class``"""
    return slots.slot_value(instance, slot.name)


def set_slot_value_using_class(new: object, class_: Any, instance: Any, slot: Any) -> object:
    """``(setf sb-mop:slot-value-using-class)``"""
    return slots.set_slot_value(new, instance, slot.name)


def slot_boundp_using_class(class_: Any, instance: Any, slot: Any) -> object:
    """``sb-mop:slot-boundp-using-class``"""
    return slots.slot_boundp(instance, slot.name)


def slot_makunbound_using_class(class_: Any, instance: Any, slot: Any) -> object:
    """``sb-mop:slot-makunbound-using-class``"""
    return slots.slot_makunbound(instance, slot.name)


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


NAMES = """compute-slots
class-default-initargs class-direct-default-initargs class-prototype slot-definition-location slot-value-using-class
slot-boundp-using-class slot-makunbound-using-class method-lambda-list generic-function-method-combination
generic-function-argument-precedence-order generic-function-declarations intern-eql-specializer specializer-direct-methods
specializer-direct-generic-functions"""
OF_COMMON_LISP = """add-method allocate-instance built-in-class class class-name ensure-generic-function generic-function make-instance
method method-combination method-qualifiers remove-method standard-class standard-generic-function standard-method standard-object"""
CLASSES = """eql-specializer forward-referenced-class funcallable-standard-class funcallable-standard-object metaobject specializer
slot-definition direct-slot-definition effective-slot-definition standard-slot-definition standard-direct-slot-definition
standard-effective-slot-definition"""


_SLOT_CLASSES = {
    SlotDefinition: "STANDARD-SLOT-DEFINITION",
    DirectSlot: "DIRECT-SLOT-DEFINITION STANDARD-DIRECT-SLOT-DEFINITION",
    Slot: "EFFECTIVE-SLOT-DEFINITION STANDARD-EFFECTIVE-SLOT-DEFINITION",
}


def define() -> None:
    """Complete SB-MOP, and make SB-PCL of it."""
    this = sys.modules[__name__]
    package = define_face(
        "SB-MOP", functions={this: NAMES}, generic="compute-slots", imports={"COMMON-LISP": OF_COMMON_LISP}, export=CLASSES
    )
    package.intern("SLOT-VALUE-USING-CLASS").setf_function = set_slot_value_using_class
    validate = generic("SB-MOP::VALIDATE-SUPERCLASS", "(class superclass)")
    if not validate.methods:
        validate.method(None, None)(lambda class_, superclass: True)
    package.export(package.intern("VALIDATE-SUPERCLASS"))
    for cls, names in _SLOT_CLASSES.items():
        for name in names.split():
            alias_class(package.intern(name), cls)
    pcl = ensure_package("SB-PCL")
    define_own_type(sym("SB-PCL::CONDITION-CLASS"), lambda thing: isinstance(thing, type) and class_of(thing) is ConditionClass)
    for symbol in list(package.external.values()):
        name = getattr(symbol, "name", None)
        if name is not None and not pcl.present(name):
            pcl.import_symbol(symbol)
            pcl.export(symbol)
