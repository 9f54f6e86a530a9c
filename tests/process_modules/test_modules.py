"""Process modules: process-modules.md section 11, invariants 1 to 31."""

import pytest
from designators.support import lisp, make, user

from cramhy_runtime import cpl, kernel
from cramhy_runtime import designators as desig
from cramhy_runtime import process_modules as pm
from cramhy_runtime.cpl.failures.failure_types import opened
from cramhy_runtime.cpl.failures.handling import attempt
from cramhy_runtime.lisp_core.conditions import Error, SimpleError, error, handler_bind, invoke_restart
from cramhy_runtime.lisp_core.data import NO_VALUES, MultipleValues, lisp_list
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.process_modules import asynchronous, executing, modules, registry
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group, remove_fact_group

NAVIGATION, ARM = intern("TEST-NAVIGATION", "CRAM-USER"), intern("TEST-ARM", "CRAM-USER")


def define(body, name=NAVIGATION):
    pm.define_process_module(name, body)
    return name


def motion(*pairs):
    return make("motion", *pairs)


def with_modules(body, *names):
    """The values of ``body`` as a plan while modules run."""
    return pm.with_process_modules_running(list(names) or [NAVIGATION], lambda: cpl.top_level(body))


def fails_with(body):
    _, failure = attempt(body)
    return failure


def test_the_body_runs_when_a_designator_is_sent_and_its_values_come_back():
    seen = []
    define(lambda designator: (seen.append(designator), 42)[1])
    wanted = motion()
    assert with_modules(lambda: pm.pm_execute(NAVIGATION, wanted)) == 42
    assert seen == [wanted]


def test_all_values_come_back():
    define(lambda designator: MultipleValues((1, 2)))
    assert with_modules(lambda: pm.pm_execute(NAVIGATION, motion())) == (1, 2)
    define(lambda designator: NO_VALUES)
    assert with_modules(lambda: pm.pm_execute(NAVIGATION, motion())) == ()


def test_the_body_gets_the_youngest_equated_designator():
    define(lambda designator: designator)
    old, new = motion(), motion()
    desig.equate(old, new)
    assert with_modules(lambda: pm.pm_execute(NAVIGATION, old)) is new


def test_two_instances_under_two_names_process_their_own_inputs():
    define(lambda designator: (cpl.sleep(1), designator)[1])
    left, right = user("LEFT"), user("RIGHT")
    first, second = motion(), motion()

    def body():
        results = []
        cpl.par(lambda: results.append(pm.pm_execute(left, first)), lambda: results.append(pm.pm_execute(right, second)))
        return results

    assert with_modules(body, (left, NAVIGATION), (right, NAVIGATION)) == [first, second] and kernel.now() == 1


def test_a_failure_of_the_body_reaches_the_caller_as_the_identical_object():
    failure, problem = cpl.SimplePlanFailure("no way"), SimpleError("broken")
    define(lambda designator: cpl.fail(failure))
    assert with_modules(lambda: fails_with(lambda: pm.pm_execute(NAVIGATION, motion()))) is failure
    define(lambda designator: error(problem))
    with pytest.raises(SimpleError) as caught:
        with_modules(lambda: pm.pm_execute(NAVIGATION, motion()))
    assert caught.value is problem


def test_after_a_failure_the_module_goes_on_and_its_status_tells():
    outcomes = iter([lambda: cpl.fail("x"), lambda: "fine"])
    define(lambda designator: next(outcomes)())
    seen = []

    def body():
        status = pm.pm_status(NAVIGATION)
        cpl.register_update_callback(status, "watch", lambda now: seen.append(now.name))
        fails_with(lambda: pm.pm_execute(NAVIGATION, motion()))
        return pm.pm_execute(NAVIGATION, motion())

    assert with_modules(body) == "fine"
    assert seen == ["RUNNING", "FAILED", "RUNNING", "WAITING", "OFFLINE"]


def test_each_of_many_requests_gets_its_own_result():
    define(lambda designator: (kernel.yield_(), designator)[1])
    wrong = []

    def caller():
        for _ in range(50):
            mine = motion()
            if pm.pm_execute(NAVIGATION, mine) is not mine:
                wrong.append(mine)

    with handled_warnings():
        with_modules(lambda: cpl.par(caller, caller, caller))
    assert wrong == []


class handled_warnings:  # noqa: N801  (reads as a statement)
    """``with handled_warnings() as texts:`` warnings of the block are collected and not printed."""

    def __enter__(self):
        self.old, texts = executing.warn, []
        executing.warn = lambda condition: texts.append(condition)
        return texts

    def __exit__(self, *problem):
        executing.warn = self.old


def test_a_second_caller_is_warned_and_served_afterwards():
    define(lambda designator: cpl.sleep(1))

    def body():
        cpl.par(lambda: pm.pm_execute(NAVIGATION, motion()), lambda: pm.pm_execute(NAVIGATION, motion()))

    with handled_warnings() as warnings:
        with_modules(body)
    (warning,) = warnings
    assert warning.format_control == "Process module ~a already processing input. Waiting for it to become free."
    assert kernel.now() == 2


def test_evaporating_the_caller_stops_the_body_and_waits_for_its_cleanup():
    done = []

    def drive(designator):
        try:
            cpl.sleep(100)
        finally:
            cpl.sleep(0.5)
            done.append("stopped")

    define(drive)

    def body():
        cpl.pursue(lambda: pm.pm_execute(NAVIGATION, motion()), lambda: cpl.sleep(1))
        done.append("pursue over")

    with_modules(body)
    assert done == ["stopped", "pursue over"] and kernel.now() == 1.5


def test_a_caller_that_gives_up_while_it_waits_is_never_served():
    served = []
    define(lambda designator: (served.append(designator), cpl.sleep(10)))
    first, second = motion(), motion()

    def body():
        cpl.par(
            lambda: pm.pm_execute(NAVIGATION, first), lambda: cpl.pursue(lambda: pm.pm_execute(NAVIGATION, second), lambda: cpl.sleep(1))
        )

    with handled_warnings():
        with_modules(body)
    assert served == [first]


def test_suspending_the_caller_cancels_the_run_and_repeats_it_after_wake_up():
    runs = []

    def drive(designator):
        runs.append(kernel.now())
        cpl.sleep(2)
        return len(runs)

    define(drive)

    def body():
        caller = cpl.Task(lambda: pm.pm_execute(NAVIGATION, motion()), "caller").execute()
        cpl.sleep(1)
        other = cpl.with_task_suspended(caller, lambda: pm.pm_execute(NAVIGATION, motion()))
        return other, cpl.join_task(caller)

    assert with_modules(body) == (2, 3) and runs == [0, 1, 3]


def test_a_run_cancelled_by_somebody_else_is_a_failure_of_its_caller():
    define(lambda designator: cpl.sleep(10))

    def body():
        return cpl.par(lambda: fails_with(lambda: pm.pm_execute(NAVIGATION, motion())), lambda: (cpl.sleep(1), pm.pm_cancel(NAVIGATION)))

    failure = with_modules(body)
    assert failure.format_control == "The execution of ~a by process module ~a was cancelled." and kernel.now() == 1


@pytest.mark.parametrize(
    "call",
    [
        lambda: pm.pm_execute(ARM, None),
        lambda: pm.pm_run(ARM),
        lambda: pm.pm_status(ARM),
        lambda: pm.pm_execute(None, None),
        lambda: pm.pm_cancel(ARM),
    ],
)
def test_an_unknown_module_is_an_error_at_once(call):
    with pytest.raises(registry.UnknownProcessModule) as problem:
        cpl.top_level(call)
    assert problem.value.format_control == "Unknown process module: ~a "


@pytest.mark.parametrize(
    ("name", "package", "meant"),
    [
        ("TEST-NAVIGATION", "COMMON-LISP-USER", "cram-user::test-navigation"),
        ("TEST-NAVIGATIO", "COMMON-LISP-USER", "cram-user::test-navigation"),
        ("TEST-NAVIGATIO", "CRAM-USER", "test-navigation"),
    ],
)
def test_the_hint_for_an_unknown_module_names_the_package_where_that_differs(name, package, meant):
    define(lambda designator: 1)
    with pytest.raises(registry.UnknownProcessModule) as problem:
        cpl.top_level(lambda: pm.pm_execute(intern(name, package), None))
    assert problem.value.hint.startswith(f"Did you mean {meant}? Running now: none. Defined: ")


def test_an_unknown_module_cannot_be_started_and_the_caller_hears_of_it():
    define(lambda designator: 1)
    with pytest.raises(registry.UnknownProcessModule):
        with_modules(lambda: 1, NAVIGATION, ARM)
    assert pm.get_running_process_module(NAVIGATION) is None


def test_a_module_runs_once_under_one_name():
    define(lambda designator: 1)
    with pytest.raises(registry.ProcessModuleRunning) as problem:
        with_modules(lambda: pm.pm_run(NAVIGATION))
    assert problem.value.report() == "Process module `TEST-NAVIGATION' already running. foo foo"


def test_a_module_needs_a_name():
    with pytest.raises(Error) as problem:
        pm.ProcessModule()
    assert problem.value.format_control == "Process modules need a name."


def test_status_and_registry_inside_and_outside():
    define(lambda designator: 1)
    module = with_modules(lambda: pm.get_running_process_module(NAVIGATION))
    assert module.status_fluent.value is keyword("OFFLINE")
    assert pm.get_running_process_module(NAVIGATION) is None
    assert with_modules(lambda: pm.pm_status(NAVIGATION).value) is keyword("WAITING")


def test_the_same_modules_can_be_started_again_and_again():
    define(lambda designator: 1)
    assert [with_modules(lambda: pm.pm_execute(NAVIGATION, motion())) for _ in range(30)] == [1] * 30


def test_aliases_reach_the_module_and_end_with_it():
    define(lambda designator: "moved")
    other = user("BASE")

    def body():
        pm.process_module_alias(other, NAVIGATION)
        return pm.pm_execute(other, motion())

    assert with_modules(body) == "moved"
    assert pm.get_running_process_module(other) is None
    assert with_modules(lambda: pm.with_process_module_aliases([(other, NAVIGATION)], lambda: pm.pm_execute(other, motion()))) == "moved"
    with pytest.raises(registry.UnknownProcessModule) as problem:
        pm.process_module_alias(other, ARM)
    assert problem.value.format_control == "Could not find process module with name `~s'"


def test_monitoring_gives_a_result_once_more():
    define(lambda designator: (cpl.sleep(1), "moved")[1])
    wanted = motion()

    def body():
        pm.pm_execute(NAVIGATION, wanted)
        again = pm.monitor_process_module(NAVIGATION, keyword("DESIGNATORS"), lisp_list(wanted))
        beside = cpl.par(lambda: pm.monitor_process_module(NAVIGATION), lambda: pm.pm_execute(NAVIGATION, motion()))
        return again, beside

    assert with_modules(body) == ("moved", "moved")


def test_waiting_for_a_module_that_never_starts():
    assert pm.wait_for_process_module_running(ARM, timeout=2) is None and kernel.now() == 2


def test_hooks_run_with_module_input_and_outcome():
    define(lambda designator: cpl.fail("x"))
    events = []
    hooks = [
        (modules.on_process_module_started, lambda module, input_: events.append("started")),
        (modules.on_process_module_failed, lambda module, input_, failure: events.append(("failed", failure.format_control))),
        (modules.on_process_module_finished, lambda module, input_, result: events.append(("finished", result.format_control))),
    ]
    for hook, function in hooks:
        hook.add(function, "test")
    try:
        with_modules(lambda: fails_with(lambda: pm.pm_execute(NAVIGATION, motion())))
    finally:
        for hook, _ in hooks:
            hook.remove("test")
    assert events == ["started", ("failed", "x"), ("finished", "x")]


@pytest.mark.parametrize("restart, still_there", [("CONTINUE-PM", True), ("TERMINATE-PM", False)])
def test_a_debugger_hook_decides_whether_the_module_goes_on(restart, still_there):
    define(lambda designator: error("broken"))
    hook = sym("CPM::*PROCESS-MODULE-DEBUGGER-HOOK*")

    def body():
        try:
            pm.pm_execute(NAVIGATION, motion())
        except SimpleError:
            kernel.yield_()
            return pm.get_running_process_module(NAVIGATION) is not None

    with binding(hook, lambda condition, hook: invoke_restart(sym("CPM::" + restart))):
        assert with_modules(body) is still_there


# ------------------------------------------------------------------------------------------------------------------ matching


@pytest.fixture
def two_modules():
    matching, available = "cpm::matching-process-module", "cpm::available-process-module"
    define_fact_group(
        user("TWO"),
        lisp([matching, available]),
        lisp(
            [
                [[matching, "?d", "test-navigation"], ["desig::desig-prop", "?d", [":type", ":driving"]]],
                [[matching, "?d", "test-arm"]],
                [[available, "test-navigation"]],
                [[available, "test-arm"]],
            ]
        ),
    )
    yield
    remove_fact_group(user("TWO"))


def test_matching_modules_come_in_clause_order_and_only_those_that_run(two_modules):
    define(lambda designator: "navigated")
    define(lambda designator: "grasped", ARM)
    driving = motion([":type", ":driving"])
    assert list(pm.matching_process_module_names(driving)) == [NAVIGATION, ARM]
    assert with_modules(lambda: pm.pm_execute_matching(driving), NAVIGATION, ARM) == "navigated"
    assert with_modules(lambda: pm.pm_execute_matching(driving), ARM) == "grasped"
    assert pm.matching_available_process_modules(driving) is None
    with pytest.raises(cpl.PlanFailure) as problem:
        pm.matching_available_process_modules(driving, fail_if_none=True)
    assert problem.value.format_control == "No process modules found for executing designator ~a"


def test_the_next_module_is_tried_when_one_fails_and_the_first_failure_counts(two_modules):
    define(lambda designator: cpl.fail("first"))
    define(lambda designator: "grasped", ARM)
    driving = motion([":type", ":driving"])
    assert with_modules(lambda: pm.pm_execute_matching(driving), NAVIGATION, ARM) == "grasped"
    define(lambda designator: cpl.fail("second"), ARM)
    assert with_modules(lambda: fails_with(lambda: pm.pm_execute_matching(driving)), NAVIGATION, ARM).format_control == "first"


# -------------------------------------------------------------------------------------------------------------- asynchronous


class Conveyor(asynchronous.AsynchronousProcessModule):
    lisp_name = "CRAM-USER::CONVEYOR"


@asynchronous.synchronization_fluent.method(Conveyor, None)
def always_ready(module, designator):
    return True


@asynchronous.on_input.method(Conveyor, None)
def take(module, designator):
    module.log.append((kernel.now(), designator))
    cpl.sleep(2)


def with_conveyor(body):
    module = Conveyor(user("CONVEYOR"))
    module.log = []
    return cpl.top_level(lambda: cpl.pursue(lambda: pm.pm_run(module, module.name), lambda: (cpl.sleep(0.1), body(module))[1]))


def test_an_asynchronous_module_returns_at_once_and_takes_inputs_one_by_one():
    first, second = motion(), motion()

    def body(module):
        assert pm.pm_execute(module.name, first) is first
        pm.pm_execute(module.name, second)
        sent = kernel.now()
        cpl.sleep(5)
        return sent, [when for when, _ in module.log]

    sent, times = with_conveyor(body)
    assert sent == pytest.approx(0.1) and times == pytest.approx([0.1, 2.1])


def test_monitoring_ends_when_designators_are_finished_or_fail():
    failure = SimpleError("jammed")
    first, second = motion(), motion()

    def body(module):
        pm.pm_execute(module.name, first)
        pm.pm_execute(module.name, second)

        def ends():
            cpl.sleep(3)
            pm.finish_process_module(module, keyword("DESIGNATOR"), first)
            cpl.sleep(3)
            pm.fail_process_module(module, failure, keyword("DESIGNATOR"), second)

        def watch():
            pm.monitor_process_module(module, keyword("DESIGNATORS"), first)
            first_over = kernel.now()
            seen = []
            try:
                handler_bind([(Error, seen.append)], lambda: pm.monitor_process_module(module, keyword("DESIGNATORS"), second))
            except SimpleError as caught:
                return first_over, caught, seen

        return cpl.par(watch, ends)

    first_over, caught, seen = with_conveyor(body)
    assert first_over == pytest.approx(3.1) and caught is failure and seen == [failure]


def test_finishing_what_is_not_being_done_is_an_error():
    def body(module):
        with pytest.raises(Error) as problem:
            pm.finish_process_module(module)
        return problem.value.format_control

    assert with_conveyor(body) == "Cannot finish an already stopped process module."


def test_a_module_that_fails_is_the_reason_that_the_user_hears():
    """The request only says that the module is not running; why it is not must not be lost (law 3)."""

    def broken(designator):
        raise LookupError("the motor is gone")

    def body():
        module = pm.registry.get_running_process_module(NAVIGATION)
        module.sleeper.interject(lambda: broken(None))
        return pm.pm_execute(NAVIGATION, motion())

    define(lambda designator: None)
    with pytest.raises(Exception, match="the motor is gone"):
        with_modules(body)


def test_a_module_that_ends_while_its_caller_is_suspended_fails_the_caller():
    """The caller asked again after its wake-up, and waited for ever."""
    define(lambda designator: cpl.sleep(10))

    def body():
        caller = cpl.Task(lambda: pm.pm_execute(NAVIGATION, motion()), "caller").execute()
        cpl.sleep(1)
        cpl.suspend(caller)
        module = pm.registry.get_running_process_module(NAVIGATION)
        module.sleeper.owner.evaporate()
        cpl.sleep(1)
        cpl.wake_up(caller)
        return fails_with(lambda: cpl.join_task(caller))

    failure = with_modules(body)
    assert "not running" in str(opened(failure))


def evaluated(text):
    return evaluate(Reader(text, "<test>").read())


def test_the_body_of_a_process_module_may_begin_with_declarations():
    assert evaluated("""(progn (cpm:def-process-module declaring (designator) (declare (ignore designator)) :done)
                          (cpm:with-process-modules-running (declaring)
                            (cpl:top-level (cpm:pm-execute 'declaring (desig:make-designator :motion nil)))))""") is keyword("DONE")
