"""Macros of the user that fail while a form is compiled: a warning, and an error when the call is reached (ANSI 3.2.5).

So one wrong call does not keep a function, or the rest of its file, from being defined, and a handler around it hears it, as on SBCL. At
top level, where nothing stands around the call but calls of functions, the error itself is signalled. So is one of a form of Common Lisp
that is written wrongly.
"""

from __future__ import annotations

from textwrap import indent

from cramhy_runtime.lisp_core.condition_types import Error, ProgramError, SimpleWarning
from cramhy_runtime.lisp_core.conditions import error, handler_case
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol, lisp_list
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import prin1_to_string
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


_TRANSPARENT = {sym(name) for name in ("SETQ", "PROGN", "LOCALLY", "MACROLET", "SYMBOL-MACROLET")}


def reached_at_once(reached: list, form: Any, special: Any) -> bool:
    """Whether evaluating one of the forms ``reached`` evaluates ``form`` with nothing around it that could skip it or handle its errors.

    special: a container of the names of special forms.
    """
    rest = list(reached)
    while rest:
        around = rest.pop()
        if around is form:
            return True
        if around.__class__ is Cons and isinstance(around.car, Symbol) and around.car.macro is None:
            if around.car in _TRANSPARENT or around.car not in special:
                cell = around.cdr
                while cell.__class__ is Cons:
                    rest.append(cell.car)
                    cell = cell.cdr
    return False


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
