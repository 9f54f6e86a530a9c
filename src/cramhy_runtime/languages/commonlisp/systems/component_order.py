"""The components of a system in the order of loading: each after those that it depends on, otherwise as they stand."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from .system_definitions import Component, Module, SourceFile

if TYPE_CHECKING:
    from collections.abc import Iterator


def components_of(module: Module) -> Iterator[Component]:
    """The components of a system or module that are not modules, in the order of loading."""
    for component in _ordered(module):
        if isinstance(component, Module):
            yield from components_of(component)
        else:
            yield component


def files_of(module: Module) -> Iterator[SourceFile]:
    """The source files of a system or module, in the order of loading."""
    return (component for component in components_of(module) if isinstance(component, SourceFile))


def _ordered(module: Module) -> list[Component]:
    """The components of ``module`` so that each comes after those it depends on, otherwise as they stand."""
    by_name = {component.name: component for component in module.components}
    done: set[str] = set()
    active: list[str] = []
    order: list[Component] = []

    def visit(component: Component) -> None:
        if component.name in done:
            return
        if component.name in active:
            error(
                "Circular dependency in system ~A: ~{~A~^ -> ~} -> ~A",
                module.system.name,
                list_from(active[active.index(component.name) :]),
                component.name,
            )
        active.append(component.name)
        for other in component.depends_on:
            if other not in by_name and other in module.without:
                continue
            if other not in by_name:
                error(
                    CompileError(
                        "DEFSYSTEM ~A: ~S depends on ~S, which is not a component beside it.", module.system.name, component.name, other
                    )
                )
            visit(by_name[other])
        active.pop()
        done.add(component.name)
        order.append(component)

    for component in module.components:
        visit(component)
    return order


__all__ = ["components_of", "files_of"]
