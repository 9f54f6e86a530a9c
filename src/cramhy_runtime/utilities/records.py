"""The part of `dataclasses` that the compiler needs, for the classes of its nodes.

`dataclasses` imports `inspect`, and writes three functions for each class at once: with forty classes that is a tenth of the time that a
prompt takes to start. Here the initializer of a class is written when its first object is made, and the rest is written for all.
"""

from __future__ import annotations

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, annotations_of, dataclass_transform

from .generated_functions import generated_function

if TYPE_CHECKING:
    from collections.abc import Callable

_MISSING: Any = object()


class Field:
    """A field of a record: its ``name``, and its ``default`` or the ``factory`` of that, if there is one."""

    __slots__ = ("name", "default", "factory")

    def __init__(self, name: str, default: Any = _MISSING, factory: Any = _MISSING):
        self.name, self.default, self.factory = name, default, factory


def field(*, default_factory: Callable[[], Any]) -> Any:
    """What stands behind a field in its class: when it is not given, ``default_factory()`` makes its value."""
    return Field("", factory=default_factory)


def fields(record: Any) -> tuple[Field, ...]:
    """The fields of a class of records, or of a record, in order."""
    found: tuple[Field, ...] = record.__record_fields__
    return found


@dataclass_transform(field_specifiers=(field,))
def dataclass(cls: type[Any]) -> type[Any]:
    """Decorator: the annotations of the class are its fields, after those of its base. Records of one class with equal fields are equal."""
    known = {each.name: each for each in getattr(cls, "__record_fields__", ())}
    for name in annotations_of(cls):
        given = cls.__dict__.get(name, _MISSING)
        if given.__class__ is Field:
            delattr(cls, name)
            known[name] = Field(name, factory=given.factory)
        else:
            known[name] = Field(name, given)
    cls.__record_fields__ = tuple(known.values())

    def __init__(self: Any, *values: Any, **named: Any) -> None:
        cls.__init__ = _initializer(cls)
        cls.__init__(self, *values, **named)

    cls.__init__, cls.__eq__, cls.__repr__, cls.__hash__ = __init__, _same, _shown, None
    return cls


def _initializer(cls: Any) -> Callable[..., None]:
    scope, parameters, body = {"missing": _MISSING}, ["self"], []
    for each in cls.__record_fields__:
        name = value = each.name
        if each.factory is not _MISSING:
            scope[f"make_{name}"] = each.factory
            parameters.append(f"{name}=missing")
            value = f"make_{name}() if {name} is missing else {name}"
        elif each.default is not _MISSING:
            scope[f"default_{name}"] = each.default
            parameters.append(f"{name}=default_{name}")
        else:
            parameters.append(name)
        body.append(f"self.{name} = {value}")
    return generated_function(f"making a {cls.__name__}", "__init__", parameters, body, scope)


def _values(record: Any) -> list[Any]:
    return [getattr(record, each.name) for each in record.__record_fields__]


def _same(self: Any, other: object) -> Any:
    return _values(self) == _values(other) if other.__class__ is self.__class__ else NotImplemented


def _shown(self: Any) -> str:
    parts = ", ".join(f"{each.name}={getattr(self, each.name)!r}" for each in self.__record_fields__)
    return f"{self.__class__.__qualname__}({parts})"


__all__ = ["Field", "dataclass", "field", "fields"]
