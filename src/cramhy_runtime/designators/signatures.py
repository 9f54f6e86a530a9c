"""Types of the arguments in this room. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol, TypeVar

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.signatures import GenericOf
from .classes import Designator

F = TypeVar("F", bound=Callable[..., object])
T = TypeVar("T")
K = TypeVar("K")

Key = str | Symbol
Pair = tuple[Key, object]
"""A property that stands in front of the keyword arguments."""
Candidates = Iterable[object] | None
Verdict = bool | Keyword | None
"""The answer of a validator: True accepts, False refuses, None leaves it to others. Keywords such as ``kw.maybe_reject`` do as well."""
EqualityOfTwo = GenericOf[[object, object], bool | None]
OfOne = GenericOf[[Designator], Designator]


class MakeDesignator(GenericOf[..., Designator], Protocol):
    """A function that makes a designator of a kind, such as ``kw.motion``, or of a class."""

    def __call__(self, class_: Keyword | type[Designator], description: Cons | None, parent: Designator | None = None, /) -> Designator: ...


class Grounds(Protocol[K]):
    """A decorator for a function of a designator of one type."""

    def __call__(self, function: Callable[[K], T], /) -> Callable[[K], T]: ...


class Generates(Protocol[K]):
    """A decorator for a function that proposes places for a location."""

    def __call__(self, function: Callable[[K], Candidates], /) -> Callable[[K], Candidates]: ...


class Judges(Protocol[K]):
    """A decorator for a function that judges a candidate for a location."""

    def __call__(self, function: Callable[[K, Any], Verdict], /) -> Callable[[K, Any], Verdict]: ...
