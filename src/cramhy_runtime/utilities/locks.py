"""Locks, condition variables, and hash tables with a lock: for steps that wait in the middle and must not be mixed.

One task runs at a time, so a plan needs no lock around code that does not wait. It needs one where it waits half-way: a table
that is walked with a ``sleep`` in the loop, a robot that two branches ask. A lock is held by a task; the others stand in line.
Who leaves the form, by whatever way, evaporation included, gives the lock up; an evaporated task that was waiting for a condition
variable first gets its lock back, because its cleanup forms count on it. Source: cpl.md 13.3; texts are SBCL's.
"""

from __future__ import annotations

import weakref

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.hash_tables import HashTable, make_hash_table
from cramhy_runtime.lisp_core.conditions import SimpleError, error
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import Line, need, time_limit


class Lock:
    """``holder`` is the kernel's task that has it, ``depth`` how often; only a ``recursive`` one may be taken more than once."""

    lisp_name = "CRAM-UTILITIES::LOCK"

    def __init__(self, name=None, recursive=False):
        self.name, self.recursive = name, recursive
        self.holder, self.depth = None, 0
        self.line = Line(give_back=lambda place: self.pass_on())

    def take(self, depth=1):
        """Wait until nobody else has it, then have it."""
        me = kernel.current()
        if self.holder is me:
            if not self.recursive:
                error(
                    SimpleError("Recursive lock attempt ~S.", self),
                    hint="This task has the lock already. One that its holder may take again is made with MAKE-RECURSIVE-LOCK.",
                )
            self.depth += 1
        elif self.holder is None:
            self.holder, self.depth = me, depth
        else:
            self.line.stand(lambda: f"the lock {self.name or ''}, which {self.holder.name} has".replace(" ,", ","))
            self.depth = depth

    def release(self):
        """Undo one `take`. Who lost the lock in the wait for a condition variable, and could not get it back, has nothing to give up."""
        if not self.held_by_me():
            return
        self.depth -= 1
        if not self.depth:
            self.pass_on()

    def pass_on(self):
        """The next in line has it, or nobody."""
        if len(self.line):
            self.holder, self.depth = self.line.serve().task, 1
        else:
            self.holder, self.depth = None, 0

    def held_by_me(self):
        return self.holder is kernel.current()

    def __enter__(self):
        self.take()
        return self

    def __exit__(self, *_):
        self.release()
        return False


def _lock(thing):
    return need(thing, Lock, "CRAM-UTILITIES::LOCK")


def make_lock(*, name=None):
    """``cut:make-lock``: a lock that its holder cannot take again."""
    return Lock(name)


def make_recursive_lock(*, name=None):
    """``cut:make-recursive-lock``: a lock that its holder may take again."""
    return Lock(name, recursive=True)


def with_lock_held(lock, body):
    """Values of ``body()``, called with ``lock`` held: the work of the macro of that name."""
    with _lock(lock):
        return body()


def _print_lock(lock, stream):
    name = f"{prin1_to_string(lock.name)} " if lock.name is not None else ""
    state = "free" if lock.holder is None else f"taken owner={lock.holder.name}"
    print_unreadable(lock, stream, f"{'RECURSIVE-' if lock.recursive else ''}LOCK {name}{state}", identity=True)


define_printer(Lock, _print_lock)


# ------------------------------------------------------------------------------------------------------- condition variables


class ConditionVariable:
    """Something that tasks wait for until somebody says that it may have come about. It has a lock of its own, or the one given."""

    lisp_name = "CRAM-UTILITIES::CONDITION-VARIABLE"

    def __init__(self, lock):
        self.lock = lock
        self.line = Line(give_back=lambda place: self.signal())

    def wait(self, until=None):
        """Give the lock up if this task has it, wait for `signal`, and take it again; whether the signal came in time."""
        lock, depth = self.lock, 0
        if lock.held_by_me():
            depth = lock.depth
            lock.pass_on()
        try:
            return self.line.stand("the signal of a condition variable", until) is not None
        finally:
            if depth:
                with kernel.shield():
                    lock.take(depth)

    def signal(self):
        if len(self.line):
            self.line.serve()


def _variable(thing):
    return need(thing, ConditionVariable, "CRAM-UTILITIES::CONDITION-VARIABLE")


def make_condition_variable(*, lock=None):
    """``cut:make-condition-variable``: a condition variable; its lock is a new one if none is given."""
    return ConditionVariable(Lock() if lock is None else _lock(lock))


def condition_variable_wait(cv):
    """``cut:condition-variable-wait``: wait for a signal; the lock of ``cv`` is free meanwhile. T."""
    return _variable(cv).wait()


def condition_variable_wait_with_timeout(cv, seconds):
    """``cut:condition-variable-wait-with-timeout``: T when a signal came, nil after ``seconds``."""
    return True if _variable(cv).wait(time_limit(seconds)) else None


def condition_variable_signal(cv):
    """``cut:condition-variable-signal``: wake the task that waits longest, if there is one."""
    _variable(cv).signal()


def condition_variable_broadcast(cv):
    """``cut:condition-variable-broadcast``: wake all that wait."""
    _variable(cv).line.serve_all()


# ---------------------------------------------------------------------------------------------------- synchronized hash tables


_locks: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()


class SynchronizedHashTable(HashTable):
    """A hash table whose every operation waits while another task has it locked."""

    __slots__ = ("_entries",)

    @property
    def entries(self):
        lock = _locks.get(self)
        if lock is not None and lock.holder is not None and not lock.held_by_me():
            with lock:
                return self._entries
        return self._entries

    @entries.setter
    def entries(self, entries):
        self._entries = entries


def make_synchronized_hash_table(*arguments):
    """``cut:make-synchronized-hash-table``: arguments as those of ``make-hash-table``."""
    plain = _make_hash_table(*arguments)
    return SynchronizedHashTable(plain.test, plain.weakness, plain.size, plain.rehash_size, plain.rehash_threshold, True)


_make_hash_table = lispify(make_hash_table)


def with_hash_table_locked(table, body):
    """Values of ``body()``, during which no other task gets at ``table``: the work of the macro of that name."""
    need(table, SynchronizedHashTable, "(SATISFIES SB-EXT:HASH-TABLE-SYNCHRONIZED-P)")
    with lock_of_table(table):
        return body()


def lock_of_table(table):
    """The `Lock` of a hash table, which its holder may take again."""
    lock = _locks.get(table)
    if lock is None:
        lock = _locks[table] = Lock("of a hash table", recursive=True)
    return lock
