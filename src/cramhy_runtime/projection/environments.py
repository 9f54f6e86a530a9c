"""Projection environments: imagined worlds that plans are tried in.

An environment gives variables values of their own, runs process modules that move no robot, and has code for its beginning and its
end. `with_projection_environment` runs a body in one: the variables are bound for this task and the tasks that it starts, and for
nobody else, so that several projections may go on side by side, or one in the other. Special projection variables are bound anew in
every environment. Source: projection-and-events.md A1.

The order: the variables are bound, all initialisers before any; the process modules start; ``startup``; the special projection
variables are bound; the body; ``shutdown``, however the body or ``startup`` ended; the process modules end; the bindings are undone. The
modules see the environment's variables, and of the special projection variables the values outside.

Repaired: the result tells the values that special projection variables had inside; ``own_modules.py`` says which modules are seen.
"""

from __future__ import annotations


from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from ..cpl.task_variables import define_task_variable, inherit
from cramhy_runtime.ground.conditions import SimpleError, error
from cramhy_runtime.ground.data import UNBOUND, Cons, all_values, list_from, one
from cramhy_runtime.ground.dynamic import binding
from cramhy_runtime.ground.classes import find_class_or_error, register_class
from cramhy_runtime.ground.packages import near_names
from cramhy_runtime.ground.printing import prin1_to_string
from ..process_modules.registry import RUNNING_MODULES, running
from ..process_modules.running import with_process_modules_running
from .own_modules import ProjectedRegistry
from .symbols import sym

PROJECTION_ENVIRONMENT = inherit(sym("CRAM-PROJECTION::*PROJECTION-ENVIRONMENT*"), None)
"""The name of the environment that the current task runs in; nil in the real world."""

_environments = per_image({})
_special_variables = per_image({})  # symbol → initialiser, in order of definition


class ProjectionEnvironment:
    """What ``define-projection-environment`` said: pairs (symbol, initialiser), modules as `with_process_modules_running` takes them,
    two functions of no arguments or ``None``."""

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
        """``startup``, the body in the special projection variables, ``shutdown``: the values, and the variables at the body's end."""
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
    """What to bind: all initialisers are evaluated before the first variable has its value."""
    values = [one(initializer()) for _, initializer in variables]
    return [item for (symbol, _), value in zip(variables, values, strict=True) for item in (symbol, value)]


def define_projection_environment(name, variables=(), modules=(), startup=None, shutdown=None):
    """``(define-projection-environment name ...)``: define the environment ``name``, in place of an old one of that name.

    ``variables``: pairs (symbol, function of no arguments that gives the initial value); they become task variables. ``modules``:
    names of process modules, or pairs (name, name of the class). Returns the list of all environments, the newest first.
    """
    variables = list(variables)
    for symbol, _ in variables:
        define_task_variable(symbol, symbol.value)
    _environments.pop(name, None)
    _environments[name] = ProjectionEnvironment(name, variables, list(modules), startup, shutdown)
    return list_from(list(reversed(_environments.values())))


def define_special_projection_variable(symbol, initializer):
    """``(define-special-projection-variable name initializer)``: a task variable that is bound anew in every projection. ``symbol``."""
    define_task_variable(symbol, symbol.value)
    _special_variables[symbol] = initializer
    return symbol


def find_environment(name):
    """The environment ``name``, or the error that there is none."""
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

    Returns a structure with the name, the list of the body's values, and an alist of variables and what they were at its end. A
    failure of the body goes on when ``shutdown`` has run and the process modules are dead. Errors: an unknown name.
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
    """What `with_projection_environment` returns where no language defines a structure of that name."""

    def __init__(self, name, result, environment):
        self.name, self.result, self.environment = name, result, environment


RESULT = sym("CRAM-PROJECTION::PROJECTION-ENVIRONMENT-RESULT")
register_class(RESULT, EnvironmentResult)
