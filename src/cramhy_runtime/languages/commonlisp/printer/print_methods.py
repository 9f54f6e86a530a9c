"""PRINT-OBJECT: the printer asks the methods that users gave it, and its own method is the printer's (ANSI 22.4).

The printer does not look for methods while nobody has added one. Which classes have methods of users is noted, and forgotten when
classes or methods change.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.classes import when_classes_change
from cramhy_runtime.lisp_core.dispatch.generic_functions import EqlSpecializer, protocol_function, when_methods_change
from ..objects import instances
from ..streams.streams import output_stream
from . import printer
from .printer import standard_print_object

LISP_NAMES = "print-object"


def _print_object(object_, stream):
    standard_print_object(object_, output_stream(stream))
    return object_


print_object = protocol_function("PRINT-OBJECT", "(object stream)", _print_object)
_printed_by_users: dict = {}


@when_classes_change
def _forget_printing():
    _printed_by_users.clear()


@when_methods_change
def _print_methods_changed(function):
    if function is print_object:
        _printed_by_users.clear()
        printer.print_through(_print_by_method if len(print_object.methods) > 1 else None)


def _print_by_method(obj, stream):
    """Call the user's print-object method for ``obj``; ``False`` when there is none."""
    cls = obj.__class__
    found = _printed_by_users.get(cls)
    if found is None:
        found = _printed_by_users[cls] = any(
            isinstance(method.specializers[0], EqlSpecializer) or issubclass(cls, method.specializers[0])
            for method in print_object.methods
            if not getattr(method.function, "lisp_default", False)
        ) or bool(instances.applicable_user_methods(print_object, cls))
    if not found:
        return False
    print_object(obj, stream)
    return True
