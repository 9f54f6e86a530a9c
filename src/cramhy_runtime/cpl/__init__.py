"""CPL, the CRAM plan language: fluents, tasks, failures and the operators that combine them. Usable from Python:

    from cramhy_runtime import cpl, kernel

    kernel.start(clock="virtual")
    door = cpl.make_fluent(name="door-open")

    def watch():
        return cpl.wait_for(door, timeout=5.0)

    def open_it():
        cpl.sleep(2.0)
        door.value = True

    cpl.top_level(lambda: cpl.par(watch, open_it))      # True, after two seconds of virtual time

Where the parts are: ``fluents``, ``fluent_operators``, ``waiting`` · ``tasks``, ``task_variables``, ``branches``, ``suspension`` ·
``failure_types``, ``failures``, ``retry_counters``, ``debugging`` · ``operators``, ``watching`` · ``tree``, ``tree_report``,
``tags``, ``plans``, ``policies`` · ``hooks``, ``logging``, ``printing`` · ``package``, the Lisp faces. Reference: cpl.md.
"""

from .failure_types import (
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
from .failures import fail, with_failure_handling
from .fluent_operators import fl_and, fl_apply, fl_eq, fl_eql, fl_funcall, fl_not, fl_or, fl_pulsed, fl_value_changed, pulsed
from .fluents import Fluent, ValueFluent, make_fluent, peek_value, pulse, register_update_callback, remove_update_callback, value
from .operators import (
                            named_top_level,
                            par,
                            par_loop,
                            partial_order,
                            pursue,
                            seq,
                            top_level,
                            try_all,
                            try_each_in_order,
                            try_in_order,
                            with_task,
)
from .retry_counters import RetryCounter
from .suspension import on_suspension, retry_after_suspension, suspend, wake_up, with_task_suspended, without_scheduling
from .task_variables import define_task_variable
from .current import current_task
from .tasks import Task, ToplevelTask, evaporate, join_task
from .tree_report import describe_task_tree, task_tree_text
from .waiting import sleep, wait_for, whenever

__all__ = [
    "CommonLispErrorEnvelope", "CompositeFailure", "current_task", "define_task_variable", "describe_task_tree", "envelope", "evaporate",
    "fail", "fl_and", "fl_apply", "fl_eq", "fl_eql", "fl_funcall", "fl_not", "fl_or", "fl_pulsed", "fl_value_changed",
    "Fluent", "join_task", "make_fluent", "named_top_level", "on_suspension", "opened", "par", "par_loop",
    "partial_order", "peek_value", "PlanFailure", "PolicyCheckConditionMet", "PolicyCondition", "PolicyFailure",
    "PolicyInitFailed", "PolicyNotFound", "pulse", "pulsed", "pursue", "register_update_callback",
    "remove_update_callback", "retry_after_suspension", "RetryCounter", "seq", "SimplePlanFailure", "sleep", "suspend",
    "Task", "task_tree_text", "top_level", "ToplevelTask", "try_all", "try_each_in_order", "try_in_order", "value", "ValueFluent",
    "wait_for", "wake_up", "whenever", "with_failure_handling", "with_task", "with_task_suspended",
    "without_scheduling",
]  # fmt: skip
