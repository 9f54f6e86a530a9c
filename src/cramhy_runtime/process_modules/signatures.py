"""Types of the arguments in this room. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

from cramhy_runtime.cpl.tasks.tasks import AbstractTask
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.signatures import GenericOf
from ..designators.classes import Designator
from .asynchronous import AsynchronousProcessModule
from .modules import AbstractProcessModule
from .python_modules import Module

D = TypeVar("D", bound=Designator)
T = TypeVar("T")

ModuleOrName = AbstractProcessModule | Symbol
RunningAs = Symbol | tuple[Symbol, Symbol]
"""A module to start: its name, or (alias, name)."""


class Defines(Protocol[D]):
    """A decorator that makes a process module of a function of a designator."""

    def __call__(self, body: Callable[[D], T], /) -> Module[D, T]: ...


class Execute(GenericOf[..., Any], Protocol):
    """The type of ``pm-execute``."""

    def __call__(self, process_module: ModuleOrName, input: Designator, /, *, task: AbstractTask[object] | None = None) -> Any: ...


class Monitor(GenericOf[..., Any], Protocol):
    """The type of ``monitor-process-module``."""

    def __call__(self, process_module: ModuleOrName, /, *, designators: Cons | None = None) -> Any: ...


class Finish(GenericOf[..., None], Protocol):
    """The type of ``finish-process-module``."""

    def __call__(self, process_module: AsynchronousProcessModule, /, *, designator: Designator | None = None) -> None: ...


class Fail(GenericOf[..., None], Protocol):
    """The type of ``fail-process-module``."""

    def __call__(
        self, process_module: AsynchronousProcessModule, error: BaseException, /, *, designator: Designator | None = None
    ) -> None: ...
