"""A run of a plan in a kernel of its own."""

import pytest

from cramhy_runtime import cpl, kernel, testing
from cramhy_runtime.lisp_core.packages import find_package_or_error
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.testing.runs import describe

BACKENDS = ["threads", "greenlet"]
WAITS = "(top-level (let ((bell (make-fluent))) (par (progn (wait-for bell) (list :heard 1)) (progn (sleep 2) (setf (value bell) t)))))"


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_plan_is_a_function_or_a_text_or_a_form(backend):
    assert testing.run(lambda: cpl.top_level(lambda: (cpl.sleep(2), 5)[1]), backend=backend).value == 5
    outcome = testing.run(WAITS, backend=backend)
    assert (str(outcome), outcome.time) == ("(:HEARD 1)", 2)
    testing.plans.with_lisp(lambda: None)
    assert str(testing.run(testing.plans.with_lisp(lambda: Reader(WAITS, "<form>").read()), backend=backend)) == "(:HEARD 1)"


def test_what_is_no_plan_is_refused():
    with pytest.raises(TypeError, match="A plan is a function, a text of Lisp or a Lisp form, not 5."):
        testing.run(5)
    with pytest.raises(ValueError, match="The text of the plan has no form."):
        testing.run("; nothing")


def test_definitions_of_a_text_are_evaluated_once_and_its_last_form_each_time():
    text = "(defvar *counted* 0) (incf *counted*) (progn (incf *counted* 10) *counted*)"
    assert [testing.run(text).value for _ in range(3)] == [11, 21, 31]


def test_a_text_may_name_its_package():
    assert testing.run("(in-package :cl-user) (package-name (symbol-package 'foo))").value == "COMMON-LISP-USER"
    assert testing.run('(symbol-name (intern "X"))').value == "X"
    assert find_package_or_error("TESTING-USER")


def test_an_error_is_raised():
    with pytest.raises(cpl.PlanFailure, match="no WAY"):
        testing.run('(top-level (par (sleep 1) (fail "no ~a" \'way)))')


def test_an_expected_error_is_an_outcome_and_is_raised_when_the_value_is_asked_for():
    outcome = testing.run('(top-level (par (sleep 1) (fail "no ~a" \'way)))', expect=cpl.PlanFailure)
    assert str(outcome) == "SimplePlanFailure: no WAY" and outcome.stack
    with pytest.raises(cpl.PlanFailure):
        outcome.value


def test_a_composite_failure_is_described_with_its_parts():
    outcome = testing.run('(top-level (try-all (fail "one") (fail "two")))', expect=cpl.CompositeFailure)
    assert str(outcome) == describe(outcome.error) == "CompositeFailure of [SimplePlanFailure: two; SimplePlanFailure: one]"


def test_a_run_disturbs_no_kernel_that_was_active_before():
    mine = kernel.start()
    try:
        kernel.sleep(3)
        testing.run(WAITS)
        assert kernel.active() is mine and kernel.now() == 3
    finally:
        kernel.stop()


@pytest.mark.parametrize("backend", BACKENDS)
def test_virtual_time_is_a_block_with_a_clock(backend):
    with testing.virtual_time(backend=backend) as clock:
        assert cpl.top_level(lambda: cpl.par(lambda: (cpl.sleep(3600), 1)[1], lambda: None)) == 1
        assert clock.now() == 3600


def test_a_plan_without_an_end_reaches_the_time_limit():
    assert str(testing.run("(top-level (loop (sleep 1)))", time_limit=10, expect=kernel.TimeLimit)).startswith("TimeLimit")


def test_the_same_seed_is_the_same_run_and_that_of_the_command_line():
    plan = "(top-level (let ((log nil)) (par-loop (n '(1 2 3 4)) (sleep 1) (push n log)) log))"
    runs = [str(testing.run(plan, seed=seed)) for seed in (None, 1, 2, 3, 4, 1, 2, 3, 4)]
    assert runs[1:5] == runs[5:] and len(set(runs)) > 1
    with testing.virtual_time(seed=3):
        log = []
        cpl.top_level(lambda: cpl.par_loop(testing.plans.lisp_list(1, 2, 3, 4), lambda n: (cpl.sleep(1), log.insert(0, n))))
    assert f"({' '.join(map(str, log))})" == runs[3]


def test_a_seed_and_a_schedule_exclude_each_other():
    with pytest.raises(ValueError, match="A seed or a schedule, not both"):
        testing.run(WAITS, seed=1, schedule=[1])


def test_what_a_plan_leaves_behind_is_an_error_of_the_test():
    kept = []

    def plan():
        flag = cpl.make_fluent(name="flag")
        kept.append(cpl.fl_not(flag))
        flag.waiters = [kernel.current()]
        kernel.call_at(100, lambda: None)

    with pytest.raises(AssertionError) as problem:
        testing.run(plan)
    text = str(problem.value)
    assert text.startswith("Something is left:\n  a timer for 100 s is left")
    assert "has waiters: main" in text and "is still held by somebody" in text


@pytest.mark.parametrize("backend", BACKENDS)
def test_assert_nothing_left_names_a_task_that_lives(backend):
    with testing.virtual_time(backend=backend) as clock:
        testing.assert_nothing_left(clock)
        task = kernel.spawn(lambda: kernel.park("a bell"), name="deaf")
        kernel.sleep(1)
        with pytest.raises(AssertionError, match="task deaf is alive .parked, waits for a bell."):
            testing.assert_nothing_left(clock)
        testing.assert_nothing_left(clock, allowed=["task deaf *"])
        task.cancel()
        task.join()
        testing.assert_nothing_left(clock)


class Stuck(cpl.PlanFailure):
    """The door does not open."""


def _stuck():
    raise Stuck("the door")


def _misspelt():
    return missing  # noqa: F821


def _wrong():
    assert 2 == 3, "two is not three"


@pytest.mark.parametrize(
    "plan, error", [(_stuck, Stuck), (_wrong, AssertionError), (_misspelt, NameError)], ids=["fails", "asserts", "misspelt"]
)
@pytest.mark.parametrize(
    "run", [testing.run, testing.explore, lambda plan: testing.explore(plan, 3, lambda value: True)], ids=["run", "explore", "check"]
)
def test_a_failing_plan_does_not_pass(run, plan, error):
    with pytest.raises((error, testing.DependsOnLuck)):
        run(plan)


def test_what_is_expected_must_come():
    assert isinstance(testing.run(_stuck, expect=(OSError, Stuck)).error, Stuck)
    assert testing.explore(_stuck, 3, expect=cpl.PlanFailure).runs == 3
    with pytest.raises(AssertionError, match="The plan was to end with Stuck, but it ended well, with 5."):
        testing.run(lambda: 5, expect=Stuck)
    with pytest.raises(AssertionError, match="two is not three"):
        testing.run(_wrong, expect=Stuck)
    with pytest.raises(TypeError, match="expect= takes a class of exceptions, or a tuple of classes, as in expect=cpl.PlanFailure"):
        testing.run(_stuck, expect="Stuck")


@pytest.mark.parametrize("no", [0, "", [], (), {}, False, 0.0], ids=repr)
def test_a_check_goes_by_the_truth_of_python(no):
    with pytest.raises(testing.DependsOnLuck, match="the check says no"):
        testing.explore(lambda: "value", 2, check=lambda value: no)


def test_a_check_that_only_asserts_may_return_nothing_but_a_lambda_may_not():
    def check(value):
        assert value == "value"

    assert testing.explore(lambda: "value", 2, check=check).runs == 2
    with pytest.raises(testing.DependsOnLuck, match="the check says no"):
        testing.explore(lambda: "value", 2, check={}.get)
