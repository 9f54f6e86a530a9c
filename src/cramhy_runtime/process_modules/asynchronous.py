"""Asynchronous process modules: ``pm-execute`` hands the designator over and returns; somebody says later that it is finished.

Users define a class and methods: ``on-input`` is called for each designator, one after the other; ``on-run`` may do work beside it;
``on-cancel`` is called for unfinished designators when the module is cancelled; ``synchronization-fluent`` says when the next input
may be taken. `finish_process_module` and `fail_process_module` report the end. Source: process-modules.md section 6.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime import kernel

from ..cpl.fluent_operators import fl_pulsed
from ..cpl.operators import par
from ..cpl.current import current_task
from ..cpl.pausing import pause
from ..cpl.waiting import wait_for, whenever
from ..lisp.conditions import error
from ..lisp.data import Cons
from ..lisp.objects.generic import generic
from ..lisp.packages import keyword
from .modules import (
    OFFLINE,
    RUNNING,
    WAITING,
    AbstractProcessModule,
    await_online,
    monitor_process_module,
    on_process_module_failed,
    on_process_module_finished,
    on_process_module_started,
    pm_execute,
    pm_run,
    sym_of_class,
)
from .registry import running

on_input = generic("CPM::ON-INPUT", "(process-module input-designator)")
on_cancel = generic("CPM::ON-CANCEL", "(process-module input-designator)")
on_run = generic("CPM::ON-RUN", "(process-module)")
synchronization_fluent = generic("CPM::SYNCHRONIZATION-FLUENT", "(process-module designator)")
finish_process_module = generic("CPM::FINISH-PROCESS-MODULE", "(process-module &key designator)", documentation="""
Say that the module has finished one designator, or all of them.""")
fail_process_module = generic("CPM::FAIL-PROCESS-MODULE", "(process-module error &key designator)", documentation="""
Say that one designator, or all unfinished ones, failed with the condition ``error``.""")


class AsynchronousProcessModule(AbstractProcessModule):
    """A module that takes the next designator while others are still being processed."""

    lisp_name = "CRAM-PROCESS-MODULES::ASYNCHRONOUS-PROCESS-MODULE"
    initargs = {"NOTIFICATION-FLUENT": "notification_fluent"}

    def __init__(self, name=None):
        super().__init__(name)
        self.queue = deque()
        self.unfinished = []
        self.failures = []  # (condition, designator), the newest first
        self.notification_fluent = self._fluent("NOTIFICATION")
        self.executing = False  # somebody waits for the input to become free

    def run(self, name):
        if self.status_fluent.stored is not OFFLINE:
            error("Process module `~a' already running.", self.name)
        registry = running()
        registry.add(name, self)
        self.status_fluent.set(WAITING)
        self.cancel.set(None)
        try:
            par(lambda: on_run(self), self._take_inputs, self._process, lambda: whenever(self.cancel, self._cancel_all))
        finally:
            registry.remove(self)
            self.status_fluent.set(OFFLINE)

    def _take_inputs(self):
        def take():
            designator = self.input.stored
            self.queue.append(designator)
            self.status_fluent.set(RUNNING)
            self.input.set(None)
            self.notification_fluent.pulse()

        whenever(self.input, take)

    def _process(self):
        while True:
            while not self.queue:
                wait_for(fl_pulsed(self.notification_fluent, handle_missed_pulses=keyword("NEVER")))
            designator = self.queue.popleft()
            self.unfinished.append(designator)
            on_input(self, designator)
            if on_process_module_started:
                on_process_module_started(self, designator)

    def _cancel_all(self):
        for designator in list(self.unfinished):
            on_cancel(self, designator)
        self.cancel.set(None)

    def open_designators(self):
        """Everything that was handed over and is not finished."""
        pending = [self.input.stored] if self.input.stored is not None else []
        return pending + list(self.queue) + self.unfinished

    def changed(self):
        self.notification_fluent.pulse()


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
    await_online(module)
    while module.executing:
        pause(lambda: f"process module {module.name.name} to take another input")
    module.executing = True
    try:
        while module.input.stored is not None:
            wait_for(fl_pulsed(module.input, handle_missed_pulses=keyword("NEVER")))
        wait_for(synchronization_fluent(module, input_))
        module.caller.set(task or current_task())
        module.input.set(input_)
    finally:
        module.executing = False
        kernel.yield_()
    return input_


def _require(condition, control, *arguments):
    if not condition:
        error(control, *arguments)


@finish_process_module.method(AsynchronousProcessModule)
def _finish(module, *, designator=None):
    _require(module.status_fluent.stored is RUNNING, "Cannot finish an already stopped process module.")
    if designator is None:
        module.unfinished.clear()
        module.status_fluent.set(WAITING)
    else:
        _require(designator in module.unfinished, "Cannot finish a designator that is not being processed: ~a", designator)
        module.unfinished.remove(designator)
    if on_process_module_finished:
        on_process_module_finished(module, designator, None)
    module.changed()


@fail_process_module.method(AsynchronousProcessModule, None)
def _fail(module, condition, *, designator=None):
    if designator is not None:
        _require(designator in module.unfinished, "Cannot fail for designator that is not processed: ~a", designator)
    for failed in [designator] if designator is not None else list(module.unfinished):
        module.failures.insert(0, (condition, failed))
        module.unfinished.remove(failed)
    if on_process_module_failed:
        on_process_module_failed(module, designator, condition)
    module.changed()


@monitor_process_module.method(AsynchronousProcessModule)
def _monitor(module, *, designators=None):
    wanted = list(designators) if isinstance(designators, Cons) else [designators] if designators is not None else []
    while True:
        for condition, designator in module.failures:
            if not wanted or designator in wanted:
                module.failures = [entry for entry in module.failures if entry[0] is not condition]
                return error(condition)
        still_open = module.open_designators()
        if not still_open if not wanted else any(designator not in still_open for designator in wanted):
            return None
        wait_for(fl_pulsed(module.notification_fluent, handle_missed_pulses=keyword("NEVER")))
