"""Reader functions of process modules, under the Lisp names of their slots; each gives a fluent."""

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.process_modules.modules import AbstractProcessModule


def _module(thing):
    return thing if isinstance(thing, AbstractProcessModule) else type_error(thing, "ABSTRACT-PROCESS-MODULE")


def input_(module):
    """The fluent of the designator that is processed now."""
    return _module(module).input


def cancel(module):
    """The fluent that cancels what is processed now when it becomes true."""
    return _module(module).cancel


def caller(module):
    """The fluent of the task that sent the current input."""
    return _module(module).caller
