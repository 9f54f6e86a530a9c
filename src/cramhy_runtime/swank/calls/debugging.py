"""Calls of the debugger's buffer."""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import all_values
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_PRETTY
from cramhy_runtime.languages.commonlisp.tools import tracing
from cramhy_runtime.languages.commonlisp.tools.advice import explanation

from .. import places
from ..packages import prompt_of
from ..rpcs import Refused, number, rpc, text
from ..wire import Name
from .evaluating import echo
from .inspecting import inspect


def _debugger(call):
    if call.debugger is None:
        raise Refused("This call belongs to a debugger, and there is none.")
    return call.debugger


def frame_at(call, index):
    """The frame of that number in the debugger whose buffer the call came from."""
    return _debugger(call).frame(index)


def variable_at(call, index, variable):
    """The value of a variable, by its number, in the frame of that number. `Refused` if there is none."""
    variables = frame_at(call, index).variables
    if not isinstance(variable, int) or not 0 <= variable < len(variables):
        raise Refused(f"This frame has no variable {variable}.")
    return variables[variable][1]


@rpc("backtrace")
def backtrace(call, start, end=None):
    return _debugger(call).backtrace(number(start), end if isinstance(end, int) else None)


@rpc("debugger-info-for-emacs")
def debugger_info(call, start, end=None):
    return list(_debugger(call).told(number(start), end if isinstance(end, int) else None))


@rpc("invoke-nth-restart-for-emacs")
def invoke_nth_restart(call, level, index):
    debugger = _debugger(call)
    if not isinstance(index, int) or not 0 <= index < len(debugger.restarts):
        raise Refused(f"There is no restart {index}; they go from 0 to {len(debugger.restarts) - 1}.")
    return invoke(call, debugger.restarts[index])


def invoke(call, restart):
    """Take a restart. What it asks the user for is asked in the package of the buffer."""
    with binding(evaluator.PACKAGE, call.package):
        conditions.invoke_restart_interactively(restart)


def _named(call, name):
    return [restart for restart in _debugger(call).restarts if restart.name is not None and symbol_name(restart.name) == name]


@rpc("sldb-abort")
def sldb_abort(call):
    found = _named(call, "ABORT")
    if not found:
        raise Refused("There is no restart ABORT here.")
    return invoke(call, found[0])


@rpc("sldb-continue")
def sldb_continue(call):
    found = _named(call, "CONTINUE")
    if not found:
        raise Refused("There is no restart CONTINUE here. Choose another one.")
    return invoke(call, found[0])


@rpc("throw-to-toplevel")
def throw_to_toplevel(call):
    found = _named(call, "ABORT")
    if not found:
        raise Refused("There is no restart ABORT here.")
    return invoke(call, found[-1])


@rpc("frame-locals-and-catch-tags")
def frame_locals(call, index):
    variables = frame_at(call, index).variables
    shown = [[Name(":name"), name, Name(":id"), 0, Name(":value"), _text(value)] for name, value in variables]
    return [shown, None]


def _text(value):
    return attempt_to_print(prin1_to_string, value)


@rpc("frame-source-location")
def frame_source_location(call, index):
    return places.location_of(frame_at(call, index).position)


@rpc("frame-package-name")
def frame_package_name(call, index):
    frame_at(call, index)
    return prompt_of(call.package)


@rpc("eval-string-in-frame", evaluates=True)
def eval_in_frame(call, source, index, package=None):
    with binding(evaluator.PACKAGE, call.package):
        return echo(list(all_values(frame_at(call, index).evaluate(text(source)))))


@rpc("pprint-eval-string-in-frame", evaluates=True)
def pprint_eval_in_frame(call, source, index, package=None):
    with binding(evaluator.PACKAGE, call.package):
        values = all_values(frame_at(call, index).evaluate(text(source)))
        with binding(PRINT_PRETTY, True):
            return "".join(prin1_to_string(value) + "\n" for value in values)


@rpc("inspect-in-frame", evaluates=True)
def inspect_in_frame(call, source, index):
    with binding(evaluator.PACKAGE, call.package):
        values = all_values(frame_at(call, index).evaluate(text(source)))
    return inspect(call, values[0] if values else None)


@rpc("inspect-frame-var")
def inspect_frame_var(call, index, variable):
    return inspect(call, variable_at(call, index, variable))


@rpc("inspect-current-condition")
def inspect_condition(call):
    return inspect(call, _debugger(call).condition)


@rpc("sdlb-print-condition")
def print_condition(call):
    return explanation(_debugger(call).condition)


@rpc("sldb-disassemble")
def sldb_disassemble(call, index):
    import dis
    import io

    shown = io.StringIO()
    dis.dis(frame_at(call, index).frame.f_code, file=shown)
    return shown.getvalue()


@rpc("disassemble-form", evaluates=True)
def disassemble_form(call, source):
    from .evaluating import eval_and_grab_output

    return eval_and_grab_output(call, f"(disassemble {text(source)})")[0]


@rpc("sldb-step sldb-next sldb-out", evaluates=True)
def step(call, index):
    raise Refused("Compiled code cannot be stopped between its forms. (step form) prints each call that a form makes, as (trace f) does.")


@rpc("sldb-return-from-frame", evaluates=True)
def return_from_frame(call, index, source):
    frame = frame_at(call, index)
    if frame.why_it_stays:
        return _what_to_do(frame.why_it_stays)
    with binding(evaluator.PACKAGE, call.package):
        value = frame.evaluate(text(source))
    return frame.leave(value)


@rpc("restart-frame", evaluates=True)
def restart_frame(call, index):
    frame = frame_at(call, index)
    return _what_to_do(frame.why_it_stays) if frame.why_it_stays else frame.restart()


def _what_to_do(why):
    """A text for the echo area. It is no refusal, because SLIME shows no reason of one here."""
    return f"{why} C-u C-c C-c in a definition compiles it for that; or take a restart."


@rpc("sldb-break-on-return sldb-break")
def break_at(call, what):
    if isinstance(what, int):
        raise Refused("cramhy cannot stop where a frame returns. (break) in the code stops there.")
    from cramhy_runtime.lisp_core.data import list_from

    from .packages import symbol_of

    symbol = symbol_of(call, what)
    from cramhy_runtime.lisp_core.packages import sym

    tracing.trace(list_from([symbol, sym(":BREAK"), True]))
    return f"Calls of {prin1_to_string(symbol)} open the debugger."


@rpc("sldb-break-with-default-debugger")
def with_default_debugger(call, *_):
    raise Refused("The session has no other debugger than this one.")


@rpc("simple-break", evaluates=True)
def simple_break(call):
    conditions.break_("Break from Emacs.")
