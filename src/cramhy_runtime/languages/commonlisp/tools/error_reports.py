"""How a program tells of the error that ended it: its type, what happened, where, and what to try.

cramhy: UNBOUND-VARIABLE
  The variable *SPEDE* is unbound.
  at plan.lisp:7:10
    (drive *spede*)
           ^
  Did you mean *SPEED*?
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.packages import COMMON_LISP, printed, symbol_name, symbol_package
from cramhy_runtime.lisp_core.source_places import locate

from ..streams import streams
from . import backtrace
from .advice import explanation


def condition_of(exception):
    """The condition for any exception that left a form, with its place."""
    condition = from_python(exception)
    locate(condition, exception)
    return condition


def condition_type(condition):
    """The name of the class of ``condition`` as the debugger shows it."""
    name = class_name(type(condition))
    return symbol_name(name) if symbol_package(name) in (COMMON_LISP, None) else printed(name)


def report_lines(condition):
    """The lines that tell of ``condition``, with the calls that led to it when they are asked for."""
    return [f"cramhy: {condition_type(condition)}", explanation(condition), *backtrace.lines(condition)]


def report(condition, file=None):
    """Print an error that ends a program."""
    show(report_lines(condition), file)


def show(lines, file=None):
    """Print ``lines``, which tell of an error, on ``file`` (standard error), after what the program has printed."""
    streams.CONSOLE_OUTPUT.fresh_line()
    streams.CONSOLE_OUTPUT.flush()
    print("\n".join(lines), file=file or sys.stderr)


def end_line():
    """Let a terminal's prompt begin on a line of its own, after output such as PRINT's; a file or a pipe gets what the program wrote."""
    if sys.stdout is not None and sys.stdout.isatty():
        streams.CONSOLE_OUTPUT.fresh_line()
        streams.CONSOLE_OUTPUT.flush()


__all__ = ["condition_of", "condition_type", "end_line", "report", "report_lines", "show"]
