"""The plan task that runs now, if there is one. All modules of this room ask here; this module itself does not know what a task is."""

from __future__ import annotations

import sys

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

from cramhy_runtime import kernel
from cramhy_runtime.kernel.active import ACTIVE

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.source_places import calling_form


if TYPE_CHECKING:
    from .tasks.tasks import AbstractTask


_LEAD_TO_TEXTS = ("load", "import", "require", "ros-load:load-system", "asdf:load-system")
"""Operators of forms that are not calls of a plan function, though one may be called below them."""


def current_task() -> AbstractTask[object] | None:
    """The plan task that runs, or ``None`` outside of plans."""
    running = ACTIVE.value
    return (kernel.current() if running is None else running.current).owner  # type: ignore[no-any-return]  # the kernel knows no owners


def inside_plan(form: object) -> AbstractTask[object]:
    """The current task. Outside of a plan it signals the error that ``form``, a name, must stand inside a plan."""
    active = ACTIVE.value
    task = None if active is None else active.current.owner
    if task is None:
        outside = types.SimpleError("'~a' form not inside a plan.", form)
        called = calling_form(sys._getframe(1), _LEAD_TO_TEXTS)
        if called is None:
            outside.hint = f"Plan forms run inside of a plan: write (top-level ({str(form).lower()} ...))."
        else:
            outside.hint = f"Functions with plan forms are called inside of a plan: write (top-level {called})."
        outside.add_note("From Python, run the plan with cpl.run(main), or write it below `with cpl.plan():`.")
        if active is None:
            raise outside  # there are no handlers without a kernel
        return error(outside)
    return task
