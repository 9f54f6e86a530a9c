"""Plans for tests: a Python function, the text of a Lisp program, or a Lisp form.

All forms of a text but the last are its definitions, and are evaluated once. The last form is the plan. It is compiled once and called
in every run, so it should make the objects that a run changes (``let``), and not use global variables for them. Names are those of the
package TESTING-USER, which has the plan language and ``mark``, unless the text begins with ``in-package``.
"""

from __future__ import annotations

from .. import kernel
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import find_package_or_error, sym
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T", default=Any)
if TYPE_CHECKING:
    Plan = Callable[[], T] | str | Cons  # a function, a text of Lisp or a form

_compiled: dict[str, Callable[[], Any]] = per_image({})
_AT_ONCE = (sym("IN-PACKAGE"), sym("DEFPACKAGE"))


def plan_of(plan: Plan[T]) -> Callable[[], T]:
    """The function of no arguments that runs ``plan``: a function, a text or a form. Other objects are a TypeError."""
    if callable(plan):
        return plan
    if isinstance(plan, str):
        function = _compiled.get(plan)
        if function is None:
            function = _compiled[plan] = with_lisp(lambda: _compile_text(plan))
        return function
    if isinstance(plan, Cons):
        return with_lisp(lambda: _function_of(plan))
    raise TypeError(f"A plan is a function, a text of Lisp or a Lisp form, not {plan!r}.")


def with_lisp(thunk: Callable[[], T]) -> T:
    """Make the Lisp image if necessary, and call ``thunk`` in a kernel of its own, in the package TESTING-USER."""
    from .. import session
    from cramhy_runtime.lisp_core.dynamic import binding
    from cramhy_runtime.languages.commonlisp.evaluation.evaluator import PACKAGE
    from . import package

    with kernel.aside():
        kernel.start()
        session.boot()
        package.define_faces()
        with binding(PACKAGE, find_package_or_error("TESTING-USER")):
            return thunk()


def _compile_text(text: str) -> Callable[[], Any]:
    from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
    from cramhy_runtime.languages.commonlisp.reader.reader import Reader

    reader = Reader(text, filename="<plan>")
    end, form = object(), None
    while True:
        if isinstance(form, Cons) and form.car in _AT_ONCE:  # the next form is to be read in that package
            evaluate(form, reader.filename, reader.positions)
            form = None
        following = reader.read(eof_error=False, eof_value=end)
        if following is end:
            break
        if form is not None:
            evaluate(form, reader.filename, reader.positions)
        form = following
    if form is None:
        raise ValueError("The text of the plan has no form.")
    return _function_of(form, reader)


def _function_of(form, reader=None):
    from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate

    function = lisp_list(sym("LAMBDA"), None, form)
    place = (reader.filename, reader.positions) if reader else ()
    return evaluate(function, *place)
