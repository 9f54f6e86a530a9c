"""Vectors in space: the class 3D-VECTOR and its algebra.

Vectors are not changed after they are made. In Python they compare by value; in Lisp they are equal only to themselves, as in the
original. Source: cl-transforms.md 2.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.conditions import DivisionByZero, error, wrong_argument_count
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.floats import ZERO, result_class
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import sym

from .coercion import ByValue, check_type, component, element, elements, instance, no_method, part, real, wrong_type
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from .signatures import Place, Three


class Vector3(ByValue):
    """A vector or point. ``components`` are its plain Python floats; ``x``, ``y`` and ``z`` the doubles that Lisp sees."""

    lisp_name = "CL-TRANSFORMS::3D-VECTOR"
    initargs = {"X": "x", "Y": "y", "Z": "z"}
    x, y, z = component(0), component(1), component(2)
    components: Three = part("components", "The components, plain floats.")
    _components: Three

    def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0):
        self._components: Three = (float(x), float(y), float(z))

    def component(self, index: int) -> float:
        return self._components[index]

    def __iter__(self) -> Iterator[float]:
        return iter(self._components)

    def __repr__(self) -> str:
        return "#<3D-VECTOR ({} {} {})>".format(*self._components)


def vector(components: Three) -> Vector3:
    """The vector with three plain Python floats, which are not coerced."""
    made = Vector3.__new__(Vector3)
    made._components = components
    return made


def point(value: Place, parameter: str = "V") -> Three:
    """The three components of a point as plain floats."""
    if isinstance(value, Vector3):
        return value._components
    items = elements(value, 3)
    if items is None:
        hint = "A list is no point; a vector such as #(1 2 3) is, or (make-3d-vector 1 2 3)." if isinstance(value, Cons) else None
        return wrong_type(value, sym("CL-TRANSFORMS::POINT"), parameter, hint)
    x, y, z = items
    return real(x), real(y), real(z)


def make_3d_vector(x: float, y: float, z: float) -> Vector3:
    """A vector of three reals, in metres where it is a place; components are coerced to double-floats."""
    return vector((real(x), real(y), real(z)))


def make_identity_vector() -> Vector3:
    """The vector (0 0 0)."""
    return Vector3()


def copy_3d_vector(v: Vector3, *, x: float | None = None, y: float | None = None, z: float | None = None) -> Vector3:
    """A copy of ``v`` with components replaced."""
    old = instance(v, Vector3, "V")._components
    return Vector3(*(before if new is None else real(new) for before, new in zip(old, (x, y, z))))


def _reader(index: int, letter: str) -> Callable[[object], float]:
    def read(obj: Any) -> float:
        if obj.__class__ is Vector3:
            return obj._components[index]
        if hasattr(obj, "_components"):  # a quaternion, or a vector of another kind
            return obj.component(index)
        found = element(obj, index)
        if found is not None:
            return found
        return ZERO if is_real(obj) else no_method(letter, obj)

    read.__name__ = letter
    read.__doc__ = f"The {letter} of a vector, quaternion or array; 0.0 of a number."
    return read


x, y, z = _reader(0, "x"), _reader(1, "y"), _reader(2, "z")


def v_plus(*vecs: Place) -> Vector3:
    """``v+``: the sum of points; a single argument is returned as it is."""
    if len(vecs) < 2:
        return vecs[0] if vecs else wrong_argument_count(0)
    ax, ay, az = point(vecs[0])
    for other in vecs[1:]:
        bx, by, bz = point(other)
        ax, ay, az = ax + bx, ay + by, az + bz
    return vector((ax, ay, az))


def v_minus(*vecs: Place) -> Vector3:
    """``v-``: the first point less the others; a single argument is returned unchanged, not negated."""
    if len(vecs) < 2:
        return vecs[0] if vecs else wrong_argument_count(0)
    ax, ay, az = point(vecs[0])
    for other in vecs[1:]:
        bx, by, bz = point(other)
        ax, ay, az = ax - bx, ay - by, az - bz
    return vector((ax, ay, az))


def v_star(v: Place, scalar: float) -> Vector3:
    """``v*``: the point ``v`` (first) scaled by a real."""
    factor = real(scalar, "SCALAR")
    vx, vy, vz = point(v)
    return vector((vx * factor, vy * factor, vz * factor))


def v_star_pairwise(v_1: Place, v_2: Place) -> Vector3:
    """``v*-pairwise``: the products of the components."""
    (ax, ay, az), (bx, by, bz) = point(v_1, "V-1"), point(v_2, "V-2")
    return vector((ax * bx, ay * by, az * bz))


def v_slash_pairwise(v_1: Place, v_2: Place) -> Vector3:
    """``v/-pairwise``: the quotients of the components; a zero in ``v_2`` is a division by zero."""
    (ax, ay, az), (bx, by, bz) = point(v_1, "V-1"), point(v_2, "V-2")
    if not (bx and by and bz):
        return error(DivisionByZero())
    return vector((ax / bx, ay / by, az / bz))


def v_inv(v: Place) -> Vector3:
    """The vector in the other direction. Zeros become -0.0d0."""
    return v_star(v, -1)


def _numbers(v: Place, parameter: str) -> list[float]:
    """The components as Lisp sees them, for functions whose result has the type of the inputs."""
    if isinstance(v, Vector3):
        return [v.component(index) for index in range(3)]
    point(v, parameter)
    return elements(v, 3)


def dot_product(v_1: Place, v_2: Place) -> float:
    """The scalar product of two points; an integer for integer arrays, a double for vectors."""
    if isinstance(v_1, Vector3) and isinstance(v_2, Vector3):
        (ax, ay, az), (bx, by, bz) = v_1._components, v_2._components
        return ax * bx + ay * by + az * bz
    return sum(a * b for a, b in zip(_numbers(v_1, "V-1"), _numbers(v_2, "V-2")))


def cross_product(v_1: Place, v_2: Place) -> Vector3:
    """The right-handed vector product."""
    (ax, ay, az), (bx, by, bz) = point(v_1, "V-1"), point(v_2, "V-2")
    return vector((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))


def v_norm(v: Place) -> float:
    """The length of a point; a double for vectors, a single for arrays of integers."""
    square = dot_product(v, v)
    return math.sqrt(square) if square.__class__ is float else result_class(square)(math.sqrt(square))


def v_dist(v_1: Place, v_2: Place) -> float:
    """The distance of two points, a double."""
    for v in (v_1, v_2):
        if not isinstance(v, Vector3) and elements(v, 3) is None:
            return no_method("x", v)
    return math.dist(point(v_1), point(v_2))


def normalize_vector(v: Place) -> Vector3:
    """The vector of length 1 in the same direction; a zero vector is a division by zero."""
    vx, vy, vz = point(v)
    length = math.sqrt(vx * vx + vy * vy + vz * vz)
    if length == 0.0:
        return error(DivisionByZero())
    factor = 1 / length
    return vector((vx * factor, vy * factor, vz * factor))


def interpolate_vector(v_0: Vector3, v_1: Vector3, ratio: float) -> Vector3:
    """``v_0`` + ``ratio`` (``v_1`` - ``v_0``) of two 3d-vectors; the ratio, a real, is not limited to [0, 1]."""
    ax, ay, az = check_type(v_0, Vector3, "V-0")._components
    bx, by, bz = check_type(v_1, Vector3, "V-1")._components
    share = real(ratio, "RATIO")
    return vector((ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)))
