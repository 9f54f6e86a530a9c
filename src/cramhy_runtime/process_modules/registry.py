"""The process modules that are defined, and those that run, by name (process-modules.md section 3).

The value of ``*running-process-modules*`` holds the running modules, so a projection may bind it and see only its own modules.
Repaired: all aliases of a module end with it. ``with-process-module-aliases`` makes aliases that can be seen. No alias or registration
takes a name away from another module. A name without a running module is an error at once, which tells the nearest name, and why the
module ended if it did.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.cpl.failures.failure_types import opened
from cramhy_runtime.cpl.tasks.pausing import pause
from ..cpl.task_variables import inherit
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import SimpleError, as_name, error
from cramhy_runtime.lisp_core.data import Symbol, list_from
from cramhy_runtime.lisp_core.source_places import describe, locate
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.lisp_core.printing import attempt_to_print, princ_to_string
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from cramhy_runtime.lisp_core.data import Cons
    from .modules import AbstractProcessModule

T = TypeVar("T")


class UnknownProcessModule(SimpleError):
    """No module runs under a name."""

    lisp_name = "CRAM-PROCESS-MODULES::UNKNOWN-PROCESS-MODULE"


class ProcessModuleRunning(SimpleError):
    """A module runs under a name already."""

    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-RUNNING"


class ProcessModuleNotRunning(SimpleError):
    """A module has ended, or was never started."""

    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-NOT-RUNNING"


class Registry:
    """The running modules by name, in order of registration, the tasks that wait for a module, and why modules ended that failed."""

    def __init__(self) -> None:
        self.modules: dict[Symbol, AbstractProcessModule] = {}
        self.waiters: list[kernel.Task[object]] = []
        self.reasons: dict[Symbol, str] = {}  # name -> text

    def copy(self) -> Registry:
        """An empty registry for another image, where no module runs yet."""
        return Registry()

    def add(self, name: Symbol, module: AbstractProcessModule) -> None:
        """Enter ``module`` under ``name``, and wake the tasks that wait for modules."""
        self.modules[name] = module
        self.reasons.pop(name, None)
        for task in self.waiters:
            task.kernel.unpark(task)

    def remove(self, module: AbstractProcessModule, reason: str | None = None) -> None:
        """Remove all names of ``module``. ``reason`` says why it failed."""
        for name in self.names(module):
            del self.modules[name]
            if reason is not None:
                self.reasons[name] = reason

    def names(self, module: AbstractProcessModule) -> list[Symbol]:
        """The names of ``module``, in order of registration."""
        return [name for name, running in self.modules.items() if running is module]


RUNNING_MODULES = inherit(sym("CPM::*RUNNING-PROCESS-MODULES*"), Registry())
_defined: dict[Symbol, bool] = per_image({})


def running() -> Registry:
    """The `Registry` in force."""
    return RUNNING_MODULES.value


def register_process_module(name: Symbol) -> Cons | None:
    """Note that ``name`` is the class of a process module. Returns the list of such names, the newest first."""
    _defined.pop(as_name(name), None)
    _defined[name] = True
    return get_process_module_names()


def is_defined(name: object) -> bool:
    """Whether ``name`` is the class of a process module."""
    return name in _defined


def get_process_module_names() -> Cons | None:
    """The names of all classes of process modules, a Lisp list, the newest first."""
    return list_from(list(reversed(_defined)))


def get_running_process_module(name: Symbol) -> AbstractProcessModule | None:
    """The running module called ``name``, or nil."""
    return running().modules.get(as_name(name))


def get_running_process_module_name(module):
    """The first name of the running ``module``, or nil."""
    names = running().names(module)
    return names[0] if names else None


def get_running_process_module_names(module):
    """All names of the running ``module``, the newest first."""
    return list_from(list(reversed(running().names(module))))


def module_called(name: Any) -> Any:
    """The running module called ``name``. An object that is not a symbol is returned as it is; an unknown name is an error."""
    if not isinstance(name, Symbol) and name is not None:
        return name
    return running().modules.get(name) or unknown(name)


def unknown(name: object) -> NoReturn:
    """Signal that no module runs under ``name``."""
    error(_with_hint(UnknownProcessModule("Unknown process module: ~a ", name), name))


def not_running(name: object) -> ProcessModuleNotRunning:
    """The condition for a module that has ended, or was never started."""
    return _with_hint(ProcessModuleNotRunning("Process module `~a' not running.", name), name)


def ended_because(problem):
    """A text that says why a module ended. It refers to no object of the plan."""
    problem = from_python(opened(problem))
    locate(problem, problem)
    place = describe(getattr(problem, "position", None))
    return f"{in_one_line(problem)}{f', at {place}' if place else ''}"


_BRIEF = 120  # characters


def in_one_line(thing: object) -> str:
    """``thing`` as ``princ`` prints it, on one line. What cannot be printed is said to be so: the text is for the report of an error."""
    return " ".join(attempt_to_print(princ_to_string, thing).split())


def in_brief(thing: object) -> str:
    """The same, cut off where it gets too long for a line of a report: a pose or an object that was seen has many numbers."""
    text = in_one_line(thing)
    return text if len(text) <= _BRIEF else f"{text[: _BRIEF - 4]} ..."


def _with_hint(problem, name):
    registry = running()
    shown = _typed(name)
    lines = []
    if name in registry.reasons:
        lines.append(f"It has ended by a failure of its own: {registry.reasons[name]}.")
    if name not in _defined:
        nearest = _nearest(name, [*registry.modules, *_defined])
        if nearest is not None:
            lines.append(f"Did you mean {_as_typed_beside(name, nearest)}?")
    lines.append(f"Running now: {_listed(registry.modules)}. Defined: {_listed(_defined)}.")
    if name in _defined and name not in registry.modules:
        lines.append(f"Modules run in (cpm:with-process-modules-running ({shown}) ...).")
    problem.hint = " ".join(lines)
    return problem


def _typed(name: Any) -> str:
    """A name as the user types it."""
    return str(getattr(name, "name", name)).lower()


def _as_typed_beside(name: Any, other: Any) -> str:
    """``other`` as one types it in the place of ``name``: with its package if that is another one."""
    package = getattr(other, "package", None)
    if package is None or package is getattr(name, "package", None):
        return _typed(other)
    return f"{package.name.lower()}::{_typed(other)}"


def _listed(names):
    return ", ".join(dict.fromkeys(map(_typed, names))) or "none"


def _nearest(name, names):
    by_text = {_typed(known): known for known in names}
    found = near_names(_typed(name), by_text, 1)
    return by_text[found[0]] if found else None


def start_under(name, module=None):
    """Register ``module`` under ``name``, or without ``module`` only check the name. If a module runs under it, it is an error."""
    if name in running().modules:
        return error(ProcessModuleRunning("Process module `~a' already running. foo foo", name))
    if module is not None:
        running().add(name, module)


def process_module_alias(alias: Symbol, name: Symbol) -> Symbol:
    """Let ``alias`` be another name of the running module ``name``, until that ends. Returns ``alias``.

    An unknown ``name``, and an alias under which another module runs, are errors. Source: process-modules.md section 3.
    """
    module = get_running_process_module(name)
    if module is None:
        error(_with_hint(UnknownProcessModule("Could not find process module with name `~s'", name), name))
    other = get_running_process_module(alias)
    if other is None:
        running().add(alias, module)
    elif other is not module:
        return error(
            ProcessModuleRunning("Process module `~a' already running", alias),
            hint=f"{_typed(alias)} cannot be another name of {_typed(name)}: a module of that name runs. Take another alias.",
        )
    return alias


def with_process_module_aliases(aliases: Iterable[tuple[Symbol, Symbol]], body: Callable[[], T]) -> T:
    """Call ``body()`` while the aliases, pairs (alias, name), are in force, and return its values. See `process_module_alias`."""
    made = []
    try:
        for alias, name in aliases:
            if alias not in running().modules:
                made.append((alias, get_running_process_module(name)))
            process_module_alias(alias, name)
        return body()
    finally:
        _forget(made)


def with_process_module_registered_running(name: Symbol, module: AbstractProcessModule, body: Callable[[], T]) -> T:
    """Call ``body()`` while ``module`` is registered under ``name``, and return its values. No main loop is started for it.

    If a module runs under that name already, it stays registered instead.
    """
    made = []
    if get_running_process_module(name) is None:
        made.append((name, module))
        running().add(name, module)
    try:
        return body()
    finally:
        _forget(made)


def _forget(pairs):
    modules = running().modules
    for name, module in pairs:
        if modules.get(name) is module:
            modules.pop(name, None)


def wait_for_process_module_running(process_module: Symbol | AbstractProcessModule, *, timeout: float | None = None) -> bool | None:
    """Wait until the module (a name or an object) is registered, and return true; after ``timeout`` seconds return nil."""
    registry, me = running(), kernel.current()
    until = None if timeout is None else kernel.now() + timeout

    def found():
        return as_name(process_module) in registry.modules or any(module is process_module for module in registry.modules.values())

    registry.waiters.append(me)
    try:
        while not found():
            if until is not None and kernel.now() >= until:
                return None
            pause(lambda: f"process module {getattr(process_module, 'name', process_module)} to be started", until)
    finally:
        registry.waiters.remove(me)
    return True
