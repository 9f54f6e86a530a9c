"""Quaternions and rotations. Components stand in the order x y z w; w is the scalar part.

q and -q are the same rotation and different objects. Source: cl-transforms.md section 3.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core.conditions import FloatingPointInvalidOperation, SimpleError, error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, list_from
from cramhy_runtime.lisp_core.floats import ZERO, float_like, literal_float, result_class
from cramhy_runtime.lisp_core.numbers import is_real
from cramhy_runtime.lisp_core.packages import keyword, sym

from .coercion import (
    ByValue,
    check_type,
    component,
    element,
    elements,
    float_argument,
    instance,
    no_method,
    part,
    real,
    sine_and_cosine,
    wrong_type,
)
from .vectors import Vector3, point, vector
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .signatures import Four, Place, Rotation, Three


TOLERANCE = 1e-6
"""How far the squared norm of a unit quaternion may be from 1."""


class Quaternion(ByValue):
    """A quaternion. ``components`` are plain Python floats; ``kind`` is the float type that Lisp sees (double-float, as a rule)."""

    lisp_name = "CL-TRANSFORMS::QUATERNION"
    initargs = {"X": "x", "Y": "y", "Z": "z", "W": "w"}
    kind: type[float] = float
    x, y, z, w = component(0), component(1), component(2), component(3)
    components: Four = part("components", "The components, plain floats.")
    _components: Four

    def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0, w: float = 1.0):
        self._components: Four = (float(x), float(y), float(z), float(w))

    def component(self, index: int) -> float:
        return self.kind(self._components[index])

    def __iter__(self) -> Iterator[float]:
        return iter(self._components)

    def __repr__(self) -> str:
        return "#<QUATERNION ({} {} {} {})>".format(*map(self.kind, self._components))


def quaternion(components: Four) -> Quaternion:
    """The quaternion with four plain Python floats, which are not coerced."""
    made = Quaternion.__new__(Quaternion)
    made._components = components
    return made


def general(q: Rotation) -> Four:
    """The four components of a quaternion, an array of four numbers, or a real r that stands for (0 0 0 r)."""
    if isinstance(q, Quaternion):
        return q._components
    if is_real(q):
        return (0.0, 0.0, 0.0, real(q))
    items = elements(q, 4)
    if items is None:
        hint = "The place comes first, then the rotation." if isinstance(q, Vector3) else None
        return wrong_type(q, sym("CL-TRANSFORMS::GEN-QUATERNION"), "Q", hint)
    return tuple([real(item) for item in items])


def _made(components: Any, *sources: Rotation) -> Quaternion:
    """A quaternion of ``components``: of singles if no source has a double, as the original's arithmetic gives."""
    result = quaternion(components)
    for source in sources:
        kind = source.kind if isinstance(source, Quaternion) else result_class(*(elements(source, 4) or [source]))
        if kind is float:
            return result
    result.kind = kind
    return result


def _numbers(q: Rotation) -> list[float]:
    """The components as Lisp sees them, for functions whose result has the type of the inputs."""
    if isinstance(q, Quaternion):
        return [q.kind(component) for component in q._components]
    general(q)
    return [ZERO, ZERO, ZERO, q] if is_real(q) else elements(q, 4)


def make_quaternion(x: float, y: float, z: float, w: float) -> Quaternion:
    """A quaternion with components coerced to doubles; it is not normalised."""
    return quaternion((real(x), real(y), real(z), real(w)))


def make_identity_rotation(type_template: object = None) -> Quaternion:
    """The rotation (0 0 0 1). The argument changes nothing, as in the original."""
    return Quaternion()


def copy_quaternion(
    q: Quaternion, *, x: float | None = None, y: float | None = None, z: float | None = None, w: float | None = None
) -> Quaternion:
    """A copy of ``q`` with components replaced."""
    old = instance(q, Quaternion, "Q")._components
    return Quaternion(*(before if new is None else real(new) for before, new in zip(old, (x, y, z, w))))


def w(obj: Any) -> float:
    """The w of a quaternion or array; a number is its own."""
    if isinstance(obj, Quaternion):
        return obj.component(3)
    found = element(obj, 3)
    if found is not None:
        return found
    return obj if is_real(obj) else no_method("w", obj)


# ------------------------------------------------------------------------------------------------------------------ algebra


def multiply(a: Four, b: Four) -> Four:
    """The Hamilton product of two component tuples."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def q_eq(q1: Rotation, q2: Rotation) -> bool | None:
    """``q=``: whether all components are the same numbers."""
    return True if general(q1) == general(q2) else None


def q_star(*args: Rotation) -> Quaternion:
    """``q*``: the product; without arguments the number 1.0."""
    if not args:
        return literal_float(1.0)
    product = general(args[-1])
    for q in args[-2::-1]:
        product = multiply(general(q), product)
    return _made(product, *args)


def inverse(components: Four) -> Four:
    """The inverse of a component tuple: the conjugate divided by the squared norm."""
    qx, qy, qz, qw = components
    square = qx * qx + qy * qy + qz * qz + qw * qw
    if square == 0.0:
        return error(FloatingPointInvalidOperation())
    return (-qx / square, -qy / square, -qz / square, qw / square)


def q_inv(q: Rotation) -> Quaternion:
    """The conjugate divided by the squared norm."""
    return _made(inverse(general(q)), q)


def q_plus(*args: Rotation) -> Quaternion:
    """``q+``: the sum; without arguments the number 0.0."""
    if not args:
        return ZERO
    return _made(tuple(map(sum, zip(*map(general, args)))), *args)


def q_minus(q1: Rotation, *args: Rotation) -> Quaternion:
    """``q-``: the difference; one argument is negated."""
    components = general(q1)
    if not args:
        return _made(tuple([-component for component in components]), q1)
    for q in args:
        components = tuple([a - b for a, b in zip(components, general(q))])
    return _made(components, q1, *args)


def q_dot(q1: Rotation, q2: Rotation) -> float:
    """The sum of the four products; a double for quaternions, of the type of the inputs for arrays and reals."""
    return sum(a * b for a, b in zip(_numbers(q1), _numbers(q2)))


def q_scale(q: Rotation, scalar: float) -> Quaternion:
    """All components times the real ``scalar``."""
    factor = real(scalar, "SCALAR")
    return quaternion(tuple([component * factor for component in general(q)]))


def squared_norm(q: Rotation) -> float:
    """The sum of the squares of the components."""
    return q_dot(q, q)


def q_norm(q: Rotation) -> float:
    """The root of the sum of the squares of the components."""
    square = q_dot(q, q)
    return result_class(square)(math.sqrt(square))


def normalized(q: Rotation) -> bool:
    """Whether the squared norm of ``q`` is 1, nearly."""
    qx, qy, qz, qw = general(q)
    return -TOLERANCE < qx * qx + qy * qy + qz * qz + qw * qw - 1 < TOLERANCE


def is_normalized(q: Rotation) -> bool | None:
    """T if the squared norm of ``q`` is within 1e-6 of 1, else NIL."""
    return True if normalized(q) else None


def normalize(q: Rotation) -> Quaternion:
    """The unit quaternion for the same rotation; one without length is an error."""
    components = general(q)
    norm = math.sqrt(sum(component * component for component in components))
    if norm < TOLERANCE:
        return error(
            SimpleError("Attempted to normalize quaternion ~a with norm ~a", q, norm),
            hint="A message that nobody filled in has the orientation (0 0 0 0), which is no rotation; "
            "(make-identity-rotation) is the one that turns nothing.",
        )
    return _made(tuple([component / norm for component in components]), q)


def unit(q: Any) -> Quaternion:
    """``q`` itself when it is of unit length, else normalised, silently."""
    return q if normalized(q) else normalize(q)


# ---------------------------------------------------------------------------------------------------------------- rotations


def axis_angle_to_quaternion(axis: Place, angle: float) -> Quaternion:
    """The rotation by ``angle`` (a float, radians) about ``axis``, which is normalised first."""
    float_argument(angle, "ANGLE")
    ax, ay, az = point(axis, "AXIS")
    square = ax * ax + ay * ay + az * az
    if not -TOLERANCE < square - 1 < TOLERANCE:
        if square == 0.0:
            return error("Can't normalize ~a", axis)
        factor = 1 / math.sqrt(square)
        ax, ay, az = ax * factor, ay * factor, az * factor
    sine, cosine = sine_and_cosine(angle / 2)
    return quaternion((ax * sine, ay * sine, az * sine, cosine))


def quaternion_to_axis_angle(q: Rotation) -> tuple[Vector3, float]:
    """Values: the vector part, which is not of unit length, and the angle in [0, 2 pi]."""
    qx, qy, qz, qw = general(q)
    return MultipleValues((vector((qx, qy, qz)), 2 * math.acos(max(-1.0, min(1.0, qw)))))


def euler_to_quaternion(*, ax: float = ZERO, ay: float = ZERO, az: float = ZERO) -> Quaternion:
    """The rotation by roll ``ax``, then pitch ``ay``, then yaw ``az`` about the fixed axes, in radians."""
    (sx, cx), (sy, cy), (sz, cz) = (sine_and_cosine(float_like(angle, real(angle) / 2)) for angle in (ax, ay, az))
    return quaternion((sx * cy * cz - cx * sy * sz, cx * sy * cz + sx * cy * sz, cx * cy * sz - sx * sy * cz, cx * cy * cz + sx * sy * sz))


def quaternion_to_euler(q: Rotation, *, just_values: bool | None = None) -> Cons:
    """``(:ax roll :ay pitch :az yaw)``, or the three numbers only. At the poles roll is the integer 0."""
    qx, qy, qz, qw = general(q)
    sine = qw * qy - qz * qx
    if abs(sine - 0.5) < 1e-5:
        angles = (0, math.pi / 2, -2 * math.atan2(qx, qw))
    elif abs(sine + 0.5) < 1e-5:
        angles = (0, -math.pi / 2, 2 * math.atan2(qx, qw))
    else:
        angles = (
            math.atan2(2 * (qw * qx + qy * qz), 1 - 2 * (qx * qx + qy * qy)),
            math.asin(max(-1.0, min(1.0, 2 * sine))),
            math.atan2(2 * (qx * qy + qw * qz), 1 - 2 * (qy * qy + qz * qz)),
        )
    if just_values is not None:
        return list_from(angles)
    return list_from([item for name, angle in zip(("AX", "AY", "AZ"), angles) for item in (keyword(name), angle)])


def get_yaw(q: Rotation) -> float:
    """The heading of a rotation, in radians."""
    qx, qy, qz, qw = general(q)
    return math.atan2(2 * (qx * qy + qw * qz), qw * qw + qx * qx - qy * qy - qz * qz)


_Z = Vector3(0.0, 0.0, 1.0)


def yaw(angle: float) -> Quaternion:
    """The rotation by ``angle`` (a float, radians) about z. `get_yaw` is the way back."""
    return axis_angle_to_quaternion(_Z, angle)


def rotated(components: Four, v: Three) -> Three:
    """The components of the vector ``v`` (a tuple) turned by a unit quaternion (a tuple)."""
    qx, qy, qz, qw = components
    vx, vy, vz = v
    return (
        vx * (1 - 2 * (qy * qy + qz * qz)) + 2 * vy * (qx * qy - qw * qz) + 2 * vz * (qw * qy + qx * qz),
        vy * (1 - 2 * (qx * qx + qz * qz)) + 2 * vx * (qx * qy + qw * qz) + 2 * vz * (qy * qz - qw * qx),
        vz * (1 - 2 * (qx * qx + qy * qy)) + 2 * vx * (qx * qz - qw * qy) + 2 * vy * (qw * qx + qy * qz),
    )


def rotate(q: Rotation, v: Place, *, normalize: object = keyword("CHECK")) -> Vector3:
    """``v`` turned by ``q``. ``normalize``: ``:check`` demands a unit quaternion, ``t`` makes it one, anything else takes it as it is."""
    if normalize is keyword("CHECK"):
        if not normalized(q):
            return error("The assertion (CL-TRANSFORMS:IS-NORMALIZED CL-TRANSFORMS::Q) failed with CL-TRANSFORMS::Q = ~S.", q)
    elif normalize is True:
        q = globals()["normalize"](q)
    return vector(rotated(general(q), point(v)))


def angle_between_quaternions(q1: Rotation, q2: Rotation) -> tuple[float, Vector3]:
    """Values: angle and axis (not of unit length) of the rotation from ``q1`` to ``q2``."""
    axis, angle = quaternion_to_axis_angle(q_star(q_inv(q1), q2))
    return MultipleValues((angle, axis))


def normalize_angle(angle: float) -> float:
    """The same angle, in radians, in [-pi, pi]; one that is there already is returned untouched.

    In the original an angle that is so large that 2 pi vanishes in it is an endless loop, and an infinite one, too.
    """
    value = real(angle)
    if -math.pi <= value < math.pi:
        return angle
    if abs(value) > _MANY_TURNS:
        if math.isinf(value):
            return error(FloatingPointInvalidOperation())
        value = math.remainder(value, 2 * math.pi)
    while value < math.pi:
        value += 2 * math.pi
    while value > math.pi:
        value -= 2 * math.pi
    return value


_MANY_TURNS = 1e5
"""Angles beyond this, in radians, are normalised in one step; those within turn by turn, which gives the original's last digits."""


def slerp(q1: Quaternion, q2: Quaternion, ratio: float) -> Quaternion:
    """Spherical interpolation from ``q1`` (ratio 0) to ``q2`` (ratio 1), the shorter way.

    The original takes the inverse of ``q2`` where it should take -``q2``; here the result is always a rotation.
    """
    a = check_type(q1, Quaternion, "Q1")._components
    b = check_type(q2, Quaternion, "Q2")._components
    share, product = real(ratio, "RATIO"), sum(p * q for p, q in zip(a, b))
    if product < 0:
        b, product = tuple(-component for component in b), -product
    if product < 1 - TOLERANCE:
        angle = math.atan2(math.sqrt(1 - product * product), product)
        first, second = [sine_and_cosine(part * angle)[0] / math.sin(angle) for part in (1 - share, share)]
        return quaternion(tuple([first * p + second * q for p, q in zip(a, b)]))
    return normalize(quaternion(tuple([(1 - share) * p + share * q for p, q in zip(a, b)])))
