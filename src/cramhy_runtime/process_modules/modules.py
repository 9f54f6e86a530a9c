"""Process modules: the parts of a plan that talk to the robot, one request at a time.

A module is a task that waits for designators. ``pm-execute`` sends one, waits, and returns the values of the module's body, or
signals its failure, the identical object, in the caller. Requests queue up; the body runs in a task of its own, and is evaporated
when the request is cancelled or its caller is. Source: process-modules.md sections 2 to 4.

Repaired: each request has its own result, so two callers cannot get each other's; a caller that is evaporated or suspended waits
until the body it asked for is dead, so no motion outlives its plan (law 1); a run cancelled by somebody else is a plan failure in
its caller, where the original returns an old result; a module that ends fails the requests that are left.
"""

from __future__ import annotations

import weakref
from collections import deque

from cramhy_runtime import kernel

from ..cpl.branches import Branches, nobody_lives
from ..cpl.ending import awaiting_death
from ..cpl.failure_types import PlanFailure, SimplePlanFailure, opened
from ..cpl.fluent_operators import fl_funcall, fl_not, fl_pulsed
from ..cpl.fluents import make_fluent
from ..cpl.suspension import retry_after_suspension
from ..cpl.task_variables import inherit
from ..cpl.current import current_task
from ..cpl.pausing import pause
from ..cpl.statuses import EVAPORATED
from ..cpl.task_readers import result, status
from ..cpl.tasks import Task
from ..cpl.statuses import FAILED as TASK_FAILED
from ..cpl.waiting import wait_for
from ..designators.equating import current_desig
from ..lisp.condition_types import SimpleWarning
from ..lisp.conditions import DEBUGGER_HOOK, Error, error, handler_bind, invoke_debugger, restart_case, warn
from ..lisp.data import Symbol, all_values, lisp_list, list_from, python_list, truth, values
from ..lisp.dynamic import binding
from ..lisp.hooks import Hook
from ..lisp.objects.class_definition import define_class
from ..lisp.objects.classes import class_name, find_class_or_error, make_instance
from ..lisp.objects.generic import generic
from ..lisp.packages import keyword
from .registry import ProcessModuleNotRunning, ProcessModuleRunning, is_defined, module_called, register_process_module, running, unknown
from .symbols import sym

OFFLINE, WAITING, RUNNING, FAILED = map(keyword, ("OFFLINE", "WAITING", "RUNNING", "FAILED"))
PM_DEBUGGER_HOOK = inherit(sym("CPM::*PROCESS-MODULE-DEBUGGER-HOOK*"), None)
CONTINUE_PM, TERMINATE_PM = sym("CPM::CONTINUE-PM"), sym("CPM::TERMINATE-PM")

on_process_module_started = Hook("CPM::ON-PROCESS-MODULE-STARTED", "(module input)")
on_process_module_finished = Hook("CPM::ON-PROCESS-MODULE-FINISHED", "(module input result)")
on_process_module_failed = Hook("CPM::ON-PROCESS-MODULE-FAILED", "(module input failure)")

pm_run = generic("CPM::PM-RUN", "(process-module &optional name)", documentation="""
Run a process module, an object or the name of its class, until the task is evaporated.""")
pm_execute = generic("CPM::PM-EXECUTE", "(process-module input &key task)", documentation="""
Send a designator to a process module and wait: the values of its body.""")
pm_cancel = generic("CPM::PM-CANCEL", "(process-module)", documentation="Cancel what the module does now; nobody waits.")
pm_status = generic("CPM::PM-STATUS", "(process-module)", documentation="The fluent of its status.")
running_fluent = generic("CPM::RUNNING-FLUENT", "(process-module)", documentation="A fluent: is its status :running?")
finished_fluent = generic("CPM::FINISHED-FLUENT", "(process-module)", documentation="A fluent: is its status not :running?")
monitor_process_module = generic("CPM::MONITOR-PROCESS-MODULE", "(process-module &key designators)", documentation="""
Wait until the module has finished and return a stored result, that of a listed designator if there is a list.""")


class Request:
    """One call of `pm_execute`: the designator, who asked, and what came of it."""

    __slots__ = ("input", "caller", "started", "finished", "values", "failure", "branches", "cancelled", "waiter")

    def __init__(self, input_, caller):
        self.input, self.caller = input_, caller
        self.started = self.finished = self.cancelled = False
        self.values = ()
        self.failure = None
        self.branches = None  # the body, while it runs
        self.waiter = kernel.current()

    def finish(self):
        self.finished = True
        self.waiter.kernel.unpark(self.waiter)

    def cancel(self):
        self.cancelled = True
        if self.branches is not None:
            for task in self.branches.tasks:
                task.ask_to_end("Cancelled.")


class AbstractProcessModule:
    """What synchronous and asynchronous modules share: a name, and fluents for input, status, cancellation and caller."""

    lisp_name = "CRAM-PROCESS-MODULES::ABSTRACT-PROCESS-MODULE"
    initargs = {"NAME": "name", "INPUT": "input", "STATUS": "status_fluent", "CANCEL": "cancel", "CALLER": "caller"}

    def __init__(self, name=None):
        if name is None:
            error("Process modules need a name.")
        self.name = name
        self.input = self._fluent("INPUT")
        self.status_fluent = self._fluent("STATUS", OFFLINE)
        self.cancel = self._fluent("CANCEL")
        self.caller = self._fluent("CALLER")

    def _fluent(self, what, initial=None):
        return make_fluent(name=Symbol(f"{self.name.name}-{what}"), value=initial)


class ProcessModule(AbstractProcessModule):
    """A module that processes one designator after the other; its body is the primary method of ``pm-run``."""

    lisp_name = "CRAM-PROCESS-MODULES::PROCESS-MODULE"
    initargs = {"RESULT": "result_fluent"}

    def __init__(self, name=None):
        super().__init__(name)
        self.result_fluent = self._fluent("RESULT")
        self.queue = deque()
        self.request = None  # the one in progress
        self.sleeper = None  # the kernel task of the main loop, while it waits for requests
        self.terminating = False
        self.unprocessed_results = weakref.WeakKeyDictionary()
        self.cancel.callbacks = {"cancel": self._cancel_request}

    def _cancel_request(self, wanted):
        if truth(wanted) and self.request is not None:
            self.request.cancel()

    @property
    def busy(self):
        return self.request is not None or bool(self.queue)

    def submit(self, request):
        """Put ``request`` into the queue."""
        self.queue.append(request)
        if self.sleeper is not None:
            self.sleeper.kernel.unpark(self.sleeper)

    def withdraw(self, request):
        """Its caller gives up: take it out of the queue, or cancel its run and wait until that is over."""
        if request in self.queue:
            self.queue.remove(request)
            return
        with awaiting_death(lambda: request.branches.tasks if request.branches is not None else ()):
            request.cancel()
            request.waiter = kernel.current()
            while not request.finished:
                kernel.park(lambda: f"process module {self.name.name} to stop")

    # ---------------------------------------------------------------------------------------------------------- main loop

    def run(self, body, name):
        """The main loop: serve requests until the task is evaporated or the module is told to terminate."""
        if self.status_fluent.stored is not OFFLINE:
            error("Process module `~a' already running.", self.name)
        if name in running().modules:
            error(ProcessModuleRunning("Process module `~a' already running. foo foo", name))
        registry = running()
        self.terminating = False
        self.input.set(None)
        self.cancel.set(None)
        self.status_fluent.set(WAITING)
        registry.add(name, self)
        try:
            while not self.terminating:
                self._await_request()
                self._serve(self.queue.popleft(), body)
        finally:
            registry.remove(self)
            self.status_fluent.set(OFFLINE)
            while self.queue:
                request = self.queue.popleft()
                request.failure = ProcessModuleNotRunning("Process module `~a' not running.", self.name)
                request.finish()

    def _await_request(self):
        self.sleeper = kernel.current()
        try:
            while not self.queue:
                pause(lambda: f"a request to process module {self.name.name}")
        finally:
            self.sleeper = None

    def _serve(self, request, body):
        self.cancel.set(None)
        self.request = request
        self.caller.set(request.caller)
        self.input.set(request.input)
        self.status_fluent.set(RUNNING)
        task = Task(lambda: self._call_body(body, request), lambda: f"[{self.name.name}]")
        branches = request.branches = Branches("PROCESS-MODULE", [task])
        try:
            branches.wait(nobody_lives)
        finally:
            branches.end()
            self._conclude(request, task)

    def _call_body(self, body, request):
        task = current_task()
        task.path = task.node = None
        request.started = True
        for later in self.queue:  # they announce that they wait, once it has begun
            later.waiter.kernel.unpark(later.waiter)
        if on_process_module_started:
            on_process_module_started(self, request.input)
        if PM_DEBUGGER_HOOK.value is None:
            return body()
        return self._with_debugger(body)

    def _with_debugger(self, body):
        problems = []

        def ask(condition):
            problems.append(condition)
            with binding(DEBUGGER_HOOK, PM_DEBUGGER_HOOK.value):
                invoke_debugger(condition)

        def terminate():
            self.terminating = True
            return _GiveUp

        outcome = restart_case(
            [(CONTINUE_PM, lambda: _GiveUp, "Ignore error and restart process module main loop."),
             (TERMINATE_PM, terminate, "Terminate process module")],
            lambda: handler_bind([(Error, lambda condition: None if isinstance(condition, PlanFailure) else ask(condition))], body))
        if outcome is _GiveUp:
            raise problems[-1]
        return outcome

    def _conclude(self, request, task):
        input_ = request.input
        if task.status is TASK_FAILED:
            request.failure = opened(task.result)
            self.result_fluent.set(request.failure)
            if on_process_module_failed:
                on_process_module_failed(self, input_, request.failure)
        elif task.status is EVAPORATED:
            request.cancelled = True
        else:
            request.values = all_values(task.result)
            if request.values:
                self.result_fluent.set(list_from(request.values))
                self.unprocessed_results[input_] = request.values
        self.request = request.branches = None
        self.input.set(None)
        if on_process_module_finished:
            on_process_module_finished(self, input_, self.result_fluent.stored)
        self.status_fluent.set(FAILED if request.failure is not None else WAITING)
        request.finish()


class _GiveUp:
    """What the restarts of a module's error return."""


def define_process_module(name, body):
    """``(def-process-module name (designator) ...)``: define the class ``name`` of modules whose body is ``body(designator)``.

    The body gets the youngest equated designator of the input. Returns the names of all modules.
    """
    cls = define_class(name, lisp_list(sym("CPM::PROCESS-MODULE")), None)
    pm_run.method(cls)(lambda module, module_name=None: body(current_desig(module.input.stored)))
    return register_process_module(name)


def make_module(name, class_name=None):
    """A new module called ``name`` of the class ``class_name`` (default: ``name``)."""
    return make_instance(find_class_or_error(class_name or name), keyword("NAME"), name)


@pm_run.method(Symbol)
def _run_by_name(class_name, name=None):
    name = name or class_name
    if not is_defined(class_name):
        return unknown(class_name)
    if name in running().modules:
        return error(ProcessModuleRunning("Process module `~a' already running. foo foo", name))
    return pm_run(make_module(name, class_name), name)


@pm_run.method(ProcessModule, qualifier="around", uses_next=True)
def _run_module(next_method, module, name=None):
    module.run(next_method, name or sym_of_class(module))


def sym_of_class(module):
    return class_name(type(module))


# ----------------------------------------------------------------------------------------------------------------- executing


status.method(AbstractProcessModule)(lambda module: module.status_fluent)
result.method(ProcessModule)(lambda module: module.result_fluent)


@pm_execute.method(Symbol, None)
@pm_execute.method(type(None), None)
def _execute_by_name(name, input_, *, task=None):
    return pm_execute(module_called(name), input_, keyword("TASK"), task or current_task())


@pm_execute.method(ProcessModule, None)
def _execute(module, input_, *, task=None):
    await_online(module)
    if input_ is None:
        return values(*python_list(module.result_fluent.stored)) if not isinstance(module.result_fluent.stored, BaseException) else None

    def attempt():
        if module.status_fluent.stored is OFFLINE:  # it has ended while the caller was suspended
            return error(ProcessModuleNotRunning("Process module `~a' not running.", module.name))
        before = module.request or (module.queue[0] if module.queue else None)
        request = Request(input_, task or current_task())
        module.submit(request)
        try:
            while not request.finished:
                if before is not None and before.started:
                    warn(SimpleWarning("Process module ~a already processing input. Waiting for it to become free.", module))
                    before = None
                    continue
                pause(lambda: f"process module {module.name.name}")
        finally:
            if not request.finished:
                module.withdraw(request)
        return request

    request = retry_after_suspension(attempt)
    if request.failure is not None:
        return error(request.failure)
    if request.cancelled:
        return error(SimplePlanFailure("The execution of ~a by process module ~a was cancelled.", input_, module.name))
    return values(*request.values)


def await_online(module):
    """Wait, with a warning, until ``module`` is not offline."""
    status = module.status_fluent
    if status.stored is OFFLINE:
        warn(SimpleWarning("Process module ~a not running. Status is ~a. Waiting for it to come up.", module, OFFLINE))
        wait_for(fl_not(fl_funcall(lambda now: now is OFFLINE or None, status)))


# ------------------------------------------------------------------------------------------------------------ other operations


@pm_cancel.method(Symbol)
def _cancel_by_name(name):
    return pm_cancel(module_called(name))


@pm_cancel.method(ProcessModule)
def _cancel(module):
    module.cancel.set(True)
    return True


@pm_status.method(Symbol)
def _status_by_name(name):
    return pm_status(module_called(name))


@pm_status.method(AbstractProcessModule)
def _status(module):
    return module.status_fluent


@running_fluent.method(ProcessModule)
def _running(module):
    return fl_funcall(lambda status: True if status is RUNNING else None, module.status_fluent)


@finished_fluent.method(ProcessModule)
def _finished(module):
    return fl_funcall(lambda status: None if status is RUNNING else True, module.status_fluent)


@monitor_process_module.method(Symbol)
def _monitor_by_name(name, *, designators=None):
    return monitor_process_module(module_called(name), keyword("DESIGNATORS"), designators)


@monitor_process_module.method(ProcessModule)
def _monitor(module, *, designators=None):
    wanted = python_list(designators)
    while True:
        wait_for(finished_fluent(module))
        results = module.unprocessed_results
        for designator in wanted or list(results):
            if designator in results:
                return values(*results.pop(designator))
        wait_for(fl_pulsed(module.status_fluent, handle_missed_pulses=keyword("NEVER")))
