"""CPL, the CRAM plan language, as a Python library: fluents, tasks, failures and the forms that combine them. No Lisp is needed:

    from cramhy_runtime import cpl

    class DoorStuck(cpl.PlanFailure):
        pass

    bumper = cpl.make_fluent(name="bumper", value=False)

    def drive(metres):
        cpl.sleep(metres / 0.5)
        return "there"

    def main():
        for attempt in cpl.attempts(3, on=DoorStuck, pause=1.0):
            with attempt, cpl.timeout(10):
                with cpl.pursue() as race:
                    race.start(drive, 2.0)
                    race.start(cpl.wait_for, bumper)
        return race.result

    cpl.run(main)       # "there", after four seconds of virtual time

The page docs/plans-in-python.md tells the whole story. In short: a plan runs below `run` or ``with plan():``. ``par pursue try_all``
take branches as functions, or begin a ``with`` block that starts them. When a form is left, its branches are dead, and the failure
that decided the form is raised. A task waits for a value that is neither ``None`` nor ``False``; 0 and "" are true, as in Lisp.

Where the parts are (reference: cpl.md): `failures`, `fluents`, `tasks`, `tree` and `forms` are folders in this order, and each knows only
those before it. Below them are `symbols`, `statuses`, `current` (the task that runs), `task_variables`, `hooks`, `logging` and
`type_checks`. `plain_printing` shows fluents and tasks when no language is loaded, and `signatures` is for type checkers.
"""

from cramhy_runtime.kernel import Deadlock, TimeLimit, checkpoint, now, run_blocking, cleanup
from .fluents import python_operators as fluent_notation  # noqa: F401  they teach fluents Python's operators, and how they are shown
from . import plain_printing  # noqa: F401
from .tasks.attempts import Attempt, attempts, handling
from .tasks.timeouts import Timeout, TimedOut, move_on_after, timeout
from .forms.branch_blocks import ParBlock, RaceBlock, TryAllBlock
from .failures.failure_types import (
    CommonLispErrorEnvelope,
    CompositeFailure,
    PlanFailure,
    PolicyCheckConditionMet,
    PolicyCondition,
    PolicyFailure,
    PolicyInitFailed,
    PolicyNotFound,
    SimplePlanFailure,
    envelope,
    opened,
)
from .failures.handling import Handling as Retry, with_failure_handling
from .fluents.operators import fl_and, fl_apply, fl_eq, fl_eql, fl_funcall, fl_not, fl_or, fl_pulsed, fl_value_changed, pulsed
from .fluents.fluents import Fluent, ValueFluent, make_fluent, peek_value, pulse, register_update_callback, remove_update_callback, value
from .forms.operators import named_top_level, seq, top_level
from .forms.plan_run import plan, run
from .forms.policies import Policy, make_policy
from .forms.python_forms import (
    fail,
    join_task,
    on_suspension,
    par,
    par_loop,
    partial_order,
    policy,
    pursue,
    task_suspended,
    try_all,
    try_each_in_order,
    try_in_order,
    wait_for,
    whenever,
    with_scheduling,
    with_task,
    without_scheduling,
)
from .failures.retry_counters import RetryCounter
from .statuses import CREATED, EVAPORATED, FAILED, RUNNING, SUCCEEDED, SUSPENDED
from .forms.named_steps import Tag, plan_function, tag
from .tasks.suspension import retry_after_suspension, suspend, wake_up, with_task_suspended
from .task_variables import define_task_variable
from .current import current_task
from .tasks.ending import cleanup_time_limit
from .tasks.tasks import Task, ToplevelTask, evaporate
from .tree.tree_report import describe_task_tree, task_tree_text
from .tasks.waiting import sleep

__all__ = [
    "Attempt", "attempts", "checkpoint", "cleanup", "cleanup_time_limit", "CommonLispErrorEnvelope", "CompositeFailure", "CREATED",
    "current_task", "Deadlock", "define_task_variable", "describe_task_tree", "envelope", "evaporate", "EVAPORATED",
    "fail", "FAILED", "fl_and", "fl_apply", "fl_eq", "fl_eql", "fl_funcall", "fl_not", "fl_or", "fl_pulsed", "fl_value_changed",
    "Fluent", "handling", "join_task", "make_fluent", "make_policy", "move_on_after", "named_top_level", "now", "on_suspension",
    "opened", "par", "par_loop", "ParBlock", "partial_order", "peek_value", "plan", "plan_function", "PlanFailure", "policy", "Policy",
    "PolicyCheckConditionMet", "PolicyCondition", "PolicyFailure", "PolicyInitFailed", "PolicyNotFound", "pulse", "pulsed", "pursue",
    "RaceBlock", "register_update_callback", "remove_update_callback", "Retry", "retry_after_suspension", "RetryCounter", "run",
    "run_blocking", "RUNNING", "seq", "SimplePlanFailure", "sleep", "SUCCEEDED", "suspend", "SUSPENDED", "tag", "Tag",
    "Task", "task_suspended", "task_tree_text", "TimedOut", "TimeLimit", "timeout", "Timeout", "top_level", "ToplevelTask", "try_all",
    "try_each_in_order", "try_in_order", "TryAllBlock", "value", "ValueFluent", "wait_for", "wake_up", "whenever",
    "with_failure_handling", "with_scheduling", "with_task", "with_task_suspended", "without_scheduling",
]  # fmt: skip
