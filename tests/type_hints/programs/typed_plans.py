"""What a type checker knows of plans: the types that a user of `cramhy_runtime.cpl` sees."""

from contextlib import ExitStack
from typing import Any, assert_type

from cramhy_runtime import cpl


class DoorStuck(cpl.PlanFailure):
    def __init__(self, angle: float) -> None:
        super().__init__(f"the door is stuck at {angle} degrees")
        self.angle = angle


def drive(metres: float, speed: float = 0.5) -> str:
    cpl.sleep(metres / speed)
    return f"drove {metres} m"


def look() -> list[str]:
    return ["cup"]


def starting() -> None:
    assert_type(cpl.run(drive, 2.0), str)
    assert_type(cpl.run(drive, 2.0, 0.1, clock="wall", seed=3, time_limit=60), str)
    with cpl.plan(clock="virtual", backend="greenlet") as root:
        assert_type(root.name, str)
        assert_type(root.started_at, float | None)
    assert_type(cpl.top_level(look), list[str])
    assert_type(cpl.named_top_level(look, "looking"), list[str])


def branches() -> None:
    assert_type(cpl.par(lambda: drive(2), look), str)
    assert_type(cpl.pursue(lambda: drive(2), look), str | list[str])
    assert_type(cpl.try_all(look), list[str])
    assert_type(cpl.try_in_order(lambda: drive(1), look), str | list[str])
    assert_type(cpl.try_in_order(*[look, look]), list[str])
    assert_type(cpl.try_each_in_order([1, 2], lambda x: x / 2), float)
    assert_type(cpl.par_loop({"cup", "plate"}, len), int | None)
    assert_type(cpl.seq(look, lambda: drive(1)), str)
    assert_type(cpl.with_task(look, "looking"), list[str])
    with cpl.par() as both:
        task = both.start(drive, 3, speed=1.0)
        assert_type(task.result, str)
        assert_type(task.alive, bool)
        task.suspend("wait", sync=False)
        cpl.evaporate(task, reason="enough")
    assert_type(task.join(), str)
    assert_type(cpl.join_task(task), str)
    with cpl.pursue() as race, cpl.try_all() as attempts:
        race.start(look)
        attempts.start(look)
        running: list[cpl.Task[object]] = [*race.tasks, *attempts.tasks]
        print(running, both.results)
    me = cpl.current_task()
    if me is not None:
        cpl.suspend(me)
        cpl.wake_up(me, sync=False)
        assert_type(me.status == cpl.RUNNING, bool)


def fluents() -> None:
    distance = cpl.make_fluent(name="distance", value=3.0)
    count = cpl.make_fluent(value=0)
    open_ = cpl.make_fluent(name="open", value=False)
    thing: cpl.ValueFluent[str | None] = cpl.make_fluent(name="thing")
    assert_type(distance, cpl.ValueFluent[float])
    assert_type(distance.value, float)
    distance.value -= 1
    thing.value = "cup"
    assert_type(distance.set(2.0), float)
    assert_type(distance < 1.0, cpl.Fluent[bool])
    assert_type(1 < distance, cpl.Fluent[bool])
    assert_type(count + 1, cpl.Fluent[int])
    assert_type(1.5 - count, cpl.Fluent[float])
    assert_type(abs(distance * 100), cpl.Fluent[float])
    assert_type((distance < 1.0) | open_, cpl.Fluent[bool | None])
    assert_type(~open_, cpl.Fluent[bool | None])
    assert_type(cpl.wait_for(thing), str)
    assert_type(cpl.wait_for(thing, timeout=2.0), str | None)
    assert_type(cpl.wait_for((distance < 1) & ~open_), bool)
    for seen in cpl.whenever(thing):
        assert_type(seen, str)
        break
    assert_type(cpl.fl_funcall(len, thing), cpl.Fluent[int])
    assert_type(cpl.value(distance), float)
    assert_type(cpl.value(5), int)
    for changed in cpl.whenever(cpl.pulsed(distance, handle_missed_pulses="ALWAYS")):
        assert_type(changed, bool)
    cpl.wait_for(cpl.fl_value_changed(distance, key=round, test=lambda new, old: new == old))
    cpl.register_update_callback(distance, "log", print)
    cpl.remove_update_callback(distance, "log")


class Battery(cpl.ValueFluent[float]):
    """A fluent of a user's own, and functions that take fluents."""

    def low(self, limit: cpl.Fluent[float]) -> cpl.Fluent[bool]:
        return self < limit


def show(fluent: cpl.Fluent[object], task: cpl.Task, anything: cpl.Fluent) -> Any:
    return fluent.name, task.result, anything.value


def failures() -> str:
    for attempt in cpl.attempts(3, on=(DoorStuck, ConnectionError), pause=2.0):
        with attempt, cpl.timeout(60):
            return drive(1)
    with cpl.move_on_after(1.0) as limit:
        drive(5)
    assert_type(limit.expired, bool)
    try:
        cpl.try_all(look)
    except cpl.CompositeFailure as failure:
        assert_type(failure.exceptions, list[BaseException])
    except cpl.TimedOut as late:
        assert_type(late.seconds, float | None)
    except cpl.CommonLispErrorEnvelope as error:
        raise error.error
    cpl.fail(DoorStuck(30))


def handlers() -> None:
    def unjam(failure: DoorStuck, retry: cpl.Retry) -> None:
        print(failure.angle)
        retry()

    def give_up(failure: ValueError, retry: cpl.Retry) -> None:
        retry.leave("nothing")

    @cpl.handling({DoorStuck: unjam, (ValueError, OSError): give_up})
    def pass_door(name: str, *, quickly: bool = False) -> str:
        if not quickly:
            cpl.fail("~a is closed", name)
        cpl.fail(cpl.SimplePlanFailure, format_control="closed")

    assert_type(pass_door("front", quickly=True), str)
    counter = cpl.RetryCounter(3)
    assert_type(counter.use(), bool | None)
    assert_type(counter.left, float)


@cpl.plan_function
def fetch(thing: str, *, quickly: bool = False) -> int:
    return len(thing)


def steps() -> None:
    assert_type(fetch("cup", quickly=True), int)
    look_, take = cpl.tag("look"), cpl.tag("take")
    assert_type(take.run(fetch, "cup"), int)
    assert_type(cpl.partial_order([lambda: look_.run(look), look], [(look_, take)]), list[str])
    place = cpl.define_task_variable("place", "home")
    place.value = "away"
    battery = cpl.make_fluent(value=80)
    low = cpl.make_policy("low-battery", check=lambda store, least: battery.value < least, recover=lambda store, least: print("home"))
    with ExitStack() as stack:
        stack.enter_context(cpl.policy(low, 20))
        stack.enter_context(cpl.cleanup())
        stack.enter_context(cpl.cleanup_time_limit(5.0))
        stack.enter_context(cpl.without_scheduling())
        stack.enter_context(cpl.on_suspension(lambda: print("brakes")))
    assert_type(cpl.retry_after_suspension(look), list[str])
    assert_type(cpl.run_blocking(len, "cup"), int)
    cpl.describe_task_tree(depth=2)
    assert_type(cpl.task_tree_text(), str)
