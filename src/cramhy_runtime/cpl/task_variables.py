"""Task variables: specials that a new task inherits from the task that starts it.

An ordinary special has its global value in every new task, even in the body of ``top-level`` (cpl.md 3.13). A task variable starts
with the parent's current value, or with the value that its init function makes of it. Assignments stay in the task.

The language's own task variables are bound in a new task only if its parent has them bound, so that a task without any costs nothing.
For this reason all tasks see an assignment to one of these outside of ``let``. ``*current-task*``, ``*current-path*`` and
``*task-tree*`` are not bound at all: `TaskStateSymbol` computes them from the task that runs.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.data import UNBOUND, Symbol
from cramhy_runtime.lisp_core.dynamic import Bindings, special
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import find_package, redefined

if TYPE_CHECKING:
    from collections.abc import Callable

    from .tasks.tasks import AbstractTask

_inherited: set[Symbol] = set()  # the language's own: inherited when bound
_within_plans: set[Symbol] = set()  # those of them that a new top-level does not inherit
declared: dict[Symbol, Callable[..., Any] | None] = per_image({})  # the user's: init function or None; bound in every task


class TaskStateSymbol(Symbol):
    """A variable whose value ``getter`` computes, for example from the current task. ``setter``, if there is one, gets assigned values."""

    __slots__ = ("getter", "setter")

    def __init__(self, name, package, getter, setter):
        self.getter, self.setter = getter, setter
        super().__init__(name, package)
        self.special = True

    @property
    def value(self):
        return self.getter()

    @value.setter
    def value(self, new):
        if self.setter is not None and new is not UNBOUND:
            self.setter(new)


def define_task_state(package, name, getter, setter=None):
    """Make ``name`` in ``package`` a variable that reads the state of tasks. Call this before the name is interned."""
    package = find_package(package)
    symbol = package.internal[name] = TaskStateSymbol(name, package, getter, setter)
    return symbol


def inherit(symbol: Any, initial: object, within_plans: bool = False) -> Any:
    """Declare one of the language's own task variables, with its global value. With ``within_plans``, no top-level inherits its value."""
    _inherited.add(special(symbol, initial))
    if within_plans:
        _within_plans.add(symbol)
    return symbol


def define_task_variable(
    symbol: str | Symbol,
    global_value: object = None,
    *,
    init_function: Callable[[AbstractTask[object], AbstractTask[object] | None, Any], object] | None = None,
) -> Symbol:
    """``(define-task-variable name value)``: give every task its own binding of ``symbol``, with its parent's value. Returns the symbol.

    symbol: a Lisp symbol, or a name, which becomes a new symbol. ``symbol.value`` is the value in the task that asks.
    ``init_function(task, parent, value)`` computes the initial value, in the parent; ``parent`` is nil for a top-level.
    Source: cpl.md 3.13.
    """
    if isinstance(symbol, str):
        symbol = Symbol(symbol.upper(), None)
    redefined(symbol)
    symbol.special = True
    if symbol.value is UNBOUND:
        symbol.value = global_value
    declared[symbol] = None if init_function is None else function_of(init_function)
    return symbol


def inherited_bindings(here, task, parent):
    """The bindings that the new ``task`` starts with, or ``None``. ``here`` is the task of the kernel that starts it, in which they are
    computed."""
    current = here.dynamic
    if current is None and not declared:
        return None
    stack = []
    if current is not None:
        for symbol in dict.fromkeys(entry[0] for entry in current.stack):
            if symbol in _inherited and (parent is not None or symbol not in _within_plans):
                stack.append([symbol, symbol.value])
    for symbol, init_function in declared.items():
        stack.append([symbol, symbol.value if init_function is None else init_function(task, parent, symbol.value)])
    return bindings_of(stack) if stack else None


def bindings_of(stack):
    """The bindings in ``stack``, a list of [symbol, value]."""
    bindings = Bindings()
    bindings.stack = stack
    return bindings


def tv_closure(task, parent, continuation):
    """A function that binds the task variables to their present values and calls ``continuation``."""
    bindings = inherited_bindings(kernel.current(), task, parent) or bindings_of([])

    def call(*arguments):
        here = kernel.current()
        outer, handlers = here.dynamic, here.handlers
        here.dynamic, here.handlers = bindings, None
        if outer is not None:
            outer.leave()
        bindings.enter()
        try:
            return continuation(*arguments)
        finally:
            bindings.leave()
            here.dynamic, here.handlers = outer, handlers
            if outer is not None:
                outer.enter()

    return call
