"""Hints for a student: why no process module was found for a designator.

Three things are necessary: a clause of ``matching-process-module`` names the module, a clause of ``available-process-module`` says that it
can be used, and it runs. The hint names the first that is missing. It is computed when the failure is shown, by a dry proof; see
``designators/hints.py``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol, lisp_list
from cramhy_runtime.prolog.explanations import explaining, explanations
from cramhy_runtime.prolog.python.ground import reasoning
from cramhy_runtime.prolog.explanations.failure_reasons import declare_harmless
from cramhy_runtime.prolog.engine.goal_text import show
from cramhy_runtime.prolog.terms.terms import resolve
from .symbols import sym

MATCHING, AVAILABLE = sym("CPM::MATCHING-PROCESS-MODULE"), sym("CPM::AVAILABLE-PROCESS-MODULE")
declare_harmless("CPM::MATCHING-PROCESS-MODULE", "CPM::AVAILABLE-PROCESS-MODULE")
_MODULE = Symbol("?MODULE")
_MOST_GOALS = 2000


def why_none_runs(designator):
    """The hint for ``designator``, for which `running_matches` found no module."""
    with reasoning():  # a failure may be looked at when its kernel has stopped
        return _missing(designator)


def _missing(designator):
    matching = _modules(lisp_list(MATCHING, designator, _MODULE))
    if not matching:
        return _explained(lisp_list(MATCHING, designator, _MODULE))
    available = [name for name in matching if explanations.explain(lisp_list(AVAILABLE, name), _MOST_GOALS, dry=True).holds]
    if not available:
        text = _explained(lisp_list(AVAILABLE, matching[0]))
        return f"{_names(matching)} would match, but there is no solution of {show(lisp_list(AVAILABLE, matching[0]))}.\n{text}"
    return (
        f"{_names(available)} would do it, but {'does' if len(available) == 1 else 'do'} not run: write "
        f"(with-process-modules-running ({show(available[0])}) ...) around the plan."
    )


def _names(names):
    return " and ".join(map(show, names))


def _modules(goal):
    proof, variables = explaining.start(goal, _MOST_GOALS, dry=True)
    found = {}
    while proof.next_solution():
        found.setdefault(resolve(variables[_MODULE]))
    return list(found)


def _explained(goal):
    told = explanations.explain(goal, _MOST_GOALS, dry=True)
    return f"{told.hint()}\n{explanations.offer(goal)} tries it again and tells all of it."
