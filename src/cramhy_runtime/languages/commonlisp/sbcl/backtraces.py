"""SB-DEBUG: the calls that run, printed or as a list, for programs that log them. Only the calls of users' functions are shown.

Source: SBCL's manual, chapter 5.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import NO_VALUES, Symbol, lisp_list, list_from, truth
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.kernel.typing_names import Any
from cramhy_runtime.utilities.threads import current_thread

from ..streams.streams import output_stream
from ..tools.backtrace import running_calls

MOST = 1000


def _calls(count: Any) -> list[tuple[str, Any]]:
    return running_calls(sys._getframe(2))[: count if isinstance(count, int) else MOST]


def _print(calls: list[tuple[str, Any]], start: int, thread: bool, stream: Any) -> object:
    out = output_stream(sym("*DEBUG-IO*").value if stream is None else stream)
    out.fresh_line()
    if thread:
        out.write(f"Backtrace for: {prin1_to_string(current_thread())}\n")
    for number, (name, place) in enumerate(calls):
        if number >= start:
            out.write(f"{number}: ({name}) at {describe(place)}\n")
    return NO_VALUES


def _list(calls: list[tuple[str, Any]]) -> object:
    return list_from([lisp_list(Symbol(name, None)) for name, _ in calls])


def print_backtrace(*, stream: Any = None, start: int = 0, count: Any = None, print_thread: object = True, **others: object) -> object:
    """``sb-debug:print-backtrace``: print the calls that run, the innermost first, each with its place. No values."""
    return _print(_calls(count), start, truth(print_thread), stream)


def backtrace(count: Any = None, stream: Any = None) -> object:
    """``sb-debug:backtrace``, the old name of `print_backtrace`."""
    return _print(_calls(count), 0, False, stream)


def list_backtrace(*, count: Any = None, **others: object) -> object:
    """``sb-debug:list-backtrace``: the calls that run as lists with the function's name, the innermost first."""
    return _list(_calls(count))


def backtrace_as_list(count: Any = None) -> object:
    """``sb-debug:backtrace-as-list``, the old name of `list_backtrace`."""
    return _list(_calls(count))
