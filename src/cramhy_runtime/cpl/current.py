"""The plan task that runs, if one does. Everything else in this room may ask; nothing here knows what a task is."""

from __future__ import annotations

from typing import Any

from cramhy_runtime import kernel

from ..lisp import condition_types as types
from ..lisp.conditions import error


def current_task() -> Any:
    """The plan task that runs, or ``None`` outside of plans."""
    return kernel.current().owner


def inside_plan(form):
    """The current task; the error of ``form`` (a name) outside of a plan if there is none."""
    active = kernel.active()
    task = None if active is None else active.current.owner
    if task is None:
        outside = types.SimpleError("'~a' form not inside a plan.", form)
        outside.hint = f"Plan forms run inside of a plan: write (top-level ({str(form).lower()} ...))."
        outside.add_note("From Python, run the plan with cpl.run(main), or write it below `with cpl.plan():`.")
        if active is None:
            raise outside  # there are no handlers without a kernel
        return error(outside)
    return task
