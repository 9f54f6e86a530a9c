"""Process modules and ``perform`` from Python.

    @process_module(Driving)                    # for motions of that type
    def navigation(motion):
        drive(*reference(motion))
        return "there"

    def main():
        with process_modules(navigation):
            return perform(Driving(speed=1.5))  # finds the module, waits for it: "there"

    cpl.run(main)

A motion can be performed only if it can be resolved: see `motion_grounding`. A module is a function that is called with one designator
after the other. Each call is like a task of its own, and ends when its caller ends. An asynchronous module is a class derived from
`AsynchronousModule`. Both have a name for Lisp, in the package PYTHON-USER or from ``name=``. The rules which designators a module is for
are a fact group of their own, for ``(matching-process-module ...)`` and ``(available-process-module ...)``; `perform` asks the modules in
order of definition. A failure of a module is raised in its caller, the same exception. Source: process-modules.md 2 to 8.
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
from ..designators.python_kinds import Kind, hold_for_derived
from cramhy_runtime.kernel.unstarted import plain_function
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.data import MultipleValues, Symbol, list_from
from cramhy_runtime.lisp_core.classes import register_class
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.python.rules import fact_group, remove_fact_group
from cramhy_runtime.prolog.python.spelling import exact_lisp_name
from cramhy_runtime.prolog.python.terms import USER, Goal, Name, P, V, claim, import_predicates, to_lisp, to_python
from . import asynchronous, executing, executive, modules
from .matching import AVAILABLE, MATCHING
from .registry import UnknownProcessModule, module_called, register_process_module
from .running import modules_running

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from cramhy_runtime.lisp_core.data import Keyword
    from .signatures import Defines

    Body = Callable[[Any], object]

D = TypeVar("D", bound=Designator, default=Any)
T = TypeVar("T", default=Any)
M = TypeVar("M", bound="AsynchronousModule")
PROJECTION_RUNNING = sym("CPM::PROJECTION-RUNNING")
import_predicates(MATCHING, AVAILABLE, PROJECTION_RUNNING)


class Module(Name, Generic[D, T]):
    """A process module that is a function in Python. It is equal to its name. A call of it calls the function directly."""

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
    """Decorator: make a process module of a function ``body(designator)``, whose result `execute` and `perform` return.

    given: the declared types of designators that `perform` gives to it. matches: a function ``matches(designator)`` that says whether
    `perform` may give it one. Without both, only `execute` reaches the module. name: its name for Lisp. A definition of the same name
    replaces the old one. Anything but declared types is a TypeError.
    """
    plain = len(given) == 1 and not isinstance(given[0], type)

    def define(body: Callable[[D], T]) -> Module[D, T]:
        plain_function(body, "a process module")
        module = Module(to_lisp(name) if name is not None else _symbol(body.__name__), body)
        claim(module.symbol, body, "process module")
        with reasoning():
            modules.define_process_module(module.symbol, body)
        _say_what_it_is_for(module.symbol, () if plain else given, matches)
        return module

    return define(given[0]) if plain else define


def _symbol(name: str) -> Symbol:
    return USER.intern(exact_lisp_name(name)) if name.isidentifier() else _no_name(name)


def _no_name(name: str) -> Symbol:
    raise TypeError(f"{name} cannot name a process module. Write process_module(name=P.navigation)(...).")


def _say_what_it_is_for(name: Symbol, kinds: Any, matches: Any) -> None:
    kinds = list(kinds)
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
    head = Goal(to_lisp([Name(MATCHING), V.designator, Name(name)]))
    with fact_group(Name(USER.intern(f"{name.name} IN PYTHON")), extends=[Name(MATCHING), Name(AVAILABLE)]) as group:
        for kind in kinds:
            group.rule(head, *kind_goals(kind))
        if matches is not None:
            group.rule(head, P.lisp_pred(matches, V.designator))
        group.rule(Goal(to_lisp([Name(AVAILABLE), Name(name)])))
    for number, kind in enumerate(kinds):
        _hold_for_derived(name, number, kind, head)


def _hold_for_derived(name: Symbol, number: int, kind: Kind, head: Goal) -> None:
    inherited = USER.intern(f"{name.name} FOR DERIVED TYPES {number}")

    def define(kinds: list[Kind]) -> None:
        with fact_group(Name(inherited), extends=[Name(MATCHING)]) as group:
            for derived in kinds:
                group.rule(head, *kind_goals(derived))

    remove_fact_group(Name(inherited))
    hold_for_derived(inherited, kind, define)


class AsynchronousModule(asynchronous.AsynchronousProcessModule):
    """A module that takes the next designator while it still processes others. Derive a class from it:

        class Arm(AsynchronousModule, kinds=[Reaching]):
            def on_input(self, motion): ...        # begin; may wait, and others queue up meanwhile
            def on_cancel(self, motion): ...       # for each unfinished motion, when the module is cancelled
            def on_run(self): ...                  # other work, as long as the module runs
            def ready(self, motion): ...           # a fluent, or True: when the module may take the motion

    `finish` and `fail` report the end of a designator, and `monitor` waits for that. `execute` returns when the module has taken the
    designator. Class options: ``kinds``, the declared types of designators; ``matches`` and ``name`` as for `process_module`.
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
        """Begin with a designator. Derived classes must define it."""
        raise NotImplementedError(f"{type(self).__name__} does not say what it does with a designator: def on_input(self, designator): ...")

    def on_cancel(self, designator: Any) -> object:
        """Called for each unfinished designator when the module is cancelled. By default it does nothing."""

    def on_run(self) -> object:
        """Work beside taking inputs. By default there is none."""

    def ready(self, designator: Any) -> object:
        """A fluent that is true when the module may take the designator. By default it may at any time."""
        return True

    @for_python
    def finish(self, designator: Designator | None = None) -> None:
        """Report that a designator, or all that were begun, are finished. Any other designator, or an idle module, is an error."""
        asynchronous.finish_process_module(self, designator=designator)

    @for_python
    def fail(self, failure: BaseException, designator: Designator | None = None) -> None:
        """Report that a designator, or all that were begun, failed: `monitor` raises ``failure``. Another designator is an error."""
        asynchronous.fail_process_module(self, from_python(failure), designator=designator)


asynchronous.on_input.method(AsynchronousModule, None)(lambda module, designator: module.on_input(designator))
asynchronous.on_cancel.method(AsynchronousModule, None)(lambda module, designator: module.on_cancel(designator))
asynchronous.on_run.method(AsynchronousModule)(lambda module: module.on_run())
asynchronous.synchronization_fluent.method(AsynchronousModule, None)(lambda module, designator: module.ready(designator))

Designation = Module | type[AsynchronousModule] | Name | Symbol | str
"""A process module, or its name. A string is an alias given by `process_modules`."""


# -------------------------------------------------------------------------------------------------------------------- in plans


@contextmanager
def process_modules(*running: Designation, **aliases: Designation) -> Iterator[None]:
    """``with process_modules(navigation, left=arm, right=arm):`` runs the modules during the block. After it they have ended.

    A keyword is the name of one more module of that kind. Errors: a module cannot start; after the block, the failure of a module.
    Source: process-modules.md section 5.
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
    """Let ``module`` execute a designator, wait, and return the result of its function. Its failure is raised.

    Requests queue up. If the caller is ended, its call of the function is ended. If the caller is suspended, the call is ended too, and
    made again afterwards. Several values of a module of Lisp are a tuple. Errors: an unknown module, TypeError for anything but a
    designator, and calls outside of plans. Source: process-modules.md 4.3.
    """
    module_symbol(module)
    _checked(designator)
    inside_plan("EXECUTE")
    return in_python(_asked(executing.pm_execute, module, designator))


@for_python
def perform(designator: Designator) -> Any:
    """Perform a motion by a process module that matches it, or an action by its plan function. Returns the result.

    Failures: SimplePlanFailure if there is no module or plan function, ReferenceFailure if the designator cannot be resolved, and the
    failures of the module or the plan. Anything but a designator is a TypeError. Source: process-modules.md section 8.
    """
    _checked(designator)
    inside_plan("PERFORM")
    return in_python(executive.perform(designator))


@for_python
def monitor(module: Designation, *designators: Designator) -> Any:
    """Wait until ``module`` has finished one of the designators, or, without any, all that it has. Returns the result.

    A failure of the module is raised. If the module ends meanwhile, it is an error. Source: process-modules.md 4.4, 6.
    """
    module_symbol(module)
    inside_plan("MONITOR")
    return in_python(_asked(lambda found: executing.monitor_process_module(found, designators=list_from(designators)), module))


@for_python
def cancel(module: Designation) -> None:
    """End the present run of ``module``, without waiting for that. The caller of the run gets a failure. Source: process-modules.md 4.4."""
    module_symbol(module)
    inside_plan("CANCEL")
    _running(module).cancel.set(True)


@for_python
def status(module: Designation) -> Fluent[Keyword]:
    """The fluent of the status of ``module``: ``kw.waiting``, ``kw.running``, ``kw.failed``, or ``kw.offline`` when it has ended."""
    module_symbol(module)
    inside_plan("STATUS")
    found: Fluent[Keyword] = _running(module).status_fluent
    return found


@overload
def running_module(module: type[M]) -> M: ...
@overload
def running_module(module: Name | Symbol | str) -> modules.AbstractProcessModule: ...
@for_python
def running_module(module: Designation) -> Any:
    """The object of a running module. For an `AsynchronousModule` it has `finish` and `fail`. An unknown module is an error."""
    module_symbol(module)
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
    """The result of a Lisp form, converted for Python: several values are a tuple."""
    return tuple(map(to_python, value)) if value.__class__ is MultipleValues else to_python(value)
