"""Macros of the user that fail while a function is compiled: a warning, and an error when the call is reached (ANSI 3.2.5).

So one wrong call does not keep a function, or the rest of its file, from being defined, as on SBCL. At top level, where the call would be
reached at once, the error itself is signalled, and so is one of a form of Common Lisp that is written wrongly.
"""

from __future__ import annotations

from textwrap import indent

from cramhy_runtime.ground.condition_types import Error, ProgramError, SimpleWarning
from cramhy_runtime.ground.conditions import error, handler_case
from cramhy_runtime.ground.data import Keyword, Symbol, lisp_list
from cramhy_runtime.ground.packages import sym
from cramhy_runtime.ground.printing import prin1_to_string
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.storage.dependency_tracing import current

from ..syntax.lambda_lists import support

if TYPE_CHECKING:
    from collections.abc import Callable


class CompiledProgramError(ProgramError):
    """A call is reached whose macro failed when it was compiled. ``form``: its text. ``cause``: what the macro signalled."""

    lisp_name = "SB-INT::COMPILED-PROGRAM-ERROR"

    def __init__(self, form: str = "", cause: str = "", **slots: Any) -> None:
        super().__init__(**slots)
        self.form, self.cause = form, cause

    def report(self) -> str:
        return (
            f"Execution of a form compiled with errors.\nForm:\n{indent(self.form, '  ')}\nCompile-time error:\n{indent(self.cause, '  ')}"
        )


def is_of_user(name: Any, env: Any) -> bool:
    """Whether ``name`` is a macro of the user's, global or local. Keywords name macros of ours, such as ``:tag``."""
    if not isinstance(name, Symbol) or isinstance(name, Keyword):
        return False
    return env.function(name) is not None or name.macro is not None and not (name.package is not None and name.package.built_in)


def expanded_or_failing(unit: Any, expand: Callable[[], tuple[Any, bool]], form: Any) -> tuple[Any, bool]:
    """What ``expand()`` returns; if it signals an error, a form that signals it when it is reached, with a warning now."""

    def fails(problem: Error) -> tuple[Any, bool]:
        text, cause = prin1_to_string(form), problem.report()
        unit.tell(SimpleWarning, "The macro call ~A fails, and will be an error when it is reached:~%~A", text, indent(cause, "  "))
        trace = current()
        if trace is not None:
            trace.refuse("a macro that it calls failed")
        return lisp_list(support("REACHED-FAILING-MACRO"), lisp_list(sym("QUOTE"), text), lisp_list(sym("QUOTE"), cause)), True

    return handler_case([(Error, fails)], expand)


def reached_failing_macro(form: str, cause: str) -> Any:
    """Signal the error of a call whose macro failed."""
    return error(CompiledProgramError(str(form), str(cause)))
