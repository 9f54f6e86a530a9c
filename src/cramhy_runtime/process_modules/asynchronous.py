"""Asynchronous process modules: ``pm-execute`` hands the designator over and returns; later the module reports that it is finished.

Users define a class and methods. The module calls ``on-input`` for each designator, one after the other. ``on-run`` may do work beside it.
``on-cancel`` is called for unfinished designators when the module is cancelled. ``synchronization-fluent`` says when the module may take
the next input. `finish_process_module` and `fail_process_module` report the end. Source: process-modules.md section 6.

Repaired: callers that hand over a designator stand in line. A caller or monitor of a module that ends gets an error, where the original
waits for ever. If several designators fail, every monitor of one of them gets the failure. A module that finishes all designators while
others are waiting stays ``:running``.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime import kernel

from ..cpl.current import current_task
from cramhy_runtime.cpl.fluents.operators import fl_funcall, fl_or, fl_pulsed
from cramhy_runtime.cpl.fluents.fluents import Fluent
from cramhy_runtime.cpl.forms.operators import pursue
from cramhy_runtime.cpl.tasks.pausing import pause
from cramhy_runtime.cpl.tasks.waiting import wait_for, whenever
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.source_places import circumstance
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from ..utilities.locks import Lock
from .executing import NEVER, await_online, finished_fluent, monitor_process_module, pm_cancel, pm_execute, running_fluent
from .modules import (
    OFFLINE,
    RUNNING,
    WAITING,
    AbstractProcessModule,
    on_process_module_failed,
    on_process_module_finished,
    on_process_module_started,
    pm_run,
    sym_of_class,
)
from .registry import in_brief, not_running

if TYPE_CHECKING:
    from cramhy_runtime.cpl.fluents.fluents import ValueFluent
    from cramhy_runtime.lisp_core.data import Symbol
    from ..designators.classes import Designator
    from .signatures import Fail, Finish

on_input = generic(
    "CPM::ON-INPUT",
    "(process-module input-designator)",
    documentation="""
Called by an asynchronous module with each input. Users write methods.""",
)
on_cancel = generic(
    "CPM::ON-CANCEL",
    "(process-module input-designator)",
    documentation="""
Called by an asynchronous module that is cancelled, with each unfinished designator. Users write methods.""",
)
on_run = generic(
    "CPM::ON-RUN",
    "(process-module)",
    documentation="""
Called by an asynchronous module at its start, for work beside taking inputs, up to its end. Users write methods.""",
)
synchronization_fluent = generic(
    "CPM::SYNCHRONIZATION-FLUENT",
    "(process-module designator)",
    documentation="""
The fluent that is true when an asynchronous module may take the designator. Users write methods.""",
)
finish_process_module: Finish = generic(
    "CPM::FINISH-PROCESS-MODULE",
    "(process-module &key designator)",
    documentation="""
Report that the module has finished one designator, or all of them.""",
)
fail_process_module: Fail = generic(
    "CPM::FAIL-PROCESS-MODULE",
    "(process-module error &key designator)",
    documentation="""
Report that one designator, or all unfinished ones, failed with the condition ``error``.""",
)

on_input.advice = "Say what the module does with an input: (defmethod cpm:on-input ((module ...) input) ...)."
synchronization_fluent.advice = (
    "Say when the module takes an input: (defmethod cpm:synchronization-fluent ((module ...) designator) "
    "fluent), where a fluent of value T means at any time."
)
pm_cancel.advice = "An asynchronous module is cancelled by (setf (cpl:value (cpm:cancel module)) t)."
running_fluent.advice = finished_fluent.advice = "Of an asynchronous module, (cpm:pm-status module) is the fluent of its status."


class AsynchronousProcessModule(AbstractProcessModule):
    """A module that takes the next designator while it still processes others."""

    lisp_name = "CRAM-PROCESS-MODULES::ASYNCHRONOUS-PROCESS-MODULE"
    initargs = {"NOTIFICATION-FLUENT": "notification_fluent"}

    def __init__(self, name: Symbol | None = None):
        super().__init__(name)
        self.queue: deque[Designator] = deque()
        self.unfinished: list[Designator] = []
        self.failures: list[tuple[BaseException, Designator]] = []  # the newest first
        self.notification_fluent: ValueFluent[None] = self._fluent("NOTIFICATION")
        self.input_lock = Lock(f"for the input of {self.name.name}")

    def run(self, name: Symbol) -> None:
        """Take inputs, under ``name``, until the task or a branch of it is evaporated, or ``on-input`` or ``on-run`` fails."""
        self.online(
            name, lambda: pursue(self._work_beside, self._take_inputs, self._process, lambda: whenever(self.cancel, self._cancel_all))
        )

    def _work_beside(self):
        on_run(self)
        while True:
            pause(lambda: f"the end of process module {self.name.name}")

    def ended(self) -> None:
        """Forget all designators, and wake the tasks that wait for the module."""
        self.queue.clear()
        self.unfinished.clear()
        self.input.set(None)
        self.changed()

    def _take_inputs(self):
        def take():
            designator = self.input.stored
            self.queue.append(designator)
            self.status_fluent.set(RUNNING)
            self.input.set(None)
            self.changed()

        whenever(self.input, take)

    def _process(self):
        while True:
            while not self.queue:
                self.await_change()
            designator = self.queue.popleft()
            self.unfinished.append(designator)
            self._call_on_input(designator)
            if on_process_module_started.methods:
                on_process_module_started(self, designator)

    @circumstance(lambda here: f"while process module {here['self'].name.name} took {in_brief(here['designator'])}")
    def _call_on_input(self, designator):
        on_input(self, designator)

    def _cancel_all(self):
        for designator in list(self.unfinished):
            on_cancel(self, designator)
        self.cancel.set(None)

    @property
    def pending(self) -> list[Designator]:
        """The designators that were handed over and have not reached ``on-input`` yet."""
        return [*([self.input.stored] if self.input.stored is not None else ()), *self.queue]

    def changed(self) -> None:
        """Wake the tasks in `await_change`."""
        self.notification_fluent.pulse()

    def await_change(self) -> None:
        """Wait until a designator is handed over, finished or failed."""
        wait_for(fl_pulsed(self.notification_fluent, handle_missed_pulses=NEVER))

    def await_while_online(self, fluent: object) -> None:
        """Wait for ``fluent``. If the module ends meanwhile, it is an error."""
        over = fl_funcall(lambda status: True if status is OFFLINE else None, self.status_fluent)
        wait_for(fl_or(fluent, over) if isinstance(fluent, Fluent) else fluent)
        if self.status_fluent.stored is OFFLINE:
            error(not_running(self.name))


@on_cancel.method(AsynchronousProcessModule, None)
def _ignore(module, designator):
    return None


@on_run.method(AsynchronousProcessModule)
def _nothing_beside(module):
    return None


@pm_run.method(AsynchronousProcessModule)
def _run(module, name=None):
    module.run(name or sym_of_class(module))


@pm_execute.method(AsynchronousProcessModule, None)
def _execute(module, input_, *, task=None):
    if module.status_fluent.stored is OFFLINE:
        await_online(module)
    kernel.choice_point(lambda: f"its turn to ask process module {module.name.name}")
    with module.input_lock:
        module.await_while_online(fl_funcall(lambda input_: True if input_ is None else None, module.input))
        module.await_while_online(synchronization_fluent(module, input_))
        module.caller.set(task or current_task())
        module.input.set(input_)
    return input_


def _require(condition, control, *arguments):
    if not condition:
        error(control, *arguments)


@finish_process_module.method(AsynchronousProcessModule)
def _finish(module, *, designator=None):
    _require(module.status_fluent.stored is RUNNING, "Cannot finish an already stopped process module.")
    if designator is None:
        module.unfinished.clear()
        if not module.pending:
            module.status_fluent.set(WAITING)
    else:
        _require(designator in module.unfinished, "Cannot finish a designator that is not being processed: ~a", designator)
        module.unfinished.remove(designator)
    if on_process_module_finished.methods:
        on_process_module_finished(module, designator, None)
    module.changed()


@fail_process_module.method(AsynchronousProcessModule, None)
def _fail(module, condition, *, designator=None):
    if designator is not None:
        _require(designator in module.unfinished, "Cannot fail for designator that is not processed: ~a", designator)
    for failed in [designator] if designator is not None else list(module.unfinished):
        module.failures.insert(0, (condition, failed))
        module.unfinished.remove(failed)
    if on_process_module_failed.methods:
        on_process_module_failed(module, designator, condition)
    module.changed()


@monitor_process_module.method(AsynchronousProcessModule)
def _monitor(module, *, designators=None):
    wanted = designators if isinstance(designators, Cons) else [designators] if designators is not None else None
    while True:
        for failure in module.failures:
            condition, designator = failure
            if wanted is None or designator in wanted:
                module.failures.remove(failure)
                return error(condition)
        still_open = [*module.pending, *module.unfinished]
        if not still_open if wanted is None else any(designator not in still_open for designator in wanted):
            return None
        module.await_change()
        if module.status_fluent.stored is OFFLINE:
            return error(not_running(module.name))
