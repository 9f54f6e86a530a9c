"""One task resolves a designator, and those that need it meanwhile wait and get the same.

A designator is resolved by at most one task at a time: its ``resolver``. A method of a user on ``reference`` may do anything, and keeps
no note of its own, so the call of it is what the tasks share: a `Call`, for one designator and one role, as long as it runs. If it fails
or its task is evaporated, the next task that waits makes a call of its own. Calls that the method itself makes, in its task or in the
branches of a plan below, are not held up.

If tasks wait for each other in a ring, that would be for ever, and is an error. Source: designators.md section 7.
"""

from __future__ import annotations

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.printing import princ_to_string
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn
from cramhy_runtime.utilities.wait_queue import Line

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.kernel import Task
    from .classes import Designator

_lines: dict[Designator | Call, Line] = {}
"""A designator or `Call` → the line of the tasks that wait while another one resolves it."""
_wanted: dict[Task[object], Designator | Call] = {}
"""Task → the designator or `Call` for which it waits."""
_calls: dict[tuple[int, int], Call] = {}
"""The numbers of a designator and of a role → the `Call` that runs."""


class Call:
    """A call of a user's method for ``designator`` and ``role`` by the task ``resolver``; ``done`` when it has its ``values``."""

    __slots__ = ("designator", "role", "resolver", "done", "values")

    def __init__(self, designator: Designator, role: object, resolver: Task[object]):
        self.designator, self.role = designator, role
        self.resolver: Task[object] | None = resolver
        self.done = False
        self.values: Any = None


def share_call(designator: Designator, role: object, thunk: Callable[[], Any]) -> Any:
    """The values of ``thunk()``, or of another task's call for the same designator and role that runs now."""
    key, me = (id(designator), id(role)), kernel.current()
    while (call := _calls.get(key)) is not None:
        if _is_below(me, call.resolver):
            return thunk()
        await_resolver(call, me)
        if call.done:
            return call.values
    call = _calls[key] = Call(designator, role, me)
    try:
        call.values = thunk()
        call.done = True
        return call.values
    finally:
        del _calls[key]
        call.resolver = None
        serve(call)


def _is_below(task: Task[object] | None, other: Task[object] | None) -> bool:
    while task is not None and task is not other:
        task = task.parent
    return task is other


def await_resolver(wanted: Designator | Call, me: Task[object]) -> None:
    """Wait until no task resolves ``wanted``, a designator or a `Call`. If its resolver waits for ``me``, that is an error."""
    ring = [wanted]
    while True:
        resolver = ring[-1].resolver
        if resolver is me:
            _endless(ring)
        following = None if resolver is None else _wanted.get(resolver)
        if following is None:
            break
        ring.append(following)
    line = _lines.get(wanted)
    if line is None:
        line = _lines[wanted] = Line()
    _wanted[me] = wanted
    other = wanted.resolver
    try:
        line.stand(lambda: f"the designator that {getattr(other, 'name', 'another task')} resolves")
    finally:
        del _wanted[me]


def serve(wanted: Designator | Call) -> None:
    """Wake the tasks that wait for ``wanted``, a designator or a `Call`: nobody resolves it now."""
    line = _lines.pop(wanted, None) if _lines else None
    if line is not None:
        line.serve_all()


def _endless(ring: list[Designator | Call]) -> NoReturn:
    """Signal that resolving the first of ``ring`` waits for the task that needs it."""
    designators = [wanted.designator if isinstance(wanted, Call) else wanted for wanted in ring]
    if len(ring) > 1:
        others = ", ".join(" ".join(princ_to_string(other).split()) for other in designators[1:])
        hint = f"The task that resolves it waits for {others}, which this task resolves: each waits for the other, for ever."
    else:
        hint = (
            "A clause, generator or validator asks for the designator that it is to resolve: look at its properties with "
            "desig-prop instead."
        )
    error(SimpleError("Recursive lock attempt: designator ~a is needed to resolve itself.", designators[0]), hint=hint)
