"""Facts that come and go, from Python: what holds for a while, and who is told of it.

    def stacked(operation, a, b, c):                # kw.assert_ when a match comes, kw.retract when it goes
        print(operation, a, "on", b, "on", c)

    with facts_watched(stacked, P.on(V.a, V.b), P.on(V.b, V.c)):
        with facts_asserted(P.on(P.cup, P.box), P.on(P.box, P.table)):
            holds(P.rete_holds(P.on(V.what, P.table)))

They are the facts of CRAM's rete network, which Lisp asserts by ``with-facts-asserted`` and watches by productions. Facts of groups, which
always hold, are in `fact_group`. The parts of a fact are names, keywords, numbers and objects. Two strings are two objects, also if they
have the same characters, so a string matches no other. Source: prolog.md section 12.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.utilities.patterns import variables_of

from ..builtins import productions, rete
from .terms import Goal, Variable, goal_form, to_python

if TYPE_CHECKING:
    from collections.abc import Callable


@contextmanager
def facts_asserted(*facts: Goal) -> Iterator[None]:
    """``with facts_asserted(P.on(P.cup, P.table)):`` the facts hold while the block runs.

    facts: goals without ``V._``. The goal ``P.rete_holds(P.on(V.what, P.table))`` asks for them. Errors: TypeError for what is no goal.
    """
    forms = [goal_form(fact) for fact in facts]
    with rete.asserted(forms):
        yield


@contextmanager
def facts_watched(watcher: Callable[..., object], *patterns: Goal) -> Iterator[None]:
    """``with facts_watched(watcher, P.on(V.a, V.b), P.on(V.b, V.c)):`` the watcher is told when all patterns hold.

    watcher: it is called with ``kw.assert_``, or ``kw.retract`` when they hold no more, and with the variables of the patterns as keyword
    arguments. It is told of matches that are there already. patterns: goals with variables, at least one. Errors: TypeError for what is
    no goal.
    """
    if not patterns:
        raise TypeError("A watcher needs a pattern: facts_watched(watcher, P.on(V.what, P.table)).")
    forms = [goal_form(pattern) for pattern in patterns]

    def tell(operation: Any, *arguments: Any) -> None:
        values = dict(zip(arguments[::2], arguments[1::2], strict=True))
        watcher(operation, **{names[variable.name]: to_python(value, list) for variable, value in values.items()})

    names = {symbol.name: Variable(symbol).name for form in forms for symbol in variables_of(form)}
    with productions.watched(forms, tell):
        yield
