"""Tags: names for steps of a plan, so that other steps can be ordered by them, watch them or suspend them.

``(with-tags ... (:tag grasp form...) ...)`` binds a variable ``grasp`` to a task that is created now and executed when control
reaches the tag; executing it again makes a new task at the next iteration path and assigns it to the variable. Source: cpl.md 7.1.

The macro finds the names by walking through its body with all macros expanded (``languages/commonlisp/faces/cpl/walker.py``), binds
each by `make_tag_task`, and compiles ``(:tag name form...)`` to
``(progn (setq name (prepare-tag name)) (execute-tag name (lambda () form...) '(:tag ...)))``.
The tags of an inner ``with-tags`` belong to that form alone. In the original the outer one makes tasks for them too, which never run.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list
from ..tasks.branches import run_one
from ..hooks import on_begin_execute_tag_task, on_finish_execute_tag_task
from ..logging import active_tags, log
from ..symbols import sym
from ..current import inside_plan
from .task_tree import current_path, make_task
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..tasks.tasks import Task

T = TypeVar("T")

TAGGED = sym("CPL-IMPL::TAGGED")


def enter_with_tags() -> Any:
    """Signal an error outside of a plan. Returns the path below which the tags of ``with-tags`` go."""
    inside_plan("WITH-TAGS")
    return current_path()


def make_tag_task(name: Symbol, path: Any = None) -> Task[object]:
    """A task for the tag ``name``, not executed yet, at ``((tagged name) . path)``. The default is the current path."""
    path = enter_with_tags() if path is None else path
    return make_task(name=lambda: f"[TAG-{name.name}]", path=Cons(lisp_list(TAGGED, name), path))


def prepare_tag(task: Task[object]) -> Task[object]:
    """``task`` if it was not executed yet, or else a new task at the next iteration path."""
    if task.unexecuted:
        return task
    part = task.path.car
    return make_task(name=lambda: f"[TAG-{part.cdr.car.name}]", path=Cons(lisp_list(part.car, part.cdr.car), task.path.cdr))


def execute_tag(task: Task[object], body: Callable[..., T], sexp: Any = None) -> T:
    """Run ``body`` as ``task`` and wait for it. Returns its values or signals its failure. ``sexp`` is the tag's whole form."""
    code = task.code
    if code is None:
        task.body = body
    else:
        if code.function is None:
            code.function, code.sexp = body, sexp
        task.body = lambda: code.function(*(code.parameters or ()))
    if active_tags:
        log("WITH-TAGS", "~s", task.path)
    if not (on_begin_execute_tag_task or on_finish_execute_tag_task):
        return run_one(task, "TAG")
    run_id = on_begin_execute_tag_task.first(task)
    try:
        return run_one(task, "TAG")
    finally:
        on_finish_execute_tag_task(run_id)


def is_tag_name(name):
    """Whether ``name`` can be the name of a tag, that is, of a variable."""
    return isinstance(name, Symbol) and not name.constant


def check_tag(form, within):
    """Signal a compile-time error if the tag ``form`` is wrong. ``within`` says whether a ``with-tags`` is around it."""
    name = form.cdr.car if isinstance(form.cdr, Cons) else None
    if not is_tag_name(name):
        error(CompileError("~S is no tag: it is written (:tag name form...), and the name is a symbol that can be a variable.", form))
    if not within:
        error(
            CompileError("(:TAG ~S ..) used outside of WITH-TAGS.", name),
            hint="Put (with-tags ...) around the forms that use the tag; the body of a plan function or goal is in one already.",
        )
