"""``with-process-modules-running``: modules that live as long as a body (process-modules.md section 5).

The modules run in a top-level of their own beside the body. Repaired: an error while they start reaches the caller at once, and
leaving the form waits until they have ended, so the same modules can be started again right away.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from ..cpl.ending import end_tasks
from ..cpl.failure_types import opened
from ..cpl.operators import par
from ..cpl.pausing import pause
from ..cpl.statuses import DEAD, FAILED
from ..cpl.tasks import ToplevelTask
from ..cpl.tree import TaskTreeNode
from ..lisp.conditions import error
from ..lisp.data import Cons
from .modules import pm_run
from .registry import ProcessModuleNotRunning, UnknownProcessModule, running


def with_process_modules_running(modules, body):
    """Values of ``body()`` while ``modules`` run: class names, or pairs (alias, class name). The caller may be outside of plans."""
    started = [_names(module) for module in modules]
    if not started:
        return body()
    me = kernel.current()
    background = ToplevelTask(lambda: par(*[_runner(name, cls) for name, cls in started]), lambda: "[PROCESS-MODULES]")
    background.tree = TaskTreeNode()
    background.ended = lambda task: me.kernel.unpark(me)
    registry = running()
    background.execute()
    try:
        _await_start(background, [name for name, _ in started], registry, me)
        result = body()
    except (ProcessModuleNotRunning, UnknownProcessModule) as missed:
        if background.status is FAILED:  # that is why it was not running
            raise opened(background.result) from missed
        raise
    finally:
        background.ended = None
        end_tasks([background], "Body ended.")
    if background.status is FAILED:
        return error(opened(background.result))
    return result


def _names(module):
    if isinstance(module, (Cons, tuple, list)):
        alias, cls = module
        return alias, cls
    return module, module


def _runner(name, cls):
    return lambda: pm_run(cls, name)


def _await_start(background, names, registry, me):
    registry.waiters.append(me)
    try:
        while background.status not in DEAD and not all(name in registry.modules for name in names):
            pause(lambda: "process modules to start")
        # A module that cannot start has said so by now, or will before anybody else runs.
        if background.status not in DEAD:
            kernel.yield_()
    finally:
        registry.waiters.remove(me)
    if background.status is FAILED:
        error(opened(background.result))
