"""Law 3: a form fails with one failure, and the others of its branches are told with it, or as a warning when nobody can take them."""

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl import CompositeFailure, PlanFailure, SimplePlanFailure
from cramhy_runtime.lisp_core.conditions import handler_bind, muffle_warning, types
from cramhy_runtime.languages.commonlisp.tools.advice import explanation, hint_for


def failing(text, after=0):
    def branch():
        cpl.sleep(after)
        cpl.fail(text)

    return branch


def failing_in_cleanup(text):
    def branch():
        try:
            cpl.sleep(100)
        finally:
            cpl.fail(text)

    return branch


def failure_of(*branches, form=cpl.par):
    with pytest.raises(PlanFailure) as caught:
        cpl.top_level(lambda: form(*branches))
    return caught.value


def texts(failure):
    return [str(other) for _, other in failure.beside]


def warnings_of(plan):
    """What ``plan`` warned of, and its values."""
    heard = []

    def hear(warning):
        heard.append(str(warning))
        muffle_warning(warning)

    values = cpl.top_level(lambda: handler_bind([(types.Warning_, hear)], plan))
    return heard, values


def test_the_failures_of_the_other_branches_come_along():
    failure = failure_of(failing("first"), failing("second"), failing("third"))
    assert str(failure) == "third"
    assert texts(failure) == ["first", "second"]


def test_a_failure_in_the_cleanup_of_an_ended_branch_comes_along():
    failure = failure_of(failing("bumped", after=1), failing_in_cleanup("the brake is stuck"))
    assert str(failure) == "bumped"
    assert texts(failure) == ["the brake is stuck"]


def test_failures_of_every_level_are_gathered_once_each():
    inner = [failing("inner", after=1), failing_in_cleanup("inner cleanup")]
    failure = failure_of(lambda: cpl.par(*inner), failing_in_cleanup("outer cleanup"))
    assert str(failure) == "inner"
    assert texts(failure) == ["inner cleanup", "outer cleanup"]


def test_an_error_and_a_plan_failure_are_told_with_each_other():
    def broken():
        raise ZeroDivisionError("a bug")

    def plan():
        return cpl.par(failing("lost"), broken)

    with pytest.raises(ZeroDivisionError) as caught:
        cpl.top_level(plan)
    assert hint_for(caught.value).splitlines()[-1].startswith("[PAR-CHILD-#1/2]-")
    assert "failed too: lost." in explanation(caught.value)


def test_a_form_that_fails_alone_has_nothing_beside_it():
    failure = failure_of(failing("alone"), lambda: 1)
    assert not hasattr(failure, "beside")
    assert hint_for(failure) is None


def test_a_composite_failure_names_its_failures():
    failure = failure_of(failing("a"), failing("b"), form=cpl.try_in_order)
    assert isinstance(failure, CompositeFailure)
    assert [line.split(" (at")[0] for line in hint_for(failure).splitlines()] == ["Failure 1 of 2: a.", "Failure 2 of 2: b."]


def test_what_fails_beside_a_composite_failure_is_told_after_its_parts():
    failure = failure_of(lambda: cpl.try_in_order(failing("a"), failing("b")), failing_in_cleanup("cleanup"))
    assert isinstance(failure, CompositeFailure) and texts(failure) == ["a", "b", "cleanup"]
    assert [str(part) for part in failure.failures] == ["a", "b"]


def test_more_than_three_failures_are_counted():
    failure = failure_of(*[failing(str(number)) for number in range(6)])
    assert hint_for(failure).splitlines()[-1] == "and 2 more failures"


def test_a_cleanup_that_fails_after_try_all_succeeded_is_a_warning():
    heard, values = warnings_of(lambda: cpl.try_all(failing_in_cleanup("the brake is stuck"), lambda: cpl.sleep(1) or "there"))
    assert values == "there"
    assert len(heard) == 1 and heard[0].endswith("failed while it was ended: the brake is stuck")


def test_what_try_all_is_made_to_ignore_is_no_warning():
    heard, values = warnings_of(lambda: cpl.try_all(failing("a"), lambda: "there"))
    assert (heard, values) == ([], "there")


def test_who_handles_a_failure_has_handled_what_came_along():
    def plan():
        return cpl.with_failure_handling(
            [(SimplePlanFailure, lambda failure, retry: retry.leave(texts(failure)))],
            lambda retry: cpl.par(failing_in_cleanup("the brake is stuck"), failing("bumped", after=1)),
        )

    assert warnings_of(plan) == ([], ["the brake is stuck"])
    assert kernel.now() == 1.0


def test_a_failure_wins_over_a_request_to_end_that_has_not_been_delivered():
    def asked_to_end():
        cpl.current_task().ask_to_end()
        cpl.fail("just then")

    assert str(failure_of(asked_to_end, lambda: cpl.sleep(9))) == "just then"
