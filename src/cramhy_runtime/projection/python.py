"""Projection from Python: a plan tried in an imagined world.

    from cramhy_runtime.projection.python import project, projection_environment

    @process_module
    def imagined_navigation(motion):
        return reference(motion)

    imagined = projection_environment(modules={"navigation": imagined_navigation})
    result = project(imagined, lambda: cpl.run(execute, "navigation", Driving(speed=1.0)))
    result.value

While the function runs, the modules of the environment stand under these names, its variables have values of their own, and the robot does
not move. Source: projection-and-events.md A1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from cramhy_runtime.cpl.failures.python_exceptions import for_python
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.kernel.typing_names import Generic, TypeVar
from cramhy_runtime.prolog.python.ground import reasoning

from ..cpl.task_variables import define_task_variable
from ..process_modules.python_modules import Designation, module_symbol
from .environments import ProjectionEnvironment, define_special_projection_variable, in_environment

T = TypeVar("T")


@dataclass(frozen=True)
class Projected(Generic[T]):
    """What `project` gives: the ``value`` of the function, and the ``variables`` that the environment bound, as they were at its end."""

    value: T
    variables: dict[Symbol, object]


def projection_environment(
    name: str = "imagined",
    *,
    modules: Mapping[Designation, Designation] | None = None,
    variables: Mapping[Symbol, Callable[[], object]] | None = None,
    startup: Callable[[], object] | None = None,
    shutdown: Callable[[], object] | None = None,
) -> ProjectionEnvironment:
    """An imagined world, for `project`.

    modules: what stands for which process module: ``{"arm": imagined_arm}``. variables: task variables, and functions that give the values
    that they begin with. startup, shutdown: they are called when the modules run, and when the function has ended, in whatever way.
    name: how messages call it.
    """
    symbols = dict(variables or {})
    for symbol in symbols:
        define_task_variable(symbol, symbol.value)
    running = [(module_symbol(role), module_symbol(module)) for role, module in (modules or {}).items()]
    return ProjectionEnvironment(Symbol(name.upper(), None), list(symbols.items()), running, startup, shutdown)


def projection_variable(name: str, initializer: Callable[[], object]) -> Symbol:
    """A task variable that every projection binds anew, to ``initializer()``; ``variable.value`` is its value in the task that asks."""
    return define_special_projection_variable(define_task_variable(name), initializer)


@for_python
def project(environment: ProjectionEnvironment, function: Callable[[], T]) -> Projected[T]:
    """Call ``function()`` in an imagined world, and wait for its end.

    It may be called in a plan and outside of one. Errors: what the function raises, when `shutdown` has run and the modules are dead.
    """
    with reasoning():
        returned: list[T] = []
        _, pairs = in_environment(environment, lambda: returned.append(function()))
        return Projected(returned[0], {pair.car: pair.cdr for pair in pairs})
