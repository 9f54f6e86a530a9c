"""Threads of CRAM-UTILITIES: functions that run beside the rest without being branches of a form.

A thread is a task of the kernel like any other: it runs when others wait, in the kernel's time, and nothing of it is a thread of the
operating system. It is no task of a plan: ``*current-task*`` is nil in it, and it may use ``top-level``.

Who ends it? In the original nobody does. Here nothing outlives its parent (law 1). A thread that a task of a plan spawned is ended,
and its cleanup awaited, when that task ends, before the task is dead. Every other thread belongs to the session: it ends when its
function returns, by ``kill-thread``, or when the session ends. An error in a thread that nobody joins is reported (law 3).
Source: cpl.md 13.3.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import shown_with
from cramhy_runtime.lisp_core.conditions import Error, error, type_error
from cramhy_runtime.lisp_core.data import NO_VALUES, Symbol, all_values, list_from, truth
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import ensure_package, keyword
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import need, time_limit

ERROR, TIMEOUT = keyword("ERROR"), keyword("TIMEOUT")


class ThreadError(Error):
    """Something cannot be done with ``thread``; ``problem`` says why. The classes are SBCL's, on which CRAM-UTILITIES stands."""

    lisp_name = "SB-THREAD::THREAD-ERROR"
    initargs = {"THREAD": "thread"}
    thread = problem = None

    def report(self):
        return self.problem or super().report()


class JoinThreadError(ThreadError):
    """A thread was joined that did not end in time, or not by returning."""

    lisp_name = "SB-THREAD::JOIN-THREAD-ERROR"
    initargs = {"PROBLEM": "problem"}


class Thread:
    """What Lisp sees of a task of the kernel: ``values`` when its function has returned, ``failure`` when it left otherwise.

    ``returns`` says that it belongs to a task of a plan, which takes requests to end it itself. So such a thread returns also when its
    task was evaporated, but not when `kill_thread` ended it.
    """

    lisp_name = "SB-THREAD::THREAD"

    def __init__(self, task):
        self.task = task
        self.name = str(task.name)
        self.values = NO_VALUES
        self.failure = None
        self.killed = False
        self.returns = task.owner is not None
        task.local.thread = self

    @property
    def state(self):
        if not self.task.dead:
            return "RUNNING"
        asked_to_end = self.killed or self.task.cancelled_delivered and not self.returns
        return "ABORTED" if self.failure is not None or asked_to_end else "FINISHED"

    def run(self, function, arguments):
        """The life of a thread that was spawned here."""
        try:
            self.values = function(*arguments)
        except BaseException as exception:
            self.failure = exception
            raise


def _thread(thing):
    return need(thing, Thread, "SB-THREAD:THREAD")


def thread_of(task):
    """The `Thread` of a task of the kernel."""
    thread = getattr(task.local, "thread", None)
    return Thread(task) if thread is None else thread


def spawn_thread(name, fn, *arguments):
    """``cut:spawn-thread``: call ``fn`` with ``arguments`` in a new thread; the thread."""
    if name is not None and not isinstance(name, (str, Symbol)):
        type_error(name, "(OR STRING SYMBOL)")
    function = function_of(fn)
    me = kernel.current()
    owner = me.owner
    task = kernel.spawn(
        _begin,
        function,
        arguments,
        name=str(getattr(name, "name", name) or "anonymous"),
        parent=me if owner is not None else me.kernel.main,
    )
    if owner is not None:
        owner.threads = [*(thread for thread in owner.threads if not thread.dead), task]
    return Thread(task)


def _begin(function, arguments):
    thread_of(kernel.current()).run(function, arguments)


def spawn_threads(n, prefix, fn):
    """``cut:spawn-threads``: ``n`` threads named ``<prefix>-1`` and so on, each calling ``fn``; a list of them."""
    if not isinstance(n, int) or n < 0:
        type_error(n, "UNSIGNED-BYTE")
    return list_from([spawn_thread(f"{getattr(prefix, 'name', prefix)}-{number}", fn) for number in range(1, n + 1)])


def run_in_thread(fn, *arguments):
    """``cut:run-in-thread``: the values of ``fn``, called with ``arguments`` in a thread of its own."""
    return join_thread(spawn_thread(None, fn, *arguments))


def kill_thread(thread):
    """``cut:kill-thread``: make ``thread`` unwind from its next waiting point; T if it was alive."""
    task = _thread(thread).task
    if task.dead:
        return None
    if task is task.kernel.main:
        error("The main thread cannot be killed: it evaluates what is typed. To end the session call (quit).")
    thread.killed = True
    task.cancel("it was killed")
    if task is kernel.current():
        kernel.checkpoint()
    return True


def join_thread(thread, *, timeout=None, on_timeout=TIMEOUT, on_failure=ERROR):
    """``cut:join-thread``: wait for the end of ``thread``; its values.

    After ``timeout`` seconds: ``on_timeout``. If it was killed or ended by an error: ``on_failure``. Either may be ``:error``, which
    signals an error.
    """
    task, until = _thread(thread).task, time_limit(timeout)
    if task is kernel.current():
        fail(thread, f"In thread {shown_in_messages(thread)}, attempt to join the current thread.")
    task.join(lambda: f"the end of the thread {thread.name}", until)
    if not task.dead:
        if on_timeout is ERROR:
            fail(thread, f"Joining thread timed out: thread {shown_in_messages(thread)} did not exit in time.")
        return on_timeout
    if thread.state == "FINISHED":
        return thread.values
    if on_failure is ERROR:
        reason = "" if thread.failure is None or isinstance(thread.failure, kernel.Cancelled) else f"\nIts error: {thread.failure}"
        fail(thread, f"Joining thread failed: thread {shown_in_messages(thread)} did not return normally.{reason}")
    return on_failure


def shown_in_messages(thread):
    """``thread`` as SBCL shows it in its messages: without the package of its class."""
    return shown_with(thread, ensure_package("SB-THREAD"))


def fail(thread, problem):
    """The error that joining ``thread`` failed."""
    failure = JoinThreadError(thread=thread, problem=problem)
    failure.__cause__ = thread.failure
    error(failure)


def thread_alive_p(thread):
    return None if _thread(thread).task.dead else True


def thread_name(thread):
    return _thread(thread).name


def current_thread():
    """``cut:current-thread``: the thread that runs; each task of a plan is one, too."""
    return thread_of(kernel.current())


def all_threads():
    """``cut:all-threads``: all that live, tasks of plans and of the runtime included, the oldest first."""
    return list_from([thread_of(task) for task in kernel.active().tasks])


def thread_local_binding_p(symbol, thread=None):
    """``cut:thread-local-binding-p``: whether ``symbol`` is bound dynamically in ``thread`` (default: here)."""
    task = kernel.current() if thread is None else _thread(thread).task
    bindings = task.dynamic
    return True if bindings is not None and any(entry[0] is symbol for entry in bindings.stack) else None


def _print(thread, stream):
    name = "" if thread.name is None else f"{prin1_to_string(thread.name)} "
    text = f"{name}{thread.state}"
    if thread.state == "FINISHED":
        values = ", ".join(map(prin1_to_string, all_values(thread.values)))
        text += f" values: {values}" if truth(values) else ""
    print_unreadable(thread, stream, text, type_=True, identity=True)


define_printer(Thread, _print)
