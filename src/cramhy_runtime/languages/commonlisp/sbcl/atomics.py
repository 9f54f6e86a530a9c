"""``compare-and-swap``, ``atomic-incf`` and their relatives of SB-EXT, for every place that ``setf`` knows.

One task runs at a time, and none is stopped between reading a place and storing into it, so they are ordinary reads and stores.
Source: SBCL's manual, chapter 13.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, list_from, lisp_list
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..evaluation.setf_places import setf_expansion
from ..syntax.lambda_lists import gensym

if TYPE_CHECKING:
    from collections.abc import Callable


def stored(place: Any, environment: Any, compute: Callable[[Any], Any], gives_old: bool = True, before: Any = ()) -> Any:
    """The form that stores what ``compute(old)`` says into PLACE. BEFORE: pairs of variables and forms that are evaluated first."""
    temporaries, forms, stores, setter, getter = setf_expansion(place, environment)
    old = gensym("OLD")
    pairs = [*before, *zip(temporaries, forms), (old, getter), (stores[0], compute(old))]
    bindings = list_from([lisp_list(variable, form) for variable, form in pairs])
    return lisp_list(sym("LET*"), bindings, setter, old if gives_old else stores[0])


def _counting(operator: str) -> Callable[[Any, Any, Any], Any]:
    def expand(environment: Any, place: Any, difference: Any = 1) -> Any:
        return stored(place, environment, lambda old: lisp_list(sym(operator), old, difference))

    return expand


def _swap(environment: Any, place: Any, expected: Any, new: Any) -> Any:
    temporaries, forms, stores, setter, getter = setf_expansion(place, environment)
    old, wanted = gensym("OLD"), gensym("EXPECTED")
    pairs = [*zip(temporaries, forms), (wanted, expected), (stores[0], new), (old, getter)]
    bindings = list_from([lisp_list(variable, form) for variable, form in pairs])
    return lisp_list(sym("LET*"), bindings, lisp_list(sym("WHEN"), lisp_list(sym("EQ"), old, wanted), setter), old)


def _push(environment: Any, item: Any, place: Any) -> Any:
    value = gensym("ITEM")
    return stored(place, environment, lambda old: lisp_list(sym("CONS"), value, old), gives_old=False, before=[(value, item)])


def _pop(environment: Any, place: Any) -> Any:
    return lisp_list(sym("CAR"), stored(place, environment, lambda old: lisp_list(sym("CDR"), old)))


def _update(environment: Any, place: Any, function: Any, *arguments: Any) -> Any:
    return stored(place, environment, lambda old: lisp_list(sym("FUNCALL"), function, *arguments, old), gives_old=False)


def _defined(environment: Any, name: Any, value: Any, *documentation: Any) -> Any:
    return lisp_list(sym("DEFVAR"), name, value, *documentation)


MACROS = {
    "ATOMIC-INCF": _counting("+"),
    "ATOMIC-DECF": _counting("-"),
    "COMPARE-AND-SWAP": _swap,
    "CAS": _swap,
    "ATOMIC-PUSH": _push,
    "ATOMIC-POP": _pop,
    "ATOMIC-UPDATE": _update,
    "DEFGLOBAL": _defined,
    "DEFINE-LOAD-TIME-GLOBAL": _defined,
}


def define(symbol: Any, expand: Callable[..., Any]) -> None:
    """Make ``symbol`` the macro whose expansion ``expand(environment, *parts)`` gives."""

    def expander(form: Cons, environment: Any) -> Any:
        try:
            return expand(environment, *(form.cdr or ()))
        except (TypeError, ValueError) as problem:
            from ..syntax.operator_macros import malformed

            return malformed(form, symbol, problem)

    symbol.macro = expander
