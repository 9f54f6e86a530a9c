"""Process modules: the parts of a plan that talk to the robot, one request at a time.

A module is a task that waits for designators; `run` is its main loop. Requests queue up, each with a result of its own. The body runs as
an `Errand` of the module's task, so it can be evaporated, with its cleanup, while the module lives on. Plans send requests and wait for
them with ``executing.py``. Source: process-modules.md sections 2 and 4.

Repaired: each request has its own result, so a caller cannot get the result of another. A caller that is evaporated or suspended waits
until its run of the body is over, so no motion outlives its plan (law 1). If another task cancels a run, the caller gets a plan failure,
where the original returns an old result. When a module ends, the requests that are left fail.
"""

from __future__ import annotations

import weakref
from collections import deque

from cramhy_runtime import kernel
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..cpl.current import current_task, inside_plan
from cramhy_runtime.cpl.failures.debugging import DEBUG_ON_LISP_ERRORS
from cramhy_runtime.cpl.tasks.ending import awaiting_death
from cramhy_runtime.cpl.tasks.delegated_work import Errand
from cramhy_runtime.cpl.failures.failure_types import PlanFailure, opened
from cramhy_runtime.cpl.fluents.fluents import make_fluent
from ..cpl.statuses import EVAPORATED
from cramhy_runtime.cpl.statuses import FAILED as TASK_FAILED
from ..cpl.task_variables import inherit
from ..designators.classes import Designator, attached
from ..designators.equating import current_desig
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import DEBUGGER_HOOK, Error, enter_debugger, error, handler_bind, restart_case, type_error
from cramhy_runtime.lisp_core.data import Symbol, all_values, list_from, truth
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.source_places import circumstance
from cramhy_runtime.lisp_core.hooks import Hook
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.classes import class_name, find_class_or_error
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.lisp_core.packages import CURRENT, keyword
from .registry import ended_because, in_brief, is_defined, not_running, register_process_module, running, start_under, unknown
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.cpl.fluents.fluents import ValueFluent
    from cramhy_runtime.cpl.tasks.tasks import AbstractTask
    from cramhy_runtime.lisp_core.data import Cons, Keyword
    from cramhy_runtime.lisp_core.signatures import GenericOf

OFFLINE, WAITING, RUNNING, FAILED = map(keyword, ("OFFLINE", "WAITING", "RUNNING", "FAILED"))
NAME = keyword("NAME")
PM_DEBUGGER_HOOK = inherit(sym("CPM::*PROCESS-MODULE-DEBUGGER-HOOK*"), None)
CONTINUE_PM, TERMINATE_PM = sym("CPM::CONTINUE-PM"), sym("CPM::TERMINATE-PM")

own_fluents = weakref.WeakSet()
"""The fluents of process modules themselves, such as ``NAVIGATION-STATUS``."""

on_process_module_started = Hook("CPM::ON-PROCESS-MODULE-STARTED", "(module input)")
on_process_module_finished = Hook("CPM::ON-PROCESS-MODULE-FINISHED", "(module input result)")
on_process_module_failed = Hook("CPM::ON-PROCESS-MODULE-FAILED", "(module input failure)")

pm_run: GenericOf[..., object] = generic(
    "CPM::PM-RUN",
    "(process-module &optional name)",
    documentation="""
Run a process module, an object or the name of its class, until the task is evaporated.""",
)


class Request:
    """One call of ``pm-execute``: the designator, its ``caller``, and the result."""

    __slots__ = ("input", "caller", "started", "finished", "values", "failure", "cancelled", "errand", "waiter")

    def __init__(self, input_: Designator, caller: AbstractTask[object] | None):
        self.input, self.caller = input_, caller
        self.started = self.finished = self.cancelled = False
        self.values: tuple[Any, ...] = ()
        self.failure: BaseException | None = None
        self.errand: Errand | None = None  # the run of the body, from its start
        self.waiter = kernel.current()

    def finish(self) -> None:
        """Wake the task that waits for the result."""
        self.finished = True
        self.waiter.kernel.unpark(self.waiter)

    def cancel(self) -> None:
        """End the run of the body, if it has begun."""
        self.cancelled = True
        if self.errand is not None:
            self.errand.end()


class Results:
    """The values of a module's runs, until ``monitor-process-module`` takes them or the designator is gone.

    The designator itself holds the values, since they may refer to it: values in a weak table would keep it alive for ever.
    """

    def __init__(self):
        self._inputs = {}  # id of a designator -> weak reference to it, in the order of completion
        self._key = object()

    def note(self, designator, values):
        """Keep ``values`` for ``designator``."""
        if not isinstance(designator, Designator):
            return
        inputs, number = self._inputs, id(designator)
        inputs.pop(number, None)
        inputs[number] = weakref.ref(designator, lambda gone: inputs.pop(number, None))
        attached(designator).setdefault("_results_of_modules", {})[self._key] = values

    def take(self, wanted):
        """Take the values for the first designator in ``wanted`` that has some, or for any designator if it is empty; or ``None``."""
        for number in [id(designator) for designator in wanted] or list(self._inputs):
            if number in self._inputs:
                return attached(self._inputs.pop(number)())["_results_of_modules"].pop(self._key)
        return None


class AbstractProcessModule:
    """The base of synchronous and asynchronous modules: a name, and fluents for input, status, cancellation and caller."""

    lisp_name = "CRAM-PROCESS-MODULES::ABSTRACT-PROCESS-MODULE"
    initargs = {"NAME": "name", "INPUT": "input", "STATUS": "status_fluent", "CANCEL": "cancel", "CALLER": "caller"}

    def __init__(self, name: Symbol | None = None):
        if name is None:
            error("Process modules need a name.")
        if not isinstance(name, Symbol):
            type_error(name, "SYMBOL", "\n(The name of a process module is a symbol.)")
        self.name = name
        self.task: AbstractTask[object] | None = None  # of the plan, which runs it
        self.input: ValueFluent[Designator | None] = self._fluent("INPUT")
        self.status_fluent: ValueFluent[Keyword] = self._fluent("STATUS", OFFLINE)
        self.cancel: ValueFluent[bool | None] = self._fluent("CANCEL")
        self.caller: ValueFluent[AbstractTask[object] | None] = self._fluent("CALLER")

    def _fluent(self, what: str, initial: object = None) -> ValueFluent[Any]:
        made: ValueFluent[Any] = make_fluent(name=CURRENT.value.intern(f"{self.name.name}-{what}"), value=initial)
        own_fluents.add(made)
        return made

    def online(self, name: Symbol, work: Callable[[], object]) -> None:
        """Call ``work()``, the main loop. Meanwhile the module is registered under ``name`` and its status is not ``:offline``.

        If it runs already, or a module of that name runs, it is an error.
        """
        inside_plan("PM-RUN")
        if self.status_fluent.stored is not OFFLINE:
            error("Process module `~a' already running.", self.name)
        registry = running()
        start_under(name, self)
        self.task = current_task()
        self.input.set(None)
        self.cancel.set(None)
        self.status_fluent.set(WAITING)
        reason = None
        try:
            work()
        except Exception as problem:
            reason = ended_because(problem)
            raise
        except PlanFailure as failure:
            reason = ended_because(failure)
            raise
        finally:
            registry.remove(self, reason)
            self.task = None
            self.status_fluent.set(OFFLINE)
            self.ended()

    def ended(self) -> None:
        """Called when the main loop is over: tell the tasks that wait for the module."""


class ProcessModule(AbstractProcessModule):
    """A module that processes one designator after the other. Its body is the primary method of ``pm-run``."""

    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE"
    initargs = {"RESULT": "result_fluent"}

    def __init__(self, name: Symbol | None = None):
        super().__init__(name)
        self.result_fluent: ValueFluent[Any] = self._fluent("RESULT")
        self.queue: deque[Request] = deque()
        self.request: Request | None = None  # the one in progress
        self.sleeper: kernel.Task[object] | None = None  # the kernel task of the main loop, while it waits for requests
        self.terminating = False
        self.results = Results()

    def submit(self, request: Request) -> None:
        """Put ``request`` into the queue."""
        self.queue.append(request)
        if self.sleeper is not None:
            self.sleeper.kernel.unpark(self.sleeper)

    def withdraw(self, request: Request) -> None:
        """Take ``request`` out of the queue, or cancel its run and wait until that is over, because its caller gives up."""
        if request in self.queue:
            self.queue.remove(request)
            return
        with awaiting_death(lambda: (self.task,) if self.request is request else ()):
            request.cancel()
            request.waiter = kernel.current()
            while not request.finished:
                kernel.park(lambda: f"process module {self.name.name} to stop")

    # ---------------------------------------------------------------------------------------------------------- main loop

    def run(self, body: Callable[[], object], name: Symbol) -> None:
        """Serve requests, under ``name``, until the task is evaporated or the restart ``terminate-pm`` is chosen."""
        self.online(name, lambda: self._serve_all(body))

    def _serve_all(self, body: Callable[[], object]) -> None:
        self.terminating = False
        self.cancel.callbacks = {"cancel": self._cancel_request}
        try:
            while not self.terminating:
                self._await_request()
                self._serve(self.queue.popleft(), body)
        finally:
            self.cancel.callbacks = None

    def _cancel_request(self, wanted):
        if truth(wanted) and self.request is not None:
            self.request.cancel()

    def _await_request(self):
        if self.queue:
            return
        me = self.sleeper = kernel.current()
        try:
            while not self.queue:
                me.kernel.park(lambda: f"a request to process module {self.name.name}")
        finally:
            self.sleeper = None

    def _serve(self, request, body):
        errand = request.errand = Errand()
        self.request = request
        status, outcome = EVAPORATED, None
        try:
            if self.cancel.stored is not None:
                self.cancel.set(None)
            self.caller.set(request.caller)
            self.input.set(request.input)
            self.status_fluent.set(RUNNING)
            status, outcome = errand.run(self._call_body, body, request)
        except (PlanFailure, Exception) as problem:  # of an observer of a fluent: it is the end of the module, too
            status, outcome = TASK_FAILED, from_python(problem)
            raise
        finally:
            self._conclude(request, status, outcome)

    @circumstance(lambda here: f"while process module {here['self'].name.name} executed {in_brief(here['request'].input)}")
    def _call_body(self, body, request):
        request.started = True
        for later in self.queue:  # they announce that they wait, once it has begun
            later.waiter.kernel.unpark(later.waiter)
        if on_process_module_started.methods:
            on_process_module_started(self, request.input)
        if PM_DEBUGGER_HOOK.value is None and DEBUG_ON_LISP_ERRORS.value is None:
            return body()
        return handler_bind([(Error, lambda problem: None if isinstance(problem, PlanFailure) else self._ask_what_to_do(problem))], body)

    def _ask_what_to_do(self, problem):
        """Call the debugger, or the hook in its place, for an error of the body. With both restarts the body fails with the error."""

        def terminate():
            self.terminating = True

        def ask():
            hook = PM_DEBUGGER_HOOK.value
            if hook is None:
                enter_debugger(problem)
                return
            with binding(DEBUGGER_HOOK, hook):
                enter_debugger(problem)

        restart_case(
            [
                (CONTINUE_PM, lambda: None, "Ignore error and restart process module main loop."),
                (TERMINATE_PM, terminate, "Terminate process module"),
            ],
            ask,
        )
        raise problem

    def _conclude(self, request, status, outcome):
        try:
            self._note(request, status, outcome)
            self.request = request.errand = None
            self.input.set(None)
            if on_process_module_finished.methods:
                on_process_module_finished(self, request.input, self.result_fluent.stored)
            self.status_fluent.set(FAILED if request.failure is not None else WAITING)
        finally:
            self.request = request.errand = None
            request.finish()

    def _note(self, request, status, outcome):
        if status is TASK_FAILED:
            request.failure = opened(outcome)
            self.result_fluent.set(request.failure)
            if on_process_module_failed.methods:
                on_process_module_failed(self, request.input, request.failure)
        elif status is EVAPORATED:
            request.cancelled = True
        else:
            request.values = all_values(outcome)
            if request.values:
                self.result_fluent.set(list_from(request.values))
                self.results.note(request.input, request.values)

    def ended(self) -> None:
        while self.queue:
            request = self.queue.popleft()
            request.failure = not_running(self.name)
            request.finish()


def define_process_module(name: Symbol, body: Callable[[Any], object]) -> Cons | None:
    """``(def-process-module name (designator) ...)``: define the class ``name`` of modules whose body is ``body(designator)``.

    The body gets the youngest designator in the chain of the input. Returns the names of all modules. Source: process-modules.md 4.1.
    """
    cls = PORTS.classes.define(name, ProcessModule)
    pm_run.method(cls)(lambda module, module_name=None: body(current_desig(module.input.stored)))
    return register_process_module(name)


def make_module(name: Symbol, class_name: Symbol | None = None) -> AbstractProcessModule:
    """A new module called ``name`` of the class ``class_name`` (default: ``name``). A class that does not exist is an error."""
    return make_instance(find_class_or_error(class_name or name), NAME, name)


@pm_run.method(Symbol)
@pm_run.method(type(None))
def _run_by_name(class_name, name=None):
    if not is_defined(class_name):
        return unknown(class_name)
    name = name or class_name
    start_under(name)
    return pm_run(make_module(name, class_name), name)


@pm_run.method(ProcessModule, qualifier="around", uses_next=True)
def _run_module(next_method, module, name=None):
    module.run(next_method, name or sym_of_class(module))


def sym_of_class(module):
    """The name of the class of ``module``."""
    return class_name(type(module))
