"""Starting plans from Python: ``run(main)`` and ``with plan():``.

Both make a plan: a task at the root, and when it ends all tasks below it are dead. ``run`` is ``top-level`` for a script: it starts a
kernel, runs the function as a plan, stops the kernel, and returns the function's result or raises its failure. In a ``with plan():``
block the plan is the block itself, which suits tests and notebooks.

With an option (``clock``, ``backend``, ``seed``, ``time_limit``: see `kernel.start`) the plan gets a kernel of its own, and a kernel that
is active already, such as a session's, is put aside meanwhile. Without options the plan uses the active kernel and leaves it running:
a plan in a session sees the session's fluents, process modules and turtle; a test sees what its fixtures started.
"""

from __future__ import annotations

from contextlib import contextmanager
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, TypeVarTuple

from cramhy_runtime import kernel
from cramhy_runtime.kernel.unstarted import callable_part

from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import NO_VALUES
from ..tree import finished_plans
from ..failures.failure_types import opened
from ..failures.python_exceptions import for_python, raise_in_python
from ..current import current_task
from ..tasks.ending import close_plan
from .operators import top_level
from ..statuses import FAILED, RUNNING, SUCCEEDED
from ..tasks.tasks import ToplevelTask
from ..tree.task_tree import TaskTreeNode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from cramhy_runtime.kernel.signatures import Backend, BackendName, Clock, ClockName, Seed
    from ..tasks.tasks import AbstractTask

T = TypeVar("T")
Arguments = TypeVarTuple("Arguments")


@for_python
def run(
    main: Callable[[*Arguments], T],
    *arguments: *Arguments,
    clock: ClockName | Clock | None = None,
    backend: BackendName | Backend | None = None,
    seed: Seed | None = None,
    time_limit: float | None = None,
) -> T:
    """Run ``main(*arguments)`` as a plan and return its result. Its failure is raised here, when all its tasks are dead.

    clock: "virtual" or "wall", or a clock. backend: as for `kernel.start`. seed: decides the order of tasks and random
    numbers. time_limit: seconds of the kernel's clock, after which the plan ends with `TimeLimit`. Inside a plan it is an error. An
    interrupt becomes ``KeyboardInterrupt``.
    """
    callable_part(main, "run", "the plan")
    with _kernel(clock, backend, seed, time_limit):
        return top_level(lambda: main(*arguments))


@contextmanager
def plan(
    *,
    clock: ClockName | Clock | None = None,
    backend: BackendName | Backend | None = None,
    seed: Seed | None = None,
    time_limit: float | None = None,
) -> Iterator[ToplevelTask[None]]:
    """``with cpl.plan(clock="wall") as root:`` makes the block a plan. Its tasks are dead when the block is left.

    ``root`` is the task at the root. The options, errors and failures are those of `run`.
    """
    with _kernel(clock, backend, seed, time_limit):
        task: ToplevelTask[None] = ToplevelTask(name=lambda: "[TOP-LEVEL]")
        me = kernel.current()
        task.tree = TaskTreeNode()
        task.kernel_task = me
        task.change_status(RUNNING)
        me.owner = task
        task.started_at = kernel.now()
        finished_plans.begins(task, None)
        status, result = SUCCEEDED, NO_VALUES
        problem: BaseException | None = None
        try:
            try:
                yield task
            except BaseException as exception:
                problem = exception
                status, result = task.outcome(exception)
            if getattr(me.local, "blocks", None):
                status, result = task.close_blocks(status, result)
                problem = problem if status is not FAILED or problem is not None else opened(result)
            _end(list(task.children))
        finally:
            task._die(status, result)
            me.owner = None
            me.spare()
            finished_plans.ended(task, None)
        if status is FAILED and problem is not None:
            raise_in_python(problem)


def _end(children: list[AbstractTask[object]]) -> None:
    for child in children:
        child.ask_to_end("The plan is over.")
    for child in children:
        close_plan(child, "The plan is over.")


@contextmanager
def _kernel(clock: object, backend: object, seed: object, time_limit: float | None) -> Iterator[None]:
    """The kernel for a plan. An interrupt that ends the plan becomes Python's KeyboardInterrupt outside of it."""
    active = kernel.active()
    if active is not None and current_task() is not None:
        error(
            "A plan was started inside of a plan. Call its function as it is: it then runs as a part of this plan, in the time of this "
            "one. A plan in another time (clock=) is run before this one or after it, or in a process of its own."
        )
    given = {"clock": clock, "backend": backend, "seed": seed, "time_limit": time_limit}
    options: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    try:
        if active is not None and not options:
            yield
        elif active is not None and active.current is not active.main:
            error("A kernel cannot be started by a task of another one. Leave out the options of the plan, so that it uses this kernel.")
        else:
            with kernel.aside():
                kernel.start(**options)
                yield
    except kernel.Terminated:
        raise
    except (kernel.Interrupted, kernel.Abandoned):
        if kernel.active() is not None:
            kernel.interrupt_over()
        interrupted = True
    else:
        interrupted = False
    if interrupted:
        raise KeyboardInterrupt
