"""What the functions of cl-transforms accept, and their errors.

A component may be any real: integers, ratios and singles become doubles, a single with the rounding that it has. A point is a
`Vector3` or a Lisp vector of three numbers; a list is not a point. Source: cl-transforms.md sections 1.1 and 1.2.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime.lisp.numbers.arithmetic import single
from cramhy_runtime.lisp.conditions import SimpleTypeError, error, type_error
from cramhy_runtime.lisp.data import DoubleFloat
from cramhy_runtime.lisp.objects.generic_errors import no_applicable_method
from cramhy_runtime.lisp.collections.vectors import LispArray


def real(value, context=""):
    """The real ``value`` as a Python float at double precision."""
    kind = value.__class__
    if kind is DoubleFloat:
        return float(value)
    if kind is float:
        return single(value)
    if kind is int or kind is Fraction:
        return float(value)
    return type_error(value, "REAL", context)


def float_argument(value, name):
    """A parameter that must be a float: integers are refused, as in the original."""
    if not isinstance(value, float):
        return type_error(value, "FLOAT", f"\nwhen binding CL-TRANSFORMS::{name}")
    return value


def elements(array, size):
    """The elements of a Lisp vector of ``size`` numbers, or ``None`` if ``array`` is not one."""
    if isinstance(array, list):
        items = array
    elif isinstance(array, LispArray) and len(array.dimensions) == 1:
        items = array.active()
    else:
        return None
    return items if len(items) == size else None


def check_type(value, cls, parameter):
    """Signal the error of ``check-type`` unless ``value`` is of the class."""
    if isinstance(value, cls):
        return value
    name = cls.lisp_name.rpartition("::")[2]
    return error(SimpleTypeError("The value of CL-TRANSFORMS::~A is ~S, which is not of type ~A.", parameter, value, name,
                                 datum=value, expected_type=name))


def instance(value, cls, parameter):
    """Signal a type-error unless ``value`` is of the class: a declared parameter or slot."""
    if isinstance(value, cls):
        return value
    return type_error(value, cls.lisp_name, f"\nwhen binding CL-TRANSFORMS::{parameter}")


def component(index):
    """A property: component ``index`` of an object with ``components``, a tuple of floats, as ``component(index)`` shows it to Lisp."""

    def get(self):
        return self.component(index)

    def set_(self, value):
        components = list(self.components)
        components[index] = real(value)
        self.components = tuple(components)

    return property(get, set_, doc="A component, as the float that Lisp sees.")


def no_method(function, *arguments):
    """Signal that a generic function has no method for ``arguments``."""
    return no_applicable_method(f"CL-TRANSFORMS:{function.upper()}", None, *arguments)
