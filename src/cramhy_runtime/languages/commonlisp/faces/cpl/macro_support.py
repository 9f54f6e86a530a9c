"""What the macros of the plan language call, as functions of the package CRAMHY.

The macros (``hy_src/cramhy/cpl.hy``) turn branches into functions of no arguments and pass lists as Lisp lists; here these become
what the functions of this room take. Nothing else happens here.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol, python_list
from ...packages.face_definition import define_face
from ...objects.classes import find_class
from cramhy_runtime.cpl.failures import handling as failures, retry_counters
from cramhy_runtime.cpl.fluents import operators as fluent_operators
from cramhy_runtime.cpl import logging, task_variables
from cramhy_runtime.cpl.forms import operators, plans, policies
from cramhy_runtime.cpl.tasks import suspension, waiting
from cramhy_runtime.cpl.tree import tags, task_tree as tree
from cramhy_runtime.cpl.symbols import sym


def partial_order(steps, orderings):
    """``orderings()`` gives a list of lists (before after)."""
    return operators.partial_order(python_list(steps), lambda: [tuple(pair) for pair in python_list(orderings())])


def with_task(cls, name, body):
    """``cls``: a class of tasks, or its name."""
    return operators.with_task(body, name, find_class(cls) if isinstance(cls, Symbol) else cls)


def with_parallel_childs(name, thunks, watcher):
    return operators.with_parallel_childs(name, python_list(thunks), watcher)


def with_tree_node(path_part, function, name, sexp, lambda_list, parameters, log_parameters, log_pattern):
    return tree.with_task_tree_node(
        path_part,
        function,
        name=name,
        sexp=sexp,
        lambda_list=lambda_list,
        parameters=parameters,
        log_parameters=log_parameters,
        log_pattern=log_pattern,
    )


def cram_function_call(name, function, arguments):
    return plans.call_cram_function(name, function, python_list(arguments))


def top_level_cram_function_call(name, function, arguments):
    return plans.call_top_level_cram_function(name, function, python_list(arguments))


def _clauses(clauses):
    return {clause.car.name.lower().replace("-", "_"): clause.cdr.car for clause in python_list(clauses)}


def make_policy(name, parameters, documentation, clauses):
    """``clauses`` is a list of lists (keyword function)."""
    return policies.make_policy(name, parameters, documentation, **_clauses(clauses))


def define_policy(name, parameters, documentation, clauses):
    return policies.define_policy(name, parameters, documentation, **_clauses(clauses))


def with_policy(policy, arguments, forms, body):
    """``arguments()`` gives the list of the parameters' values."""
    return policies.with_policy(policy, lambda: python_list(arguments()), body, forms)


FUNCTIONS = {
    "retry-counter": retry_counters.known_counter,
    "assert-no-returning": failures.assert_no_returning,
    "assert-no-nlx": failures.assert_no_nlx,
    "top-level": operators.top_level,
    "named-top-level": lambda name, body: operators.named_top_level(body, name),
    "par": operators.par,
    "pursue": operators.pursue,
    "try-all": operators.try_all,
    "try-in-order": operators.try_in_order,
    "try-each-in-order": operators.try_each_in_order,
    "par-loop": operators.par_loop,
    "partial-order": partial_order,
    "with-parallel-childs": with_parallel_childs,
    "with-task": with_task,
    "with-task-suspended": lambda task, reason, body: suspension.with_task_suspended(task, body, reason),
    "whenever": waiting.whenever,
    "cpl-parameter": fluent_operators.define_cpl_parameter,
    "parameter-value": fluent_operators.parameter_value,
    "on-suspension": suspension.on_suspension,
    "retry-after-suspension": suspension.retry_after_suspension,
    "without-scheduling": suspension.without_scheduling,
    "with-scheduling": suspension.with_scheduling,
    "define-task-variable": lambda name, init: task_variables.define_task_variable(name, name.value, init_function=init),
    "with-failure-handling": failures.handling_failures,
    "retry": failures.Handling.__call__,
    "make-retry-counter": retry_counters.RetryCounter,
    "use-retry": lambda counter: counter.use(),
    "counter-value": lambda counter: counter.left,
    "reset-retry-counter": lambda counter: counter.reset(),
    "enter-with-tags": tags.enter_with_tags,
    "make-tag-task": tags.make_tag_task,
    "prepare-tag": tags.prepare_tag,
    "execute-tag": tags.execute_tag,
    "with-tree-node": with_tree_node,
    "cram-function-call": cram_function_call,
    "top-level-cram-function-call": top_level_cram_function_call,
    "define-plan": plans.define_plan,
    "declare-goal": plans.declare_goal,
    "goal-call": plans.call_goal,
    "define-goal": plans.define_goal,
    "policy-get": lambda store, symbol: store.get(symbol),
    "policy-set": lambda store, symbol, value: store.set(symbol, value),
    "make-policy": make_policy,
    "define-policy": define_policy,
    "with-policy": with_policy,
    "named-policy": policies.named_policy,
    "log-event": logging.log_event,
    "logging-enabled": logging.logging_enabled_p,
    "define-log-tags": logging.define_log_tags,
}


def define():
    """Enter the functions into CRAMHY."""
    define_face("CRAMHY", functions=FUNCTIONS)
    sym("CRAMHY::PARAMETER-VALUE").setf_function = fluent_operators.set_parameter_value
