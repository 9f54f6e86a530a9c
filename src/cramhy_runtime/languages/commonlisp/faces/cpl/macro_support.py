"""What the macros of the plan language call, as functions of the package CRAMHY.

The templates of ``languages/operators/plan_language.py``, and ``hy_src/cramhy/cpl.hy``, turn branches into functions of no arguments and
pass lists as Lisp lists; here these become what the functions of the room take. A function that takes them as they come stands in its room
alone.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import Symbol, python_list
from ....operators import PLAN_LANGUAGE, UTILITIES
from ...packages.face_definition import define_face, define_meanings
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


def define_task_variable(name, init):
    """``init``: a function of no arguments that gives each task its value, or nil."""
    return task_variables.define_task_variable(name, name.value, init_function=init)


def define():
    """Enter the functions into CRAMHY."""
    define_meanings(
        PLAN_LANGUAGE,
        failures,
        retry_counters,
        fluent_operators,
        logging,
        operators,
        plans,
        policies,
        suspension,
        waiting,
        tags,
        tree,
        adapters=sys.modules[__name__],
    )
    define_meanings(UTILITIES, failures)
    define_face(
        "CRAMHY",
        functions={
            retry_counters: "known-counter",
            failures: "handling-failures",
            fluent_operators: "define-cpl-parameter parameter-value",
            tags: "enter-with-tags make-tag-task prepare-tag execute-tag",
            plans: "define-plan define-goal call-goal",
            policies: "named-policy",
            "retry": failures.Handling.__call__,
            "make-retry-counter": retry_counters.RetryCounter,
            "use-retry": lambda counter: counter.use(),
            "counter-value": lambda counter: counter.left,
            "reset-retry-counter": lambda counter: counter.reset(),
            "policy-get": lambda store, symbol: store.get(symbol),
            "policy-set": lambda store, symbol, value: store.set(symbol, value),
        },
    )
    sym("CRAMHY::PARAMETER-VALUE").setf_function = fluent_operators.set_parameter_value
