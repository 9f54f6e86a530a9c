"""Process modules and ``perform`` from Python: definition, running, requests, failures, and what is said about mistakes."""

from __future__ import annotations

import pytest

from cramhy_runtime import cpl, kernel
from cramhy_runtime.designators import Action, Motion, Object, action_grounding, equate, motion_grounding
from cramhy_runtime.lisp_core.condition_types import Error
from cramhy_runtime.lisp_core.data import values
from cramhy_runtime.process_modules import (
    AsynchronousModule,
    ProcessModuleRunning,
    ReferenceFailure,
    UnknownProcessModule,
    cancel,
    define_process_module,
    execute,
    monitor,
    perform,
    process_module,
    process_modules,
    running_module,
    status,
)
from cramhy_runtime.prolog import P, V, fact_group, findall, kw


class Driving(Motion):
    speed: float


class Drawing(Motion):
    shape: str


class Fetching(Action):
    what: str


@pytest.fixture
def log():
    return []


@pytest.fixture
def navigation(log):
    @motion_grounding
    def anything(motion):
        return motion.type

    @process_module(Driving)
    def navigation(motion):
        log.append(("begins", motion.speed, cpl.now()))
        try:
            cpl.sleep(10 / motion.speed)
        finally:
            log.append(("ends", motion.speed, cpl.now()))
        return ["there", motion.speed]

    return navigation


def text_of(problem):
    return "\n".join([str(problem.value), *getattr(problem.value, "__notes__", ())])


# ----------------------------------------------------------------------------------------------------------- execute, perform


def test_perform_finds_the_module_and_returns_what_its_function_returns(navigation, log):
    def plan():
        with process_modules(navigation):
            return perform(Driving(speed=2)), cpl.now()

    assert cpl.run(plan) == (["there", 2], 5.0)
    assert log == [("begins", 2, 0.0), ("ends", 2, 5.0)]
    assert cpl.run(plan) == (["there", 2], 10.0)  # and once more, in the same kernel


def test_a_block_is_a_plan_too(navigation):
    with cpl.plan(), process_modules(navigation):
        assert perform(Driving(speed=5)) == ["there", 5]


def test_an_action_is_its_plan_function_with_its_arguments(navigation, log):
    def fetch(what, times: list, arm=None):
        log.append((what, times, arm))
        return perform(Driving(speed=10)), what

    @action_grounding(Fetching)
    def grounding(action):
        return fetch, action.what, [], kw.left

    with cpl.plan(), process_modules(navigation):
        assert perform(Fetching(what="cup")) == (["there", 10], "cup")
    assert log[0] == ("cup", [], kw.left)


def test_a_module_says_what_it_is_for_by_types_or_by_a_function(navigation, log):
    @process_module(Drawing, Driving)
    def pen(motion):
        return "pen"

    @process_module(matches=lambda motion: "colour" in motion)
    def painter(motion):
        return "painter"

    with cpl.plan(), process_modules(pen, painter):
        assert [perform(motion) for motion in (Drawing(shape="o"), Driving(speed=1), Motion(type=kw.any, colour="red"))] == [
            "pen",
            "pen",
            "painter",
        ]
        assert findall(V.module, P.matching_process_module(Driving(speed=1), V.module)) == [navigation, pen]
        with pytest.raises(cpl.PlanFailure, match="No matching process module found for #<A MOTION"):
            perform(Motion(type=kw.drawing))  # without shape


def test_the_next_module_is_tried_when_one_fails(navigation, log):
    @process_module(Driving)
    def walking(motion):
        return "walked"

    @process_module(name=navigation)
    def broken(motion):
        cpl.fail("no fuel")

    with fact_group("choice", extends=[P.matching_process_module, P.available_process_module]) as group:
        group.rule(P.matching_process_module(V.d, navigation), P.desig_prop(V.d, [kw.type, kw.driving]))
        group.fact(P.available_process_module(navigation))
    with cpl.plan(), process_modules(walking, navigation):
        assert perform(Driving(speed=1)) == "walked"


def test_execute_takes_a_module_an_alias_or_a_name(navigation):
    with cpl.plan(), process_modules(navigation, left_arm=navigation):
        assert execute(navigation, Driving(speed=1)) == execute("left_arm", Driving(speed=1)) == ["there", 1]
        assert execute(P.navigation, Driving(speed=1)) == execute(P.left_arm.symbol, Driving(speed=1)) == ["there", 1]
        assert cpl.now() == 40.0


def test_values_of_a_module_of_lisp_are_a_tuple():
    define_process_module(P.in_lisp.symbol, lambda designator: values(1, None, designator.type))
    with cpl.plan(), process_modules(P.in_lisp):
        assert execute(P.in_lisp, Motion(type=kw.x)) == (1, None, kw.x)


def test_the_function_gets_the_youngest_of_the_equated_designators():
    @process_module
    def looking(designator):
        return designator

    old, young = Motion(), Motion()
    equate(old, young)
    with cpl.plan(), process_modules(looking):
        assert execute(looking, old) is young
    assert looking(old) is old  # called as a function it is the function


def test_requests_queue_up_and_each_gets_its_own_result(navigation, log):
    with cpl.plan(), process_modules(navigation):
        with cpl.par() as branches:
            slow, fast = (branches.start(execute, navigation, Driving(speed=speed)) for speed in (2, 5))
        assert (slow.result, fast.result) == (["there", 2], ["there", 5])
    assert [(what, speed) for what, speed, _ in log] == [("begins", 2), ("ends", 2), ("begins", 5), ("ends", 5)]


def test_who_is_ended_ends_what_it_asked_for(navigation, log):
    with cpl.plan(), process_modules(navigation):
        with cpl.move_on_after(2.0):
            perform(Driving(speed=1))
        assert log == [("begins", 1, 0.0), ("ends", 1, 2.0)]
        assert status(navigation).value is kw.waiting


def test_who_is_suspended_has_it_done_anew(navigation, log):
    with cpl.plan(), process_modules(navigation), cpl.par() as branches:
        driver = branches.start(perform, Driving(speed=2))
        cpl.sleep(1)
        with cpl.task_suspended(driver):
            cpl.sleep(3)
    assert [(what, when) for what, _, when in log] == [("begins", 0.0), ("ends", 1.0), ("begins", 4.0), ("ends", 9.0)]


def test_status_is_a_fluent_and_cancel_ends_what_is_done_now(navigation):
    with cpl.plan(), process_modules(navigation):
        state = status(navigation)
        with (
            pytest.raises(cpl.PlanFailure, match=r"(?s)^The execution of #<A MOTION.* by process module NAVIGATION was cancelled"),
            cpl.par() as branches,
        ):
            branches.start(perform, Driving(speed=1))
            cpl.sleep(1)
            assert state.value is kw.running
            cancel(navigation)
        assert state.value is kw.waiting and cpl.now() == 1.0
    assert state.value is kw.offline


# ------------------------------------------------------------------------------------------------------------------- failures


class DoorStuck(cpl.PlanFailure):
    pass


@pytest.mark.parametrize("problem", [DoorStuck("front door"), ValueError("no map")])
def test_what_a_module_fails_with_is_raised_where_it_was_asked(problem):
    @motion_grounding
    def anything(motion):
        return 1

    @process_module(Driving)
    def failing(motion):
        cpl.sleep(1)
        raise problem

    with cpl.plan(), process_modules(failing):
        for ask in (lambda: execute(failing, Driving(speed=1)), lambda: perform(Driving(speed=1))):
            with pytest.raises(type(problem)) as raised:
                ask()
            assert raised.value is problem and status(failing).value is kw.failed
        for attempt in cpl.attempts(1):
            with attempt, pytest.raises(type(problem)):
                execute(failing, Driving(speed=1))


def test_a_motion_that_cannot_be_resolved():
    @motion_grounding(Drawing)
    def draw(motion):
        return None

    @process_module(Drawing)
    def pen(motion):
        return motion

    with cpl.plan(), process_modules(pen), pytest.raises(ReferenceFailure) as problem:
        perform(Drawing(shape="o"))
    text = text_of(problem)
    assert isinstance(problem.value, cpl.PlanFailure) and isinstance(problem.value, Error)
    assert str(problem.value).endswith("could not be resolved.\nCannot perform motion.") and "draw" in text


def test_an_action_without_plan(navigation):
    @action_grounding(Fetching)
    def grounding(action):
        return P.fetch_it, action.what

    with cpl.plan(), pytest.raises(cpl.PlanFailure, match="resolved to cram function `FETCH-IT', but it isn't defined"):
        perform(Fetching(what="cup"))


def test_modules_that_are_not_there(navigation):
    with cpl.plan():
        with pytest.raises(UnknownProcessModule) as problem:
            execute(navigation, Driving(speed=1))
        assert text_of(problem) == (
            "Unknown process module: NAVIGATION \nFrom Python, modules run in a block: with process_modules(navigation): ..."
        )
        with process_modules(navigation), pytest.raises(UnknownProcessModule):
            status("other_arm")
        with process_modules(navigation), pytest.raises(ProcessModuleRunning), process_modules(navigation):
            pass


@pytest.mark.parametrize(
    "mistake, kind, text",
    [
        (lambda: cpl.run(lambda: perform(3)), TypeError, "3 is no designator, and cannot be performed. Make one: Motion(type=kw.driving)."),
        (
            lambda: cpl.run(lambda: execute(len, Motion())),
            TypeError,
            "<built-in function len> is no process module. Decorate a function with @process_module.",
        ),
        (
            lambda: process_module(matches=len)(lambda motion: 1),
            TypeError,
            "<lambda> cannot name a process module. Write process_module(name=P.navigation)(...).",
        ),
        (
            lambda: process_module(Motion)(test_a_block_is_a_plan_too),
            TypeError,
            "Motion describes all motions. Say so by a function: matches=lambda designator: True.",
        ),
        (
            lambda: process_module(int)(test_a_block_is_a_plan_too),
            TypeError,
            "<class 'int'> is no declared type of designators. Declare one, class Driving(Motion): ..., or give a function: "
            "matches=lambda designator: ...",
        ),
    ],
)
def test_mistakes_say_what_to_write(mistake, kind, text):
    with pytest.raises(kind) as problem:
        mistake()
    assert text_of(problem) == text


@pytest.mark.parametrize(
    "form, use",
    [
        ("PERFORM", lambda: perform(Motion())),
        ("EXECUTE", lambda: execute("arm", Motion())),
        ("STATUS", lambda: status("arm")),
        ("CANCEL", lambda: cancel("arm")),
        ("MONITOR", lambda: monitor("arm")),
        ("PROCESS-MODULES", lambda: process_modules().__enter__()),
    ],
)
def test_outside_of_a_plan(form, use):
    with kernel.aside(), pytest.raises(Error) as problem:
        use()
    assert text_of(problem) == (
        f"'{form}' form not inside a plan.\nFrom Python, run the plan with cpl.run(main), or write it below `with cpl.plan():`."
    )


# --------------------------------------------------------------------------------------------------------------- asynchronous


def test_an_asynchronous_module(log):
    class Reaching(Motion):
        height: int

    class Arm(AsynchronousModule, kinds=[Reaching]):
        def on_run(self):
            log.append("runs")
            cpl.sleep(100)

        def on_input(self, motion):
            log.append((motion.height, cpl.now()))
            cpl.sleep(1)
            if motion.height > 2:
                self.fail(ValueError("too high"), motion)
            else:
                self.finish(motion)

    low, middle, high = (Reaching(height=height) for height in (1, 2, 3))
    with cpl.plan(), process_modules(Arm):
        assert [execute(Arm, motion) for motion in (low, middle, high)] == [low, middle, high] and cpl.now() == 0.0
        assert status(Arm).value is kw.running
        monitor(Arm, middle)
        assert cpl.now() == 2.0
        with pytest.raises(ValueError, match="^too high$"):
            monitor(Arm)
        assert cpl.now() == 3.0 and isinstance(running_module(Arm), Arm)
    assert log == ["runs", (1, 0.0), (2, 1.0), (3, 2.0)]


def test_it_takes_an_input_when_it_is_ready_and_hears_of_a_cancellation(log):
    free = cpl.make_fluent(name="free", value=False)

    class Gripper(AsynchronousModule):
        def on_input(self, motion):
            log.append(cpl.now())

        def on_cancel(self, motion):
            log.append(("cancelled", motion))
            self.finish(motion)

        def ready(self, motion):
            return free

    motion = Motion()
    with cpl.plan(), process_modules(Gripper):
        with cpl.par() as branches:
            branches.start(execute, Gripper, motion)
            cpl.sleep(2)
            free.value = True
        cpl.sleep(1)
        cancel(Gripper)
        monitor(Gripper)
    assert log == [2.0, ("cancelled", motion)]


def test_one_that_does_not_say_what_it_does():
    class Idle(AsynchronousModule):
        pass

    with pytest.raises(NotImplementedError) as problem, cpl.plan(), process_modules(Idle):
        execute(Idle, Motion())
        monitor(Idle)
    assert text_of(problem).startswith("Idle does not say what it does with a designator: def on_input(self, designator): ...")


def test_the_designator_of_another_kind_is_a_dispatch_error(navigation):
    with cpl.plan(), pytest.raises(Error, match="no applicable method"):
        perform(Object())


def test_modules_hold_for_derived_types_after_modules_for_the_derived_type():
    class Going(Motion):
        speed: float

    class Parking(Going):
        lot: str = "a"

    motion_grounding(lambda motion: ["go"])

    @process_module(Going)
    def base(motion):
        return "base", motion.speed

    class Docking(Going):
        port: int = 1

    @process_module(Docking)
    def dock(motion):
        return "dock", motion.port

    def main():
        with process_modules(base, dock):
            return perform(Going(speed=1.0)), perform(Parking(speed=2.0)), perform(Docking(speed=3.0))

    assert cpl.run(main) == (("base", 1.0), ("base", 2.0), ("dock", 1))
