"""Process modules and the executive: how a plan moves a robot. Usable from Python:

    from cramhy_runtime import process_modules as pm
    from cramhy_runtime.lisp.packages import intern

    NAVIGATION = intern("NAVIGATION", "CRAM-USER")
    pm.define_process_module(NAVIGATION, lambda designator: drive(reference(designator)))
    pm.with_process_modules_running([NAVIGATION], lambda: cpl.top_level(lambda: pm.pm_execute(NAVIGATION, motion)))

``modules`` the module, its queue and main loop · ``executing`` a plan's requests · ``asynchronous`` modules that return at once ·
``registry`` names · ``running`` starting them around a body · ``matching`` the right one for a designator, ``hints`` why there is
none · ``executive`` perform · ``package`` the Lisp faces.
Reference: process-modules.md.
"""

from .asynchronous import AsynchronousProcessModule, fail_process_module, finish_process_module
from .executing import monitor_process_module, pm_cancel, pm_execute, pm_status
from .executive import generic_perform, perform, try_reference_designator
from .matching import matching_available_process_modules, matching_process_module_names, pm_execute_matching
from .modules import ProcessModule, define_process_module, make_module, pm_run
from .registry import (
                       get_running_process_module,
                       process_module_alias,
                       wait_for_process_module_running,
                       with_process_module_aliases,
                       with_process_module_registered_running,
)
from .running import with_process_modules_running

__all__ = [
    "AsynchronousProcessModule", "define_process_module", "fail_process_module", "finish_process_module",
    "generic_perform", "get_running_process_module", "make_module", "matching_available_process_modules",
    "matching_process_module_names", "monitor_process_module", "perform", "pm_cancel", "pm_execute",
    "pm_execute_matching", "pm_run", "pm_status", "process_module_alias", "ProcessModule", "try_reference_designator",
    "wait_for_process_module_running", "with_process_module_aliases", "with_process_module_registered_running",
    "with_process_modules_running",
]  # fmt: skip
