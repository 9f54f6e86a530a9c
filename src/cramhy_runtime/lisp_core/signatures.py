"""How type checkers see what this room makes. Nothing imports this module when a program runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, Protocol, TypeVar

P = ParamSpec("P")
R = TypeVar("R", covariant=True)
F = TypeVar("F", bound=Callable[..., Any])


class GenericOf(Protocol[P, R]):
    """A generic function: what it takes and gives, and how methods are added (`cramhy_runtime.lisp_core.dispatch.generic_functions`)."""

    advice: str | None

    def __call__(self, *arguments: P.args, **keywords: P.kwargs) -> R: ...
    def method(self, *specializers: object, qualifier: str | None = None, uses_next: bool = False) -> Callable[[F], F]: ...
    def call_directly(self, function: F) -> F: ...
    def enclose(self, enclosure: F) -> F: ...
    def refuse(self, *arguments: Any) -> Any: ...
