"""Plan functions and goals: functions that run as tasks of their own, at a place in the task tree.

A plan function is called like any function; each call is a node ``(name)`` below the caller's path and a new task, whose values
or failure the caller gets. A goal is a plan function with several bodies, chosen by matching its arguments against patterns, in
the order of their definition. Source: cpl.md section 8. A call outside of ``top-level`` is a type error, as in the original, that
says so.
"""

from __future__ import annotations

from ..lisp.conditions import error, style_warn
from ..lisp.data import Cons, all_values, lisp_list, list_from
from ..lisp.packages import keyword
from .hooks import on_def_top_level_plan_hook
from .operators import named_top_level
from .symbols import sym
from .tree import replaceable_function, with_task_tree_node

GOAL = sym("CPL-IMPL::GOAL")
TOP_LEVEL = sym("CPL-IMPL::TOP-LEVEL")
_PLAN_TYPE, _LAMBDA_LIST, _SEXP = sym("CPL-IMPL::PLAN-TYPE"), sym("CPL-IMPL::PLAN-LAMBDA-LIST"), sym("CPL-IMPL::PLAN-SEXP")
_goals = {}


def call_cram_function(name, function, arguments, lambda_list=None, sexp=None):
    """A call of the plan function ``name``: ``function(*arguments)`` in a new task at ``(name)`` below the current path.

    ``arguments`` is a Python sequence; a wrong number of them is an error of the new task.
    """
    return replaceable_function(name, lambda_list, list_from(arguments), lisp_list(name), function, sexp)


def call_top_level_cram_function(name, function, arguments, lambda_list=None, sexp=None):
    """As `call_cram_function`, inside a top-level called ``name``; the tree is kept under that name."""
    def body():
        return with_task_tree_node(lisp_list(TOP_LEVEL, name), function, name=lambda: f"[REPLACEABLE-FUNCTION-{name.name}]",
                                   sexp=sexp, lambda_list=lambda_list, parameters=list_from(arguments))

    return named_top_level(body, name)


def note_plan(name, kind, lambda_list=None, sexp=None):
    """Note on the symbol ``name`` that it is a plan: ``kind`` is "PLAN" or "TOP-LEVEL-PLAN". Returns ``name``."""
    for indicator, value in ((_SEXP, sexp), (_LAMBDA_LIST, lambda_list), (_PLAN_TYPE, keyword(kind))):
        _put(name, indicator, value)
    if kind == "TOP-LEVEL-PLAN" and on_def_top_level_plan_hook:
        on_def_top_level_plan_hook(name)
    return name


def _put(symbol, indicator, value):
    cell = symbol.plist
    while isinstance(cell, Cons):
        if cell.car is indicator:
            cell.cdr.car = value
            return
        cell = cell.cdr.cdr
    symbol.plist = Cons(indicator, Cons(value, symbol.plist))


class Goal:
    """The bodies of a goal: pattern, function of the bindings, doc string; in order of definition."""

    def __init__(self):
        self.bodies = []


def declare_goal(name):
    """Forget all bodies of the goal ``name``; what ``declare-goal`` does before it defines the function."""
    _goals[name] = Goal()
    return name


def register_goal(name, pattern, function, documentation=None):
    """Add a body for calls that match ``pattern``; an equal pattern is replaced in place, with a style warning.

    ``function`` takes the list of bindings.
    """
    bodies = _goals.setdefault(name, Goal()).bodies
    equal = sym("EQUAL").function
    for index, (known, _, _) in enumerate(bodies):
        if equal(known, pattern):
            style_warn("Redefining goal `~a'", Cons(name, pattern))
            bodies[index] = (pattern, function, documentation)
            return name
    bodies.append((pattern, function, documentation))
    return name


def call_goal(name, arguments):
    """Run the first body of the goal ``name`` whose pattern matches ``arguments`` (a Lisp list), in a new task: its values."""
    match = sym("CUT::PAT-MATCH").function
    for pattern, function, _ in _goals[name].bodies if name in _goals else ():
        bindings, matched = all_values(match(pattern, arguments))
        if matched:
            return with_task_tree_node(lisp_list(GOAL, Cons(name, pattern)), function, name=lambda: f"[GOAL-{name.name}]",
                                       lambda_list=None, parameters=lisp_list(bindings), log_parameters=arguments,
                                       log_pattern=pattern)
    return error("No goal found that matches arguments: ~a ~a", name, arguments)


def describe_goal(goal):
    """The doc string of the body whose pattern equals that of ``goal`` = ``(name . pattern)`` but for variable names, or nil."""
    same = sym("CUT::PATTERNS-EQ").function
    for pattern, _, documentation in _goals[goal.car].bodies if goal.car in _goals else ():
        if same(pattern, goal.cdr):
            return documentation
    return None
