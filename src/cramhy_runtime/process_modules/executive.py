"""The executive: ``perform`` a designator (process-modules.md section 8).

A motion goes to a matching process module; an action is resolved to a plan function and its arguments, which is called. Each
``perform`` is a node of the task tree. An action with a ``:goal`` is not done when the goal holds already, and must make it hold.
"""

from __future__ import annotations

from ..cpl.failure_types import SimplePlanFailure
from ..cpl.failures import fail
from ..cpl.plans import GOAL
from ..cpl.tree import with_task_tree_node
from ..designators.classes import ActionDesignator, DesignatorError, MotionDesignator, desig_prop_value
from ..designators.resolution import reference
from ..lisp.conditions import handler_case, type_error, warn
from ..lisp.data import UNBOUND, Cons, Symbol, UndefinedFunction, lisp_list
from ..lisp.objects.generic import generic
from ..lisp.packages import find_package, keyword
from ..prolog.query import holds
from .matching import execute_by, running_matches
from .symbols import sym

GOAL_KEY = keyword("GOAL")
_PATH_PART = lisp_list(GOAL, lisp_list(sym("EXE::PERFORM"), sym("EXE::?DESIGNATOR")))


class DesignatorReferenceFailure(SimplePlanFailure, DesignatorError):
    """A designator to be performed cannot be resolved. A plan failure and an error."""

    lisp_name = "CRAM-EXECUTIVE::DESIGNATOR-REFERENCE-FAILURE"
    initargs = {**DesignatorError.initargs, "RESULT": "result"}
    result = None
    bare = "designator-failure"

    def report(self):
        return self.bare if self.format_control is UNBOUND else SimplePlanFailure.report(self)


class DesignatorGoalParsingFailure(DesignatorReferenceFailure):
    """The goal of an action designator is not a list. (In the original a sibling of the above, with the same superclasses.)"""

    lisp_name = "CRAM-EXECUTIVE::DESIGNATOR-GOAL-PARSING-FAILURE"
    bare = "designator-goal-parsing-failure"


generic_perform = generic("EXE::GENERIC-PERFORM", "(designator)", documentation="""
Perform a motion or action designator; called by perform in a task of its own.""")


def perform(designator):
    """Perform ``designator`` as a goal: the values of the process module or plan function. Only inside of a plan."""
    return with_task_tree_node(_PATH_PART, generic_perform, name=_goal_name, parameters=lisp_list(designator),
                               log_parameters=lisp_list(designator), log_pattern=_PATH_PART.cdr.car.cdr)


def _goal_name():
    return "[GOAL-PERFORM]"


def try_reference_designator(designator, error_message=""):
    """Resolve ``designator``; if that cannot be, fail with ``designator-reference-failure`` and ``error_message`` in the text."""

    def refused(problem):
        failure = DesignatorReferenceFailure("Designator ~a could not be resolved.~%~a", designator, error_message)
        failure.about = problem.about
        return fail(failure)

    return handler_case([(DesignatorError, refused)], lambda: reference(designator))


@generic_perform.method(MotionDesignator)
def _perform_motion(designator):
    modules = running_matches(designator)
    if not modules:
        return fail("No matching process module found for ~a", designator)
    try_reference_designator(designator, "Cannot perform motion.")
    return execute_by(modules, designator)


@generic_perform.method(ActionDesignator)
def _perform_action(designator):
    solution = try_reference_designator(designator)
    if not isinstance(solution, Cons):
        return type_error(solution, "LIST")
    command, arguments = solution.car, solution.cdr
    if not isinstance(command, Symbol) or (isinstance(command.function, UndefinedFunction) and command.macro is None):
        return fail("Action designator `~a' resolved to cram function `~a', but it isn't defined. Cannot perform action.",
                    designator, command)
    goal = desig_prop_value(designator, GOAL_KEY)
    if goal is None:
        return command.function(*(arguments or ()))
    if not isinstance(goal, Cons):
        return fail(DesignatorGoalParsingFailure("Designator goal ~a could not be parsed.~%~a", goal,
                                                 "A goal is a list (occasion parameter ...), given in a ?variable."))
    if _goal_holds(goal):
        warn("Action goal `~a' already achieved.", goal)
    else:
        command.function(*(arguments or ()))
    if not _goal_holds(goal):
        return fail("Goal `~a' of action `~a' was not achieved.", designator, goal)
    return None


def _goal_holds(goal):
    package = find_package("CRAM-OCCASIONS-EVENTS")
    return package is not None and holds(lisp_list(package.intern("HOLDS"), goal))


