"""Plan functions and goals: functions that run as tasks of their own, at a place in the task tree.

A plan function is called like any function. Each call is a node ``(name)`` below the caller's path and a new task, whose values or
failure the caller gets. A goal is a plan function with several bodies: the first body whose pattern matches the arguments runs.
Source: cpl.md section 8. A call outside of ``top-level`` is a type error, as in the original, and the error says so.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.utilities import patterns
from cramhy_runtime.lisp_core import condition_types as types
from cramhy_runtime.lisp_core.conditions import error, style_warn, type_error
from cramhy_runtime.lisp_core.data import Cons, Symbol, all_values, lisp_list, list_from, truth
from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.lisp_core.packages import keyword, redefined
from ..hooks import on_def_top_level_plan_hook
from .operators import named_top_level
from ..symbols import sym
from ..tree.task_tree import replaceable_function, with_task_tree_node

GOAL = sym("CPL-IMPL::GOAL")
TOP_LEVEL = sym("CPL-IMPL::TOP-LEVEL")
REPLACEABLE_FUNCTION = sym("CPL-IMPL::REPLACEABLE-FUNCTION")
PROPERTIES = {name: sym(f"CPL-IMPL::{name}") for name in ("PLAN-TYPE", "PLAN-LAMBDA-LIST", "PLAN-SEXP")}
"""The properties of a plan function's name: its kind (``:plan`` or ``:top-level-plan``), its lambda list, its body."""

_expressions = per_image({})  # name of a plan function → (lambda list, what is recorded at the nodes of its calls)
_goals = per_image({})


def call_cram_function(name, function, arguments):
    """Call the plan function ``name``: ``function(*arguments)`` in a new task at ``(name)`` below the current path. Returns its values.

    ``arguments`` is a Python sequence. A wrong number of arguments is an error of the new task.
    """
    lambda_list, sexp = _expressions.get(name, _UNKNOWN)
    return replaceable_function(name, lambda_list, list_from(arguments), lisp_list(name), function, sexp)


def call_top_level_cram_function(name, function, arguments):
    """As `call_cram_function`, inside a top-level called ``name``, whose tree is kept under that name."""
    lambda_list, sexp = _expressions.get(name, _UNKNOWN)
    return named_top_level(
        lambda: replaceable_function(name, lambda_list, list_from(arguments), lisp_list(TOP_LEVEL, name), function, sexp), name
    )


_UNKNOWN = (None, None)


def define_plan(name, kind, lambda_list=None, body=None):
    """Note on the property list of the symbol ``name`` that its function, just defined, is a plan. Returns ``name``.

    ``kind`` is "PLAN" or "TOP-LEVEL-PLAN". Programs that inspect plans read the property list.
    """
    for indicator, value in (("PLAN-SEXP", body), ("PLAN-LAMBDA-LIST", lambda_list), ("PLAN-TYPE", keyword(kind))):
        cell = _property_cell(name, PROPERTIES[indicator])
        if cell is not None:
            cell.car = value
        else:
            redefined(name)
            name.plist = Cons(PROPERTIES[indicator], Cons(value, name.plist))
    _expressions[name] = (lambda_list, Cons(REPLACEABLE_FUNCTION, Cons(name, Cons(lambda_list, body))))
    if kind == "TOP-LEVEL-PLAN" and on_def_top_level_plan_hook:
        on_def_top_level_plan_hook(name)
    return name


def plan_property(name, indicator):
    """The property ``indicator`` (see `PROPERTIES`) of the plan function ``name``; nil if ``name`` is not a plan function."""
    cell = _property_cell(name, PROPERTIES[indicator]) if isinstance(name, Symbol) else None
    return cell.car if cell is not None else None


def _property_cell(symbol, indicator):
    cell = symbol.plist
    while isinstance(cell, Cons):
        if cell.car is indicator:
            return cell.cdr
        cell = cell.cdr.cdr
    return None


class GoalBody:
    """One body of a goal: the pattern of the calls that it is for, a function of the bindings, and the doc string."""

    __slots__ = ("pattern", "variables", "function", "documentation", "sexp")

    def __init__(self, pattern, function, documentation, sexp):
        self.pattern, self.function, self.documentation, self.sexp = pattern, function, documentation, sexp
        self.variables = patterns.vars_in(pattern)

    def match(self, arguments):
        """The bindings under which the pattern equals ``arguments``, and whether it matches."""
        return all_values(patterns.pat_match(self.pattern, arguments))

    def values(self, bindings):
        """The values of the variables, a list in the order of ``vars-in``."""
        value = patterns.var_value
        return list_from([value(variable, bindings) for variable in self.variables or ()])


class Goal:
    """The bodies of a goal, in order of definition."""

    def __init__(self):
        self.bodies = []


def declare_goal(name):
    """Forget all bodies of the goal ``name``. ``declare-goal`` calls this when it has defined the function."""
    _goals[name] = Goal()
    return name


def register_goal(name, pattern, goal_fun, doc_string=None):
    """``(register-goal name pattern goal-fun)``: add a body for calls that match ``pattern``. ``goal_fun`` takes the bindings."""
    return define_goal(name, pattern, goal_fun, doc_string)


def define_goal(name, pattern, function, documentation=None, sexp=None):
    """Add a body to the goal ``name``, for ``def-goal``. A body with an equal pattern is replaced in its place, with a style warning.

    ``function`` takes the list of bindings. ``sexp`` is the form that the nodes of its calls record.
    """
    bodies = _goals.setdefault(name, Goal()).bodies
    body = GoalBody(pattern, function, documentation, sexp)
    for index, known in enumerate(bodies):
        if truth(equal(known.pattern, pattern)):
            style_warn("Redefining goal `~a'", Cons(name, pattern))
            bodies[index] = body
            return name
    bodies.append(body)
    return name


def call_goal(name, arguments):
    """Run the first body of the goal ``name`` whose pattern matches ``arguments`` (a Lisp list), in a new task. Returns its values.

    If no pattern matches, it is an error. Source: cpl.md 8.5.
    """
    for body in bodies_of(name):
        bindings, matched = body.match(arguments)
        if matched:
            return with_task_tree_node(
                lisp_list(GOAL, Cons(name, body.pattern)),
                lambda *values: body.function(bindings),
                name=lambda: f"[GOAL-{name.name}]",
                sexp=body.sexp,
                lambda_list=body.variables,
                parameters=body.values(bindings),
                log_parameters=arguments,
                log_pattern=body.pattern,
                called_with=arguments,
            )
    patterns = [prin1_to_string(Cons(name, body.pattern)) for body in bodies_of(name)]
    hint = (
        f"Bodies are defined for {', '.join(patterns)}."
        if patterns
        else f"No body is defined: write (def-goal ({name.name.lower()} ...) ...)."
    )
    return error(types.SimpleError("No goal found that matches arguments: ~a ~a", name, arguments), hint=hint)


def bodies_of(name):
    """The bodies (`GoalBody`) of the goal ``name``, in the order in which they are tried."""
    return _goals[name].bodies if name in _goals else ()


def describe_goal(goal):
    """The doc string of the body of ``goal``, a list ``(name . pattern)``, or nil. The names of variables may differ."""
    if not isinstance(goal, Cons):
        return type_error(goal, "CONS", "\n(A goal is a list (name argument...), as in (describe-goal '(at ?x)).)")
    same = patterns.patterns_eq
    for body in bodies_of(goal.car):
        if body.pattern is None or goal.cdr is None:
            found = body.pattern is goal.cdr
        else:
            found = same(body.pattern, goal.cdr)
        if found:
            return body.documentation
    return None
