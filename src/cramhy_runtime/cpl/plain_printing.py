"""How fluents and tasks look when no language is loaded: ``#<FLUENT NAME [VALUE]>``, ``#<TASK "NAME" {address}>``."""

from __future__ import annotations

from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string, princ_to_string, print_unreadable
from .fluents.fluents import Fluent, ValueFluent
from .tasks.tasks import AbstractTask, ToplevelTask


def print_fluent(fluent, stream):
    """Print the name, and for a value fluent the value in brackets."""
    value = f" [{prin1_to_string(fluent.stored)}]" if isinstance(fluent, ValueFluent) else ""
    stream.write(f"#<FLUENT {princ_to_string(fluent.name)}{value}>")


def print_task(task, stream):
    """Print the name, and an address, which distinguishes tasks of the same name."""
    kind = "TOPLEVEL-TASK" if isinstance(task, ToplevelTask) else "TASK"
    print_unreadable(task, stream, f"{kind} {prin1_to_string(task.name)}", identity=True)


define_printer(Fluent, print_fluent)
define_printer(AbstractTask, print_task)
