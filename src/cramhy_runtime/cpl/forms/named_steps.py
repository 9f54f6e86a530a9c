"""Steps of a plan that have a name: plan functions and tags for Python.

``@plan_function`` is ``def-cram-function``: each call is a task of its own, at a place in the task tree that says who called it.
``tag("grasp")`` is a ``(:tag grasp ...)``: its task exists before it runs, so other steps can be ordered by it, watch it or suspend it.
"""

from __future__ import annotations

from functools import partial, wraps
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, ParamSpec, TypeVar, TypeVarTuple

from cramhy_runtime.lisp_core.data import Symbol
from ..failures.python_exceptions import for_python
from .plans import call_cram_function
from ..tree.tags import execute_tag, make_tag_task, prepare_tag
from ..tasks.tasks import Task

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
T = TypeVar("T")
Arguments = TypeVarTuple("Arguments")


def _symbol(name: str) -> Symbol:
    return Symbol(name.upper().replace("_", "-"))


def plan_function(function: Callable[P, T]) -> Callable[P, T]:
    """A decorator: each call of ``function`` runs in a task of its own, below the caller's in the task tree.

    Such a function can be called in plans only; elsewhere it is a type error. Source: cpl.md 8.1.
    """
    symbol = _symbol(function.__name__)

    @for_python
    @wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> T:
        return call_cram_function(symbol, partial(function, **keywords) if keywords else function, arguments)

    return call


class Tag:
    """A named step, made by `tag` inside of a plan. ``task`` is its task, which exists at once and runs in `run`."""

    def __init__(self, name: str):
        self.name = name
        self.task: Task[object] = make_tag_task(_symbol(name))

    @for_python
    def run(self, function: Callable[[*Arguments], T], *arguments: *Arguments) -> T:
        """Run ``function(*arguments)`` as this step, wait for it and return its result. A second run is a new task."""
        self.task = prepare_tag(self.task)
        return execute_tag(self.task, partial(function, *arguments) if arguments else function)


def tag(name: str) -> Tag:
    """A step called ``name`` below the current place in the task tree. Outside of a plan it is an error. Source: cpl.md 7.1."""
    return Tag(name)
