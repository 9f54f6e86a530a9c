"""Failures and their handling: cpl.md section 16, invariants 65 to 77."""

import pytest
from small_plans import plan

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl import hooks
from cramhy_runtime.lisp_core.conditions import Error, SimpleError, error, handler_bind, ignore_errors, restart_case
from cramhy_runtime.lisp_core.packages import sym


def handling(*clauses, body):
    return cpl.with_failure_handling(list(clauses), lambda retry: body())


def give(value):
    return lambda condition, retry: retry.leave(value)


def test_a_handler_returns_from_the_form_or_tries_again():
    attempts = []

    def body():
        attempts.append(1)
        cpl.fail("attempt ~a", len(attempts))

    def handler(failure, retry):
        assert failure.format_arguments == (len(attempts),)
        if len(attempts) < 3:
            retry()
        retry.leave("gave up")

    assert plan(lambda: handling((cpl.SimplePlanFailure, handler), body=body)) == "gave up"
    assert len(attempts) == 3


def test_handlers_run_before_anything_unwinds():
    order = []

    def body():
        try:
            cpl.fail("x")
        finally:
            order.append("cleanup")

    plan(lambda: handling((cpl.PlanFailure, lambda failure, retry: (order.append("handler"), retry.leave())), body=body))
    assert order == ["handler", "cleanup"]


def test_a_childs_cleanup_runs_before_the_parents_handler():
    order = []

    def body():
        try:
            cpl.fail("x")
        finally:
            order.append("cleanup")

    plan(lambda: handling((cpl.PlanFailure, lambda failure, retry: (order.append("handler"), retry.leave())), body=lambda: cpl.par(body)))
    assert order == ["cleanup", "handler"]


def test_a_handler_that_returns_declines_and_all_matching_clauses_then_outer_forms_have_their_turn():
    seen = []

    def note(name):
        return lambda failure, retry: seen.append((name, failure))

    def body():
        return handling(
            (cpl.SimplePlanFailure, note("first")), (Error, note("never")), (cpl.PlanFailure, note("second")), body=lambda: cpl.fail("x")
        )

    plan(lambda: handling((cpl.PlanFailure, lambda failure, retry: (seen.append(("outer", failure)), retry.leave())), body=body))
    assert [name for name, _ in seen] == ["first", "second", "outer"]
    assert len({id(failure) for _, failure in seen}) == 1


def test_a_failure_raised_in_a_handler_is_not_seen_by_the_same_form():
    seen = []

    def handler(failure, retry):
        seen.append(failure.format_control)
        cpl.fail("again")

    with pytest.raises(cpl.PlanFailure) as problem:
        plan(lambda: handling((cpl.PlanFailure, handler), body=lambda: cpl.fail("first")))
    assert seen == ["first"] and problem.value.format_control == "again"


def test_an_error_clause_lets_failures_pass_and_a_failure_clause_lets_errors_of_the_same_task_pass():
    with pytest.raises(cpl.PlanFailure):
        plan(lambda: handling((Error, give("caught")), body=lambda: cpl.fail("x")))
    with pytest.raises(SimpleError):
        plan(lambda: handling((cpl.PlanFailure, give("caught")), body=lambda: error("x")))


def test_an_error_clause_gets_the_original_error_from_several_levels_below():
    problem = SimpleError("deep down")
    caught = []

    def handler(condition, retry):
        caught.append(condition)
        retry.leave("ok")

    assert plan(lambda: handling((Error, handler), body=lambda: cpl.par(lambda: cpl.par(lambda: error(problem))))) == "ok"
    assert caught == [problem] and caught[0] is problem


def test_a_failure_clause_gets_an_envelope_that_is_never_nested():
    problem = SimpleError("deep down")
    caught = []

    def handler(condition, retry):
        caught.append(condition)
        retry.leave()

    plan(lambda: handling((cpl.PlanFailure, handler), body=lambda: cpl.par(lambda: cpl.par(lambda: error(problem)))))
    assert isinstance(caught[0], cpl.CommonLispErrorEnvelope) and caught[0].error is problem


def test_in_an_envelope_the_first_clause_for_the_error_comes_before_clauses_for_the_envelope():
    seen = []

    def note(name):
        return lambda condition, retry: seen.append((name, type(condition).__name__))

    with pytest.raises(SimpleError):
        plan(
            lambda: handling(
                (cpl.PlanFailure, note("plan-failure")),
                (SimpleError, note("simple-error")),
                (Error, note("error")),
                body=lambda: cpl.par(lambda: error("x")),
            )
        )
    assert seen == [("simple-error", "SimpleError"), ("plan-failure", "CommonLispErrorEnvelope")]


def test_an_error_leaves_top_level_as_itself_and_handlers_there_run_after_everything_is_dead():
    problem = SimpleError("x")
    states = []

    def body():
        states.append(cpl.current_task())
        cpl.par(lambda: error(problem), lambda: cpl.sleep(10))

    def handler(condition, retry):
        states.append(states[0].dead)
        retry.leave(condition)

    assert handling((Error, handler), body=lambda: plan(body)) is problem
    assert states[1] is True


def test_python_errors_of_a_branch_are_errors_too():
    def broken():
        return {}["no such key"]

    caught = plan(lambda: handling((Error, lambda condition, retry: retry.leave(condition)), body=lambda: cpl.par(broken)))
    assert isinstance(caught.exception, KeyError)


def test_fail_without_arguments_and_with_text_and_with_a_class():
    def caught(*arguments):
        return plan(lambda: handling((cpl.PlanFailure, lambda failure, retry: retry.leave(failure)), body=lambda: cpl.fail(*arguments)))

    assert caught().format_control == "Plan failure."
    assert caught("a ~a", 1).format_arguments == (1,)
    failure = cpl.CompositeFailure()
    assert caught(failure) is failure


def test_ignore_errors_does_not_stop_a_failure():
    with pytest.raises(cpl.PlanFailure):
        plan(lambda: ignore_errors(lambda: cpl.fail("x")))


def test_failures_work_outside_of_plans_too():
    assert handling((cpl.PlanFailure, give("caught")), body=lambda: cpl.fail("x")) == "caught"


def test_restarts_of_a_task_can_be_used_by_its_handlers():
    name = sym("USE-THIS")

    def body():
        return restart_case([(name, lambda value: value)], lambda: cpl.fail("x"))

    def handler(failure, retry):
        from cramhy_runtime.lisp_core.conditions import invoke_restart

        invoke_restart(name, 42)

    assert plan(lambda: handling((cpl.PlanFailure, handler), body=body)) == 42


def test_the_hook_on_fail_gets_the_datum_before_any_handler():
    order = []
    hooks.on_fail.add(lambda datum: order.append(("hook", datum)), "test")
    try:
        plan(
            lambda: handling(
                (cpl.PlanFailure, lambda failure, retry: (order.append("handler"), retry.leave())), body=lambda: cpl.fail("text")
            )
        )
    finally:
        hooks.on_fail.remove("test")
    assert order == [("hook", "text"), "handler"]


def test_hooks_of_failure_handling_begin_and_end_once():
    events = []
    hooks.on_with_failure_handling_begin.add(lambda names: events.append(list(names)) or "id", "test")
    hooks.on_with_failure_handling_end.add(lambda run: events.append(run), "test")
    try:
        plan(lambda: handling((cpl.PlanFailure, give(1)), body=lambda: cpl.fail("x")))
    finally:
        hooks.on_with_failure_handling_begin.remove("test")
        hooks.on_with_failure_handling_end.remove("test")
    assert events == [["PLAN-FAILURE", "ERROR"], ["PLAN-FAILURE"], "id", "id"]  # top-level is such a form too


@pytest.mark.parametrize("begins", [True, False])
def test_hooks_of_a_handler_get_the_id_of_the_form_and_nil_where_no_hook_gave_one(begins):
    events = []
    if begins:
        hooks.on_with_failure_handling_begin.add(lambda names: "id", "test")
    hooks.on_with_failure_handling_handled.add(lambda run: events.append(("handled", run)), "test")
    hooks.on_with_failure_handling_rethrown.add(lambda run: events.append(("rethrown", run)), "test")

    def body():
        handling((cpl.SimplePlanFailure, lambda failure, retry: None), body=lambda: cpl.fail("no"))

    try:
        assert plan(lambda: handling((cpl.SimplePlanFailure, give("done")), body=body)) == "done"
    finally:
        for hook in (hooks.on_with_failure_handling_begin, hooks.on_with_failure_handling_handled, hooks.on_with_failure_handling_rethrown):
            hook.remove("test")
    run = "id" if begins else None
    assert events == [("handled", run), ("rethrown", run), ("handled", run)]


def test_a_form_that_is_left_from_within_a_handler_of_another_tries_again_afresh():
    """Its exit is one object for all its attempts: nothing of an earlier one is left in it."""
    attempts = []

    def body(retry):
        attempts.append(len(attempts))
        if len(attempts) < 3:
            try:
                retry()
            finally:
                assert handling((cpl.SimplePlanFailure, give("cleaned")), body=lambda: cpl.fail("in cleanup")) == "cleaned"
        return "third"

    form = []

    def outer():
        def inner(retry):
            form.append(retry)
            return body(retry)

        return cpl.with_failure_handling([(cpl.SimplePlanFailure, give("wrong"))], inner)

    assert plan(outer) == "third"
    assert len(set(map(id, form))) == 1 and form[0].__traceback__ is None and form[0].__context__ is None


def test_a_counter_allows_exactly_so_many_retries_and_can_be_reset():
    counter = cpl.RetryCounter(lambda: 2)
    left = []

    def handler(failure, retry):
        left.append(counter.left)
        if counter.use():
            retry()
        retry.leave("exhausted")

    assert plan(lambda: handling((cpl.PlanFailure, handler), body=lambda: cpl.fail("f"))) == "exhausted"
    assert left == [2, 1, 0]
    assert counter.reset() == 2


def test_an_unhandled_failure_leaves_the_plan_as_the_same_object():
    failure = cpl.SimplePlanFailure("other")
    with pytest.raises(cpl.SimplePlanFailure) as problem:
        plan(lambda: handling((Error, give(1)), body=lambda: cpl.par(lambda: cpl.fail(failure))))
    assert problem.value is failure


def test_a_plain_handler_sees_an_envelope():
    seen = []
    with pytest.raises(SimpleError):
        plan(lambda: handler_bind([(cpl.PlanFailure, seen.append)], lambda: cpl.par(lambda: error("x"))))
    assert isinstance(seen[0], cpl.CommonLispErrorEnvelope)


def test_a_retry_waits_until_the_branches_of_the_first_attempt_are_dead():
    living = []
    attempts = []

    def worker():
        living.append(1)
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(1)
            living.pop()

    def body():
        attempts.append(len(living))
        cpl.par(worker, lambda: (cpl.sleep(1), cpl.fail("x")))

    def handler(failure, retry):
        if len(attempts) < 3:
            retry()
        retry.leave("done")

    assert plan(lambda: handling((cpl.PlanFailure, handler), body=body)) == "done"
    assert attempts == [0, 0, 0] and kernel.now() == 6
