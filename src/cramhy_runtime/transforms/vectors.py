"""Vectors in space: the class 3D-VECTOR and its algebra.

Vectors are not changed after they are made, and are equal only to themselves, as in the original. Source: cl-transforms.md 2.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp.numbers.arithmetic import is_real
from cramhy_runtime.lisp.conditions import DivisionByZero, error, type_error, wrong_argument_count
from cramhy_runtime.lisp.data import DoubleFloat

from .coercion import check_type, component, elements, instance, no_method, real


class Vector3:
    """A vector or point. ``components`` are its plain Python floats; ``x``, ``y`` and ``z`` the doubles that Lisp sees."""

    lisp_name = "CL-TRANSFORMS::3D-VECTOR"
    initargs = {"X": "x", "Y": "y", "Z": "z"}
    x, y, z = component(0), component(1), component(2)

    def __init__(self, x=0.0, y=0.0, z=0.0):
        self.components = (float(x), float(y), float(z))

    def component(self, index):
        return DoubleFloat(self.components[index])

    def __iter__(self):
        return iter(self.components)

    def __repr__(self):
        return "#<3D-VECTOR ({}d0 {}d0 {}d0)>".format(*self.components)


def point(value, parameter="V"):
    """The three components of a point as plain floats."""
    if isinstance(value, Vector3):
        return value.components
    items = elements(value, 3)
    if items is None:
        return type_error(value, "CL-TRANSFORMS:POINT", f"\nwhen binding CL-TRANSFORMS::{parameter}")
    return tuple([real(item) for item in items])


def make_3d_vector(x, y, z):
    """A vector; components are coerced to double-floats."""
    return Vector3(real(x), real(y), real(z))


def make_identity_vector():
    return Vector3()


def copy_3d_vector(v, *, x=None, y=None, z=None):
    """A copy of ``v`` with components replaced."""
    old = instance(v, Vector3, "V").components
    return Vector3(*(before if new is None else real(new) for before, new in zip(old, (x, y, z))))


def _reader(index, letter):
    def read(obj):
        if hasattr(obj, "components"):  # a vector or a quaternion
            return obj.component(index)
        for size in (3, 4):
            items = elements(obj, size)
            if items is not None:
                return items[index]
        return 0.0 if is_real(obj) else no_method(letter, obj)

    read.__name__ = letter
    read.__doc__ = f"The {letter} of a vector, quaternion or array; 0.0 of a number."
    return read


x, y, z = _reader(0, "x"), _reader(1, "y"), _reader(2, "z")


def _fold(vecs, operation):
    if not vecs:
        return wrong_argument_count(0)
    if len(vecs) == 1:
        return vecs[0]
    total = point(vecs[0])
    for other in vecs[1:]:
        total = [operation(a, b) for a, b in zip(total, point(other))]
    return Vector3(*total)


def v_plus(*vecs):
    """``v+``: the sum; a single argument is returned as it is."""
    return _fold(vecs, lambda a, b: a + b)


def v_minus(*vecs):
    """``v-``: the first less the others; a single argument is returned unchanged, not negated."""
    return _fold(vecs, lambda a, b: a - b)


def v_star(v, scalar):
    """``v*``: the vector (first) scaled by a number."""
    factor = real(scalar, "\nwhen binding CL-TRANSFORMS::SCALAR")
    return Vector3(*(component * factor for component in point(v)))


def v_star_pairwise(v_1, v_2):
    return Vector3(*(a * b for a, b in zip(point(v_1), point(v_2))))


def v_slash_pairwise(v_1, v_2):
    divisors = point(v_2)
    if 0.0 in divisors:
        return error(DivisionByZero())
    return Vector3(*(a / b for a, b in zip(point(v_1), divisors)))


def v_inv(v):
    """The vector in the other direction."""
    return v_star(v, -1)


def _numbers(v):
    """Components for functions whose result has the type of the inputs."""
    return tuple(DoubleFloat(component) for component in v.components) if isinstance(v, Vector3) else point(v) and elements(v, 3)


def dot_product(v_1, v_2):
    """The scalar product; integers for integer arrays, doubles for vectors."""
    if isinstance(v_1, Vector3) and isinstance(v_2, Vector3):
        a, b = v_1.components, v_2.components
        return DoubleFloat(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])
    return sum(a * b for a, b in zip(_numbers(v_1), _numbers(v_2)))


def cross_product(v_1, v_2):
    """The right-handed vector product."""
    (ax, ay, az), (bx, by, bz) = point(v_1), point(v_2)
    return Vector3(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)


def v_norm(v):
    """The length."""
    square = dot_product(v, v)
    return DoubleFloat(math.sqrt(square)) if isinstance(square, DoubleFloat) else math.sqrt(square)


def v_dist(v_1, v_2):
    """The distance of two points."""
    for v in (v_1, v_2):
        if not isinstance(v, Vector3) and elements(v, 3) is None:
            return no_method("x", v)
    return DoubleFloat(math.dist(point(v_1), point(v_2)))


def normalize_vector(v):
    """The vector of length 1 in the same direction; a zero vector is a division by zero."""
    components = point(v)
    length = math.sqrt(sum(component * component for component in components))
    if length == 0.0:
        return error(DivisionByZero())
    factor = 1 / length
    return Vector3(*(component * factor for component in components))


def interpolate_vector(v_0, v_1, ratio):
    """``v_0`` + ``ratio`` (``v_1`` - ``v_0``); the ratio is not limited."""
    check_type(v_0, Vector3, "V-0")
    check_type(v_1, Vector3, "V-1")
    share = real(ratio)
    return Vector3(*(a + share * (b - a) for a, b in zip(v_0.components, v_1.components)))
