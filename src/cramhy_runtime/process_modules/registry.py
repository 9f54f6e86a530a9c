"""Which process modules are defined, and which run under which names (process-modules.md section 3).

Running modules are in the value of ``*running-process-modules*``, so that a projection may bind it and see its own modules only.
Repaired: a module that ends takes all its aliases with it, and ``with-process-module-aliases`` makes aliases that can be seen.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..cpl.task_variables import inherit
from ..cpl.pausing import pause
from ..lisp.conditions import SimpleError, error
from ..lisp.data import Symbol, list_from
from .symbols import sym


class UnknownProcessModule(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::UNKNOWN-PROCESS-MODULE"


class ProcessModuleRunning(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-RUNNING"


class ProcessModuleNotRunning(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-NOT-RUNNING"


class Registry:
    """The running modules by name, in order of registration, and the tasks that wait for one."""

    def __init__(self):
        self.modules = {}
        self.waiters = []

    def add(self, name, module):
        self.modules[name] = module
        for task in self.waiters:
            task.kernel.unpark(task)

    def remove(self, module):
        for name in self.names(module):
            del self.modules[name]

    def names(self, module):
        return [name for name, running in self.modules.items() if running is module]


RUNNING_MODULES = inherit(sym("CPM::*RUNNING-PROCESS-MODULES*"), Registry())
_defined = {}


def running():
    """The `Registry` in force."""
    return RUNNING_MODULES.value


def register_process_module(name):
    """Note that ``name`` is the class of a process module; returns the list of such names, the newest first."""
    _defined.pop(name, None)
    _defined[name] = True
    return get_process_module_names()


def is_defined(name):
    return name in _defined


def get_process_module_names():
    return list_from(list(reversed(_defined)))


def get_running_process_module(name):
    """The running module called ``name``, or nil."""
    return running().modules.get(name)


def get_running_process_module_name(module):
    """The name that the running ``module`` got first, or nil."""
    names = running().names(module)
    return names[0] if names else None


def get_running_process_module_names(module):
    """All names of the running ``module``, the newest first."""
    return list_from(list(reversed(running().names(module))))


def module_called(name):
    """The running module that ``name`` stands for; an unknown name is an error."""
    if not isinstance(name, Symbol) and name is not None:
        return name
    return running().modules.get(name) or unknown(name)


def unknown(name):
    problem = UnknownProcessModule("Unknown process module: ~a ", name)
    problem.hint = (f"Running now: {', '.join(key.name for key in running().modules) or 'none'}. Defined: "
                    f"{', '.join(key.name for key in _defined) or 'none'}. Wrap the plan in "
                    f"(cpm:with-process-modules-running (MODULE ...) ...).")
    return error(problem)


def process_module_alias(alias, name):
    """Let ``alias`` be another name of the running module ``name``."""
    module = get_running_process_module(name)
    if module is None:
        return error(UnknownProcessModule("Could not find process module with name `~s'", name))
    running().add(alias, module)
    return alias


def with_process_module_aliases(aliases, body):
    """Values of ``body()`` while the aliases, pairs (alias, name), are in force."""
    for alias, name in aliases:
        process_module_alias(alias, name)
    try:
        return body()
    finally:
        for alias, _ in aliases:
            running().modules.pop(alias, None)


def with_process_module_registered_running(name, module, body):
    """Values of ``body()`` while ``module`` is registered under ``name``; no main loop is started for it."""
    if get_running_process_module(name) is None:
        running().add(name, module)
    try:
        return body()
    finally:
        running().modules.pop(name, None)


def wait_for_process_module_running(process_module, *, timeout=None):
    """Wait until the module (a name or an object) is registered: true; nil if that takes longer than ``timeout`` seconds."""
    registry, me = running(), kernel.current()
    until = None if timeout is None else kernel.now() + timeout

    def found():
        return process_module in registry.modules or any(module is process_module for module in registry.modules.values())

    registry.waiters.append(me)
    try:
        while not found():
            if until is not None and kernel.now() >= until:
                return None
            pause(lambda: f"process module {getattr(process_module, 'name', process_module)} to be started", until)
    finally:
        registry.waiters.remove(me)
    return True
