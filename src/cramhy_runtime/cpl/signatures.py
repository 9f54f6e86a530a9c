"""Types of the arguments of the plan language. Only type checkers read this module: no code imports it when a program runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, Protocol, TypeVar, overload

from cramhy_runtime.lisp_core.data import Symbol
from .fluents.fluents import Fluent, ValueFluent
from .fluents.nets import Net
from .fluents.pulse_fluents import PulseFluent
from .tasks.tasks import AbstractTask, Task
from .forms.named_steps import Tag
from .tree.task_tree import TaskTreeNode

T = TypeVar("T")

Name = str | Symbol
Thunk = Callable[[], T]
"""A branch, or the body of a form: any callable of no arguments."""
Same = Callable[[T, T], object]
"""A test whether a new value is the same as the old one."""
Missed = Literal["NEVER", "ONCE", "ALWAYS"]
"""The treatment of pulses that were not read. Lisp's keywords of these names do as well."""
Dependent = Net[object] | PulseFluent
"""A fluent that is told of the pulses of another."""
PlanTree = AbstractTask[object] | TaskTreeNode | Symbol
"""The subject of a report: a task, a task tree or the name of a top-level."""
Step = Task[object] | Tag
Ordering = tuple[Step | ValueFluent[Any], Step]
"""(before, after): the step ``after`` begins when ``before`` is dead, or when the fluent ``before`` has been pulsed."""
Clause = Callable[..., object]
"""A function of a policy: its first argument is a `Store`, the others are the parameters of the policy."""


class Request(Protocol):
    """A function that asks a task to do something, and waits for that unless ``sync`` is false. Lisp code may add methods to it."""

    def __call__(self, task: AbstractTask[object], *, reason: str | None = None, sync: bool = True) -> None: ...
    def method(self, *specializers: object) -> Callable[[Callable[..., object]], Callable[..., object]]: ...


class Comparison(Protocol):
    """A test of two values, or the net of it if there is a fluent among them."""

    @overload
    def __call__(self, first: Fluent[object], second: object) -> Fluent[bool | None]: ...  # type: ignore[overload-overlap]
    @overload
    def __call__(self, first: object, second: Fluent[object]) -> Fluent[bool | None]: ...  # type: ignore[overload-overlap]
    @overload
    def __call__(self, first: object, second: object) -> bool | None: ...
