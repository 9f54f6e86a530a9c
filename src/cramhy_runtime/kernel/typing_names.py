"""The names that annotations use, without the module `typing`: it takes 2 ms to import, and a running plan does not need it.

A type checker reads them from `typing`. When the code runs they are stand-ins. These are enough for annotations that are not evaluated
(all our modules have ``from __future__ import annotations``), for the bases of generic classes and for protocols. If users may write
``Task[int]`` where it is evaluated, the class has ``__class_getitem__ = subscripted``.

This module also reads the annotations of users. From Python 3.14 on they are computed on demand (PEP 649), and may contain names that are
not defined yet.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # as type checkers know it by its name

if TYPE_CHECKING:
    from typing import Any as Any
    from typing import Generic as Generic
    from typing import Literal as Literal
    from typing import NamedTuple as NamedTuple
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
    from collections import namedtuple
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

    class _OfFields(type):
        """Makes what `collections.namedtuple` makes of the annotations of a class, with the methods of the class."""

        def __new__(kind, name, bases, body):
            fields = annotations_of_body(body)
            made = namedtuple(name, fields, defaults=[body[field] for field in fields if field in body], module=body["__module__"])
            for key, value in body.items():
                if key not in fields and key not in _OF_A_BODY:
                    setattr(made, key, value)
            return made

    class _NamedTuple:
        """The base of a class of named tuples."""

        def __mro_entries__(self, bases):
            return (type.__new__(_OfFields, "NamedTuple", (), {}),)

    NamedTuple = _NamedTuple()
    _OF_A_BODY = frozenset(
        """__module__ __qualname__ __annotations__ __annotate__ __annotate_func__ __firstlineno__ __static_attributes__
        __classcell__ __conditional_annotations__ __orig_bases__""".split()
    )

    def dataclass_transform(**options):
        """Marks a decorator or metaclass that makes an initializer of the annotations of classes."""
        return lambda made: made

    def overload(function):
        """One of several signatures of a function."""
        return function


def annotations_of_body(body: dict[str, Any]) -> dict[str, Any]:
    """The annotations in the body of a class, which a metaclass gets: name → type, its text, or a stand-in for an undefined name."""
    if sys.version_info >= (3, 14) and "__annotations__" not in body:
        import annotationlib

        annotate = annotationlib.get_annotate_from_class_namespace(body)
        return annotationlib.call_annotate_function(annotate, annotationlib.Format.FORWARDREF) if annotate else {}
    found: dict[str, Any] = body.get("__annotations__", {})
    return found


def annotations_of(function: Any) -> dict[str, Any]:
    """The annotations of a function, as in `annotations_of_body`; empty if it has none."""
    if sys.version_info >= (3, 14) and (annotate := getattr(function, "__annotate__", None)) is not None:
        import annotationlib

        return annotationlib.call_annotate_function(annotate, annotationlib.Format.FORWARDREF)
    found: dict[str, Any] = getattr(function, "__annotations__", {})
    return found
