"""Performing designators: process-modules.md section 11, invariants 32 to 40."""

import pytest
from designators.support import facts, lisp, make, python, user

from cramhy_runtime import cpl
from cramhy_runtime import process_modules as pm
from cramhy_runtime.designators.classes import DesignatorError
from cramhy_runtime.lisp_core.conditions import Error
from cramhy_runtime.lisp_core.data import MultipleValues, UndefinedFunction
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.process_modules import executive
from cramhy_runtime.process_modules.executive import DesignatorReferenceFailure

from .test_modules import NAVIGATION, define, with_modules

MATCHING = [[["cpm::matching-process-module", "?d", "test-navigation"]], [["cpm::available-process-module", "test-navigation"]]]
GROUNDING = [[["desig::motion-grounding", "?d", ["drive", "?speed"]], ["desig::desig-prop", "?d", [":speed", "?speed"]]]]


@pytest.fixture
def navigation():
    define(lambda designator: python(pm.executive.reference(designator)))
    with (
        facts("matching", ["cpm::matching-process-module", "cpm::available-process-module"], *MATCHING),
        facts("grounding", ["desig::motion-grounding"], *GROUNDING),
    ):
        yield


@pytest.fixture
def drawing():
    """An action whose grounding names the plan function DRAW-IT, which is undefined at first."""
    command = user("DRAW-IT")
    with facts(
        "drawing",
        ["desig::action-grounding"],
        [["desig::action-grounding", "?d", ["draw-it", "?shape"]], ["desig::desig-prop", "?d", [":shape", "?shape"]]],
    ):
        yield command
    command.function = UndefinedFunction(command)


def failure_of(body):
    with pytest.raises(cpl.PlanFailure) as problem:
        body()
    return problem.value


def test_a_motion_goes_to_the_matching_module(navigation):
    assert with_modules(lambda: pm.perform(make("motion", [":speed", 5]))) == ["DRIVE", 5]


def test_without_a_running_module_nothing_is_resolved(navigation):
    failure = failure_of(lambda: cpl.top_level(lambda: pm.perform(make("motion"))))
    assert failure.report() == "No matching process module found for #<A MOTION>"


def test_a_motion_that_cannot_be_resolved_says_so_and_is_both_failure_and_designator_error(navigation):
    failure = failure_of(lambda: with_modules(lambda: pm.perform(make("motion"))))
    assert failure.report() == "Designator #<A MOTION> could not be resolved.\nCannot perform motion."
    assert isinstance(failure, (cpl.PlanFailure, DesignatorError)) and "There is no property :speed" in failure.hint
    assert DesignatorReferenceFailure().report() == "designator-failure"


def test_an_action_calls_the_plan_function_with_what_was_ground(drawing):
    drawing.function = lambda shape: MultipleValues((shape.name, "drawn"))
    assert cpl.top_level(lambda: pm.perform(make("action", [":shape", ":house"]))) == ("HOUSE", "drawn")


def test_an_action_whose_plan_function_is_not_defined(drawing):
    failure = failure_of(lambda: cpl.top_level(lambda: pm.perform(make("action", [":shape", ":house"]))))
    assert failure.report() == (
        "Action designator `#<A ACTION\n    (SHAPE HOUSE)>' resolved to cram function `DRAW-IT', "
        "but it isn't defined. Cannot perform action."
    )


def test_an_action_whose_goal_does_not_hold_afterwards_fails(drawing):
    drawing.function = lambda shape: None
    action = make("action", [":shape", ":house"], [":goal", ["drawn", 1]])
    failure = failure_of(lambda: cpl.top_level(lambda: pm.perform(action)))
    assert failure.format_control == "Goal `~a' of action `~a' was not achieved."
    assert failure.format_arguments[0] is action


def test_a_goal_that_is_no_list_cannot_be_parsed(drawing):
    drawing.function = lambda shape: None
    failure = failure_of(lambda: cpl.top_level(lambda: pm.perform(make("action", [":shape", ":house"], [":goal", 5]))))
    assert failure.report().startswith("Designator goal 5 could not be parsed.\n")


def test_perform_is_a_node_of_the_task_tree_and_needs_a_plan(navigation):
    assert with_modules(lambda: cpl.par(lambda: pm.perform(make("motion", [":speed", 1])))) == ["DRIVE", 1]
    with pytest.raises(Error) as problem:
        executive.perform(make("motion"))
    assert "TASK-TREE-NODE" in problem.value.report()


def test_an_object_cannot_be_performed():
    with pytest.raises(Error) as problem:
        cpl.top_level(lambda: pm.perform(make("object")))
    assert "no applicable method" in problem.value.report() and lisp([]) is None and NAVIGATION is not None


# --------------------------------------------------------------------------------------------------- why there is no module


def advice(body):
    """What the failure of ``body`` tells the user, without the prefixes of packages."""
    with binding(PACKAGE, COMMON_LISP_USER):
        text = hint_for(failure_of(body))
    for package in ("cram-user::", "cram-designators:", "cram-process-modules:"):
        text = text.replace(package, "")
    return text


def test_a_module_that_matches_but_does_not_run_is_named(navigation):
    assert advice(lambda: cpl.top_level(lambda: pm.perform(make("motion", [":speed", 3])))) == (
        "test-navigation would do it, but does not run: write (with-process-modules-running (test-navigation) ...) around the plan."
    )


def test_without_a_module_that_matches_the_nearest_clause_is_told():
    with facts(
        "MATCHING",
        ["cpm::matching-process-module"],
        [["cpm::matching-process-module", "?d", "test-navigation"], ["desig::desig-prop", "?d", [":type", ":driving"]]],
    ):
        assert (
            advice(lambda: cpl.top_level(lambda: pm.perform(make("motion", [":type", ":drivng"]))))
            == """\
There is one clause, clause 1 of matching:
  (matching-process-module ?d test-navigation)
  FAILS  (desig-prop ?d (:type :driving))
           :type is :drivng, not :driving; is that misspelled?
  with ?d = #<a motion (type drivng)>
(prolog:explain) tries it again and tells all of it."""
        )


def test_a_module_that_is_not_available_is_told():
    with facts(
        "MATCHING",
        ["cpm::matching-process-module", "cpm::available-process-module"],
        [["cpm::matching-process-module", "?d", "test-navigation"]],
        [["cpm::available-process-module", "other"]],
    ):
        assert (
            advice(lambda: cpl.top_level(lambda: pm.perform(make("motion", [":type", ":driving"]))))
            == """\
test-navigation would match, but there is no solution of (available-process-module test-navigation).
The only clause of available-process-module does not match: in clause 1 of matching, argument 1 is other, not test-navigation.
(prolog:explain) tries it again and tells all of it."""
        )
