"""Threads of SB-THREAD: the threads of `utilities.threads`, with SBCL's names and answers.

A thread sees the global values of special variables, and its own where it binds them. An interruption reaches it at its next waiting point
or at the next turn of a loop. Source: SBCL's manual, chapter 13; texts are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, all_values, boolean, list_from, truth
from cramhy_runtime.lisp_core.dynamic import global_value
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import is_symbol
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.kernel.typing_names import Any, NoReturn
from cramhy_runtime.utilities import threads
from cramhy_runtime.utilities.threads import Thread, ThreadError, fail, shown_in_messages, thread_of
from cramhy_runtime.utilities.wait_queue import need, time_limit

MISSING: Any = object()


class InterruptThreadError(ThreadError):
    """A thread that has ended was interrupted."""

    lisp_name = "SB-THREAD::INTERRUPT-THREAD-ERROR"


class SimpleThreadError(ThreadError):
    """A thread cannot do what it is asked to."""

    lisp_name = "SB-THREAD::SIMPLE-THREAD-ERROR"


class SymbolValueInThreadError(ThreadError):
    """A thread has no binding of a variable."""

    lisp_name = "SB-THREAD::SYMBOL-VALUE-IN-THREAD-ERROR"
    initargs = {"NAME": "name"}


class _Return(BaseException):
    """Unwinds a thread to its beginning, with the values of ``return-from-thread``."""

    def __init__(self, values: object) -> None:
        super().__init__()
        self.values = values


def _thread(thing: object) -> Thread:
    return need(thing, Thread, "SB-THREAD:THREAD")


def make_thread(function: Any, *, name: Any = None, arguments: Any = None, ephemeral: object = None) -> Thread:
    """``sb-thread:make-thread``: a new thread that calls ``function`` with ``arguments``, a list or a single one."""
    if name is not None and not isinstance(name, str):
        type_error(name, "(OR NULL STRING)")
    called = function_of(function)

    def life(*given: object) -> object:
        try:
            return called(*given)
        except _Return as leaving:
            return leaving.values

    given = tuple(arguments) if isinstance(arguments, Cons) else () if arguments is None else (arguments,)
    made = threads.spawn_thread(name, life, *given)
    made.name, made.ephemeral, made.returns = name, truth(ephemeral), True
    return made


def join_thread(thread: Any, *, default: object = MISSING, timeout: Any = None) -> object:
    """``sb-thread:join-thread``: wait for its end; its values.

    If it does not end by returning, or within ``timeout`` seconds: ``default`` and ``:abort`` or ``:timeout``, without a default a
    join-thread-error.
    """
    if default is MISSING:
        return threads.join_thread(_thread(thread), timeout=timeout, on_timeout=threads.ERROR)
    task = _thread(thread).task
    if task is kernel.current():
        fail(thread, f"In thread {shown_in_messages(thread)}, attempt to join the current thread.")
    task.join(lambda: f"the end of the thread {thread.name}", time_limit(timeout))
    if thread.state == "FINISHED":
        return thread.values
    return MultipleValues((default, threads.keyword("ABORT" if task.dead else "TIMEOUT")))


def _alive(thread: Any) -> Any:
    task = _thread(thread).task
    if task.dead:
        problem = f"Interrupt thread failed: thread {shown_in_messages(thread)} has exited."
        error(InterruptThreadError(thread=thread, problem=problem))
    return task


def interrupt_thread(thread: Any, function: Any) -> None:
    """``sb-thread:interrupt-thread``: call ``function`` in the thread, at its next waiting point or turn of a loop."""
    task, called = _alive(thread), function_of(function)
    if task is kernel.current():
        called()
    else:
        task.interject(called)


def terminate_thread(thread: Any) -> None:
    """``sb-thread:terminate-thread``: make the thread unwind, through its cleanup forms."""
    _alive(thread)
    threads.kill_thread(thread)


def abort_thread(*, allow_exit: object = None) -> object:
    """``sb-thread:abort-thread``: unwind the thread that calls it; who joins it gets no values."""
    return threads.kill_thread(current_thread())


def return_from_thread(values: Any) -> NoReturn:
    """The work of ``return-from-thread``: unwind this thread and end it with the values of ``values()``."""
    thread, returned = current_thread(), values()
    if thread is main_thread():
        shown = prin1_to_string(list_from(all_values(returned)))
        problem = f"Tried to return {shown} as values from main thread, but exit was not allowed."
        error(SimpleThreadError(thread=thread, problem=problem))
    if not getattr(thread, "returns", False):
        problem = f"{prin1_to_string(thread)} was not made by MAKE-THREAD: its function cannot be left by RETURN-FROM-THREAD."
        error(SimpleThreadError(thread=thread, problem=problem))
    raise _Return(returned)


def current_thread() -> Thread:
    """The value of ``sb-thread:*current-thread*``."""
    return thread_of(kernel.current())


def main_thread() -> Thread:
    """``sb-thread:main-thread``: the one that evaluates what is typed, and loads files."""
    return thread_of(kernel.current().kernel.main)


def main_thread_p(thread: Any = None) -> bool | None:
    """``sb-thread:main-thread-p``"""
    return boolean((current_thread() if thread is None else _thread(thread)) is main_thread())


def set_thread_name(name: object, thread: Any) -> object:
    """``(setf sb-thread:thread-name)``"""
    _thread(thread).name = name
    return name


def thread_ephemeral_p(thread: Any) -> bool | None:
    """``sb-thread:thread-ephemeral-p``: what `make_thread` was told."""
    return boolean(getattr(_thread(thread), "ephemeral", False))


def thread_os_tid(thread: Any) -> int | None:
    """``sb-thread:thread-os-tid``: a number of the thread; the system knows nothing of it. Nil when it has ended."""
    task = _thread(thread).task
    return None if task.dead else task.id


def thread_yield() -> int:
    """``sb-thread:thread-yield``: let the others run first."""
    kernel.yield_()
    return 0


# ----------------------------------------------------------------------------------------------- variables of other threads


def _no_value(symbol: Any, thread: Any, what: str, why: str) -> NoReturn:
    problem = f'Cannot {what} value of {prin1_to_string(symbol)} in {prin1_to_string(thread)}: "{why}"'
    error(SymbolValueInThreadError(thread=thread, name=symbol, problem=problem))


def _binding(symbol: Any, thread: Any, what: str) -> tuple[list[Any] | None, str]:
    """The innermost binding of SYMBOL in THREAD, or None and why there is none."""
    if not is_symbol(symbol):
        type_error(symbol, "SYMBOL")
    task = _thread(thread).task
    if task.dead:
        return None, "the thread has exited."
    entries = [] if task.dynamic is None else [entry for entry in task.dynamic.stack if entry[0] is symbol]
    return (entries[-1], "") if entries else (None, "the symbol has no thread-local value.")


def symbol_value_in_thread(symbol: Any, thread: Any, errorp: object = True) -> object:
    """``sb-thread:symbol-value-in-thread``: two values, that of the thread's own binding, and T; else an error, or nil and nil."""
    found, why = _binding(symbol, thread, "read")
    if found is None:
        return _no_value(symbol, thread, "read", why) if truth(errorp) else MultipleValues((None, None))
    # a thread that waits has put the outer values back, and keeps its own in the entries
    return MultipleValues((symbol.value if thread.task is kernel.current() else found[1], True))


def set_symbol_value_in_thread(value: object, symbol: Any, thread: Any, errorp: object = True) -> object:
    """``(setf sb-thread:symbol-value-in-thread)``"""
    found, why = _binding(symbol, thread, "set")
    if found is None:
        return _no_value(symbol, thread, "set", why) if truth(errorp) else MultipleValues((None, None))
    if thread.task is kernel.current():
        symbol.value = value
    else:
        found[1] = value
    return value


def symbol_global_value(symbol: Any) -> object:
    """``sb-ext:symbol-global-value``: the value outside of all bindings."""
    return global_value(symbol)


def set_symbol_global_value(value: object, symbol: Any) -> object:
    """``(setf sb-ext:symbol-global-value)``"""
    bindings = kernel.current().dynamic
    for entry in bindings.stack if bindings is not None else ():
        if entry[0] is symbol:
            entry[1] = value
            return value
    symbol.value = value
    return value
