"""The executive: ``perform`` a designator (process-modules.md section 8).

A motion goes to a matching process module. An action is resolved to a plan function and its arguments, and the function is called. Each
``perform`` is a node of the task tree. An action with a ``:goal`` is left out if the goal holds already; otherwise it must achieve it.
"""

from __future__ import annotations

from cramhy_runtime.cpl.failures.failure_types import SimplePlanFailure
from cramhy_runtime.cpl.failures.handling import fail, fail_with_advice
from cramhy_runtime.cpl.forms.plans import GOAL, bodies_of, call_goal, define_goal, plan_property
from cramhy_runtime.cpl.tree.task_tree import with_task_tree_node
from ..designators.classes import ActionDesignator, DesignatorError, MotionDesignator, desig_prop_value, pairs_of
from ..designators.resolution import reference
from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime import kernel
from cramhy_runtime.kernel.images import Cell
from cramhy_runtime.lisp_core.catching import CATCHABLE, Case, caught
from cramhy_runtime.lisp_core.conditions import Error, handler_case, warn
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, MultipleValues, Symbol, UndefinedFunction, lisp_list, one, python_list, truth
from cramhy_runtime.lisp_core.functions import check_shape, function_of
from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.source_places import circumstance
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.lisp_core.packages import keyword
from ..occasions.occasions import holds
from .hints import why_none_runs
from .matching import execute_by, running_matches
from .registry import in_brief
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from .symbols import sym

if TYPE_CHECKING:
    from collections.abc import Callable
    from cramhy_runtime.lisp_core.signatures import GenericOf
    from ..designators.classes import Designator

GOAL_KEY = keyword("GOAL")
PERFORM = sym("EXE::PERFORM")
_PATTERN = lisp_list(sym("EXE::?DESIGNATOR"))
_PATH_PART = lisp_list(GOAL, Cons(PERFORM, _PATTERN))
_GOAL_SHAPE = lisp_list(sym("EXE::OCCASION"), sym("&REST"), sym("EXE::PARAMS"))
_COMMAND_SHAPE = lisp_list(sym("EXE::COMMAND"), sym("&REST"), sym("EXE::ARGUMENTS"))


class DesignatorReferenceFailure(SimplePlanFailure, DesignatorError):
    """A designator cannot be resolved, so it cannot be performed. It is both a plan failure and an error."""

    lisp_name = "CRAM-EXECUTIVE::DESIGNATOR-REFERENCE-FAILURE"
    initargs = {**DesignatorError.initargs, "RESULT": "result"}
    result: Any = None

    def report(self) -> str:
        return "designator-failure" if self.format_control is UNBOUND else SimplePlanFailure.report(self)


class DesignatorGoalParsingFailure(SimplePlanFailure, DesignatorError):
    """The goal of an action designator is not a list. It is both a plan failure and an error."""

    lisp_name = "CRAM-EXECUTIVE::DESIGNATOR-GOAL-PARSING-FAILURE"
    initargs = DesignatorReferenceFailure.initargs
    result: Any = None
    hint = "A goal is a list (occasion parameter ...), given to the designator in a ?variable."

    def report(self) -> str:
        return "designator-goal-parsing-failure" if self.format_control is UNBOUND else SimplePlanFailure.report(self)


generic_perform: GenericOf[[Designator], Any] = generic(
    "EXE::GENERIC-PERFORM",
    "(designator)",
    documentation="""
Perform a motion or action designator. ``perform`` calls it in a task of its own.""",
)


generic_perform.advice = (
    "What can be performed are motions and actions, (desig:a motion ...) and (desig:an action ...), and what a "
    "(defmethod exe:generic-perform ((designator ...)) ...) is for."
)


def perform(designator: Designator) -> Any:
    """Perform ``designator`` as a goal, and return the values of the process module or plan function.

    Fails with a plan failure if no module matches and runs, if the designator cannot be resolved, or if its plan function is not defined.
    Outside of a plan it is an error. Source: process-modules.md section 8.
    """
    if bodies_of(PERFORM)[0] is not _own_body:  # somebody has defined the goal anew
        return call_goal(PERFORM, lisp_list(designator))
    parameters = lisp_list(designator)
    return with_task_tree_node(
        _PATH_PART,
        _perform,
        name=_goal_name,
        parameters=parameters,
        log_parameters=parameters,
        log_pattern=_PATTERN,
        called_with=parameters,
    )


def _goal_name() -> str:
    return "[GOAL-PERFORM]"


def _perform(designator):
    return generic_perform(designator)


define_goal(PERFORM, _PATTERN, lambda bindings: generic_perform(bindings.car.cdr), "Perform a motion or action designator.")
_own_body = bodies_of(PERFORM)[0]


user_reference: Cell[Callable[..., Any] | None] = Cell(None)
"""The generic function ``try-reference-designator``, when users have defined methods on it."""


def reference_through(generic: Callable[..., Any]) -> None:
    """Let `try_reference_designator` call ``generic`` from now on, a generic function with methods of users."""
    user_reference.value = generic


def try_reference_designator(designator: Designator, error_message: str = "") -> Any:
    """Resolve ``designator`` and return its reference. If that is impossible, fail with ``designator-reference-failure``.

    ``error_message`` is a part of its text.
    """
    if user_reference.value is not None:
        return user_reference.value(designator, *([error_message] if error_message else []))
    return plain_reference(designator, error_message)


def plain_reference(designator: Designator, error_message: str = "") -> Any:
    """`try_reference_designator` without the methods of users."""
    task = kernel.current()
    task.handlers = run = _REFUSED, task.handlers
    try:
        return reference(designator)
    except CATCHABLE as exception:
        problem = caught(exception, run)[1]
    finally:
        task.handlers = run[1]
    failure = DesignatorReferenceFailure("Designator ~a could not be resolved.~%~a", designator, error_message)
    failure.about = problem.about
    return fail(failure)


_REFUSED = Case(lisp_list(DesignatorError))
try_reference_designator.__lisp_lambda_list__ = lisp_list(
    sym("DESIG::DESIGNATOR"), sym("&OPTIONAL"), lisp_list(sym("EXE::ERROR-MESSAGE"), "")
)


@generic_perform.method(MotionDesignator)
def _perform_motion(designator):
    modules = running_matches(designator)
    if not modules:
        return fail_with_advice(lambda: why_none_runs(designator), "No matching process module found for ~a", designator)
    try_reference_designator(designator, "Cannot perform motion.")
    return execute_by(modules, designator)


@generic_perform.method(ActionDesignator)
def _perform_action(designator):
    goal = desig_prop_value(designator, GOAL_KEY)
    if isinstance(goal, Cons) and _goal_holds(goal):
        return warn(SimpleWarning("Action goal `~a' already achieved.", goal))
    solution = try_reference_designator(designator)
    command = _command(designator, solution)
    if not isinstance(command, Symbol) or (isinstance(command.function, UndefinedFunction) and command.macro is None):
        return fail(
            "Action designator `~a' resolved to cram function `~a', but it isn't defined. Cannot perform action.", designator, command
        )
    by_keywords = _takes_properties(solution)
    call = _call_plan_with_properties if by_keywords else _call_plan
    if goal is None:
        return call(designator, solution)
    _check_goal(goal)
    result = call(designator, solution)
    if not _goal_holds(goal):
        if by_keywords:
            warn("Goal `~a' of action `~a' was not achieved.", goal, designator)
            return one(result)
        return fail("Goal `~a' of action `~a' was not achieved.", designator, goal)
    return one(result) if by_keywords else None


def _takes_properties(solution: Cons) -> bool:
    """Whether a grounding is of the form ``(plan designator)`` for a plan that takes keywords only, as since CRAM's branch devel.

    Before, the designator itself was the argument; a plan that takes an argument still gets it.
    """
    rest = solution.cdr
    if not isinstance(rest, Cons) or rest.cdr is not None or not isinstance(rest.car, ActionDesignator):
        return False
    parameters = python_list(PORTS.definitions.lambda_list(solution.car.function) or None)
    if parameters and getattr(parameters[0], "name", "") == "&REST" and plan_property(solution.car, "PLAN-TYPE") is not None:
        parameters = python_list(plan_property(solution.car, "PLAN-LAMBDA-LIST"))  # its function hands all on to the plan's task
    return bool(parameters) and getattr(parameters[0], "name", "") == "&KEY"


def call_plan_with_designator_properties(plan: Any, designator: Designator) -> MultipleValues:
    """Call ``plan``, a function or its name, with the properties of ``designator`` as keyword arguments.

    Returns two values: the plan's, and the designator. The first of two properties with one key counts.
    """
    arguments = [item for pair in pairs_of(designator) for item in (pair.car, pair.cdr.car if pair.cdr is not None else None)]
    return MultipleValues((one(function_of(plan)(*arguments)), designator))


_told_with_the_grounding = circumstance(
    lambda here: f"while {in_brief(here['designator'])} was performed, whose grounding is {in_brief(here['solution'])}"
)


@_told_with_the_grounding
def _command(designator, solution):
    check_shape(solution, 1, None, "DESTRUCTURING-BIND", _COMMAND_SHAPE)
    return solution.car


@_told_with_the_grounding
def _call_plan(designator, solution):
    return solution.car.function(*(solution.cdr or ()))


_call_plan_with_properties = _told_with_the_grounding(
    lambda designator, solution: call_plan_with_designator_properties(solution.car, solution.cdr.car)
)


def _check_goal(goal):
    def refused(problem):
        return fail(DesignatorGoalParsingFailure("Designator goal ~a could not be parsed.~%~a", goal, problem))

    handler_case([(Error, refused)], lambda: check_shape(goal, 1, None, "DESTRUCTURING-BIND", _GOAL_SHAPE))


def _goal_holds(goal):
    return truth(one(holds(goal)))
