"""How classes, generic functions, methods and method combinations print: ``#<STANDARD-GENERIC-FUNCTION TUT::MOVE (3)>``.

The names have their package in front, always, as in SBCL.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from .print_names import symbol_with_prefix, token
from .printer import define_printer, output_object, print_unreadable
from ..objects.classes import class_name, has_own_name, metaclass_of
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.dispatch.generic_errors import ShownAsGeneric
from cramhy_runtime.lisp_core.dispatch.method_combination import Combination
from cramhy_runtime.lisp_core.dispatch.methods import EqlSpecializer, Method


def name_text(name):
    """A function name with packages: ``TUT::MOVE`` or ``(COMMON-LISP:SETF TUT::SPEED)``."""
    if is_symbol(name):
        return symbol_with_prefix(name)
    if isinstance(name, Cons):
        return "(" + " ".join(name_text(part) for part in name) + ")"
    return str(name)


def print_class(cls, stream):
    """``#<STANDARD-CLASS TUT::TURTLE>``; a Python class without a Lisp name prints as Python shows it."""
    kind = metaclass_of(cls)
    if cls not in (object, type) and not has_own_name(cls):
        return print_unreadable(cls, stream, "PYTHON " + repr(cls))

    def contents():
        output_object(class_name(kind), stream)
        stream.write(" " + symbol_with_prefix(class_name(cls)))

    return print_unreadable(cls, stream, body=contents)


def print_generic_function(function, stream):
    def contents():
        output_object(class_name(type(function)), stream)
        stream.write(f" {name_text(function.__lisp_name__)} ({len(function.methods)})")

    print_unreadable(function, stream, body=contents)


def specializer_names(method):
    """What the required parameters of ``method`` are specialized on, a Lisp list of class names and ``(eql value)``."""
    return list_from(
        [lisp_list(sym("EQL"), each.value) if isinstance(each, EqlSpecializer) else class_name(each) for each in method.specializers]
    )


def print_method(method, stream):
    def contents():
        output_object(class_name(type(method)), stream)
        if method.generic_function is not None:
            stream.write(f" {name_text(method.generic_function.__lisp_name__)}")
        stream.write(" ")
        for qualifier in method.qualifiers:
            output_object(qualifier, stream)
            stream.write(" ")
        output_object(specializer_names(method), stream)

    print_unreadable(method, stream, body=contents, identity=True)


def _print_combination(combination, stream):
    print_unreadable(combination, stream, f"{token('METHOD-COMBINATION')} {name_text(combination.name)}", identity=True)


def _print_shown_as_generic(function, stream):
    count = "" if function.methods is None else f" ({function.methods})"
    stream.write(f"#<{token('STANDARD-GENERIC-FUNCTION')} {function.name}{count}>")


define_printer(type, print_class)
define_printer(GenericFunction, print_generic_function)
define_printer(Method, print_method)
define_printer(Combination, _print_combination)
define_printer(ShownAsGeneric, _print_shown_as_generic)
