"""Process modules and ``perform`` from Python.

    @process_module(Driving)                    # for motions of that type
    def navigation(motion):
        drive(*reference(motion))
        return "there"

    def main():
        with process_modules(navigation):
            return perform(Driving(speed=1.5))  # finds the module, waits for it: "there"

    cpl.run(main)

A motion that is performed must stand for something: see `motion_grounding`. A module is a function that is called with one designator
after the other, each call a task of its own that ends with who asked for it. An asynchronous one is a class derived from
`AsynchronousModule`. Both have a name that Lisp can use, in the package PYTHON-USER or as ``name=`` says. What is said about which
designators a module is for is a fact group of its own, which ``(matching-process-module ...)`` and ``(available-process-module ...)``
find; `perform` asks for them in order of definition. Failures of a module are raised where it was asked, the very exception. Source:
process-modules.md 2 to 8.
"""

from __future__ import annotations

from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, TypeVar, overload, subscripted

from .. import kernel
from cramhy_runtime.cpl.failures.python_exceptions import for_python, raise_in_python
from ..cpl.current import inside_plan
from cramhy_runtime.cpl.fluents.fluents import Fluent
from ..designators.classes import Designator
from ..designators.python_grounding import kind_goals
from ..designators.python_kinds import Kind
from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.conditions import from_python
from cramhy_runtime.ground.data import MultipleValues, Symbol, list_from
from cramhy_runtime.ground.classes import register_class
from cramhy_runtime.ground.packages import sym
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.python.rules import fact_group
from cramhy_runtime.prolog.python.terms import USER, Goal, Name, P, V, claim, import_predicates, lisp_name, to_lisp, to_python
from . import asynchronous, executing, executive, modules
from .matching import AVAILABLE, MATCHING
from .registry import UnknownProcessModule, module_called, register_process_module
from .running import modules_running

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from cramhy_runtime.ground.data import Keyword
    from .signatures import Defines

    Body = Callable[[Any], object]

D = TypeVar("D", bound=Designator, default=Any)
T = TypeVar("T", default=Any)
M = TypeVar("M", bound="AsynchronousModule")
PROJECTION_RUNNING = sym("CPM::PROJECTION-RUNNING")
import_predicates(MATCHING, AVAILABLE, PROJECTION_RUNNING)


class Module(Name, Generic[D, T]):
    """A process module that is a function in Python; it is equal to its name. Called, it is the function: nothing is queued then."""

    __slots__ = ("body",)
    __class_getitem__ = subscripted

    def __init__(self, symbol: Symbol, body: Callable[[D], T]):
        super().__init__(symbol)
        self.body = body

    def __call__(self, designator: D) -> T:  # type: ignore[override]  # other names make goals
        return self.body(designator)


@overload
def process_module(body: Callable[[D], T], /) -> Module[D, T]: ...
@overload
def process_module(*kinds: type[D], matches: Body | None = None, name: Name | Symbol | None = None) -> Defines[D]: ...
def process_module(*given: Any, matches: Body | None = None, name: Any = None) -> Any:
    """Decorator: the function is a process module, ``body(designator)``; what it returns is what `execute` and `perform` return.

    kinds: the declared types of the designators that `perform` gives to it; matches: a function that says it, ``matches(designator)``;
    without any of them only `execute` reaches it. name: its name for Lisp. A definition of the same name replaces the old one.
    """
    plain = len(given) == 1 and not isinstance(given[0], type)

    def define(body: Callable[[D], T]) -> Module[D, T]:
        module = Module(to_lisp(name) if name is not None else _symbol(body.__name__), body)
        claim(module.symbol, body, "process module")
        with reasoning():
            modules.define_process_module(module.symbol, body)
        _say_what_it_is_for(module.symbol, () if plain else given, matches)
        return module

    return define(given[0]) if plain else define


def _symbol(name: str) -> Symbol:
    return USER.intern(lisp_name(name)) if name.isidentifier() else _no_name(name)


def _no_name(name: str) -> Symbol:
    raise TypeError(f"{name} cannot name a process module. Write process_module(name=P.navigation)(...).")


def _say_what_it_is_for(name: Symbol, kinds: Any, matches: Any) -> None:
    for kind in kinds:
        if not isinstance(kind, Kind):
            raise TypeError(
                f"{kind!r} is no declared type of designators. Declare one, class Driving(Motion): ..., or give a function: "
                "matches=lambda designator: ..."
            )
        if kind.type_ is None:
            raise TypeError(
                f"{kind.__name__} describes all {kind.__name__.lower()}s. Say so by a function: matches=lambda designator: True."
            )
    with fact_group(Name(USER.intern(f"{name.name} IN PYTHON")), extends=[Name(MATCHING), Name(AVAILABLE)]) as group:
        head = Goal(to_lisp([Name(MATCHING), V.designator, Name(name)]))
        for kind in kinds:
            group.rule(head, *kind_goals(kind))
        if matches is not None:
            group.rule(head, P.lisp_pred(matches, V.designator))
        group.rule(Goal(to_lisp([Name(AVAILABLE), Name(name)])))


class AsynchronousModule(asynchronous.AsynchronousProcessModule):
    """A module that takes the next designator while others are still being processed: derive a class from it.

        class Arm(AsynchronousModule, kinds=[Reaching]):
            def on_input(self, motion): ...        # begin; may wait, and others queue up meanwhile
            def on_cancel(self, motion): ...       # for each unfinished one, when the module is cancelled
            def on_run(self): ...                  # beside, as long as the module runs
            def ready(self, motion): ...           # a fluent, or True, that says when the motion may be taken

    `finish` and `fail` say what became of a designator, and `monitor` waits for that. Class options: ``kinds``, ``matches`` and ``name``
    as for `process_module`. `execute` of it returns when the module has taken the designator.
    """

    module_name: Symbol

    def __init_subclass__(
        cls, kinds: Iterable[type[Designator]] = (), matches: Body | None = None, name: Name | Symbol | None = None
    ) -> None:
        super().__init_subclass__()
        cls.module_name = to_lisp(name) if name is not None else _symbol(cls.__name__)
        register_class(cls.module_name, cls)
        register_process_module(cls.module_name)
        _say_what_it_is_for(cls.module_name, kinds, matches)

    def on_input(self, designator: Any) -> object:
        """Begin with a designator."""
        raise NotImplementedError(f"{type(self).__name__} does not say what it does with a designator: def on_input(self, designator): ...")

    def on_cancel(self, designator: Any) -> object:
        """The module was cancelled, and this designator is not finished. By default nothing is done."""

    def on_run(self) -> object:
        """What runs beside; by default nothing."""

    def ready(self, designator: Any) -> object:
        """A fluent that is true when the designator may be taken. By default they are taken at any time."""
        return True

    @for_python
    def finish(self, designator: Designator | None = None) -> None:
        """Say that a designator, or all that were begun, is finished."""
        asynchronous.finish_process_module(self, designator=designator)

    @for_python
    def fail(self, failure: BaseException, designator: Designator | None = None) -> None:
        """Say that a designator, or all that were begun, failed; `monitor` raises ``failure``."""
        asynchronous.fail_process_module(self, from_python(failure), designator=designator)


asynchronous.on_input.method(AsynchronousModule, None)(lambda module, designator: module.on_input(designator))
asynchronous.on_cancel.method(AsynchronousModule, None)(lambda module, designator: module.on_cancel(designator))
asynchronous.on_run.method(AsynchronousModule)(lambda module: module.on_run())
asynchronous.synchronization_fluent.method(AsynchronousModule, None)(lambda module, designator: module.ready(designator))

Designation = Module | type[AsynchronousModule] | Name | Symbol | str
"""What names a process module: itself, or a name; a string is an alias that `process_modules` gave."""


# -------------------------------------------------------------------------------------------------------------------- in plans


@contextmanager
def process_modules(*running: Designation, **aliases: Designation) -> Iterator[None]:
    """``with process_modules(navigation, left=arm, right=arm):`` the modules run while the block does, and have ended after it.

    A keyword is the name of one more module of that kind. Errors: whatever keeps a module from starting; after the block, what one failed
    with.
    """
    if kernel.active() is None:
        inside_plan("PROCESS-MODULES")
    started = [*map(module_symbol, running), *((_symbol(alias), module_symbol(module)) for alias, module in aliases.items())]
    try:
        with modules_running(started):
            yield
        return
    except Condition as condition:
        problem = condition
    raise_in_python(problem)


@overload
def execute(module: Module[D, T], designator: D) -> T: ...
@overload
def execute(module: type[AsynchronousModule] | Symbol | str, designator: Designator) -> Any: ...
@for_python
def execute(module: Designation, designator: Designator) -> Any:
    """Have ``module`` execute a designator, and wait: what its function returns; what it fails with is raised.

    Requests queue up. The call ends with the caller: when that is ended, the function is; when it is suspended, the function is ended, and
    called again afterwards. Several values of a module of Lisp are a tuple.
    """
    inside_plan("EXECUTE")
    return in_python(_asked(executing.pm_execute, module, _checked(designator)))


@for_python
def perform(designator: Designator) -> Any:
    """Perform a motion, by a process module that matches it, or an action, by its plan function: what that returns.

    Failures: SimplePlanFailure if there is no module or plan function, ReferenceFailure if the designator cannot be resolved, and what
    the module or the plan fails with.
    """
    inside_plan("PERFORM")
    return in_python(executive.perform(_checked(designator)))


@for_python
def monitor(module: Designation, *designators: Designator) -> Any:
    """Wait until ``module`` has finished one of the designators, or, without any, all it has: what it returned; a failure is raised."""
    inside_plan("MONITOR")
    return in_python(_asked(lambda found: executing.monitor_process_module(found, designators=list_from(designators)), module))


@for_python
def cancel(module: Designation) -> None:
    """End what ``module`` does now; nobody waits for that here. Who asked for it gets a failure."""
    inside_plan("CANCEL")
    _running(module).cancel.set(True)


@for_python
def status(module: Designation) -> Fluent[Keyword]:
    """The fluent of its status: ``kw.waiting``, ``kw.running``, ``kw.failed``, and ``kw.offline`` when it has ended."""
    inside_plan("STATUS")
    found: Fluent[Keyword] = _running(module).status_fluent
    return found


@overload
def running_module(module: type[M]) -> M: ...
@overload
def running_module(module: Name | Symbol | str) -> modules.AbstractProcessModule: ...
@for_python
def running_module(module: Designation) -> Any:
    """The object of a running module: that of an `AsynchronousModule` has its `finish` and `fail`."""
    inside_plan("RUNNING-MODULE")
    return _running(module)


def _running(module: Any) -> Any:
    return _asked(module_called, module)


def _asked(function: Callable[..., Any], module: Any, *arguments: Any) -> Any:
    try:
        return function(module_symbol(module), *arguments)
    except UnknownProcessModule as problem:
        note = f"From Python, modules run in a block: with process_modules({Name(module_symbol(module)).python_name}): ..."
        if note not in getattr(problem, "__notes__", ()):
            problem.add_note(note)
        raise


def module_symbol(module: Any) -> Any:
    """The symbol that names a process module, or the alias of one."""
    if isinstance(module, type) and issubclass(module, AsynchronousModule) and module is not AsynchronousModule:
        return module.module_name
    if isinstance(module, str):
        return _symbol(module)
    if isinstance(module, (Name, Symbol)):
        return to_lisp(module)
    if isinstance(module, modules.AbstractProcessModule):
        return module
    raise TypeError(f"{module!r} is no process module. Decorate a function with @process_module.")


def _checked(designator: Any) -> Designator:
    if not isinstance(designator, Designator):
        raise TypeError(f"{designator!r} is no designator, and cannot be performed. Make one: Motion(type=kw.driving).")
    return designator


def in_python(value: Any) -> Any:
    """What a form of Lisp returns as Python sees it: several values are a tuple."""
    return tuple(map(to_python, value)) if value.__class__ is MultipleValues else to_python(value)
