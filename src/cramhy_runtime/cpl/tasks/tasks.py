"""Tasks: the branches of a plan, and what can be done to them.

A task is one thread of control of a plan with a place in the tree: it has one parent, a status that can be observed, and a
result. Under each lies a task of the kernel. Every branch of ``par``, every tag and every call of a plan function is one.

Laws kept here: a task is dead only when its children are dead (law 1), and its cleanup forms run after that (law 2), because every
form that starts tasks waits for their death before it returns or lets an exception pass. A failure of a task becomes its result
and reaches the task that waits for it (law 3). Source: cpl.md section 3. Repaired: a task waits for its children also when it fails or
evaporates, where the original only tells them to end. A child cannot overrun a cleanup form of its parent.

Parking and obeying are in ``pausing.py``, requests to suspend in ``suspension.py``, the end of cleanup in ``ending.py``, parallel forms
in ``branches.py``, and questions about a task in ``task_readers.py``.
"""

from __future__ import annotations

import itertools
import time
from collections import deque
from functools import partial
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, Generic, Self, TypeVar, subscripted

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import NO_VALUES, Cons, Keyword, Symbol, truth
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.source_places import locate
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.utilities.queues import Queue, enqueue
from cramhy_runtime.utilities.threads import thread_of
from cramhy_runtime.kernel.looking_on import only_looked_at
from cramhy_runtime.kernel.unstarted import UNSTARTED, ran
from ..current import current_task
from cramhy_runtime.kernel.reports import DO_NOT_SWALLOW
from .block_order import close_rest
from .ending import LIMIT, end_tasks, end_waits, limit_cleanup
from ..failures.failure_types import PlanFailure, envelope, opened
from ..failures.handling import signal_failure
from ..fluents.operators import fl_and
from ..fluents.fluents import function_of, make_fluent
from ..logging import EVENT, active_tags, log, log_sending
from .pausing import AT_REST, AWAKE, obey, pause, release, request
from ..statuses import CREATED, DEAD, EVAPORATED, FAILED, NEXT, RUNNING, SUCCEEDED
from ..symbols import sym
from ..task_variables import declared, inherit, inherited_bindings
from .waiting import wait_for

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable

    from cramhy_runtime.utilities.threads import Thread
    from ..fluents.fluents import Fluent, ValueFluent
    from ..signatures import Request, Thunk
    from ..tree.task_tree import Code, TaskTreeNode
    from .ending import CleanupLimit

T = TypeVar("T", covariant=True, default=Any)
DEEPEST = 1000
"""The greatest number of levels of tasks below a top-level. A plan that nests deeper probably starts itself without end."""

_count = itertools.count(1)
SAVE_TASKS = inherit(sym("CPL-IMPL::*SAVE-TASKS*"), None)
SAVED_TASKS = inherit(sym("CPL-IMPL::*TASKS*"), Queue(None, ()))
RECORD = special(sym("CPL-IMPL::*RECORD-TASK-TREE*"), None)
recorded = per_image(deque(maxlen=10))
"""The newest plans that began while ``*record-task-tree*`` was true."""


class AbstractTask(Generic[T]):
    """The base of `Task` and `ToplevelTask`. `execute` starts it; then it calls ``body`` without arguments.

    ``path`` is its place in the task tree. ``constraints`` are fluents that must all be true before the body starts.
    ``ended``, if set, is called with the task when it is dead. In Lisp, ``(make-instance 'task :thread-fun f)`` also starts it,
    unless ``:run-thread nil`` is given (cpl.md 3.1).
    """

    __slots__ = (
        "_name", "body", "parent", "children", "status", "_status_fluent", "result", "path", "tree", "node", "code", "kernel_task",
        "constraints", "ended", "started_at", "ended_at", "observers", "held", "unschedulable", "suspension_handlers", "retry_level",
        "depth", "__weakref__", "__dict__",
    )  # fmt: skip
    __class_getitem__ = subscripted
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::ABSTRACT-TASK"
    lisp_slots = {
        "NAME": "name", "THREAD": "thread", "PARENT-TASK": "parent", "STATUS": "status_fluent", "THREAD-FUN": "body", "PATH": "path",
        "CODE": "code",
    }  # fmt: skip
    threads: tuple[kernel.Task[object], ...] | list[kernel.Task[object]] = ()
    """The kernel's tasks that its body started with ``cut:spawn-thread``."""
    predecessors: tuple[AbstractTask[object], ...] | list[AbstractTask[object]] = ()
    """The tasks that it waits for before it starts its body (``forms/orderings.py``)."""
    record: list[AbstractTask[object]] | None = None
    """The list of all tasks of its plan, dead ones too, if they are recorded (``tree/tree_report.py``)."""
    awaited = None
    """While it waits for the death of tasks: these tasks, or a function that returns them (``ending.py``)."""
    claimed = False  # somebody asked what became of it
    unclaimed: tuple[AbstractTask[object], ...] = ()
    """Tasks below it that failed while no form waited for them."""
    asked_to_end = False  # by a program, not only by the form that it belongs to
    cleanup_limit: CleanupLimit | None = None

    def __init__(
        self,
        body: Thunk[T] | None = None,
        name: str | Callable[[], str] | None = None,
        path: Cons | None = None,
        *,
        thread_fun: Thunk[T] | Symbol | None = None,
        run_thread: bool | None = True,
    ) -> None:
        self._name = name
        self.body = body
        self.parent: AbstractTask[object] | None = None
        self.children: dict[AbstractTask[object], bool] = {}
        self.status = CREATED
        self._status_fluent: ValueFluent[Keyword] | None = None
        self.result: T = NO_VALUES  # type: ignore[assignment]  # until it is there, and for those that evaporated
        self.path = path
        self.tree: TaskTreeNode | None = None
        self.node: TaskTreeNode | None = None
        self.code: Code | None = None
        self.kernel_task: kernel.Task[object] | None = None
        self.constraints: list[Fluent[object]] | None = None
        self.ended: Callable[[Any], object] | None = None
        self.started_at: float | None = None  # s of the kernel's clock
        self.ended_at: float | None = None
        self.observers: list[Callable[[AbstractTask[Any]], object]] | None = None
        self.held = False  # a suspension is wanted
        self.unschedulable = 0
        self.suspension_handlers: list[Callable[[], object]] | None = None
        self.retry_level = 0
        self.depth = 0
        if thread_fun is not None:
            self.body = function_of(thread_fun)
            if truth(run_thread):
                execute(self)

    # ---------------------------------------------------------------------------------------------------- names and status

    @property
    def name(self) -> str:
        """Its name, a string. A name given as a function is made when it is first asked for, unless the caller only looks on."""
        name = self._name
        if name.__class__ is not str and only_looked_at():
            return self.plain_name
        if name is None:
            name = self._name = f"UNKNOWN-{next(_count)}"
        elif callable(name):
            name = self._name = f"{name()}-{next(_count)}"
        return name

    @property
    def plain_name(self) -> str:
        """Its name, without the number if `name` has not been asked for yet. So a report does not change the numbers of names."""
        name = self._name
        return name() if callable(name) else name or "UNKNOWN"

    @property
    def thread(self) -> Thread | None:
        """What Lisp calls the thread in which it runs, or ran. None until it is executed."""
        if self.kernel_task is None:
            return None
        thread = thread_of(self.kernel_task)
        thread.name, thread.returns = str(self.name), True
        return thread  # type: ignore[no-any-return]  # the utilities are not annotated

    @property
    def alive(self) -> bool:
        """True until the task is dead."""
        return self.status not in DEAD

    @property
    def dead(self) -> bool:
        """True when the task has succeeded, failed or was evaporated."""
        return self.status in DEAD

    @property
    def comes_down(self) -> bool:
        """True once it unwinds because it was asked to end. It runs its cleanup, whatever its status is, and then it is dead."""
        return self.kernel_task is not None and self.kernel_task.cancelled_delivered

    @property
    def unexecuted(self) -> bool:
        """True until `execute` has been called."""
        return self.kernel_task is None and self.started_at is None

    @property
    def status_fluent(self) -> ValueFluent[Keyword]:
        """The fluent of its status, made when it is first asked for. Callbacks on it see each change in order."""
        fluent = self._status_fluent
        if fluent is None:
            fluent = self._status_fluent = make_fluent(name=Symbol(f"{self.name}-STATUS{next(_count)}"), value=self.status)
        return fluent

    def change_status(self, new: Keyword) -> None:
        """Go to the status ``new``. A change that cpl.md 3.2 does not allow is an error."""
        if new not in NEXT.get(self.status, ()):
            error("Invalid status transition from ~S to ~S.", self.status, new)
        if active_tags:
            log("CHANGE-STATUS", "~s -> ~s", self.status, new)
        self.status = new
        if self._status_fluent is not None:
            self._status_fluent.set(new)
        if self.observers:
            self.tell_observers()

    def tell_observers(self) -> None:
        """Call the functions in ``observers`` with the task. Tasks that wait in `park_until`, and followers of the plan, put them there."""
        for observe in self.observers or ():
            observe(self)

    # ------------------------------------------------------------------------------------------------------------- life

    def execute(self) -> Self:
        """Start the task as a child of the current task, and return it. It runs when the current task parks.

        A task that was evaporated before stays dead. Starting a task twice, or one without a body, is an error. Source: cpl.md 3.3.
        """
        if self.status is EVAPORATED and self.unexecuted:
            self.started_at = self.ended_at
            if self.ended is not None:
                self.ended(self)
            return self
        if self.body is None:
            error("Tried to execute task ~S which has no thread-fun.", self)
        if self.kernel_task is not None or self.status is not CREATED:
            error("Task ~S is already running a thread.", self)
        running = ACTIVE.value
        me = kernel.current() if running is None else running.current
        parent = self.parent = self._parent_in(me)
        if parent is not None:
            self.depth = parent.depth + 1
            if self.depth > DEEPEST:
                error(types.StorageCondition(f"Branches within branches, {DEEPEST} deep: a plan starts itself, perhaps without end."))
            parent.children[self] = True
            if active_tags:
                log("REGISTER-CHILD", "~s", self)
            if parent.record is not None:
                self.record = parent.record
                self.record.append(self)
            if self.tree is None:
                self.tree = parent.tree
            if self.path is None:
                self.path, self.node = parent.path, parent.node
        if self._name is None:
            self.name  # names are numbered in the order in which tasks start
        bindings = inherited_bindings(me, self, parent) if me.dynamic is not None or declared else None
        self.kernel_task = task = me.kernel.spawn(self._live, bindings, name=self._name_as_text)
        task.when_refused = self._refused
        if self.held:
            task.interject(lambda: obey(self))
        self.started_at = task.kernel.clock.now()
        if SAVE_TASKS.value is not None and truth(SAVE_TASKS.value):
            enqueue(self, SAVED_TASKS.value)
        return self

    def _parent_in(self, me: kernel.Task[object]) -> AbstractTask[object] | None:
        """The parent of this task, which the kernel's task ``me`` starts."""
        if me.owner is None:
            error("No current task active (*CURRENT-TASK* is NIL).")
        return me.owner  # type: ignore[no-any-return]  # the kernel does not know whose its tasks are

    def _name_as_text(self) -> str:
        return self.name

    def described(self) -> str:
        """A text for reports: what a task that waits for this one waits for."""
        return f"the plan {self.name}"

    def _live(self, bindings: Any) -> None:
        me: kernel.Task[object] = self.kernel_task  # type: ignore[assignment]  # it is there before its function is called
        me.owner = self
        if bindings is not None:
            me.dynamic = bindings
            bindings.enter()
        try:
            self.change_status(RUNNING)
            if self.constraints:
                self._await_constraints()
            result = self.body()
            if result.__class__ in UNSTARTED:
                ran(result, "a plan, or a branch of one")
            if self.held:
                obey(self)
            status = SUCCEEDED
        except BaseException as exception:
            status, result = self.outcome(exception)
        if me._local is not None and getattr(me._local, "blocks", None):
            status, result = self.close_blocks(status, result)
        if self.children:
            try:
                end_tasks(list(self.children), "Parent succeeded." if status is SUCCEEDED else "Parent aborted.")
            except BaseException as exception:  # the user gave up waiting for cleanup
                status, result = self.outcome(exception)
        if self.threads:
            self.end_threads(self.threads)
        if me.cancel_request is not None and not me.cancelled_delivered and status is SUCCEEDED:
            status, result = EVAPORATED, NO_VALUES  # asked to end at the last moment
        if self.unclaimed:
            self.tell_unclaimed(self.unclaimed)
        self._die(status, result)

    def close_blocks(self, status: Keyword, result: object) -> tuple[Keyword, object]:
        """Close the ``with`` blocks that the task, which ends, left open (``block_order.py``). Returns its status and result.

        They are those of a failure, unless there is another failure, or the whole task was asked to end.
        """
        me: kernel.Task[object] = self.kernel_task  # type: ignore[assignment]
        problem = close_rest(self, me.local.blocks)
        if problem is None or status is FAILED or status is EVAPORATED and me.cancel_request is not None:
            return status, result
        return FAILED, envelope(problem)

    def given_up(self, kernel_task: kernel.Task[object], place: str) -> None:
        """End the task as a failed one, because it swallows every request to end it or a block in it. The kernel calls it on its stack.

        place: where it does so, a text. Its branches end first (law 1). Its cleanup does not run: it is left where it is.
        """
        if kernel_task is not self.kernel_task or self.dead:
            return
        end_tasks(list(self.children), "Parent aborted.")
        self.end_threads(self.threads)
        close_rest(self, getattr(kernel_task.local, "blocks", []))
        self._die(
            FAILED,
            envelope(
                types.SimpleError(
                    "~a",
                    f"The task swallows every request to end it, at {place}. It was left where it is, and its other cleanup did not run. "
                    f"{DO_NOT_SWALLOW}",
                )
            ),
        )

    def tell_unclaimed(self, tasks: Iterable[AbstractTask[object]]) -> None:
        """Tell the user of failed ``tasks`` that the body made, if the body never asked for their results (law 3)."""
        for task in tasks:
            if not task.claimed and task._status_fluent is None:
                kernel.unhandled(task, opened(task.result))

    def end_threads(self, threads: Iterable[kernel.Task[object]]) -> None:
        """End ``threads``, which the body left running, and wait for that. The kernel reports their errors."""
        for thread in threads:
            thread.cancel(f"the end of {self.name}")
        with kernel.shield():
            for thread in threads:
                thread.join(lambda thread=thread: f"the cleanup of the thread {thread.name}", claim=False)

    def _refused(self, exception: BaseException) -> None:
        """The system gives no stack for the task, so it fails before its first step."""
        if self.status is CREATED:
            self.change_status(RUNNING)
            alive = len(kernel.active().tasks)
            self._die(
                FAILED,
                envelope(types.StorageCondition(f"The system refuses a thread for another task ({exception}); {alive} tasks are alive.")),
            )

    def _await_constraints(self) -> None:
        wait_for(fl_and(*self.constraints))
        if any(before.status is not SUCCEEDED for before in self.predecessors):
            kernel.settle()  # what ended it, a failure that nobody takes or the end of the plan, may end us before our body begins
            if self.held:
                obey(self)

    def outcome(self, exception: BaseException) -> tuple[Keyword, Any]:
        """The status and result of a task that ``exception`` ended."""
        while isinstance(exception, kernel.WaitEnded) and exception.__context__ is not None:
            exception = exception.__context__  # what was on its way out when the wait in its cleanup was ended
        if isinstance(exception, (kernel.Cancelled, kernel.Abandoned)):
            return EVAPORATED, NO_VALUES
        if isinstance(exception, PlanFailure):
            locate(exception, exception)
            return FAILED, exception
        if isinstance(exception, (KeyboardInterrupt, SystemExit, kernel.Interrupted)):
            return FAILED, exception  # meant for the program as a whole: every parent passes it on
        if isinstance(exception, (types.Condition, Exception)):
            condition = from_python(exception)
            locate(condition, exception)
            return FAILED, envelope(condition)
        lost = types.SimpleControlError(
            "A branch of a plan tried to leave a form around it, by RETURN-FROM, RETURN, GO or THROW. Every branch has a stack of its "
            "own, so only its values can leave it: let the branch return a value, or FAIL and handle the failure outside."
        )
        lost.__cause__ = exception
        locate(lost, exception)
        return FAILED, envelope(lost)

    def _die(self, status: Keyword, result: Any) -> None:
        self.result = result  # before the status, so that who sees a dead status can read it
        self.ended_at = ACTIVE.value.clock.now()
        self.body = self.constraints = self.suspension_handlers = None
        if self.parent is not None:
            self.parent.children.pop(self, None)
        if self._status_fluent is not None:
            with kernel.shield():
                self.change_status(status)
        else:
            self.change_status(status)
        if active_tags:
            log("FINISH", "~a is ~s.~@[ ~s~]", self.name, status, result if status is FAILED else None)
        if self.cleanup_limit is not None:
            self.cleanup_limit.end()
        ended, self.ended = self.ended, None
        if ended is not None:
            ended(self)
        elif isinstance(result, PlanFailure) and status is FAILED and self.parent is not None:
            self.parent.unclaimed = (*self.parent.unclaimed, self)

    def evaporate(self, reason: str | None = None) -> None:
        """Ask the task to end, without waiting for that. It unwinds from its next waiting point or checkpoint.

        A second such request ends the wait in which the cleanup of the task, or of a task below it, is stuck. Source: cpl.md 3.7.
        """
        self.ask_to_end(reason)
        if self.asked_to_end:
            end_waits(self)
        self.asked_to_end = True

    def ask_to_end(self, reason: str | None = None) -> None:
        """Ask the task to end, as a form asks its branches: like `evaporate`, but a repeated request does not disturb cleanup."""
        if self.status in DEAD:
            return
        if active_tags:
            log_sending("EVAPORATE", self, reason)
        kernel_task = self.kernel_task
        if kernel_task is None or self.status is CREATED:
            if kernel_task is not None:
                kernel_task.cancel(reason)
            self._die(EVAPORATED, NO_VALUES)  # it never ran, so nothing is to be cleaned up
            return
        kernel_task.cancel(partial(self._begin_to_end, reason))

    def _begin_to_end(self, reason: str | None) -> kernel.Cancelled:
        """The exception for a request to end that arrives in the task itself. Cleanup begins after it is raised."""
        me = self.kernel_task
        if me is not None and me.kernel.current is me:
            if active_tags:
                log("RECEIVE-EVENT", EVENT, "EVAPORATE", reason)
            if self.children:
                strays = [child for child in self.children if child.ended is None]  # no form waits for these and ends them
                if strays:
                    end_tasks(strays, reason)
            if LIMIT.value is not None:
                self.cleanup_limit = limit_cleanup(self)
        return kernel.Cancelled(reason)

    def suspend(self, reason: str | None = None, sync: bool | None = True) -> None:
        """Ask the task, and all tasks below it, to stand still. With ``sync`` wait until they do. Source: cpl.md 3.5."""
        if active_tags:
            log_sending("SUSPEND", self, reason)
        request(self)
        if self is current_task():
            if truth(sync):
                obey(self)
        elif truth(sync):
            self.park_until(AT_REST, lambda: f"the suspension of {self.name}", lambda: not self.held or self.unexecuted)

    def wake_up(self, reason: str | None = None, sync: bool | None = True) -> None:
        """Let the task, and all tasks below it, go on. With ``sync`` wait until they do. Source: cpl.md 3.5."""
        if active_tags:
            log_sending("WAKEUP", self, reason)
        release(self)
        if truth(sync) and self is not current_task():
            self.park_until(AWAKE, lambda: f"the wake-up of {self.name}", lambda: self.held or self.comes_down)

    def join(self) -> T:
        """Wait until the task is dead. Returns its values, signals its failure, or returns no values if it was evaporated.

        Joining the current task is an error. Source: cpl.md 3.8.
        """
        if self is current_task():
            error("Cannot join current task.")
        if active_tags:
            log("JOIN-TASK", "~s", self)
        self.park_until(DEAD, lambda: f"the end of {self.name}")
        self.claimed = True
        if self.status is FAILED:
            signal_failure(self.result)
        return self.result

    def park_until(self, statuses: Container[Keyword], why: Callable[[], str], given_up: Callable[[], bool] | None = None) -> None:
        """Wait until its status is among ``statuses``, or until ``given_up()`` is true. Call this in another task.

        ``why()`` is a text for reports: what the current task waits for.
        """
        me = kernel.current()

        def look_again(task):
            me.kernel.unpark(me)

        while self.status not in statuses and (given_up is None or not given_up()):
            if self.observers is None:
                self.observers = []
            self.observers.append(look_again)
            try:
                pause(why)
            finally:
                self.observers.remove(look_again)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} {self.status!r}>"


class Task(AbstractTask[T]):
    """A branch of a plan, below the task that executes it."""

    __slots__ = ()
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::TASK"


class ToplevelTask(AbstractTask[T]):
    """The root of a plan: the task that runs the body of ``top-level``. It has no parent."""

    __slots__ = ()
    lisp_name = "CRAM-LANGUAGE-IMPLEMENTATION::TOPLEVEL-TASK"

    def _parent_in(self, me: kernel.Task[object]) -> None:
        self.processor_time = time.process_time()
        if truth(RECORD.value):
            self.record = [] if self.record is None else self.record
            self.record.append(self)
            recorded.append(self)


# ------------------------------------------------------------------------------------------------------ the current task


def current_task_or_dummy() -> AbstractTask[object]:
    """``(current-task)``: as `current_task`. Outside of plans it is a new dummy, as in the original."""
    task = current_task()
    if task is None:
        task = ToplevelTask(name=str(kernel.current().name))
        task.change_status(RUNNING)
    return task


# ------------------------------------------------------------------------------------------------------------- requests


def execute(task: AbstractTask[object]) -> None:
    """``(execute task)``: start ``task`` as a child of the current task. A toplevel task, which has no parent, starts outside of plans."""
    if isinstance(task, ToplevelTask) and current_task() is not None:
        error(
            types.SimpleError("top-level calls cannot be nested."),
            hint="A TOPLEVEL-TASK has no parent, so it cannot be started inside of a plan: make a TASK.",
        )
    task.execute()


def check_reason(reason: object) -> None:
    """Signal a type error unless ``reason`` is a string or nil."""
    if reason is not None and not isinstance(reason, str):
        type_error(reason, "(OR NULL STRING)")


evaporate: Request = generic(
    "CPL-IMPL::EVAPORATE",
    "(task &key reason sync)",
    documentation="""
Ask ``task`` to end and, with ``sync`` (the default), wait until it is dead. Evaporation is not a condition: no handler catches it.

A second such request ends the wait in which the cleanup of the task, or of a task below it, is stuck.""",
)


@evaporate.method(AbstractTask)
def _evaporate(task, *, reason=None, sync=True):
    check_reason(reason)
    task.evaporate(reason)
    if task is current_task():
        if truth(sync):
            kernel.checkpoint()
    elif truth(sync):
        task.park_until(DEAD, lambda: f"the evaporation of {task.name}")


join_task = generic(
    "CPL-IMPL::JOIN-TASK",
    "(task)",
    documentation="""
Wait until ``task`` is dead. Returns its values, signals its failure, or returns no values if it was evaporated.""",
)


@join_task.method(AbstractTask)
def _join_task(task):
    return task.join()
