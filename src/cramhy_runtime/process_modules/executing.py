"""Requests of a plan to a process module: execute a designator, cancel it, ask for the status, wait for a result.

``pm-execute`` sends a request, waits, and returns the values of the module's body, or signals its failure, the same object, in the
caller. A caller that is evaporated takes its request back, or cancels the run and waits until that is over. A caller that is suspended
does the same, and asks again after its wake-up. Source: process-modules.md sections 4.3 and 4.4.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..cpl.current import current_task
from cramhy_runtime.cpl.failures.failure_types import SimplePlanFailure
from cramhy_runtime.cpl.failures.handling import signal_failure
from cramhy_runtime.cpl.fluents.operators import fl_funcall, fl_not, fl_pulsed
from cramhy_runtime.cpl.tasks.suspension import retry_after_suspension
from cramhy_runtime.cpl.tasks.task_readers import result, status
from cramhy_runtime.cpl.tasks.waiting import wait_for
from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime.lisp_core.conditions import error, type_error, warn
from cramhy_runtime.lisp_core.data import Cons, Symbol, python_list, values
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.lisp_core.packages import keyword
from .modules import OFFLINE, RUNNING, AbstractProcessModule, ProcessModule, Request
from .registry import module_called, not_running
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from cramhy_runtime.cpl.fluents.fluents import Fluent
    from cramhy_runtime.lisp_core.data import Keyword
    from cramhy_runtime.lisp_core.signatures import GenericOf
    from .signatures import Execute, ModuleOrName, Monitor

TASK, DESIGNATORS, NEVER = map(keyword, ("TASK", "DESIGNATORS", "NEVER"))

pm_execute: Execute = generic(
    "CPM::PM-EXECUTE",
    "(process-module input &key task)",
    documentation="""
Send a designator to a process module, wait, and return the values of the module's body.""",
)
pm_cancel: GenericOf[[ModuleOrName], object] = generic(
    "CPM::PM-CANCEL", "(process-module)", documentation="Cancel the present run of the module, without waiting for that."
)
pm_status: GenericOf[[ModuleOrName], Fluent[Keyword]] = generic(
    "CPM::PM-STATUS", "(process-module)", documentation="The fluent of its status."
)
running_fluent = generic("CPM::RUNNING-FLUENT", "(process-module)", documentation="A fluent that is true while its status is :running.")
finished_fluent = generic("CPM::FINISHED-FLUENT", "(process-module)", documentation="A fluent that is true unless its status is :running.")
monitor_process_module: Monitor = generic(
    "CPM::MONITOR-PROCESS-MODULE",
    "(process-module &key designators)",
    documentation="""
Wait until the module has finished, and return a stored result; if there is a list, that of a designator in it.""",
)

status.method(AbstractProcessModule)(lambda module: module.status_fluent)
result.method(ProcessModule)(lambda module: module.result_fluent)


@pm_execute.method(Symbol, None)
@pm_execute.method(type(None), None)
def _execute_by_name(name, input_, *, task=None):
    return pm_execute(module_called(name), input_) if task is None else pm_execute(module_called(name), input_, TASK, task)


@pm_execute.method(ProcessModule, None)
def _execute(module, input_, *, task=None):
    if module.status_fluent.stored is OFFLINE:
        await_online(module)
    if input_ is None:
        return _old_result(module)
    caller = task or current_task()
    request = retry_after_suspension(lambda: _attempt(module, input_, caller))
    if request.failure is not None:
        return error(request.failure)
    if request.cancelled:
        return error(SimplePlanFailure("The execution of ~a by process module ~a was cancelled.", input_, module.name))
    return values(*request.values)


def _attempt(module, input_, caller):
    """Send the request and wait for it. Returns the finished `Request`."""
    if module.status_fluent.stored is OFFLINE:  # it has ended while the caller was suspended
        return error(not_running(module.name))
    kernel.choice_point(lambda: f"its turn to ask process module {module.name.name}")
    before = module.request or (module.queue[0] if module.queue else None)
    request = Request(input_, caller)
    park = request.waiter.kernel.park
    module.submit(request)
    try:
        while not request.finished:
            if before is not None and before.started:
                warn(SimpleWarning("Process module ~a already processing input. Waiting for it to become free.", module))
                before = None
                continue
            park(lambda: f"process module {module.name.name}")
    except BaseException:
        if not request.finished:
            module.withdraw(request)
            if request.failure is not None:  # the cleanup of the body failed: that must not be lost (law 3)
                raise request.failure from None
        raise
    return request


def _old_result(module):
    """The stored result of the module, for the input nil, which runs nothing."""
    stored = module.result_fluent.stored
    return signal_failure(stored) if isinstance(stored, BaseException) else values(*python_list(stored))


def await_online(module):
    """Wait, with a warning, until ``module`` is not offline."""
    status = module.status_fluent
    if status.stored is OFFLINE:
        warn(SimpleWarning("Process module ~a not running. Status is ~a. Waiting for it to come up.", module, OFFLINE))
        wait_for(fl_not(fl_funcall(lambda now: now is OFFLINE or None, status)))


# ------------------------------------------------------------------------------------------------------------ other operations


@pm_cancel.method(Symbol)
@pm_cancel.method(type(None))
def _cancel_by_name(name):
    return pm_cancel(module_called(name))


@pm_cancel.method(ProcessModule)
def _cancel(module):
    module.cancel.set(True)
    return True


@pm_status.method(Symbol)
@pm_status.method(type(None))
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
@monitor_process_module.method(type(None))
def _monitor_by_name(name, *, designators=None):
    return monitor_process_module(module_called(name), DESIGNATORS, designators)


@monitor_process_module.method(ProcessModule)
def _monitor(module, *, designators=None):
    wanted = python_list(designators) if designators is None or isinstance(designators, Cons) else type_error(designators, "LIST")
    while True:
        wait_for(finished_fluent(module))
        found = module.results.take(wanted)
        if found is not None:
            return values(*found)
        wait_for(fl_pulsed(module.status_fluent, handle_missed_pulses=NEVER))
        if module.status_fluent.stored is OFFLINE:
            return error(not_running(module.name))
