"""``with-process-modules-running``: modules that live as long as a body (process-modules.md section 5).

The modules run in a top-level of their own beside the body. Repaired: an error while they start reaches the caller at once. The form is
left only when they have ended, so the same modules can be started again at once. A module that fails later ends alone: the others go on,
errors of requests to it say why, and the form fails with its failure when the body is over (law 3).
"""

from __future__ import annotations

from contextlib import contextmanager

from cramhy_runtime import kernel

from cramhy_runtime.cpl.tree import finished_plans
from cramhy_runtime.cpl.tasks.branches import Branches, nobody_lives
from cramhy_runtime.cpl.tasks.ending import end_tasks
from cramhy_runtime.cpl.failures.failure_types import opened
from cramhy_runtime.cpl.tasks.pausing import pause
from ..cpl.statuses import DEAD, FAILED
from cramhy_runtime.cpl.tasks.tasks import Task, ToplevelTask
from cramhy_runtime.cpl.tree.task_tree import TaskTreeNode
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons
from .modules import pm_run
from .registry import ProcessModuleNotRunning, UnknownProcessModule, not_running, running
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from .signatures import RunningAs

T = TypeVar("T")


def with_process_modules_running(modules: Iterable[RunningAs], body: Callable[[], T]) -> T:
    """Run ``modules`` during ``body()``, and return its values. It works outside of plans too.

    modules: class names, or pairs (alias, class name). Errors: a module cannot start; after the body, the failure of a module. Source:
    process-modules.md section 5.
    """
    if not modules:
        return body()
    with modules_running(modules):
        return body()


@contextmanager
def modules_running(modules: Iterable[RunningAs]) -> Iterator[None]:
    """``with modules_running([...]):`` does the same for a block."""
    group = _Group([_names(module) for module in modules])
    group.start()
    try:
        group.await_start()
        yield
    except BaseException as problem:
        group.end()
        group.tell(problem)
        raise
    group.end()
    failure = group.failure()
    if failure is not None:
        error(failure)


def _names(module: Any) -> tuple[Any, Any]:
    if isinstance(module, (Cons, tuple, list)):
        alias, cls = module
        return alias, cls
    return module, module


class _Group:
    """The modules of one form, and their root task. ``names`` are pairs (name, class name)."""

    def __init__(self, names):
        self.names = [name for name, _ in names]
        self.registry = running()
        self.caller = kernel.current()
        self.tasks = [_task(name, cls) for name, cls in names]
        self.root = ToplevelTask(self._run, lambda: "[PROCESS-MODULES]")
        self.root.tree = TaskTreeNode()
        self.root.ended = lambda task: self._wake()

    def start(self):
        """Start the modules."""
        finished_plans.beside(self.root)
        self.root.execute()

    def _run(self):
        branches = _Modules(self.tasks, self._wake)
        try:
            branches.wait(nobody_lives)
        except BaseException as exception:
            branches.abort(exception)

    def _wake(self):
        self.caller.kernel.unpark(self.caller)

    def await_start(self):
        """Return when all modules run. If one fails before that, its failure is signalled here."""
        registry = self.registry
        registry.waiters.append(self.caller)
        try:
            while not self._over() and not all(name in registry.modules for name in self.names):
                pause(lambda: "process modules to start")
            if not self._over():  # one that cannot start has said so by now, or will before anybody else runs
                kernel.yield_()
        finally:
            registry.waiters.remove(self.caller)
        failure = self.failure()
        if failure is not None:
            error(failure)
        for name in self.names:
            if name not in registry.modules:  # somebody has evaporated it already
                error(not_running(name))

    def _over(self):
        return self.root.status in DEAD or any(task.status in DEAD for task in self.tasks)

    def end(self):
        """End the modules, and wait until they are dead."""
        self.root.ended = None
        end_tasks([self.root], "Body ended.")

    def failures(self):
        """The failures of modules, or of the root with all of them, for example if the system has no stack for one."""
        failures = [opened(task.result) for task in self.tasks if task.status is FAILED]
        if not failures and self.root.status is FAILED:
            failures.append(opened(self.root.result))
        return failures

    def failure(self):
        """The failure of the first module that failed, with those of the others beside it; ``None`` if none failed."""
        first, *others = self.failures() or (None,)
        if others:
            _add_beside(first, others)
        return first

    def tell(self, problem):
        """Note the failures of modules beside ``problem``, with which the body is left. If it only follows from one, raise that instead."""
        failures = [failure for failure in self.failures() if failure is not problem]
        if not failures:
            return
        failure = self.failure()  # the cause of one that Python raised is the exception, and stays it
        if isinstance(problem, (ProcessModuleNotRunning, UnknownProcessModule)):
            raise failure from failure.__cause__ or problem
        if isinstance(problem, kernel.Cancelled):
            raise failure from failure.__cause__
        if isinstance(problem, Condition):
            _add_beside(problem, failures)


def _add_beside(problem, failures):
    known = list(getattr(problem, "beside", ()))
    problem.beside = known + [
        ("A process module failed, too", failure) for failure in failures if all(other is not failure for _, other in known)
    ]


class _Modules(Branches):
    """The tasks of modules. ``told()`` is called each time that one ends."""

    __slots__ = ("told",)

    def __init__(self, tasks, told):
        self.told = told
        super().__init__("PROCESS-MODULES", tasks)

    def ended(self, task):
        super().ended(task)
        self.told()


def _task(name, cls):
    return Task(lambda: pm_run(cls, name), lambda: f"[{getattr(name, 'name', name)}]")
