"""The border to Python: which exception an ``except`` clause sees.

Within the plan language an error of a branch travels in an envelope, which is a plan failure, so that ``try-in-order`` and handlers
of ``plan-failure`` count it as one. Handlers run before anything unwinds, and they see it so. When all have declined and the stack
unwinds into Python code, that code expects the exception that was raised: ``except ValueError`` around ``cpl.par(...)`` catches the
``ValueError`` of a branch, with the traceback of the branch. The error keeps its envelope: when the exception goes on into the next
task, it travels in the same envelope again, so Lisp code above sees no difference.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from types import TracebackType
from cramhy_runtime.kernel.typing_names import NoReturn, ParamSpec, TypeVar

from cramhy_runtime import kernel
from cramhy_runtime.kernel.reports import of_the_library

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.conditions import note_asked
from .failure_types import python_exception

P = ParamSpec("P")
T = TypeVar("T")


def for_python(function: Callable[P, T]) -> Callable[P, T]:
    """``function``, changed to raise the exceptions that Python code expects (see `python_exception`)."""

    @wraps(function)
    def call(*arguments: P.args, **keywords: P.kwargs) -> T:
        try:
            return function(*arguments, **keywords)
        except Condition as condition:
            problem = condition
        raise_in_python(problem)

    return call


def raise_in_python(condition: BaseException) -> NoReturn:
    """Raise the exception that Python code sees for ``condition``. Do not call this in an ``except`` clause: that exception would become
    the context of this one."""
    problem = python_exception(condition) if isinstance(condition, Condition) else condition
    problem.__traceback__ = _users_part(problem.__traceback__)
    note_asked(problem)  # the condition was signalled, or there would be none to raise
    context = problem.__context__
    if isinstance(context, kernel.Cancelled):
        context = None  # what ended the block, which means nothing to the user
    try:
        raise problem
    finally:
        active = kernel.active()
        me = None if active is None else active.current
        if me is None or not (me.delivered or me.parts):  # else the kernel looks at the contexts for what ends the task
            problem.__context__ = context  # not what Python finds in the air when this is called in an __exit__ method
        del problem, condition


def _users_part(traceback: TracebackType | None) -> TracebackType | None:
    """``traceback`` without the frames of this library; as it is, if it has no others."""
    frames, entry = [], traceback
    while entry is not None:
        if not of_the_library(entry.tb_frame.f_code.co_filename):
            frames.append(entry)
        entry = entry.tb_next
    part = None
    for entry in reversed(frames):
        part = TracebackType(part, entry.tb_frame, entry.tb_lasti, entry.tb_lineno)
    return part or traceback
