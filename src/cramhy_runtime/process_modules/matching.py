"""Finding the process modules for a designator, with Prolog (process-modules.md section 7)."""

from __future__ import annotations

from cramhy_runtime.cpl.failures.handling import attempt, fail_with_advice, signal_failure
from ..designators.clause_index import index_by_properties
from cramhy_runtime.lisp_core.data import list_from, one, truth
from cramhy_runtime.lisp_core.hooks import Hook
from cramhy_runtime.prolog.engine.fact_groups import built_in_group
from ..prolog.query import ask_all
from cramhy_runtime.prolog.terms.terms import Var
from .executing import pm_execute
from .hints import AVAILABLE, MATCHING, why_none_runs
from .registry import running
from .symbols import sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cramhy_runtime.lisp_core.data import Cons, Symbol
    from ..designators.classes import Designator

on_preparing_performing = Hook("CPL::ON-PREPARING-PERFORMING-ACTION-DESIGNATOR", "(designator matching-process-modules)")
on_finishing_performing = Hook("CPL::ON-FINISHING-PERFORMING-ACTION-DESIGNATOR", "(id success)")

for _functor in (MATCHING, AVAILABLE, sym("CPM::PROJECTION-RUNNING")):
    built_in_group(sym("CPM::PROCESS-MODULES"), _functor)
index_by_properties(MATCHING)  # its clauses ask for properties of the designator


def matching_names(designator: Designator) -> list[Symbol]:
    """The names of modules that match ``designator`` and are available, in clause order, each once, as a Python list."""
    name = Var()
    return ask_all(name, (MATCHING, designator, name), (AVAILABLE, name))


def matching_process_module_names(action_designator: Designator) -> Cons | None:
    """`matching_names` as a Lisp list."""
    return list_from(matching_names(action_designator))


def running_matches(designator: Designator) -> list[Symbol]:
    """Those of `matching_names` that are running."""
    modules = running().modules
    return [name for name in matching_names(designator) if name in modules]


def matching_available_process_modules(action_designator: Designator, *, fail_if_none: bool | None = None) -> Cons | None:
    """The names of modules that match ``action_designator``, are available and running, as a Lisp list.

    With ``fail_if_none``, an empty list is a plan failure. Source: process-modules.md section 7.
    """
    names = running_matches(action_designator)
    if not names and truth(fail_if_none):
        return fail_with_advice(
            lambda: why_none_runs(action_designator), "No process modules found for executing designator ~a", action_designator
        )
    return list_from(names)


def pm_execute_matching(action_designator: Designator) -> Any:
    """Let the matching modules execute ``action_designator``, one after the other until one succeeds. Returns its first value.

    If all fail, it fails with the failure of the first. A Lisp error is signalled at once. If there is no such module, it is a plan
    failure. Source: process-modules.md section 7.
    """
    names = running_matches(action_designator)
    if not names:
        return fail_with_advice(
            lambda: why_none_runs(action_designator), "No process modules found for executing designator ~a", action_designator
        )
    return execute_by(names, action_designator)


def execute_by(names: list[Symbol], designator: Designator) -> Any:
    """Let the running modules ``names`` execute ``designator``, one after the other until one succeeds. Returns its first value."""
    observed = on_preparing_performing.methods or on_finishing_performing.methods
    run_id = on_preparing_performing.first(designator, list_from(names)) if observed else None
    success = None
    try:
        if len(names) == 1:
            value = one(pm_execute(names[0], designator))
            success = True
            return value
        first_failure = None
        for name in names:
            value, failure = attempt(lambda name=name: pm_execute(name, designator))
            if failure is None:
                success = True
                return one(value)
            first_failure = first_failure or failure
        return signal_failure(first_failure)
    finally:
        if observed:
            on_finishing_performing(run_id, success)
