"""What a type checker knows of facts, designators and process modules: `prolog`, `designators`, `process_modules`."""

import math
from collections.abc import Iterator
from typing import Any, assert_type

from cramhy_runtime import cpl
from cramhy_runtime.designators import (
    Action,
    Location,
    Motion,
    Object,
    action_grounding,
    current_desig,
    desig_equal,
    equate,
    first_desig,
    forget,
    location_generator,
    location_validator,
    motion_grounding,
    next_solution,
    properties,
    property_values,
    reference,
    replace,
    solutions,
)
from cramhy_runtime.lisp_core.data import Keyword
from cramhy_runtime.process_modules import (
    AsynchronousModule,
    cancel,
    execute,
    monitor,
    perform,
    process_module,
    process_modules,
    running_module,
    status,
)
from cramhy_runtime.prolog import (
    Answer,
    Goal,
    P,
    V,
    explain,
    fact_group,
    findall,
    first,
    function,
    holds,
    kw,
    names,
    predicate,
    solve,
    test,
)

with fact_group("types of a family", extends=[P.member]) as family:
    family.fact(P.typed_parent("tom", "bob"), P.typed_parent("bob", "ann"))
    family.rule(P.typed_ancestor(V.x, V.y), P.typed_parent(V.x, V.y) & ~P["=="](V.x, V.y))
    family.rule(P.typed_ancestor(V.x, V.z), P.typed_parent(V.x, V.y) | P.typed_parent(V.y, V.x), V.n < 3)


def queries() -> None:
    for answer in solve(P.typed_ancestor("tom", V.who)):
        assert_type(answer, Answer)
        print(answer.who, answer[V.who], answer["who"])
    assert_type(first(P.member(V.x, [1, 2])), Answer | None)
    assert_type(holds(P.member(1, [V.first, *V.rest])), bool)
    assert_type(findall(V.x, P.member(V.x, [1])), list[Any])
    assert_type(findall((V.x, V.y), P.append(V.x, V.y, [1, 2])), list[tuple[Any, ...]])
    for left, right in findall((V.x, V.y), P.append(V.x, V.y, [1, 2])):
        print(left, right)
    assert_type(names("DESIG").motion_grounding(V.motion, V.what), Goal)
    assert_type(explain(P.member(3, [1, 2])).holds, bool)


@predicate
def typed_way(room: str) -> Iterator[tuple[str, float]]:
    yield "hall", 3.0


@function(name=P.typed_seconds)
def seconds(metres: float) -> float:
    return metres / 0.5


@test
def typed_near(metres: float) -> bool:
    return metres < 2.5


def predicates() -> None:
    assert_type(seconds.function(1.0), float)
    assert_type(typed_way("hall", V.to, V._), Goal)
    assert_type(holds(typed_near(1.5), seconds(1.5, V.s), P.lisp_fun(math.hypot, 3, 4, V.d)), bool)


class Driving(Motion):
    speed: float
    angle: float = 0.0
    careful: bool = False


class Patrolling(Action, type="patrolling"):
    rounds: int


class Near(Location):
    x: float


@motion_grounding(Driving)
def drive_command(motion: Driving) -> list[object]:
    return ["drive", motion.speed]


@motion_grounding
def any_command(motion: Motion) -> Iterator[str]:
    yield "stop"


@location_generator(Near, priority=5)
def around(place: Near) -> Iterator[float]:
    yield place.x + 0.5


@location_validator(Near)
def in_the_room(place: Near, candidate: float) -> bool:
    return candidate >= 0


@location_validator(priority=3)
def anywhere(place: Location, candidate: object) -> Keyword | None:
    return kw.maybe_reject if candidate is None else None


def patrol(rounds: int) -> int:
    return rounds


@action_grounding(Patrolling)
def how_to_patrol(action: Patrolling) -> tuple[object, ...]:
    return patrol, action.rounds


def designators() -> None:
    motion = Driving(speed=1.5, careful=True)
    assert_type(motion.speed, float)
    assert_type(replace(motion, speed=2.0), Driving)
    assert_type(next_solution(motion), Driving | None)
    assert_type(equate(Object(type=kw.cup), motion), Driving)
    assert_type(properties(motion), list[tuple[str, Any]])
    assert_type(drive_command(motion), list[object])
    cup = Object(("color", "red"), ("color", "blue"), type=kw.cup)
    print(cup["color"], "size" in cup, property_values(cup, "color"), cup.type.name)
    match Motion(type=kw.driving, speed=2.0, towards=cup):
        case Driving(speed=speed, angle=angle):
            assert_type(speed, float)
            print(angle)
    for solution in solutions(Near(x=0.2)):
        print(solution, reference(Near(x=0.5)))
    print(current_desig(motion), first_desig(motion), desig_equal(motion, cup))
    forget(drive_command)


@process_module(Driving)
def typed_base(motion: Driving) -> str:
    command, speed = reference(motion)
    return f"{command} {speed}"


@process_module
def typed_arm(motion: Motion) -> None: ...


class TypedHand(AsynchronousModule, kinds=[Driving], name=P.typed_hand):
    def on_input(self, designator: Driving) -> None:
        self.finish(designator)

    def on_cancel(self, designator: Driving) -> None:
        self.fail(cpl.SimplePlanFailure("cancelled"), designator)

    def ready(self, designator: Driving) -> cpl.Fluent[bool]:
        return cpl.make_fluent(value=True)


def acting() -> None:
    with process_modules(typed_base, TypedHand, left=typed_arm):
        assert_type(execute(typed_base, Driving(speed=1.0)), str)
        print(execute("left", Motion(type=kw.reaching)), perform(Patrolling(rounds=2)))
        cpl.wait_for(status(typed_base), timeout=3)
        assert_type(status(typed_base).value == kw.running, bool)
        assert_type(running_module(TypedHand), TypedHand)
        monitor(TypedHand, Driving(speed=1.0))
        cancel(typed_base)
