"""The names that annotations use, without the module that has them: `typing` takes 2 ms, and a plan that runs needs none of it.

A type checker reads them from `typing`. When the code runs they are stand-ins, good for annotations that nobody evaluates (all our
modules have ``from __future__ import annotations``), for the bases of generic classes and for protocols. A generic class whose users
may write ``Task[int]`` where that is evaluated has ``__class_getitem__ = subscripted``.

The annotations of users are read here, too. From Python 3.14 on they are computed when somebody asks for them (PEP 649), and may name
what is not defined yet.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # as type checkers know it by its name

if TYPE_CHECKING:
    from typing import Any as Any
    from typing import Generic as Generic
    from typing import Literal as Literal
    from typing import NoReturn as NoReturn
    from typing import ParamSpec as ParamSpec
    from typing import Protocol as Protocol
    from typing import Self as Self
    from typing import TypeVarTuple as TypeVarTuple
    from typing import dataclass_transform as dataclass_transform
    from typing import overload as overload

    from typing_extensions import TypeVar as TypeVar  # which knows defaults; every type checker brings it along

    subscripted: Any
else:
    from types import GenericAlias

    subscripted = classmethod(GenericAlias)
    Any = Literal = NoReturn = Self = object

    class _Vanishing:
        """A base that only type checkers see, with or without type parameters. The class has no such base when the code runs."""

        def __getitem__(self, parameters):
            return self

        def __mro_entries__(self, bases):
            return ()

    Generic = Protocol = _Vanishing()

    class TypeVar:
        """A type parameter."""

        def __init__(self, name, **others):
            self.__name__ = name

    ParamSpec = TypeVarTuple = TypeVar

    def dataclass_transform(**options):
        """For a decorator or metaclass that makes classes with an initializer of their annotations."""
        return lambda made: made

    def overload(function):
        """One of several signatures of a function."""
        return function


def annotations_of_body(body: dict[str, Any]) -> dict[str, Any]:
    """The annotations in the body of a class, as a metaclass gets it: name → type, its text, or what stands for a name not yet defined."""
    if sys.version_info >= (3, 14) and "__annotations__" not in body:
        import annotationlib

        annotate = annotationlib.get_annotate_from_class_namespace(body)
        return annotationlib.call_annotate_function(annotate, annotationlib.Format.FORWARDREF) if annotate else {}
    found: dict[str, Any] = body.get("__annotations__", {})
    return found


def annotations_of(function: Any) -> dict[str, Any]:
    """The annotations of a function, as `annotations_of_body` gives them; empty for what has none."""
    if sys.version_info >= (3, 14) and (annotate := getattr(function, "__annotate__", None)) is not None:
        import annotationlib

        return annotationlib.call_annotate_function(annotate, annotationlib.Format.FORWARDREF)
    found: dict[str, Any] = getattr(function, "__annotations__", {})
    return found
