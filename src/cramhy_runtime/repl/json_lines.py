"""``cramhy eval``: forms and answers as JSON, one object a line.

In: ``{"form": "..."}``. Out: ``{"output": printed text, "values": [printed values], "error": null}``, or for a form that fails
``"error": {"type", "message", "restarts"}`` with ``"where"`` and ``"hint"`` when they are known. What the compiler warned of is a
list ``"warnings"`` of such objects, when there is something. A line that is no such object
gets an error answer, and the next line is read. The output has all that is printed, also by Python and by child processes (see
`answer_streams`). For the forms standard input is empty: its lines are requests. A form that ends the program is answered before.
"""

from __future__ import annotations

import sys
from contextlib import nullcontext

from cramhy_runtime import kernel
from cramhy_runtime.kernel import standard_input
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.compiler import compilation_unit
from cramhy_runtime.languages.commonlisp.tools import backtrace
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for, report_text
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.packages import COMMON_LISP, symbol_name, symbol_package
from cramhy_runtime.lisp_core.source_places import describe


from cramhy_runtime.session.session import Interruption, condition_of, signalled_here, value_text

from . import answer_streams


class Left(Exception):
    """A form has ended the program. ``answer``: what it has printed before. ``leaving``: the SystemExit."""

    def __init__(self, answer, leaving):
        self.answer, self.leaving = answer, leaving


def serve(session, lines=None, out=None, descriptors=None):
    """Answer every line of ``lines`` (default: standard input) on ``out``. descriptors: see `answer_streams`, or ``None``."""
    out = out or sys.stdout
    conditions.install_debugger(signalled_here)
    lines = iter(sys.stdin if lines is None else lines)
    while (line := _next(lines)) is not None:
        if not line.strip():
            continue
        _give(session, line, out, descriptors)


def _give(session, line, out, descriptors):
    """Answer ``line``: once, whatever interrupt comes meanwhile."""
    leaving = None
    try:
        found = answer(session, line, descriptors)
    except kernel.Terminated:
        raise
    except Left as left:
        found, leaving = left.answer, left.leaving
    except (KeyboardInterrupt, kernel.Abandoned):  # after the form, while its values are printed
        found = _failure("", "CRAMHY::INTERRUPTED", "The form was interrupted.")
    import json  # a process that is asked nothing does without it

    text = json.dumps(found) + "\n"
    with kernel.shield(), nullcontext() if descriptors is None else descriptors.answering():
        out.write(text)
        out.flush()
    if leaving is not None:
        raise leaving


def _next(lines):
    """The next request, ``None`` at the end. An interrupt between two requests has nothing to end."""
    wake = getattr(lines, "wake", None)
    taken = []  # an interrupt may be raised while a line is on its way to us

    def take():
        taken.append(next(lines, None))

    while True:
        try:
            with kernel.woken_by(wake) if wake else nullcontext():
                if kernel.active().hears_outside:  # a server listens: its clients are answered while we wait
                    kernel.run_blocking(take)
                else:
                    take()
        except kernel.Terminated:
            raise
        except (standard_input.BrokenOff, KeyboardInterrupt, kernel.Abandoned):
            kernel.interrupt_over()
        if taken:
            return taken[0]
        try:
            kernel.interrupt_over()
            kernel.yield_()  # what woke us is raised here
        except kernel.Terminated:
            raise
        except (KeyboardInterrupt, kernel.Abandoned):
            kernel.interrupt_over()


def answer(session, line, descriptors=None):
    """The answer to one line, a dict."""
    import json

    try:
        request = json.loads(line)
        text = request["form"]
        if not isinstance(text, str):
            raise TypeError
    except (ValueError, KeyError, TypeError, RecursionError):
        return _failure("", "CRAMHY::BAD-REQUEST", 'Not understood: a line must be a JSON object {"form": "..."}.')
    return evaluate(session, text, descriptors)


def evaluate(session, text, descriptors=None):
    """Evaluate the forms of ``text``; output of all tasks is collected. Raises `Left` if a form ends the program."""
    warnings = []
    reporter = compilation_unit.report_to(warnings.extend)
    try:
        found = _evaluate(session, text, answer_streams.Printed(descriptors))
    finally:
        compilation_unit.report_to(reporter)
    if warnings:
        found["warnings"] = [_warning(warning) for warning in warnings]
    return found


def _evaluate(session, text, output):
    try:
        with output.collecting():
            completed, printed = session.with_abort(lambda: [value_text(value) for value in session.evaluate_text(text)])
            if not completed:
                return _failure(output.take(), "CRAMHY::ABORTED", "aborted")
    except Interruption:
        return _failure(output.take(), "CRAMHY::INTERRUPTED", "The form was interrupted.")
    except kernel.Terminated:
        raise
    except SystemExit as leaving:
        raise Left({"output": output.take(), "values": [], "error": None}, leaving) from None
    except Exception as exception:
        return _condition(output.take(), condition_of(exception))
    except conditions.Condition as condition:
        return _condition(output.take(), condition)
    return {"output": output.take(), "values": printed, "error": None}


def _type(condition):
    name = class_name(type(condition))
    package = symbol_package(name)
    return ("" if package is COMMON_LISP or package is None else f"{package.name}::") + symbol_name(name)


def _condition(output, condition):
    restarts = [symbol_name(restart.name) for restart in condition.restarts or ()]
    return _failure(
        output,
        _type(condition),
        report_text(condition),
        restarts or ["ABORT"],
        describe(condition.position) if getattr(condition, "position", None) else None,
        hint_for(condition),
        backtrace.lines(condition),
    )


def _warning(condition):
    shown = {
        "type": _type(condition),
        "message": report_text(condition),
        "where": describe(condition.position),
        "hint": hint_for(condition),
    }
    return {key: value for key, value in shown.items() if value}


def _failure(output, kind, message, restarts=("ABORT",), where=None, hint=None, calls=()):
    # what a form printed before it failed is not its answer; it is kept with the error, so that nothing is lost
    error = {"type": kind, "message": message, "restarts": list(restarts)}
    if output:
        error["output"] = output
    if calls:
        error["backtrace"] = "\n".join(calls).lstrip("\n")
    if where:
        error["where"] = where
    if hint:
        error["hint"] = hint
    return {"output": "", "values": [], "error": error}
