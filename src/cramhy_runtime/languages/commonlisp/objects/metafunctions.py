"""Functions as metaobjects: funcallable instances, generic functions and methods of users' classes, and who is told of changes.

A generic function of a user's class (``:generic-function-class``) is called through the function that ``compute-discriminating-function``
gives for it. All others are called as ever. Source: chapters 5 and 6 of the MOP.
"""

from __future__ import annotations

import weakref

from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, boolean, lisp_list, list_from, one, python_list
from cramhy_runtime.lisp_core.dispatch import generic_functions as generics
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction, when_methods_change
from cramhy_runtime.lisp_core.dispatch.method_combination import AFTER, AROUND, BEFORE, find_combination, link
from cramhy_runtime.lisp_core.dispatch.methods import EqlSpecializer, Method, ReaderMethod, WriterMethod
from cramhy_runtime.lisp_core.packages import sym

from . import protocol_functions
from .builtin_classes import lisp_mro
from .class_objects import StandardObject, when_class_is_changed
from .metaclasses import opened


class FuncallableObject(StandardObject):
    """FUNCALLABLE-STANDARD-OBJECT: the root of the classes whose instances are functions."""

    lisp_name = "SB-MOP::FUNCALLABLE-STANDARD-OBJECT"

    def __call__(self, *arguments, **keywords):
        function = self.__dict__.get("lisp_function")
        if function is None:
            return error(SimpleError("The funcallable instance ~S has no function yet.", self))
        return function(*arguments, **keywords)


def set_funcallable_instance_function(funcallable_instance, function):
    """``sb-mop:set-funcallable-instance-function``: let calls of the instance be calls of ``function``."""
    if isinstance(funcallable_instance, GenericFunction):
        funcallable_instance.call_by(function)
    else:
        funcallable_instance.__dict__["lisp_function"] = function


class UsersGeneric(GenericFunction):
    """The generic functions of users' classes."""

    lisp_name = "STANDARD-GENERIC-FUNCTION"
    by_protocol = True
    discriminating = None

    def __call__(self, *arguments, **keywords):
        function = self.discriminating
        if function is None:
            function = self.discriminating = one(opened(compute_discriminating_function)(self))
        return function(*arguments, **keywords)

    def call_by(self, function):
        """Let ``function`` make the calls until the methods change."""
        self.discriminating = function


def function_base(base):
    """The class that a user's class inherits from where it names the class ``base``."""
    return UsersGeneric if base is GenericFunction else base


def compute_discriminating_function(generic_function):
    """``sb-mop:compute-discriminating-function``: the function that finds the methods for its arguments, and calls them."""
    return lambda *arguments, **keywords: generic_function.lookup(arguments)(*arguments, **keywords)


def compute_applicable_methods_using_classes(generic_function, classes):
    """``sb-mop:compute-applicable-methods-using-classes``: the methods for arguments of ``classes``, and whether that is certain."""
    mros = [lisp_mro(cls) for cls in python_list(classes)]
    found, certain = [], True
    for method in generic_function.methods:
        fits = True
        for specializer, mro in zip(method.specializers, mros):
            if isinstance(specializer, EqlSpecializer):
                certain = (
                    certain and not issubclass(specializer.value.__class__, mro[0]) and mro[0] not in lisp_mro(type(specializer.value))
                )
                fits = False
            elif specializer is not object and specializer not in mro:
                fits = False
        if fits:
            found.append(method)
    order = generic_function.precedence or range(len(mros))
    found.sort(key=lambda method: method.rank(mros, order))
    return MultipleValues((list_from(found), boolean(certain)))


def compute_effective_method(generic_function, method_combination, methods):
    """``sb-mop:compute-effective-method``: the form that calls ``methods``, the most specific first, in the standard combination."""
    groups = {(): [], (AROUND,): [], (BEFORE,): [], (AFTER,): []}
    for method in python_list(methods):
        groups[method.qualifiers].append(method)
    call = sym("CALL-METHOD")
    calls = [lisp_list(call, method) for method in groups[(BEFORE,)]]
    main = lisp_list(call, groups[()][0], list_from(groups[()][1:]))
    afters = [lisp_list(call, method) for method in reversed(groups[(AFTER,)])]
    if calls or afters:
        main = lisp_list(sym("PROGN"), *calls, lisp_list(sym("MULTIPLE-VALUE-PROG1"), main, *afters))
    if groups[(AROUND,)]:
        first, *others = groups[(AROUND,)]
        main = lisp_list(call, first, lisp_list(*others, lisp_list(sym("MAKE-METHOD"), main)))
    return main


def ensure_generic_function_using_class(
    generic_function, name, *, generic_function_class=None, lambda_list=None, method_class=None, **others
):
    """``sb-mop:ensure-generic-function-using-class``"""
    return generics.ensure_generic_function(
        name, lambda_list, generic_function_class=generic_function_class, method_class=method_class, **others
    )


def make_method_lambda(generic_function, method, lambda_expression, environment):
    """``sb-mop:make-method-lambda``: the expression of a function of a list of arguments and one of next methods."""
    given, following, others = Symbol("ARGUMENTS"), Symbol("FOLLOWING"), Symbol("OTHERS")
    form = lisp_list
    first, rest = form(sym("CAR"), following), form(sym("CDR"), following)
    call = form(
        sym("CALL-NEXT-METHOD"),
        form(sym("&REST"), others),
        form(sym("FUNCALL"), form(sym("SB-MOP::METHOD-FUNCTION"), first), form(sym("OR"), others, given), rest),
    )
    exists = form(sym("NEXT-METHOD-P"), None, form(sym("CONSP"), following))
    body = form(sym("FLET"), form(call, exists), form(sym("APPLY"), lambda_expression, given))
    return MultipleValues(
        (form(sym("LAMBDA"), form(given, following), form(sym("DECLARE"), form(sym("IGNORABLE"), following)), body), None)
    )


def generic_function_method_class(function):
    """``sb-mop:generic-function-method-class``"""
    return Method if function.method_class is None else function.method_class.made_class


def find_method_combination(generic_function, name, options):
    """``sb-mop:find-method-combination``"""
    return find_combination(name)


# ------------------------------------------------------------------------------------------------------------------- methods


def method_function(method):
    """``sb-mop:method-function``: the function of a list of arguments and one of next methods."""
    if not isinstance(method, Method):
        return lambda arguments, following=None: method(*python_list(arguments))  # what a user's function got as its next method
    if method.metafunction is not None:
        return method.metafunction

    def call(arguments, following=None):
        given = python_list(arguments)
        classes = tuple(argument.__class__ for argument in given)
        return link(method.generic_function, [method, *python_list(following)], classes).function(*given)

    return call


def as_method_of(cls):
    """The function that makes a `Method` one of the user's class ``cls``, and fills the slots that this has."""

    def make(method):
        method.__class__ = cls
        protocol_functions.initialize_instance(method)
        return method

    make.made_class = cls
    return make


def accessor_method_slot_definition(method):
    """``sb-mop:accessor-method-slot-definition``: the direct slot definition for which an accessor was made."""
    return method.slot_definition


def reader_method_class(class_, direct_slot, *initargs):
    """``sb-mop:reader-method-class``"""
    return ReaderMethod


def writer_method_class(class_, direct_slot, *initargs):
    """``sb-mop:writer-method-class``"""
    return WriterMethod


def _required(specialized_lambda_list):
    """The required parameters of a method's lambda list, and what follows them."""
    items = python_list(specialized_lambda_list)
    first = next((index for index, item in enumerate(items) if isinstance(item, Symbol) and item.name.startswith("&")), len(items))
    return items[:first], items[first:]


def extract_lambda_list(specialized_lambda_list):
    """``sb-mop:extract-lambda-list``: a lambda list without the specializers."""
    required, others = _required(specialized_lambda_list)
    return list_from([*(item.car if isinstance(item, Cons) else item for item in required), *others])


def extract_specializer_names(specialized_lambda_list):
    """``sb-mop:extract-specializer-names``: the names of the specializers, T where there is none."""
    required, _ = _required(specialized_lambda_list)
    return list_from([item.cdr.car if isinstance(item, Cons) else True for item in required])


# --------------------------------------------------------------------------------------------------------------------- slots


def standard_instance_access(instance, location):
    """``sb-mop:standard-instance-access``: the value of a slot by its location, whatever methods there are."""
    return instance.__dict__[location]


def set_standard_instance_access(new, instance, location):
    """``(setf sb-mop:standard-instance-access)``"""
    instance.__dict__[location] = new
    return new


# ---------------------------------------------------------------------------------------------------------------- dependents

_dependents: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()


def add_dependent(metaobject, dependent):
    """``sb-mop:add-dependent``: tell ``dependent`` when the class or generic function changes, by ``update-dependent``."""
    known = _dependents.setdefault(metaobject, [])
    if dependent not in known:
        known.append(dependent)


def remove_dependent(metaobject, dependent):
    """``sb-mop:remove-dependent``"""
    if dependent in _dependents.get(metaobject, ()):
        _dependents[metaobject].remove(dependent)


def map_dependents(metaobject, function):
    """``sb-mop:map-dependents``: call ``function`` with each dependent."""
    called = function.function if isinstance(function, Symbol) else function
    for dependent in list(_dependents.get(metaobject, ())):
        called(dependent)


def update_dependent(metaobject, dependent, *initargs):
    """``sb-mop:update-dependent``: what a change means to ``dependent``; programs have methods for theirs."""


def _tell(metaobject, *initargs):
    for dependent in list(_dependents.get(metaobject, ())):
        opened(update_dependent)(metaobject, dependent, *initargs)


@when_methods_change
def _methods_changed(generic_function):
    if _dependents:
        _tell(generic_function)


when_class_is_changed(lambda cls: _tell(cls) if _dependents else None)


def add_direct_method(specializer, method):
    """``sb-mop:add-direct-method``: nothing, since methods are found by their generic functions."""


def remove_direct_method(specializer, method):
    """``sb-mop:remove-direct-method``: nothing."""


def add_direct_subclass(class_, subclass):
    """``sb-mop:add-direct-subclass``: nothing, since Python knows the subclasses."""


def remove_direct_subclass(class_, subclass):
    """``sb-mop:remove-direct-subclass``: nothing."""
