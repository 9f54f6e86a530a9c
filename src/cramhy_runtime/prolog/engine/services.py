"""Services that folders above do for the engine: compile clauses, warn of undefined functors, watch traced goals.

The compiler, the explanations and the tracer are built on the engine, so the engine cannot import them. Each of them installs its
functions here when it is imported; `cramhy_runtime.prolog` imports all three.
"""

from __future__ import annotations

from collections.abc import Callable
from cramhy_runtime.kernel.typing_names import Any


class Services:
    """The functions that are in use. `install` sets them."""

    compile_clauses: Callable[[Any, list], tuple]
    """``compile_clauses(predicate, clauses)``: a call function and the `Relation`, or ``None``. The module ``compiler`` installs it."""

    warn_undefined: Callable[[Any, Any], None]
    """``warn_undefined(machine, goal)`` warns of a goal whose functor is not defined. The module ``undefined`` installs it."""

    watch_predicate: Callable[[Any, Any], Callable]
    """``watch_predicate(predicate, entry)``: the call function of a traced predicate; ``entry`` is its `Functor` or ``None``.
    The module ``tracing`` installs it, and the next one."""

    watch_construct: Callable[[Any, Callable], Callable]
    """``watch_construct(functor, construct)``: the control function of a traced construct."""

    def install(self, **functions: Callable) -> None:
        """Use these functions from now on. A name that is not a service is a ``TypeError``."""
        for name, function in functions.items():
            if name not in Services.__annotations__:
                raise TypeError(f"There is no service {name}; there are {', '.join(Services.__annotations__)}.")
            setattr(self, name, function)


SERVICES = Services()
