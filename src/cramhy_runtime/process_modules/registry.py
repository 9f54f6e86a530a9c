"""Which process modules are defined, and which run under which names (process-modules.md section 3).

Running modules are in the value of ``*running-process-modules*``, so that a projection may bind it and see its own modules only.
Repaired: a module that ends takes all its aliases with it, ``with-process-module-aliases`` makes aliases that can be seen, and no alias
or registration takes a name away from another module. A name that nothing runs under is an error at once, which tells the nearest name
that is, and why the module ended if it did.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.cpl.failures.failure_types import opened
from cramhy_runtime.cpl.tasks.pausing import pause
from ..cpl.task_variables import inherit
from cramhy_runtime.ground.conditions import SimpleError, error, from_python
from cramhy_runtime.ground.data import Symbol, list_from
from cramhy_runtime.ground.source_places import describe, locate
from cramhy_runtime.ground.packages import near_names
from cramhy_runtime.ground.printing import princ_to_string
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, TypeVar
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from cramhy_runtime.ground.data import Cons
    from .modules import AbstractProcessModule

T = TypeVar("T")


class UnknownProcessModule(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::UNKNOWN-PROCESS-MODULE"


class ProcessModuleRunning(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-RUNNING"


class ProcessModuleNotRunning(SimpleError):
    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE-NOT-RUNNING"


class Registry:
    """The running modules by name, in order of registration, the tasks that wait for one, and why modules that failed have ended."""

    def __init__(self) -> None:
        self.modules: dict[Symbol, AbstractProcessModule] = {}
        self.waiters: list[kernel.Task[object]] = []
        self.reasons: dict[Symbol, str] = {}  # name -> text

    def copy(self) -> Registry:
        """One of another image: nothing runs there yet."""
        return Registry()

    def add(self, name: Symbol, module: AbstractProcessModule) -> None:
        self.modules[name] = module
        self.reasons.pop(name, None)
        for task in self.waiters:
            task.kernel.unpark(task)

    def remove(self, module: AbstractProcessModule, reason: str | None = None) -> None:
        for name in self.names(module):
            del self.modules[name]
            if reason is not None:
                self.reasons[name] = reason

    def names(self, module: AbstractProcessModule) -> list[Symbol]:
        return [name for name, running in self.modules.items() if running is module]


RUNNING_MODULES = inherit(sym("CPM::*RUNNING-PROCESS-MODULES*"), Registry())
_defined: dict[Symbol, bool] = per_image({})


def running() -> Registry:
    """The `Registry` in force."""
    return RUNNING_MODULES.value


def register_process_module(name: Symbol) -> Cons | None:
    """Note that ``name`` is the class of a process module; returns the list of such names, the newest first."""
    _defined.pop(name, None)
    _defined[name] = True
    return get_process_module_names()


def is_defined(name: object) -> bool:
    return name in _defined


def get_process_module_names() -> Cons | None:
    return list_from(list(reversed(_defined)))


def get_running_process_module(name: Symbol) -> AbstractProcessModule | None:
    """The running module called ``name``, or nil."""
    return running().modules.get(name)


def get_running_process_module_name(module):
    """The name that the running ``module`` got first, or nil."""
    names = running().names(module)
    return names[0] if names else None


def get_running_process_module_names(module):
    """All names of the running ``module``, the newest first."""
    return list_from(list(reversed(running().names(module))))


def module_called(name: Any) -> Any:
    """The running module that ``name`` stands for; an unknown name is an error."""
    if not isinstance(name, Symbol) and name is not None:
        return name
    return running().modules.get(name) or unknown(name)


def unknown(name: object) -> NoReturn:
    error(_with_hint(UnknownProcessModule("Unknown process module: ~a ", name), name))


def not_running(name: object) -> ProcessModuleNotRunning:
    """The condition for a module that has ended, or was never started."""
    return _with_hint(ProcessModuleNotRunning("Process module `~a' not running.", name), name)


def ended_because(problem):
    """What ended a module, as a text that holds no object of the plan."""
    problem = from_python(opened(problem))
    locate(problem, problem)
    place = describe(getattr(problem, "position", None))
    return f"{in_one_line(problem)}{f', at {place}' if place else ''}"


def in_one_line(thing: object) -> str:
    """``thing`` as ``princ`` shows it, on one line."""
    return " ".join(princ_to_string(thing).split())


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


def _typed(name):
    """A name as the user types it."""
    return str(getattr(name, "name", name)).lower()


def _as_typed_beside(name, other):
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
    """Register ``module`` under ``name``, or only see whether that is possible; that a module runs under it is an error."""
    if name in running().modules:
        return error(ProcessModuleRunning("Process module `~a' already running. foo foo", name))
    if module is not None:
        running().add(name, module)


def process_module_alias(alias: Symbol, name: Symbol) -> Symbol:
    """Let ``alias`` be another name of the running module ``name``, until that ends."""
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
    """Values of ``body()`` while the aliases, pairs (alias, name), are in force."""
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
    """Values of ``body()`` while ``module`` is registered under ``name``; no main loop is started for it.

    Nothing happens to a module that runs under that name already.
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
