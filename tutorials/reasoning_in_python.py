"""Reasoning and acting in Python, without any Lisp: a robot lays the table in a kitchen that it knows only by description.

The plan says what is wanted, "a cup, on the table". Where cups are kept is a matter of facts and rules, where to stand is proposed and
judged when it is needed, which part of the robot moves is found by what the motion is, and how an action is done is looked up, too. So
nothing in the plan names a place, a module or a way; each can be exchanged while the plan stays. Things go wrong: a shelf is empty, the
gripper slips, and a place cannot be reached. Run it with ``python tutorials/reasoning_in_python.py``; the page
docs/reasoning-in-python.md explains the words.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cramhy_runtime import cpl
from cramhy_runtime.designators import (
    Action,
    Location,
    Motion,
    Object,
    action_grounding,
    location_generator,
    location_validator,
    motion_grounding,
    reference,
)
from cramhy_runtime.process_modules import perform, process_module, process_modules
from cramhy_runtime.prolog import P, V, fact_group, findall, first, test

SPEED = 0.5  # m/s
REACH = 1.0  # m
PLACES = {"shelf": (4.0, 0.0), "dishwasher": (1.0, 3.0), "table": (0.0, 0.0)}  # m
CONTENTS = {"shelf": ["plate"], "dishwasher": ["cup", "plate"], "table": []}


class NotThere(cpl.PlanFailure):
    """The robot looked, and saw nothing of the kind."""


class Slipped(cpl.PlanFailure):
    """The gripper closed on air."""


def say(text: str) -> None:
    print(f"{cpl.now():5.1f} s  {text}")


# What is known. Rules say where to look first: where things of that kind are kept, and then wherever dishes are.

with fact_group("kitchen") as kitchen:
    kitchen.fact(P.kept("cup", "shelf"), P.kept("plate", "shelf"), P.kept("spoon", "drawer"))
    kitchen.fact(P.dishes("cup"), P.dishes("plate"))
    kitchen.rule(P.look_for(V.thing, V.place), P.kept(V.thing, V.place))
    kitchen.rule(P.look_for(V.thing, "dishwasher"), P.dishes(V.thing))


# What there is to do, and what for. The classes declare types of designators: ``(an action (type bringing) (thing "cup") ...)``.


class Bringing(Action):
    thing: str
    to: str


class Fetching(Action):
    thing: Object


class Near(Location):
    """A place from where something can be reached."""

    what: str


class Driving(Motion):
    to: Location


class Grasping(Motion):
    thing: Object


# Where to stand: candidates around the thing, the nearest first; the wall is somebody else's business.


@location_generator(Near, priority=5)
def around(place: Near) -> Iterator[tuple[float, float]]:
    x, y = PLACES[place.what]
    for step in (0.6, 0.8, 1.2):
        yield from ((x + step, y), (x - step, y), (x, y + step))


@location_validator(Near)
def inside_the_room(place: Near, candidate: list[float]) -> bool:
    return candidate[0] <= 4.0


@location_validator(Near)
def within_reach(place: Near, candidate: list[float]) -> bool:
    x, y = PLACES[place.what]
    return abs(candidate[0] - x) + abs(candidate[1] - y) <= REACH


# How it is done. An action is a plan function with arguments, a motion a command for a part of the robot.


@action_grounding(Bringing)
def bringing(action: Bringing) -> Iterator[tuple[Any, ...]]:
    yield bring, action.thing, action.to


@action_grounding(Fetching)
def fetching(action: Fetching) -> tuple[Any, ...]:
    return fetch, action.thing


@motion_grounding(Driving)
def driving(motion: Driving) -> Any:
    return reference(motion.to)


@motion_grounding(Grasping)
def grasping(motion: Grasping) -> str:
    return str(motion.thing["name"])


def bring(thing: str, to: str) -> str:
    """Try one place after the other where the thing may be, and put it down at ``to``."""

    def fetch_from(place: str) -> Any:
        return perform(Fetching(thing=Object(name=thing, at=place)))

    cpl.try_each_in_order(findall(V.place, P.look_for(thing, V.place)), fetch_from)
    perform(Driving(to=Near(what=to)))
    CONTENTS[to].append(thing)
    say(f"puts the {thing} on the {to}")
    return thing


def fetch(thing: Any) -> None:
    perform(Driving(to=Near(what=thing.at)))
    if thing.name not in CONTENTS[thing.at]:
        say(f"sees no {thing.name} at the {thing.at}")
        raise NotThere(thing.name)
    for attempt in cpl.attempts(3, on=Slipped, pause=0.5):
        with attempt:
            perform(Grasping(thing=thing))


# The parts of the robot: each is a process module, does one thing at a time, and says which motions it is for.


class Robot:
    place = (0.0, 0.0)
    grasps = 0


@process_module(Driving)
def base(motion: Driving) -> None:
    x, y = reference(motion)
    metres = abs(x - Robot.place[0]) + abs(y - Robot.place[1])
    say(f"drives {metres:.1f} m to ({x:g}, {y:g})")
    cpl.sleep(metres / SPEED)
    Robot.place = (x, y)


@process_module(Grasping)
def gripper(motion: Grasping) -> None:
    cpl.sleep(1.0)
    Robot.grasps += 1
    if Robot.grasps == 1:
        say("the gripper slips")
        raise Slipped(reference(motion))
    CONTENTS[motion.thing["at"]].remove(reference(motion))
    say(f"holds the {reference(motion)}")


@test
def laid(thing: str) -> bool:
    return thing in CONTENTS["table"]


def main() -> list[str]:
    with process_modules(base, gripper):
        for thing in ("plate", "cup"):
            perform(Bringing(thing=thing, to="table"))
    on_table = findall(V.thing, P.member(V.thing, ["cup", "plate", "spoon"]), laid(V.thing))
    say(f"the table is laid with {' and '.join(on_table)}")
    missing = first(P.kept(V.thing, V.place), ~laid(V.thing))
    if missing:
        say(f"the {missing.thing} is still in the {missing.place}")
    return on_table


if __name__ == "__main__":
    cpl.run(main)
