"""Mutexes and wait queues of SB-THREAD.

A mutex is a lock of `utilities.locks` that may be asked for without waiting, or for a time, and that knows which thread has it. Two
threads that wait for each other's mutexes are a ``thread-deadlock``, which the second of them gets at once.
Source: SBCL's manual, chapter 13; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import error, type_error, warn
from cramhy_runtime.lisp_core.data import boolean, truth
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string, print_unreadable
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.locks import Lock
from cramhy_runtime.utilities.wait_queue import Line, need, time_limit

from .deadlines import put_off, signal_deadline
from .threads import ThreadError, thread_of

if TYPE_CHECKING:
    from cramhy_runtime.kernel import Task


class ThreadDeadlock(ThreadError):
    """Threads wait for each other's mutexes in a circle."""

    lisp_name = "SB-THREAD::THREAD-DEADLOCK"
    initargs = {"CYCLE": "cycle"}
    cycle: Any = ()

    def report(self) -> str:
        """SBCL's text: who waits for what, and who has it."""
        first = prin1_to_string(thread_of(self.cycle[0][0]))
        links = [
            f"  waited for:\n    {prin1_to_string(mutex)}\n  owned by:\n    {prin1_to_string(thread_of(mutex.holder))}\n"
            for _, mutex in self.cycle
        ]
        return f"Deadlock cycle detected:\n    {first}\n{''.join(links)}"


class Mutex(Lock):
    """A lock that no thread takes twice; ``holder`` is the task that has it."""

    lisp_name = "SB-THREAD::MUTEX"

    def grab(self, wait: bool = True, until: float | None = None) -> bool:
        """Take it; whether that was possible, without waiting if not WAIT, before the clock reaches UNTIL (s).

        While a deadline is signalled the thread does not stand in line, so that others get the mutex.
        """
        me = kernel.current()
        if self.holder is me:
            error("Recursive lock attempt ~S.", self)
        if self.holder is None:
            self.holder, self.depth = me, 1
            return True
        if not wait:
            return False
        while True:
            self._refuse_deadlock(me)
            me.local.waits_for = self
            try:
                with put_off(until) as (reached, first):
                    got = self.line.stand(self._why, first) is not None
            finally:
                me.local.waits_for = None
            if got or reached is None:
                return got
            reached.disarm()
            signal_deadline(reached)
            if self.holder is None:
                self.holder, self.depth = me, 1
                return True

    def _why(self) -> str:
        return f"the mutex {self.name or ''}, which {self.holder.name} has".replace(" ,", ",")

    def _refuse_deadlock(self, me: Task[object]) -> None:
        """An error if waiting for this mutex would close a circle."""
        cycle: list[tuple[Task[object], Mutex]] = [(me, self)]
        task = self.holder
        while task is not me:
            mutex = getattr(task.local, "waits_for", None)
            if mutex is None or mutex.holder is None or mutex.holder is task:  # it has been given what it waited for
                return
            cycle.append((task, mutex))
            task = mutex.holder
        error(ThreadDeadlock(thread=thread_of(me), cycle=cycle))


def _mutex(thing: object) -> Mutex:
    return need(thing, Mutex, "SB-THREAD:MUTEX")


def make_mutex(*, name: str | None = None) -> Mutex:
    """``sb-thread:make-mutex``"""
    return Mutex(name)


def mutex_name(mutex: Any) -> object:
    """``sb-thread:mutex-name``"""
    return _mutex(mutex).name


def set_mutex_name(name: object, mutex: Any) -> object:
    """``(setf sb-thread:mutex-name)``"""
    _mutex(mutex).name = name
    return name


def mutex_owner(mutex: Any) -> object:
    """``sb-thread:mutex-owner``: the thread that has it, or nil."""
    holder = _mutex(mutex).holder
    return None if holder is None else thread_of(holder)


def holding_mutex_p(mutex: Any) -> bool | None:
    """``sb-thread:holding-mutex-p``: whether the thread that asks has it."""
    return boolean(_mutex(mutex).held_by_me())


def grab_mutex(mutex: Any, *, waitp: object = True, timeout: Any = None) -> bool | None:
    """``sb-thread:grab-mutex``: take it; T, or nil if it cannot be had: at once if not ``waitp``, within ``timeout`` seconds."""
    return boolean(_mutex(mutex).grab(truth(waitp), time_limit(timeout)))


def get_mutex(mutex: Any, new_owner: object = None, waitp: object = True, timeout: Any = None) -> bool | None:
    """``sb-thread:get-mutex``, the old name of `grab_mutex`."""
    return grab_mutex(mutex, waitp=waitp, timeout=timeout)


def release_mutex(mutex: Any, *, if_not_owner: object = None) -> None:
    """``sb-thread:release-mutex``: give it up. For a thread that has it not, ``if_not_owner`` is ``:punt``, ``:warn`` or ``:force``."""
    if not _mutex(mutex).held_by_me():
        if if_not_owner is None or if_not_owner is sym(":PUNT"):
            return
        if if_not_owner is sym(":WARN"):
            owner = mutex.holder and str(mutex.holder.name)
            warn("Releasing ~S, owned by another thread: ~S", mutex, owner or 0)
    mutex.pass_on()


def call_with_mutex(body: Any, mutex: Any, *, wait_p: object = True, timeout: Any = None, value: object = None) -> object:
    """The work of ``with-mutex``: the values of ``body()``, called with the mutex taken; nil if it cannot be had."""
    if not _mutex(mutex).grab(truth(wait_p), time_limit(timeout)):
        return None
    try:
        return body()
    finally:
        release_mutex(mutex)


def call_with_recursive_lock(body: Any, mutex: Any, *, wait_p: object = True, timeout: Any = None) -> object:
    """The work of ``with-recursive-lock``: as `call_with_mutex`, but the thread may have the mutex already."""
    if _mutex(mutex).held_by_me():
        return body()
    return call_with_mutex(body, mutex, wait_p=wait_p, timeout=timeout)


def _print_mutex(mutex: Mutex, stream: Any) -> None:
    name = f"{prin1_to_string(mutex.name)} " if mutex.name is not None else ""
    state = "free owner=0" if mutex.holder is None else f"taken owner={thread_of(mutex.holder).name or 'anonymous'}"
    print_unreadable(mutex, stream, f"{name}{state}", type_=True, identity=mutex.name is None)


define_printer(Mutex, _print_mutex)


# ------------------------------------------------------------------------------------------------------------- wait queues


class WaitQueue:
    """Threads that wait until another thread says that something may have come about."""

    lisp_name = "SB-THREAD::WAITQUEUE"

    def __init__(self, name: str | None = None) -> None:
        self.name = name
        self.line = Line(give_back=lambda place: self.notify(1))

    def notify(self, n: int) -> None:
        """Wake the N that wait longest."""
        for _ in range(min(n, len(self.line))):
            self.line.serve()


def _queue(thing: object) -> WaitQueue:
    return need(thing, WaitQueue, "SB-THREAD:WAITQUEUE")


def make_waitqueue(*, name: str | None = None) -> WaitQueue:
    """``sb-thread:make-waitqueue``"""
    return WaitQueue(name)


def waitqueue_name(queue: Any) -> object:
    """``sb-thread:waitqueue-name``"""
    return _queue(queue).name


def set_waitqueue_name(name: object, queue: Any) -> object:
    """``(setf sb-thread:waitqueue-name)``"""
    _queue(queue).name = name
    return name


def condition_wait(queue: Any, mutex: Any, *, timeout: Any = None) -> bool | None:
    """``sb-thread:condition-wait``: give the mutex up, wait until woken, and take it again; T.

    After ``timeout`` seconds, the time to get the mutex included: nil, and the mutex is not held. A wait that is left otherwise takes the
    mutex again, because the cleanup forms of the body count on it. So does a wait that reaches a deadline, before it is signalled; when
    the deadline is deferred, the wait is over as if somebody had woken the thread. Source: SBCL's answers.
    """
    waiting, until = _queue(queue), time_limit(timeout)
    if not _mutex(mutex).held_by_me():
        error("The current thread is not holding ~S.", mutex)
    mutex.pass_on()
    try:
        with put_off(until) as (reached, first):
            woken = waiting.line.stand(lambda: f"the wait queue {waiting.name or ''}".rstrip(), first) is not None
    except BaseException:
        with kernel.shield():
            mutex.grab()
        raise
    if not woken and reached is not None:
        if mutex.grab(False):
            reached.disarm()
            signal_deadline(reached)
            return True
        woken = True  # the deadline is signalled while it waits for the mutex
    return boolean(woken and mutex.grab(True, until))


def condition_notify(queue: Any, n: Any = 1) -> None:
    """``sb-thread:condition-notify``: wake the ``n`` threads that wait longest."""
    if not isinstance(n, int) or n < 1:
        type_error(n, "(INTEGER 1)")
    _queue(queue).notify(n)


def condition_broadcast(queue: Any) -> None:
    """``sb-thread:condition-broadcast``: wake all that wait."""
    _queue(queue).line.serve_all()


def _print_queue(queue: WaitQueue, stream: Any) -> None:
    print_unreadable(queue, stream, queue.name or "", type_=True, identity=True)


define_printer(WaitQueue, _print_queue)
