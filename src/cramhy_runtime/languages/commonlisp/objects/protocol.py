"""The generic functions of the object system itself, which users specialize: MAKE-INSTANCE, INITIALIZE-INSTANCE, ...

Each has a default method on T (here: `default`, marked so that ``instances.py`` can tell whether users added any). MAKE-INSTANCE
and CHANGE-CLASS are here too, because methods on them are allowed. PRINT-OBJECT is in
``printer/print_methods.py``. Source: ANSI 7.1 to 7.7.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import shown
from cramhy_runtime.lisp_core.conditions import SimpleError, error, type_error, wrong_argument_count
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, MultipleValues, Symbol, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.functions import functionp
from cramhy_runtime.lisp_core.packages import is_symbol, sym, symbol_name
from cramhy_runtime.lisp_core.dispatch import generic_functions as generics
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from ..packages.package_errors import check_function_name
from . import instances, slots
from .builtin_classes import CLASSES
from .class_objects import Slot, direct_slots, effective_slots
from .classes import class_name, find_class_or_error
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction, Method, find_method_or_none, generic, no_method_for
from cramhy_runtime.lisp_core.dispatch.methods import specializer_of
from . import protocol_functions  # noqa: F401  makes the functions that get their defaults here
from cramhy_runtime.lisp_core.dispatch.generic_functions import protocol_function
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_next_method_error

LISP_NAMES = """make-instance allocate-instance initialize-instance reinitialize-instance shared-initialize change-class
update-instance-for-different-class update-instance-for-redefined-class slot-missing slot-unbound no-applicable-method
no-next-method make-load-form make-load-form-saving-slots make-instances-obsolete
ensure-generic-function add-method remove-method find-method compute-applicable-methods method-qualifiers function-keywords
invalid-method-error method-combination-error"""

OPEN = {
    "CLASS-NAME": "(class)",
    "(setf CLASS-NAME)": "(new-value class)",
    "ADD-METHOD": "(generic-function method)",
    "REMOVE-METHOD": "(generic-function method)",
    "FIND-METHOD": "(generic-function qualifiers specializers &optional errorp)",
    "COMPUTE-APPLICABLE-METHODS": "(generic-function arguments)",
    "METHOD-QUALIFIERS": "(method)",
    "FUNCTION-KEYWORDS": "(method)",
    "MAKE-INSTANCES-OBSOLETE": "(class)",
}
"""The functions of metaobjects on which a program may define methods; the standard has them as generic functions."""

MOP_NAMES = """class-precedence-list class-direct-superclasses class-direct-subclasses class-slots class-direct-slots
slot-definition-name slot-definition-initargs slot-definition-type slot-definition-initform slot-definition-initfunction
slot-definition-readers slot-definition-writers slot-definition-allocation generic-function-methods generic-function-name
generic-function-lambda-list method-specializers method-generic-function eql-specializer-object"""
"""Names of the package SB-MOP (the metaobject protocol, as far as programs look at classes with it)."""


make_instance = generic("MAKE-INSTANCE", "(class &rest initargs &key &allow-other-keys)")


def _make_named(name, *initargs, **keywords):
    """``(make-instance 'turtle)`` is ``(make-instance (find-class 'turtle))``, for which users may have methods."""
    if make_instance.user_methods:
        return make_instance(find_class_or_error(name), *initargs, **keywords)
    return instances.make_instance(name, *initargs, **keywords)


for _specializer, _function in ((CLASSES["SYMBOL"], _make_named), (type, instances.make_instance)):
    generics.add_method(make_instance, (), [_specializer], _function, uses_next=False, user=False)
allocate_instance = protocol_function(
    "ALLOCATE-INSTANCE", "(class &rest initargs &key &allow-other-keys)", instances.default_allocate_instance
)
initialize_instance = protocol_function(
    "INITIALIZE-INSTANCE", "(instance &rest initargs &key &allow-other-keys)", instances.default_initialize_instance
)
reinitialize_instance = protocol_function(
    "REINITIALIZE-INSTANCE", "(instance &rest initargs &key &allow-other-keys)", instances.default_reinitialize_instance
)
shared_initialize = protocol_function(
    "SHARED-INITIALIZE", "(instance slot-names &rest initargs &key &allow-other-keys)", instances.default_shared_initialize
)
change_class = protocol_function(
    "CHANGE-CLASS", "(instance new-class &rest initargs &key &allow-other-keys)", instances.default_change_class
)
update_instance_for_different_class = protocol_function(
    "UPDATE-INSTANCE-FOR-DIFFERENT-CLASS",
    "(previous current &rest initargs &key &allow-other-keys)",
    instances.default_update_for_different_class,
)
update_instance_for_redefined_class = protocol_function(
    "UPDATE-INSTANCE-FOR-REDEFINED-CLASS",
    "(instance added-slots discarded-slots property-list &rest initargs &key &allow-other-keys)",
    instances.default_update_for_redefined_class,
)
slot_unbound = protocol_function("SLOT-UNBOUND", "(class instance slot-name)", slots.unbound_slot_error)

_OPERATIONS = {
    "SLOT-VALUE": "read the slot's value (slot-value)",
    "SETF": "set the slot's value to {new} (SETF of SLOT-VALUE)",
    "SLOT-BOUNDP": "test to see whether slot is bound (SLOT-BOUNDP)",
    "SLOT-MAKUNBOUND": "make the slot unbound (SLOT-MAKUNBOUND)",
}


def _slot_missing(cls, instance, slot_name, operation, new_value=None):
    what = _OPERATIONS.get(symbol_name(operation), symbol_name(operation)).replace("{new}", shown(new_value))
    return error(slots.MissingSlot(slot_name, instance, what))


slot_missing = protocol_function("SLOT-MISSING", "(class instance slot-name operation &optional new-value)", _slot_missing)
no_applicable_method = protocol_function(
    "NO-APPLICABLE-METHOD",
    "(generic-function &rest arguments)",
    lambda function, *arguments: generics.no_applicable_method_default(function, arguments),
)
no_next_method = protocol_function(
    "NO-NEXT-METHOD",
    "(generic-function method &rest arguments)",
    lambda function, method, *arguments: no_next_method_error(function, method, arguments),
)


# ------------------------------------------------------------------------------------------------------- slots, making them again


def names_of_slots(object_):
    """The names of the slots of an instance of a class or structure."""
    structure = getattr(type(object_), "lisp_structure", None)
    if structure is not None:
        return [slot.name for slot in structure.slots]
    return list(effective_slots(type(object_)))


make_load_form = protocol_function(
    "MAKE-LOAD-FORM", "(object &optional environment)", lambda object_, environment=None: _cannot_be_dumped(object_)
)


def _cannot_be_dumped(obj):
    if isinstance(obj, type) and is_symbol(class_name(obj)):
        return lisp_list(sym("FIND-CLASS"), lisp_list(sym("QUOTE"), class_name(obj)))
    return error(SimpleError("don't know how to dump ~S (default ~S method called).", obj, sym("MAKE-LOAD-FORM")))


def make_load_form_saving_slots(object, *, slot_names=UNSUPPLIED, environment=None):
    """Two values: the form that makes an object of the class of ``object``, and the one that sets its slots.

    slot_names: the slots to be set, by default all. The second form names the object itself, as a constant.
    """
    quote = sym("QUOTE")
    wanted = names_of_slots(object) if slot_names is UNSUPPLIED else python_list(slot_names)
    creation = lisp_list(sym("ALLOCATE-INSTANCE"), lisp_list(sym("FIND-CLASS"), lisp_list(quote, class_name(type(object)))))
    setters = []
    for slot in wanted:
        place = object, lisp_list(quote, slot)
        if slots.slot_boundp(object, slot):
            setters.append(lisp_list(sym("SETF"), lisp_list(sym("SLOT-VALUE"), *place), lisp_list(quote, slots.slot_value(object, slot))))
        else:  # `allocate-instance` may have methods that give it a value
            setters.append(lisp_list(sym("SLOT-MAKUNBOUND"), *place))
    return MultipleValues((creation, lisp_list(sym("PROGN"), *setters)))


def make_instances_obsolete(class_):
    return class_


# ------------------------------------------------------------------------------------------------------- functions and methods


def ensure_generic_function(
    name,
    *,
    lambda_list=UNSUPPLIED,
    method_combination=None,
    argument_precedence_order=None,
    documentation=None,
    generic_function_class=None,
    method_class=None,
    **others,
):
    """``cl:ensure-generic-function``"""
    if not isinstance(name, (Symbol, Cons)):
        check_function_name(name, "setting fdefinition of ~S")
    function = generics.find_generic_function(name)
    if function is not None and lambda_list is not UNSUPPLIED:
        generics.set_lambda_list(function, lambda_list)
    return generics.ensure_generic_function(
        name,
        None if lambda_list is UNSUPPLIED else lambda_list,
        method_combination=method_combination,
        argument_precedence_order=argument_precedence_order,
        documentation=documentation,
        generic_function_class=generic_function_class,
        method_class=method_class,
    )


def _need_generic(obj):
    """``obj``, a generic function, or the one that it is for programs, as long as no user has a method on it."""
    if isinstance(obj, GenericFunction):
        return obj
    opening = getattr(getattr(obj, "python", obj), "opening", None)
    return type_error(obj, sym("GENERIC-FUNCTION")) if opening is None else generics.ensure_generic_function(opening.name)


def remove_method(generic_function, method):
    """``cl:remove-method``"""
    if not isinstance(generic_function, GenericFunction) or not isinstance(method, Method):
        return no_method_for("REMOVE-METHOD", generic_function, method)
    return generics.remove_method(generic_function, method)


def find_method(generic_function, qualifiers, specializers, errorp=True):
    """``cl:find-method``"""
    if not isinstance(generic_function, GenericFunction):
        return no_method_for("FIND-METHOD", generic_function, qualifiers, specializers)
    wanted = [specializer_of(specializer) for specializer in python_list(specializers)]
    if generic_function.methods and len(wanted) != generic_function.shape.required:
        return error(
            SimpleError(
                "~S has ~D required argument~:P, so a method of it has as many specializers, and not ~S.",
                generic_function,
                generic_function.shape.required,
                specializers,
            )
        )
    method = find_method_or_none(generic_function, python_list(qualifiers), wanted)
    if method is None and errorp is not None:
        which = f"the qualifiers {shown(qualifiers)}" if qualifiers is not None else "no qualifiers"
        return error(SimpleError("There is no method on ~S with ~A and specializers ~S.", generic_function, which, specializers))
    return method


def compute_applicable_methods(generic_function, function_arguments):
    """``cl:compute-applicable-methods``"""
    if not isinstance(generic_function, GenericFunction):
        return no_method_for("COMPUTE-APPLICABLE-METHODS", generic_function, function_arguments)
    arguments = tuple(python_list(function_arguments))
    if len(arguments) < generic_function.shape.required:
        return wrong_argument_count(len(arguments))
    return list_from(generic_function.applicable_methods(arguments))


def add_method(generic_function, method):
    """``cl:add-method``"""
    if not isinstance(generic_function, GenericFunction) or not isinstance(method, Method):
        return no_method_for("ADD-METHOD", generic_function, method)
    owner = method.generic_function
    if owner is not generic_function and owner is not None:
        return error(SimpleError("The method ~S is already part of the generic function ~S.", method, owner))
    generics.enter_method(generic_function, method)
    return generic_function


def method_qualifiers(method):
    """``cl:method-qualifiers``"""
    if not isinstance(method, Method):
        return no_method_for("METHOD-QUALIFIERS", method)
    return list_from(method.qualifiers)


def function_keywords(method):
    """``cl:function-keywords``"""
    if not isinstance(method, Method):
        return no_method_for("FUNCTION-KEYWORDS", method)
    return MultipleValues((list_from(method.shape.keys), True if method.shape.allow_other_keys else None))


def invalid_method_error(method, control, *arguments):
    return error(SimpleError("~@<invalid method error for ~2I~_~S ~I~_method: ~2I~_~?~:>", method, control, list_from(arguments)))


def method_combination_error(control, *arguments):
    """``cl:method-combination-error``"""
    if not isinstance(control, str) and functionp(control) is None:
        return type_error(control, "(OR STRING FUNCTION)")
    return error(SimpleError(control, *arguments))


# --------------------------------------------------------------------------------------------------------- looking at classes


def class_precedence_list(class_):
    return list_from(class_.__mro__)


def class_direct_superclasses(class_):
    return list_from(class_.__bases__)


def class_direct_subclasses(class_):
    return list_from(type.__subclasses__(class_)[::-1])  # the newest first, as on SBCL


def class_slots(class_):
    structure = getattr(class_, "lisp_structure", None)
    if structure is not None:
        return list_from([_slot_of_structure(slot, class_) for slot in structure.slots])
    return list_from(list(effective_slots(class_).values()))


def _slot_of_structure(slot, class_):
    return Slot(slot.name, slot.attribute, (slot.keyword,), slot.initform, None, slot.type, class_)


def class_direct_slots(class_):
    return list_from(direct_slots(class_))


def slot_definition_name(slot):
    return slot.name


def slot_definition_initargs(slot):
    return list_from(slot.initargs)


def slot_definition_type(slot):
    return slot.type


def slot_definition_initform(slot):
    return slot.initform


def slot_definition_initfunction(slot):
    return slot.initfunction


def slot_definition_readers(slot):
    return list_from(slot.readers)


def slot_definition_writers(slot):
    return list_from(slot.writers)


def slot_definition_allocation(slot):
    return sym(":CLASS") if slot.cell is not None else sym(":INSTANCE")


def generic_function_methods(function):
    return list_from(_need_generic(function).methods)


def generic_function_name(function):
    return _need_generic(function).__lisp_name__


def generic_function_lambda_list(function):
    return _need_generic(function).lambda_list


def method_specializers(method):
    return list_from(method.specializers)


def method_generic_function(method):
    return method.generic_function


def eql_specializer_object(specializer):
    return specializer.value


def open_functions():
    """Let programs define methods on the functions `OPEN`, when COMMON-LISP has them."""
    for name, lambda_list in OPEN.items():
        symbol = sym(name.removeprefix("(setf ").removesuffix(")"))
        function = symbol.setf_function if name.startswith("(setf ") else symbol.function
        required = len(lambda_list.strip("()").partition("&")[0].split())
        open_to_methods(getattr(function, "python", function), name, lambda_list, *[None] * required)
