"""The control operators: ``top-level``, ``seq``, ``par``, ``pursue``, ``try-all``, ``partial-order`` and related ones.

Each takes its branches as functions of no arguments and passes all values through. The *position* of a branch decides whose values a
form returns and with which failure it fails (cpl.md section 6): ``par`` returns the values of the first form, ``pursue`` those of the
last form that is done, ``try-all`` those of the first form that is done. A form fails with the failure of the last failed form. A
branch that another task evaporated counts as done, without values; in the original, ``pursue`` signals an assertion then.

The common part of all parallel forms is in ``tasks/branches.py``.
"""

from __future__ import annotations

from contextlib import nullcontext
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar, overload

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime import kernel

from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, list_from, one, truth
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.python_exceptions import from_python
from ..tree import finished_plans
from ..tasks.branches import branch_tasks, run, run_forms, run_one
from ..failures.failure_types import CompositeFailure, envelope, is_mistake, opened
from ..failures.handling import Attempt, composite_failure, observed
from ..hooks import (
    on_finishing_named_top_level,
    on_preparing_named_top_level,
    on_top_level_cleanup_hook,
    on_top_level_setup_hook,
    on_with_failure_handling_begin,
    on_with_failure_handling_end,
)
from ..logging import active_tags, log
from ..current import inside_plan
from ..tasks.ending import close_plan
from ..statuses import DEAD, DONE, FAILED
from .orderings import apply_orderings
from ..tasks.tasks import Task, ToplevelTask, evaporate
from ..tree.task_tree import TaskTreeNode, cleared, get_top_level_task_tree
from ..tree.tree_report import note_stopped
from ..tasks.parallel_children import watch

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..signatures import Name, Thunk
    from ..tasks.branches import Branches

T = TypeVar("T")


def top_level(body: Thunk[T]) -> T:
    """``(top-level body...)``: run ``body`` as the root of a plan, wait for it and return its values.

    A plan failure that leaves ``body`` is signalled here as it is, an error of a branch without its envelope. When this returns or
    unwinds, every task of the plan is dead. Inside a plan it is an error. Source: cpl.md 5.1, 5.2.
    """
    return named_top_level(body)


def named_top_level(body: Thunk[T], name: Name | None = None) -> T:
    """``(named-top-level (:name name) body...)``: as `top_level`, with a task tree that is kept under ``name``.

    If a top-level of that name is running already, it is an error. Source: cpl.md 5.1.
    """
    me = kernel.current()
    if me.owner is not None:
        error(
            types.SimpleError("top-level calls cannot be nested."),
            hint="This form runs inside a plan already: leave TOP-LEVEL away here, or make what is called a plan function with "
            "DEF-CRAM-FUNCTION.",
        )
    if name is None and not (
        on_preparing_named_top_level.methods
        or on_top_level_setup_hook.methods
        or on_finishing_named_top_level.methods
        or on_top_level_cleanup_hook.methods
        or on_with_failure_handling_begin.methods
        or on_with_failure_handling_end.methods
    ):
        return _run_top_level(body, None, TaskTreeNode())
    if name is None:
        return _observed_top_level(body, None, TaskTreeNode())
    other = _running.get(name)
    if other is not None and other.kernel is me.kernel:
        error(
            types.SimpleError("A top-level named ~S is running already.", name),
            hint="Two runs of one name would share, and disturb, one task tree: wait until the other has ended, or name this one "
            "differently.",
        )
    _running[name] = me
    try:
        return _observed_top_level(body, name, _cleared_tree(name))
    finally:
        _running.pop(name, None)


_running = per_image({})
"""Name of a top-level → the kernel's task that waits for it, while it runs."""


def _cleared_tree(name: Any) -> TaskTreeNode:
    """The tree for a new run of ``name``, cleared. The record of the last run keeps the codes that were in it."""
    tree, before = get_top_level_task_tree(name), finished_plans.by_name.get(name)
    if getattr(before, "tree", None) is tree:
        before.codes = {}
        return cleared(tree, before.codes)
    return cleared(tree)


def _observed_top_level(body: Thunk[T], name: Any, tree: TaskTreeNode) -> T:
    """Run ``body`` between the hooks of cpl.md 5.1, with the variables bound that a hook gives."""
    run_id = on_preparing_named_top_level.first(name)
    pairs = []
    for bound in on_top_level_setup_hook(name, tree):
        if bound is not None:
            for symbol, value in zip(bound.car or (), bound.cdr or (), strict=False):
                pairs += (symbol, value)
    with binding(*pairs) if pairs else nullcontext():
        try:
            return observed(["PLAN-FAILURE", "ERROR"], lambda: _run_top_level(body, name, tree))
        finally:
            on_finishing_named_top_level(run_id)
            on_top_level_cleanup_hook(name)


def _run_top_level(body: Thunk[T], name: Any, tree: TaskTreeNode) -> T:
    task = ToplevelTask(body, lambda: f"[{name.name}-TOP-LEVEL]" if name is not None else "[TOP-LEVEL]")
    task.tree = tree
    me = kernel.current()
    task.ended = lambda task: me.kernel.unpark(me)
    finished_plans.begins(task, name)
    task.execute()
    try:
        while task.status not in DEAD:
            me.kernel.park(task.described)
    except BaseException as exception:
        if isinstance(exception, kernel.Interrupted | kernel.Deadlock | kernel.TimeLimit):
            note_stopped(task, exception)
        close_plan(task, f"{name.name if name is not None else 'NIL'} aborted.")
        if task.status is FAILED and isinstance(exception, kernel.Cancelled | kernel.Interrupted):
            exception.add_note(f"While the plan was ended, its cleanup failed: {task.result}")
        raise
    finally:
        me.why = ""  # it holds the plan with its whole tree
        finished_plans.ended(task, name)
    if task.status is FAILED:
        failure = opened(task.result)
        if isinstance(failure, KeyboardInterrupt | SystemExit | kernel.Interrupted):
            raise failure
        return error(failure)
    return task.result


# ---------------------------------------------------------------------------------------------------------- when it is decided


def any_failed_or_all_dead(branches: Branches) -> object:
    """``par`` is decided."""
    return branches.failed or not branches.living


def any_dead(branches: Branches) -> object:
    """``pursue`` is decided."""
    return branches.failed or branches.done


def any_done_or_all_dead(branches: Branches) -> object:
    """``try-all`` is decided: by a success, by a mistake in the program, or since nobody is left."""
    return branches.done or branches.mistake is not None or not branches.living


# ---------------------------------------------------------------------------------------------------------- and what comes of it


def first_values(branches: Branches) -> tuple[Any, Any]:
    """The values and the failure of ``par``."""
    failure = branches.last_failure() if branches.failed else None
    return branches.tasks[0].result, failure


def winner(branches: Branches) -> tuple[Any, Any]:
    """The values and the failure of ``pursue``."""
    if branches.failed:
        return None, branches.last_failure()
    for task in reversed(branches.tasks):
        if task.status in DONE:
            return task.result, None
    return None, None


def first_success(branches: Branches) -> tuple[Any, Any]:
    """The values and the failure of ``try-all``."""
    if branches.mistake is not None:
        return None, branches.mistake
    for task in branches.tasks:
        if task.status in DONE:
            return task.result, None
    return None, CompositeFailure(failures=list_from([task.result for task in reversed(branches.tasks)]))


@overload
def seq() -> None: ...
@overload
def seq(first: Thunk[T], /) -> T: ...
@overload
def seq(first: Thunk[object], second: Thunk[T], /) -> T: ...
@overload
def seq(first: Thunk[object], second: Thunk[object], third: Thunk[T], /) -> T: ...
@overload
def seq(*thunks: Thunk[object]) -> object: ...
def seq(*thunks: Thunk[object]) -> object:
    """``(seq form...)``: call the thunks one after the other. Returns the values of the last. Source: cpl.md 6.1."""
    result = None
    for thunk in thunks:
        result = thunk()
    return result


def par(*thunks: Thunk[Any]) -> Any:
    """``(par form...)``: run all branches at once until all have ended. Returns the values of the first form.

    If a branch fails, the others are evaporated, and the form fails with that failure. Without branches it is an error. Source: cpl.md 6.2.
    """
    return run_forms("PAR", thunks, any_failed_or_all_dead, first_values)


def pursue(*thunks: Thunk[T]) -> T:
    """``(pursue form...)``: run all branches at once until one has ended. Returns its values, or fails with its failure.

    The other branches are evaporated, and dead when this returns. Without branches it is an error. Source: cpl.md 6.3.
    """
    return run_forms("PURSUE", thunks, any_dead, winner)


def try_all(*thunks: Thunk[T]) -> T:
    """``(try-all form...)``: run all branches at once until one succeeds. Returns its values.

    If all fail, the form fails with a composite failure, the failure of the last form first. Without branches it is an error. Source:
    cpl.md 6.4.
    """
    return run_forms("TRY-ALL", thunks, any_done_or_all_dead, first_success, late_failures_count=False)


def try_in_order(*thunks: Thunk[T]) -> T:
    """``(try-in-order form...)``: run one form after the other until one succeeds. Returns its values.

    If all fail, it fails with a composite failure, in the order of the forms. Source: cpl.md 6.5.
    """
    inside_plan("TRY-IN-ORDER")
    return _try(thunks)


def try_each_in_order(elements: Cons | None, body: Callable[[Any], T]) -> T:
    """``(try-each-in-order (variable list) body...)``: call ``body(element)`` for one element after the other until a call succeeds.

    Returns its values. If all fail, it fails with a composite failure. Source: cpl.md 6.6.
    """
    inside_plan("TRY-EACH-IN-ORDER")
    return _try((lambda element=element: body(element)) for element in _list(elements))


def _try(thunks):
    failures, attempt = [], Attempt()
    for thunk in thunks:
        try:
            values, failure = attempt.run(thunk)
        except Exception as problem:  # of Python: in a task of its own, as TRY-ALL's, it would be a failure, too
            if isinstance(problem, types.Condition) or is_mistake(problem) or attempt.task.cancelled_delivered:
                raise
            values, failure = None, envelope(from_python(problem))
        if failure is None:
            return values
        if active_tags:
            log("TRY-IN-ORDER", "failed: ~a", failure)
        failures.append(failure)
        kernel.checkpoint()
    return composite_failure(failures)


def par_loop(elements: Any, body: Callable[[Any], T]) -> T:
    """``(par-loop (variable list) body...)``: call ``body(element)`` for all elements at once. Returns the values for the first element.

    Failures are as in `par`. As in the original, an empty list runs the body once, with nil. Source: cpl.md 6.8.
    """
    inside_plan("PAR-LOOP")
    elements = list(_list(elements)) or [None]
    tasks = branch_tasks("PAR", [(lambda element=element: body(element)) for element in elements])
    return run("PAR", tasks, any_failed_or_all_dead, first_values)


def _list(elements: Any) -> Any:
    if elements is None:
        return ()
    if not isinstance(elements, Cons):
        return type_error(elements, "LIST")
    return elements


def partial_order(steps: Sequence[Thunk[T]], orderings: Any) -> T:
    """``(partial-order (step...) (:order before after)...)``: as `par`, with ``after`` starting its body only when ``before`` is dead.

    ``orderings`` is a list of pairs (before, after), or a function that returns one. Both are tasks; ``before`` may be a value fluent,
    and then ``after`` starts when the fluent has been pulsed. A ring of orderings is an error, before any step starts
    (``orderings.py``). Source: cpl.md 6.7.
    """
    inside_plan("PARTIAL-ORDER")
    apply_orderings(orderings)
    return run_forms("PAR", steps, any_failed_or_all_dead, first_values)


def with_task(body: Thunk[T], name: object = "WITH-TASK", cls: type[Task[object]] | None = None) -> T:
    """``(with-task (:name name) body...)``: run ``body`` in a new child task, wait for it and return its values. Source: cpl.md 6.10."""
    inside_plan("WITH-TASK")
    return run_one((cls or Task)(thread_fun=body, name=lambda: f"[{name}]", run_thread=None))


def with_parallel_childs(name, thunks, watcher):
    """The general parallel form: it calls ``watcher(running, done, failed)`` each time that a child's status has changed.

    The arguments are Lisp lists of tasks, last form first. The watcher leaves the form by ``(return ...)``, a non-local exit. If it
    never does, the form waits for ever, even when all children are dead. Source: cpl.md 6.9.
    """
    inside_plan(name or "WITH-PARALLEL-CHILDS")
    return watch(branch_tasks(name or "WITH-PARALLEL-CHILDS", thunks), watcher)


def unwind_and_teardown(*, reason="Manual teardown."):
    """``(unwind-and-teardown)``: evaporate the current task, which unwinds from here."""
    evaporate(inside_plan("UNWIND-AND-TEARDOWN"), reason=reason)


def mapcar_clean(function, first, *more):
    """``(mapcar-clean function list...)``: the results of ``mapcar`` without the nils. Repaired: it works with several lists."""
    call = function_of(function)
    results = (one(call(*arguments)) for arguments in zip(*(_list(lst) for lst in (first, *more)), strict=False))
    return list_from([result for result in results if truth(result)])
