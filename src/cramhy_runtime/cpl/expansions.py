"""What the macros of ``hy_src/cramhy/cpl.hy`` expand into: the plan language's functions, as Lisp forms call them.

Branches and bodies arrive as functions of no arguments, clauses as Lisp lists. Each function here only fits the shapes; the
meaning is in the module that it calls.
"""

from __future__ import annotations

from ..lisp.conditions import CompileError, error
from ..lisp.data import list_from, one, python_list, truth
from ..lisp.faces import define_face, python_name
from . import failures, fluent_operators, operators, plans, policies, suspension, tags, task_variables, tree, waiting


def named_top_level(name, body):
    return operators.named_top_level(body, name)


def whenever(fluent, body):
    return waiting.whenever(fluent, body)


def with_failure_handling(clauses, body):
    """``clauses``: a list of lists (type handler)."""
    return failures.with_failure_handling([tuple(clause) for clause in clauses or ()], body)


class RetryCounter:
    """A counter of ``with-retry-counters``; ``initial`` computes its value, again at each reset."""

    def __init__(self, initial):
        self.initial = initial
        self.value = one(initial())


def make_retry_counter(initial):
    return RetryCounter(initial)


def use_retry(counter):
    """Whether a retry is left; takes it."""
    if counter.value > 0:
        counter.value -= 1
        return True
    return None


def counter_value(counter):
    return counter.value


def reset_counter(counter):
    counter.value = one(counter.initial())
    return counter.value


def counter_variable(name, table):
    """At expansion time: the hidden variable of the retry counter ``name``."""
    for entry in table or ():
        if entry.car is name:
            return entry.cdr
    known = list_from([entry.car for entry in table or ()])
    return error(CompileError("There is no retry counter ~S here; WITH-RETRY-COUNTERS defines ~S.", name, known))


def partial_order(steps, orderings):
    return operators.partial_order(python_list(steps), [tuple(ordering) for ordering in orderings or ()])


def with_parallel_childs(name, thunks, watcher):
    return operators.with_parallel_childs(name, python_list(thunks), watcher)


def with_task_suspended(task, reason, body):
    return suspension.with_task_suspended(task, body, reason)


def with_task(name, body):
    return operators.with_task(body, name)


def define_task_variable(symbol, value, documentation, init_function):
    return task_variables.define_task_variable(symbol, value, documentation=documentation, init_function=init_function)


def cram_function_call(name, function, arguments):
    return plans.call_cram_function(name, function, python_list(arguments))


def top_level_cram_function_call(name, function, arguments):
    return plans.call_top_level_cram_function(name, function, python_list(arguments))


def note_plan(name, kind, lambda_list):
    return plans.note_plan(name, kind, lambda_list)


def goal_call(name, arguments):
    return plans.call_goal(name, arguments)


def _clauses(clauses):
    return {python_name(clause.car.name): clause.cdr.car for clause in clauses or ()}


def make_policy(name, parameters, description, clauses):
    """``clauses``: a list of lists (keyword function); a function takes the store and the policy's parameters."""
    return policies.make_policy(name, parameters, description, **_clauses(clauses))


def define_policy(name, parameters, description, clauses):
    return policies.define_policy(name, parameters, description, **_clauses(clauses))


def policy_get(store, symbol):
    return store.get(symbol)


def policy_set(store, symbol, value):
    return store.set(symbol, value)


def with_policy(policy, arguments, forms, body):
    return policies.with_policy(policy, lambda: python_list(arguments()), body, forms)


def with_tree_node(path_part, function, name, parameters):
    return tree.with_task_tree_node(path_part, function, name=name, parameters=parameters)


def parameter_value(parameter):
    return parameter.value


def set_parameter_value(value, parameter):
    parameter.value = value
    return value


def cpl_parameter(name, value):
    return fluent_operators.define_cpl_parameter(name, value)


def make_tag_task(name):
    return tags.make_tag_task(name)


def logging_enabled(tag_list):
    from .logging import _active

    return True if any(tag.name in _active for tag in tag_list or ()) else None


def log_line(context, display, tag_list):
    from .logging import log_event

    log_event(lambda: (str(one(context())), str(one(display()))), *[tag.name for tag in tag_list or ()])


define_face("CRAMHY", functions={
    operators: "top-level par pursue try-all try-in-order try-each-in-order par-loop",
    suspension: "on-suspension retry-after-suspension without-scheduling with-scheduling",
    tags: "prepare-tag execute-tag tag-outside-of-with-tags enter-with-tags",
    failures: "assert-no-returning assert-no-nlx",
    "named-top-level": named_top_level, "whenever": whenever, "with-failure-handling": with_failure_handling,
    "make-retry-counter": make_retry_counter, "use-retry": use_retry, "counter-value": counter_value, "reset-retry-counter": reset_counter,
    "counter-variable": counter_variable, "partial-order": partial_order, "with-parallel-childs": with_parallel_childs,
    "with-task-suspended": with_task_suspended, "with-task": with_task, "define-task-variable": define_task_variable,
    "cram-function-call": cram_function_call, "top-level-cram-function-call": top_level_cram_function_call, "note-plan": note_plan,
    "declare-goal": plans.declare_goal, "register-goal": plans.register_goal, "goal-call": goal_call, "make-policy": make_policy,
    "define-policy": define_policy, "policy-get": policy_get, "policy-set": policy_set, "with-policy": with_policy,
    "named-policy": policies.named_policy, "with-tree-node": with_tree_node, "cpl-parameter": cpl_parameter, "make-tag-task": make_tag_task,
    "parameter-value": parameter_value, "logging-enabled": logging_enabled, "log-line": log_line,
})

__all__ = ["truth"]
