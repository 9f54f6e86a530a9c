"""Calls of SLIME's trace dialog: a buffer that shows recorded calls as a tree. What is recorded says `tools.recorded_calls`."""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import is_symbol
from cramhy_runtime.languages.commonlisp.printer.print_names import symbol_with_prefix
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools import recorded_calls, tracing
from cramhy_runtime.lisp_core.data import list_from

from ..inspector import line_of
from ..rpcs import Refused, inner, number, rpc, text
from ..wire import Name
from .inspecting import inspect
from .packages import function_name

AT_ONCE = 150  # calls that are sent at once, as SLIME's own server sends them


class Reader:
    """What an Emacs has read of the recorded calls. key: a name that it chose; with another one it reads from the beginning."""

    def __init__(self, key):
        self.key, self.position, self.unfinished = key, 0, []

    def next(self):
        """The calls to send next: those that have ended since they were sent, and new ones."""
        found = [call for call in self.unfinished if call.ended][:AT_ONCE]
        self.unfinished = [call for call in self.unfinished if call not in found]
        calls = recorded_calls.calls()
        new = calls[self.position : self.position + AT_ONCE - len(found)]
        self.position += len(new)
        self.unfinished += [call for call in new if not call.ended]
        return found + new


def _told(call):
    """A recorded call as the dialog shows it: number, number of the outer call, name, arguments, values."""
    values = [call.outcome] if isinstance(call.outcome, str) else [line_of(value) for value in call.outcome]
    return [
        call.number,
        None if call.outer is None else call.outer.number,
        _spec(call.name),
        [[index, line_of(value)] for index, value in enumerate(call.arguments)],
        [[index, shown] for index, shown in enumerate(values)],
    ]


def _spec(name):
    """The name of a function so that Emacs can read it and send it back."""
    return Name(symbol_with_prefix(name) if is_symbol(name) else prin1_to_string(name))


@inner("from-string")
def from_string(call, source):
    """The text of a name, which Emacs wants read in the package of its buffer."""
    return text(source)


@rpc("dialog-toggle-trace dialog-untrace")
def toggle_trace(call, spec):
    name = function_name(call, spec)
    shown = prin1_to_string(name)
    if recorded_calls.is_recorded(name):
        tracing.untrace(list_from([name]))
        return f"{shown} is now untraced for trace dialog"
    if not recorded_calls.record(name):
        raise Refused(f"{shown} is no function that can be traced.")
    return f"{shown} is now traced for trace dialog"


@rpc("dialog-untrace-all")
def untrace_all(call):
    tracing.untrace(None)


@rpc("report-specs")
def report_specs(call):
    return sorted(map(_spec, recorded_calls.names()))


@rpc("report-total")
def report_total(call):
    return len(recorded_calls.calls())


@rpc("report-partial-tree")
def report_partial_tree(call, key):
    reader = call.connection.trace_reader
    if reader is None or reader.key != key:
        reader = call.connection.trace_reader = Reader(key)
    told = list(map(_told, reader.next()))
    return [told, len(recorded_calls.calls()) - reader.position, key]


@rpc("clear-trace-tree")
def clear_trace_tree(call):
    recorded_calls.forget()
    for connection in call.connection.server.connections:
        connection.trace_reader = None


@inner("find-trace")
def find_trace(call, index):
    """The recorded call of that number."""
    calls = recorded_calls.calls()
    if not 0 <= number(index, "The number of a call") < len(calls):
        raise Refused(f"The call number {index} is not kept any more.")
    return calls[index]


@inner("find-trace-part")
def find_trace_part(call, index, part, kind):
    """An argument or a value of a recorded call."""
    found = find_trace(call, index)
    values = found.arguments if kind == ":arg" else [] if isinstance(found.outcome, str) else found.outcome
    if not 0 <= number(part, "The number of a part") < len(values):
        raise Refused(f"The call number {index} has no such part.")
    return values[part]


@rpc("report-trace-detail")
def report_trace_detail(call, index):
    found = find_trace(call, index)
    return [*_told(found), None, f"{found.number}: {prin1_to_string(found.name)}"]


@rpc("inspect-trace-part")
def inspect_trace_part(call, index, part, kind):
    return inspect(call, find_trace_part(call, index, part, kind))
