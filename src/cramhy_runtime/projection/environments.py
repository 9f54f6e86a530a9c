"""Projection environments: imagined worlds in which plans are tried.

An environment gives variables values of their own, runs process modules that move no robot, and has code for its beginning and its
end. `with_projection_environment` runs a body in one. The variables are bound only for this task and the tasks that it starts, so several
projections may run side by side, or one inside the other. Special projection variables are bound anew in every environment. Source:
projection-and-events.md A1.

The order: all initialisers run, then the variables are bound. The process modules start. ``startup`` runs. The special projection
variables are bound. The body runs. ``shutdown`` runs, however the body or ``startup`` ended. The process modules end, and the bindings are
undone. The modules see the environment's variables, but the outer values of the special projection variables.

Repaired: the result has the values that special projection variables had inside. ``own_modules.py`` says which modules are seen.
"""

from __future__ import annotations


from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from ..cpl.task_variables import define_task_variable, inherit
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, all_values, list_from, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.classes import find_class_or_error, register_class
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ..process_modules.registry import RUNNING_MODULES, running
from ..process_modules.running import with_process_modules_running
from .own_modules import ProjectedRegistry
from .symbols import sym

PROJECTION_ENVIRONMENT = inherit(sym("CRAM-PROJECTION::*PROJECTION-ENVIRONMENT*"), None)
"""The name of the environment in which the current task runs; nil in the real world."""

_environments = per_image({})
_special_variables = per_image({})  # symbol → initialiser, in order of definition


class ProjectionEnvironment:
    """An environment of ``define-projection-environment``: ``variables`` are pairs (symbol, initialiser), ``modules`` are as for
    `with_process_modules_running`, ``startup`` and ``shutdown`` are functions of no arguments or ``None``."""

    lisp_name = "CRAM-PROJECTION::PROJECTION-ENVIRONMENT"

    def __init__(self, name, variables, modules, startup, shutdown):
        self.name, self.variables, self.modules = name, variables, modules
        self.startup, self.shutdown = startup, shutdown

    def own_names(self):
        """The names of its process modules."""
        return [
            one_module.car if isinstance(one_module, Cons) else one_module[0] if isinstance(one_module, tuple) else one_module
            for one_module in self.modules
        ]

    def run(self, body):
        """Run ``startup``, the body with the special projection variables, and ``shutdown``.

        Returns the values of the body, and pairs of the variables and their values at its end.
        """
        try:
            if self.startup is not None:
                self.startup()
            with binding(*_initial_values(list(_special_variables.items()))):
                values = all_values(body())
                return values, [
                    Cons(symbol, symbol.value) for symbol in (*dict(self.variables), *_special_variables) if symbol.value is not UNBOUND
                ]
        finally:
            if self.shutdown is not None:
                with kernel.cleanup():
                    self.shutdown()


def _initial_values(variables):
    """Symbols and values to bind. All initialisers are evaluated before the first variable is bound."""
    values = [one(initializer()) for _, initializer in variables]
    return [item for (symbol, _), value in zip(variables, values, strict=True) for item in (symbol, value)]


def define_projection_environment(name, variables=(), modules=(), startup=None, shutdown=None):
    """``(define-projection-environment name ...)``: define the environment ``name``. It replaces an old one of that name.

    variables: pairs (symbol, function of no arguments that returns the initial value); they become task variables. modules: names of
    process modules, or pairs (name, name of the class). startup, shutdown: functions of no arguments. Returns the list of all
    environments, the newest first. Source: projection-and-events.md A1.
    """
    variables = list(variables)
    for symbol, _ in variables:
        define_task_variable(symbol, symbol.value)
    _environments.pop(name, None)
    _environments[name] = ProjectionEnvironment(name, variables, list(modules), startup, shutdown)
    return list_from(list(reversed(_environments.values())))


def define_special_projection_variable(symbol, initializer):
    """``(define-special-projection-variable name initializer)``: define a task variable that is bound anew in every projection.

    Returns ``symbol``.
    """
    define_task_variable(symbol, symbol.value)
    _special_variables[symbol] = initializer
    return symbol


def find_environment(name):
    """The environment ``name``. An unknown name is an error."""
    found = _environments.get(name)
    if found is not None:
        return found
    known = [prin1_to_string(key) for key in _environments]
    near = near_names(prin1_to_string(name), known, 1)
    hint = (
        f"Did you mean {near[0]}?"
        if near
        else f"Defined are {', '.join(known)}."
        if known
        else "None is defined: write (define-projection-environment NAME ...)."
    )
    return error(SimpleError("Cannot find projection environment `~a'.", name), hint=hint)


def with_projection_environment(name, body):
    """``(with-projection-environment name ...)``: run ``body()`` in the environment ``name``.

    Returns a structure with the ``name``, the list of the body's values (``result``), and an alist of the variables and their values at
    its end (``environment``). A failure of the body goes on when ``shutdown`` has run and the process modules are dead. An unknown name is
    an error. Source: projection-and-events.md A1.
    """
    values, variables = in_environment(find_environment(name), body)
    return find_class_or_error(RESULT)(name=name, result=list_from(list(values)), environment=list_from(variables))


def in_environment(environment, body):
    """Run ``body()`` in an environment: the sequence of its values, and pairs of the variables and what they were at its end."""
    with binding(
        PROJECTION_ENVIRONMENT,
        environment.name,
        RUNNING_MODULES,
        ProjectedRegistry(running(), environment.own_names()),
        *_initial_values(environment.variables),
    ):
        return with_process_modules_running(environment.modules, lambda: environment.run(body))


class EnvironmentResult:
    """The result of `with_projection_environment` if no language defines a structure of that name."""

    def __init__(self, name, result, environment):
        self.name, self.result, self.environment = name, result, environment


RESULT = sym("CRAM-PROJECTION::PROJECTION-ENVIRONMENT-RESULT")
register_class(RESULT, EnvironmentResult)
