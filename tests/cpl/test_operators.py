"""The control operators: cpl.md section 16, invariants 78 to 97, and golden 13."""

import pytest
from small_plans import plan

from cramhy_runtime import cpl, kernel
from cramhy_runtime.cpl.forms import operators
from cramhy_runtime.cpl.tree import tags
from cramhy_runtime.cpl.statuses import DEAD, EVAPORATED, FAILED, SUCCEEDED
from cramhy_runtime.lisp_core.conditions import Error, error
from cramhy_runtime.lisp_core.data import NO_VALUES, MultipleValues, lisp_list, python_list
from cramhy_runtime.lisp_core.packages import keyword


def after(seconds, value=None):
    return lambda: (cpl.sleep(seconds), value)[1]


def failing(text, seconds=0):
    def branch():
        if seconds:
            cpl.sleep(seconds)
        cpl.fail(text)

    return branch


def failure_of(body):
    with pytest.raises(cpl.PlanFailure) as problem:
        plan(body)
    return problem.value


def test_top_level_returns_all_values_of_its_body():
    assert plan(lambda: 1) == 1
    assert plan(lambda: MultipleValues((1, 2))) == (1, 2)
    assert plan(lambda: NO_VALUES) == ()
    assert plan(lambda: None) is None


def test_top_levels_cannot_be_nested():
    with pytest.raises(Error) as problem:
        plan(lambda: plan(lambda: 1))
    assert problem.value.format_control == "top-level calls cannot be nested."


def test_two_kernel_tasks_may_each_run_a_top_level():
    results = []
    others = [kernel.spawn(lambda n=n: results.append(plan(after(1, n)))) for n in range(2)]
    for other in others:
        other.join()
    assert results == [0, 1] and kernel.now() == 1


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize(
    "form, call",
    [
        ("PAR", lambda: cpl.par(lambda: 1)),
        ("PURSUE", lambda: cpl.pursue(lambda: 1)),
        ("TRY-ALL", lambda: cpl.try_all(lambda: 1)),
        ("TRY-IN-ORDER", lambda: cpl.try_in_order(lambda: 1)),
        ("TRY-EACH-IN-ORDER", lambda: cpl.try_each_in_order(None, lambda x: 1)),
        ("PARTIAL-ORDER", lambda: cpl.partial_order([lambda: 1], [])),
        ("PAR-LOOP", lambda: cpl.par_loop(None, lambda x: 1)),
        ("WITH-TAGS", lambda: tags.enter_with_tags()),
        ("WITH-TASK-SUSPENDED", lambda: cpl.with_task_suspended(None, lambda: 1)),
        ("WITH-TASK", lambda: cpl.with_task(lambda: 1)),
    ],
)
def test_a_plan_form_outside_of_a_plan_says_so(form, call):
    with pytest.raises(Error) as problem:
        call()
    assert (problem.value.format_control, problem.value.format_arguments) == ("'~a' form not inside a plan.", (form,))


@pytest.mark.parametrize("form", [operators.par, operators.pursue, operators.try_all, lambda: cpl.partial_order([], [])])
def test_parallel_forms_without_branches_are_errors(form):
    with pytest.raises(Error) as problem:
        plan(form)
    assert str(problem.value.format_control) == "wait-for called with nil argument."


def test_seq_works_anywhere_and_gives_the_last_value():
    assert cpl.seq(lambda: 1, lambda: 2) == 2 and cpl.seq() is None


def test_par_waits_for_all_and_gives_the_values_of_the_first_form():
    assert plan(lambda: cpl.par(after(0.2, 1), after(0, 2), after(0.1, 3))) == 1
    assert kernel.now() == pytest.approx(0.2)
    assert plan(lambda: cpl.par(lambda: MultipleValues((1, 2)))) == (1, 2)


def test_par_runs_its_branches_at_once():
    ping, pong = cpl.make_fluent(), cpl.make_fluent()

    def first():
        ping.set(True)
        return cpl.wait_for(pong)

    def second():
        cpl.wait_for(ping)
        pong.set("there")

    assert plan(lambda: cpl.par(first, second)) == "there"


def test_par_fails_with_the_failure_of_the_last_form_among_those_that_failed_together():
    assert failure_of(lambda: cpl.par(failing("a"), failing("b"), failing("c"))).format_control == "c"


def test_a_failing_par_ends_the_others_before_its_failure_is_seen():
    order = []

    def slow():
        try:
            cpl.sleep(10)
        finally:
            cpl.sleep(0.5)
            order.append("cleanup over")

    def body():
        try:
            cpl.par(slow, failing("now", 1))
        finally:
            order.append("form left")

    failure_of(body)
    assert order == ["cleanup over", "form left"] and kernel.now() == pytest.approx(1.5)


def test_all_branches_have_started_even_if_the_first_fails_at_once():
    started = []
    failure_of(lambda: cpl.par(failing("x"), lambda: started.append(1)))
    assert started == [1]


def test_pursue_gives_the_values_of_the_branch_that_ended_and_the_last_among_several():
    assert plan(lambda: cpl.pursue(lambda: 1, lambda: 2, lambda: 3)) == 3
    assert plan(lambda: cpl.pursue(after(0.3, 1), after(0.1, 2))) == 2


def test_losers_are_dead_and_cleaned_up_when_pursue_returns():
    said = []

    def loser():
        try:
            cpl.sleep(10)
        finally:
            cpl.sleep(0.3)
            said.append("loser cleanup")

    assert plan(lambda: (cpl.pursue(loser, after(0.1, "winner")), said.append("after"))[0]) == "winner"
    assert said == ["loser cleanup", "after"] and kernel.now() == pytest.approx(0.4)


def test_a_loser_that_never_waits_is_ended_too():
    def busy():
        while True:
            kernel.checkpoint()

    assert plan(lambda: cpl.pursue(busy, after(0.1, "winner"))) == "winner"


def test_pursue_fails_if_a_branch_has_failed_even_if_another_has_succeeded():
    assert failure_of(lambda: cpl.pursue(lambda: 1, failing("x"))).format_control == "x"


def test_a_failure_in_the_cleanup_of_a_loser_is_not_lost():
    def loser():
        try:
            cpl.sleep(10)
        finally:
            cpl.fail("in cleanup")

    assert failure_of(lambda: cpl.pursue(loser, after(1))).format_control == "in cleanup"


def test_try_all_ends_with_the_first_success_and_drops_failures():
    assert plan(lambda: cpl.try_all(failing("x"), after(0.1, 2), after(5, 3))) == 2
    assert kernel.now() == pytest.approx(0.1)


def test_try_all_of_failures_only_has_run_all_and_lists_the_last_first():
    failure = failure_of(lambda: cpl.try_all(failing("a", 2), failing("b", 1), failing("c", 3)))
    assert [part.format_control for part in python_list(failure.failures)] == ["c", "b", "a"]


def test_try_all_collects_errors_in_envelopes():
    failure = failure_of(lambda: cpl.try_all(lambda: 1 / 0))
    assert isinstance(failure.failures.car, cpl.CommonLispErrorEnvelope)


def test_try_in_order_stops_at_the_first_success():
    ran = []
    assert plan(lambda: cpl.try_in_order(failing("x"), lambda: 2, lambda: ran.append(3))) == 2
    assert ran == []


def test_try_in_order_lists_failures_in_order_and_composites_stay_nested():
    failure = failure_of(lambda: cpl.try_in_order(failing("a"), lambda: cpl.try_in_order(failing("b"))))
    first, second = failure.failures
    assert first.format_control == "a" and isinstance(second, cpl.CompositeFailure)
    assert failure_of(lambda: cpl.try_in_order()).failures is None


def test_outer_handlers_do_not_see_what_try_in_order_takes():
    seen = []
    assert (
        plan(
            lambda: cpl.with_failure_handling(
                [(cpl.PlanFailure, lambda failure, retry: seen.append(failure))], lambda retry: cpl.try_in_order(failing("x"), lambda: 1)
            )
        )
        == 1
    )
    assert seen == []


def test_an_error_of_lisp_in_the_same_task_passes_try_in_order_and_one_of_a_child_does_not():
    with pytest.raises(Error):
        plan(lambda: cpl.try_in_order(lambda: error("no"), lambda: 2))
    assert plan(lambda: cpl.try_in_order(lambda: 1 / 0, lambda: 2)) == 2  # an exception of Python is a failure, as in TRY-ALL
    assert plan(lambda: cpl.try_in_order(lambda: cpl.par(lambda: 1 / 0), lambda: 2)) == 2


def test_try_each_in_order_gives_the_value_of_the_first_element_that_succeeds():
    tried = []

    def body(element):
        tried.append(element)
        if element < 3:
            cpl.fail("no")
        return keyword("GOT"), element

    assert plan(lambda: cpl.try_each_in_order(lisp_list(1, 2, 3, 4), body)) == (keyword("GOT"), 3)
    assert tried == [1, 2, 3]


def test_par_loop_runs_all_elements_at_once_and_gives_the_first_ones_values():
    assert plan(lambda: cpl.par_loop(lisp_list(1, 2, 3), lambda x: after(x, x * x)())) == 1
    assert kernel.now() == 3
    assert plan(lambda: cpl.par_loop(None, lambda x: (x, "once"))) == (None, "once")
    with pytest.raises(Error):
        plan(lambda: operators.par_loop([1], lambda x: x))


def steps_with_tags(log, *names):
    tasks = {name: tags.make_tag_task(keyword(name)) for name in names}

    def step(name, seconds):
        def run():
            task = tags.prepare_tag(tasks[name])
            return tags.execute_tag(task, lambda: (cpl.sleep(seconds), log.append(name), name)[-1])

        return run

    return tasks, step


def test_partial_order_starts_a_step_only_when_what_it_waits_for_is_dead():
    log = []

    def body():
        tasks, step = steps_with_tags(log, "A", "B")
        return cpl.partial_order([step("B", 0), step("A", 0.2)], [(tasks["A"], tasks["B"])])

    assert plan(body) == "B" and log == ["A", "B"]


def test_an_ordering_by_a_fluent_waits_for_its_pulse():
    log = []
    fluent = cpl.make_fluent()

    def body():
        tasks, step = steps_with_tags(log, "A")
        cpl.partial_order([step("A", 0), lambda: (cpl.sleep(2), cpl.pulse(fluent))], [(fluent, tasks["A"])])

    plan(body)
    assert log == ["A"] and kernel.now() == 2


def test_a_constrained_step_whose_predecessor_fails_never_runs():
    log = []

    def body():
        tasks, step = steps_with_tags(log, "B")
        task = tags.make_tag_task(keyword("A"))
        cpl.partial_order([step("B", 0), lambda: tags.execute_tag(task, failing("x", 1))], [(task, tasks["B"])])

    failure_of(body)
    assert log == []


def test_a_branch_evaporated_by_somebody_else_counts_as_done():
    def body():
        task = tags.make_tag_task(keyword("A"))

        def tagged():
            return tags.execute_tag(task, after(10, "never"))

        return cpl.par(tagged, lambda: (cpl.sleep(1), cpl.evaporate(task))), task.status

    assert plan(body) == (NO_VALUES, EVAPORATED)


@pytest.mark.soak
def test_par_of_a_thousand_branches():
    assert plan(lambda: cpl.par(*[after(1, n) for n in range(1000)])) == 0
    assert kernel.now() == 1


def test_the_states_after_a_failing_par():
    tasks = {}

    def body():
        for name in "AB":
            tasks[name] = tags.make_tag_task(keyword(name))
        cpl.par(lambda: tags.execute_tag(tasks["A"], after(9)), lambda: tags.execute_tag(tasks["B"], failing("x", 1)))

    failure_of(body)
    assert (tasks["A"].status, tasks["B"].status) == (EVAPORATED, FAILED)


def test_with_parallel_childs_calls_its_watcher_at_each_change():
    pictures = []

    class Leave(BaseException):
        pass

    def watcher(running, done, failed):
        pictures.append(tuple(len(python_list(part)) for part in (running, done, failed)))
        if running is None:
            raise Leave

    def body():
        try:
            operators.with_parallel_childs("PAR", [after(1)], watcher)
        except Leave:
            return "left"

    assert plan(body) == "left"
    assert pictures[-1] == (0, 1, 0) and len(pictures) == 2


def test_a_return_across_a_branch_is_a_control_error_that_says_what_to_do():
    class Exit(BaseException):
        pass

    def branch():
        raise Exit

    with pytest.raises(Error) as problem:
        plan(lambda: cpl.par(branch))
    assert problem.value.format_control == (
        "A branch of a plan tried to leave a form around it, by RETURN-FROM, RETURN, GO or THROW. Every branch has a stack of its "
        "own, so only its values can leave it: let the branch return a value, or FAIL and handle the failure outside."
    )


def test_everything_below_a_top_level_that_is_left_is_dead():
    task = []

    def body():
        task.append(cpl.current_task())
        cpl.par(after(100), after(100))

    other = kernel.spawn(lambda: plan(body))
    kernel.sleep(1)
    other.cancel()
    other.join()
    assert task[0].status is EVAPORATED and kernel.now() == 1 and SUCCEEDED in DEAD


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form",
    [
        "(top-level {0})",
        "(top-level (seq 1 {0}))",
        "(top-level (par {0} 1))",
        "(top-level (pursue (sleep 9) {0}))",
        "(top-level (try-all (fail) {0}))",
        "(top-level (try-in-order (fail) {0}))",
        "(top-level (try-each-in-order (x '(1)) x {0}))",
        "(top-level (par-loop (x '(1 2)) x {0}))",
        "(top-level (partial-order ({0} 1)))",
        "(top-level (with-tags (:tag a {0})))",
        "(top-level (with-task () {0}))",
        "(top-level (with-task-tree-node (:path-part '(a)) {0}))",
        "(top-level (with-policy timeout-policy (9) {0}))",
        "(top-level (with-failure-handling ((plan-failure (e) (return))) {0}))",
        "(top-level (with-retry-counters ((c 1)) {0}))",
        "(top-level (on-suspension (note 1) {0}))",
        "(top-level (retry-after-suspension {0}))",
        "(top-level (without-scheduling {0}))",
        "(top-level (let ((task (make-instance 'task :thread-fun (lambda () {0})))) (join-task task)))",
        "(named-top-level (:name lecture) {0})",
        "(progn (def-cram-function f () {0}) (top-level (f)))",
        "(progn (def-top-level-cram-function f () {0}) (f))",
        "(progn (declare-goal g ()) (def-goal (g) {0}) (top-level (g)))",
        "(top-level (with-parallel-childs nil (running done failed) ({0}) (when done (return (result (first done))))))",
        "(top-level (with-task-suspended ((make-instance 'task :thread-fun (lambda () (sleep 9)))) {0}))",
    ],
)
def test_every_form_passes_all_values_through(plan_text, form):
    assert plan_text(form.format("(values 1 nil :three)")) == "1 ; NIL ; :THREE"
    assert plan_text(form.format("(values)")) == ""


@pytest.mark.soak(all_but=5)
@pytest.mark.parametrize("form", ["(block out {0} :after)", "(tagbody {1} out)", "(catch 'out {2} :after)", "(dolist (x '(1)) {3})"])
@pytest.mark.parametrize("branch", ["(par {} 2)", "(pursue (sleep 9) {})", "(with-tags (:tag a {}))", "(par-loop (x '(1)) {})"])
def test_no_exit_leaves_a_branch_silently(plan_text, form, branch):
    exits = ["(return-from out 1)", "(go out)", "(throw 'out 1)", "(return 1)"]
    shown = plan_text.error("(top-level " + form.format(*[branch.format(exit) for exit in exits]) + ")")
    assert "CONTROL-ERROR" in shown
    assert "A branch of a plan tried to leave a form around it" in shown or "attempt to THROW to a tag that does not exist: OUT" in shown


@pytest.mark.soak(all_but=4)
@pytest.mark.parametrize(
    "form",
    [
        "(with-failure-handling () {})",
        "(with-failure-handling ((plan-failure (e) {})) (fail))",
        "(try-in-order {})",
        "(try-each-in-order (x '(1)) {})",
        "(whenever ((make-fluent :value t)) {})",
        "(cut:lazy-dolist (x '(1)) {})",
        "(with-parallel-childs nil (running done failed) (1) {})",
    ],
)
def test_return_means_the_innermost_block_named_nil_in_every_form_that_has_one(plan_text, form):
    assert plan_text("(top-level (list (block nil (list " + form.format("(return (values :inner 2))") + ") :after)))") == "(:AFTER)"
    assert plan_text("(top-level (multiple-value-list " + form.format("(return (values :inner 2))") + "))") == "(:INNER 2)"
    assert plan_text("(top-level (list (block around " + form.format("(return-from around :outer)") + ")))") == "(:OUTER)"


@pytest.fixture(params=range(8))
def shuffled(request, fresh_kernel):
    """A kernel in which a seed decides who runs next."""
    kernel.stop()
    return kernel.start(clock="virtual", backend=fresh_kernel.backend.name, seed=request.param, time_limit=3600)


@pytest.mark.soak(all_but=5)
@pytest.mark.law(97)
@pytest.mark.parametrize("form", [cpl.par, cpl.pursue, cpl.try_all])
def test_in_whatever_order_tasks_run_all_branches_have_started_before_the_first_decision(shuffled, form):
    started = []
    branches = [lambda: started.append(1), failing("x"), *[lambda n=n: (started.append(n), cpl.sleep(9)) for n in range(2, 8)]]
    try:
        plan(lambda: form(*branches))
    except cpl.PlanFailure:
        pass
    assert sorted(started) == list(range(1, 8))


@pytest.mark.soak(all_but=5)
@pytest.mark.law(84)
def test_in_whatever_order_tasks_run_the_last_of_the_immediate_failures_is_reported(shuffled):
    assert failure_of(lambda: cpl.par(*[failing(str(n)) for n in range(6)])).format_control == "5"
    assert plan(lambda: cpl.pursue(*[lambda n=n: n for n in range(6)])) == 5
    assert plan(lambda: cpl.try_all(*[lambda n=n: n for n in range(6)])) == 0


@pytest.mark.soak(all_but=5)
@pytest.mark.law(92)
def test_in_whatever_order_tasks_run_a_constrained_step_does_not_begin_while_its_plan_is_ended(shuffled):
    log = []

    def body():
        tasks, step = steps_with_tags(log, "A", "B")
        other = tags.make_tag_task(keyword("C"))
        cpl.par(
            lambda: cpl.partial_order([step("B", 0), step("A", 50)], [(tasks["A"], tasks["B"])]),
            lambda: tags.execute_tag(other, failing("over", 1)),
        )

    failure_of(body)
    assert log == []
