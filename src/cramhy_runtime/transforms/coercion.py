"""What the functions of cl-transforms accept, and their errors.

A component may be any real: integers, ratios and singles become doubles. A point is a
`Vector3` or a Lisp vector of three numbers; a list is not a point. Source: cl-transforms.md sections 1.1 and 1.2.
"""

from __future__ import annotations

import math
from numbers import Real
from operator import attrgetter

from cramhy_runtime.lisp_core.arrays import InvalidArrayIndex, wrong_rank
from cramhy_runtime.lisp_core.arrays import LispArray
from cramhy_runtime.lisp_core.condition_types import TypeError_, shown_with
from cramhy_runtime.lisp_core.conditions import FloatingPointInvalidOperation, SimpleTypeError, error, type_error
from cramhy_runtime.lisp_core.floats import float_like
from cramhy_runtime.lisp_core.numbers import is_real, too_large_for
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.packages import ensure_package, sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from .signatures import Component

T = TypeVar("T")
ensure_package("CL-TRANSFORMS")


def real(value: Any, parameter: str | None = None) -> float:
    """The real ``value``, given for ``parameter``, as a Python float at double precision."""
    kind = value.__class__
    if kind is float:
        plain: float = value
        return plain
    if kind is int or is_real(value):
        try:
            return float(value)
        except OverflowError:
            return too_large_for(value, "DOUBLE-FLOAT")
    if isinstance(value, Real) and kind is not bool:  # numpy's, or a Fraction
        return float(value)
    return type_error(value, "REAL", "" if parameter is None else _binding(parameter))


def _binding(parameter: str, package: str = "CL-TRANSFORMS") -> str:
    """The end of a type-error's text: which parameter the value was for."""
    return f"\nwhen binding {shown_with(sym(f'{package}::{parameter}'), 'COMMON-LISP')}"


def wrong_type(value: object, expected: object, parameter: str, hint: str | None = None, package: str = "CL-TRANSFORMS") -> NoReturn:
    """Signal a type-error: ``value`` was given for ``parameter``, which must be of the type ``expected``."""
    condition = TypeError_(value, expected)
    condition.context = _binding(parameter, package)
    return error(condition, hint=hint)


def float_argument(value: Any, parameter: str) -> float:
    """A parameter that must be a float: integers are refused, as in the original."""
    if isinstance(value, float):
        return value
    return wrong_type(value, "FLOAT", parameter, f"An angle must be a float: write {value}.0." if value.__class__ is int else None)


def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Both of an angle in radians, plain floats of its precision; of an infinite one they are an error, as in Lisp."""
    try:
        return float(float_like(angle, math.sin(angle))), float(float_like(angle, math.cos(angle)))
    except ValueError:
        return error(FloatingPointInvalidOperation())


def array_elements(array: Any) -> list[Any] | None:
    """The elements of a Lisp vector, or ``None`` if ``array`` is not one. Strings hold no numbers and do not count."""
    if isinstance(array, list):
        return array
    if isinstance(array, LispArray) and len(array.dimensions) == 1:
        return array.active()
    return None


def elements(array: Any, size: int) -> list[Any] | None:
    """The elements of a Lisp vector of ``size`` numbers, or ``None`` if ``array`` is not one."""
    items = array_elements(array)
    return items if items is not None and len(items) == size else None


def element(array, index):
    """Element ``index`` of a Lisp array, with the errors of ``aref``; ``None`` if it is not an array."""
    if not isinstance(array, (list, LispArray)):
        return None
    sizes = (len(array),) if isinstance(array, list) else array.shape()
    if len(sizes) != 1:
        wrong_rank((index,), len(sizes))
    if not 0 <= index < sizes[0]:
        error(InvalidArrayIndex(index, array, None, sizes[0]))
    return array[index] if isinstance(array, list) else array.storage[array.offset + index]


def check_type(value: object, cls: type[T], parameter: str) -> T:
    """Signal the error of ``check-type`` unless ``value`` is of the class."""
    if isinstance(value, cls):
        return value
    lisp_name: str = cls.lisp_name  # type: ignore[attr-defined]
    name, package = sym(lisp_name), lisp_name.partition("::")[0]
    return error(
        SimpleTypeError(
            "The value of ~S is ~S, which is not of type ~A.", sym(f"{package}::{parameter}"), value, name, datum=value, expected_type=name
        )
    )


def instance(value: object, cls: type[T], parameter: str) -> T:
    """Signal a type-error unless ``value`` is of the class: a declared parameter or slot."""
    if isinstance(value, cls):
        return value
    return wrong_type(value, sym(cls.lisp_name), parameter)  # type: ignore[attr-defined]


def component(index: int) -> Component:
    """A property: component ``index`` of an object with ``components``, a tuple of floats, as ``component(index)`` shows it to Lisp."""

    def get(self):
        return self.component(index)

    return FixedComponent(get, index)  # type: ignore[return-value]


class Fixed(property):
    """A part of a vector or a pose. Python cannot assign it in our own classes, which compare by value; Lisp's `slot-value` can."""

    def __set__(self, obj: object, value: object) -> None:
        if type(obj).__module__.startswith("cramhy_runtime.t"):  # transforms and tf; classes of users are theirs
            kind = type(obj).__name__
            copied = f", or {_COPIES[kind]}" if kind in _COPIES else ""
            raise AttributeError(f"A {kind} is not changed after it was made. Make a new one: {kind}(...){copied}.")
        self.set_by_lisp(obj, value)

    def set_by_lisp(self, obj: object, value: object) -> None:
        """Change the part, as ``(setf (slot-value v 'x) 5)`` does."""
        raise NotImplementedError


_COPIES = {
    "Pose": "copy_pose(pose, origin=...)",
    "PoseStamped": "copy_pose_stamped(pose, stamp=5.0)",
    "Quaternion": "copy_quaternion(q, w=1.0)",
    "Twist": "copy_twist(twist, translation=...)",
    "Wrench": "copy_wrench(wrench, translation=...)",
    "Transform": "copy_transform(transform, translation=...)",
    "Vector3": "copy_3d_vector(v, x=5)",
}


class FixedComponent(Fixed):
    """The property of one component."""

    def __init__(self, get: Callable[[object], float], index: int) -> None:
        super().__init__(get, doc="A component, as the float that Lisp sees.")
        self.index = index

    def set_by_lisp(self, obj: Any, value: object) -> None:
        components = list(obj._components)
        components[self.index] = real(value)
        obj._components = tuple(components)


class FixedPart(Fixed):
    """The property of the part that an object has in the attribute ``_name``, where it is made."""

    def __init__(self, name: str, doc: str) -> None:
        super().__init__(attrgetter(f"_{name}"), doc=doc)
        self.attribute = f"_{name}"

    def set_by_lisp(self, obj: object, value: object) -> None:
        setattr(obj, self.attribute, value)


def part(name: str, doc: str) -> Any:
    """A property: the part ``name`` of an object that keeps it in ``_name``."""
    return FixedPart(name, doc)


class ByValue:
    """Objects of one class that are equal in Python if all their attributes are. In Lisp each is equal to itself only."""

    def __eq__(self, other: object) -> Any:
        return vars(self) == vars(other) if other.__class__ is self.__class__ else NotImplemented

    def __hash__(self) -> int:
        return hash((self.__class__.__name__, *vars(self).values()))


def no_method(function: str, *arguments: object) -> Any:
    """Signal that a generic function has no method for ``arguments``."""
    return no_applicable_method(f"CL-TRANSFORMS:{function.upper()}", None, *arguments)


def slot_reader(name: str, *classes: type, package: str = "CL-TRANSFORMS") -> Callable[[Any], Any]:
    """The function that reads the slot ``name`` of objects of ``classes``; it is generic in the original."""
    attribute = name.replace("-", "_")

    def read(obj):
        return getattr(obj, attribute) if isinstance(obj, classes) else no_applicable_method(f"{package}:{name.upper()}", None, obj)

    read.__name__ = attribute
    read.__doc__ = f"The {name} of a {' or '.join(cls.__name__.lower() for cls in classes)}."
    return read
