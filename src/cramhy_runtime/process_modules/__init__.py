"""Process modules and the executive: how a plan moves a robot. From Python:

    from cramhy_runtime import cpl
    from cramhy_runtime.designators import Motion, motion_grounding, reference
    from cramhy_runtime.process_modules import perform, process_module, process_modules

    class Driving(Motion):
        speed: float

    @motion_grounding(Driving)
    def drive_command(motion):
        return ["drive", motion.speed]

    @process_module(Driving)
    def navigation(motion):
        command, speed = reference(motion)
        cpl.sleep(10 / speed)
        return "there"

    def main():
        with process_modules(navigation):
            return perform(Driving(speed=2.0))

    cpl.run(main)       # "there", after five seconds

The page docs/reasoning-in-python.md teaches it.

Where the parts are: ``modules`` the module, its queue and main loop · ``executing`` a plan's requests · ``asynchronous`` modules that
return at once · ``registry`` names · ``running`` starting them around a body · ``matching`` finding the module for a designator,
``hints`` why there is none · ``executive`` perform · ``symbols`` the Lisp packages · ``python_modules`` functions for Python ·
``signatures`` types for type checkers. Reference: process-modules.md.
"""

from .asynchronous import AsynchronousProcessModule, fail_process_module, finish_process_module
from .executing import monitor_process_module, pm_cancel, pm_execute, pm_status
from .executive import (
    DesignatorGoalParsingFailure as GoalParsingFailure,
    DesignatorReferenceFailure as ReferenceFailure,
    generic_perform,
    try_reference_designator,
)
from .matching import matching_available_process_modules, matching_process_module_names, pm_execute_matching
from .modules import ProcessModule, define_process_module, make_module, pm_run
from .python_modules import (
    AsynchronousModule,
    Module,
    cancel,
    execute,
    monitor,
    perform,
    process_module,
    process_modules,
    running_module,
    status,
)
from .registry import (
    ProcessModuleNotRunning,
    ProcessModuleRunning,
    UnknownProcessModule,
    get_running_process_module,
    process_module_alias,
    wait_for_process_module_running,
    with_process_module_aliases,
    with_process_module_registered_running,
)
from .running import with_process_modules_running

__all__ = [
    "AsynchronousModule", "AsynchronousProcessModule", "cancel", "define_process_module", "execute", "fail_process_module",
    "finish_process_module", "generic_perform", "get_running_process_module", "GoalParsingFailure", "make_module",
    "matching_available_process_modules", "matching_process_module_names", "Module", "monitor", "monitor_process_module", "perform",
    "pm_cancel", "pm_execute", "pm_execute_matching", "pm_run", "pm_status", "process_module", "process_module_alias", "process_modules",
    "ProcessModule", "ProcessModuleNotRunning", "ProcessModuleRunning", "ReferenceFailure", "running_module", "status",
    "try_reference_designator", "UnknownProcessModule", "wait_for_process_module_running", "with_process_module_aliases",
    "with_process_module_registered_running", "with_process_modules_running",
]  # fmt: skip
