"""A plan in Python, without any Lisp: a robot fetches coffee along a corridor with a chair in the way and a door at its end.

It shows what plans are made of: fluents that the robot's body sets and the plan waits for, branches that run beside each other,
failures that are retried or handled where they arise, timeouts, suspension, and cleanup that no branch can overrun. The story is
told in virtual time, so it takes no time, and is the same each time. Run it with ``python tutorials/plans_in_python.py``; the page
docs/plans-in-python.md explains the words.
"""

from __future__ import annotations

from cramhy_runtime import cpl

SPEED = 0.5  # m/s
TICK = 0.1  # s


class Collision(cpl.PlanFailure):
    """The bumper touched something."""

    def __init__(self, place: float):
        super().__init__(f"something is in the way at {place:.1f} m")
        self.place = place


class DoorClosed(cpl.PlanFailure):
    """Nobody opened the door in time."""


def say(text: str) -> None:
    print(f"{cpl.now():5.1f} s  {text}")


class Robot:
    """The body: a motor, a bumper, and where it is. ``run`` is its physics, a branch that runs as long as the plan does."""

    def __init__(self) -> None:
        self.position = cpl.make_fluent(name="position", value=0.0)  # m along the corridor
        self.bumper = cpl.make_fluent(name="bumper", value=False)
        self.door_open = cpl.make_fluent(name="door-open", value=False)
        self.chair: float | None = 2.0  # m
        self.speed = 0.0

    def run(self) -> None:
        while True:
            cpl.sleep(TICK)
            place = round(self.position.value + self.speed * TICK, 3)
            self.bumper.value = blocked = self.chair is not None and place > self.chair
            if not blocked:
                self.position.value = place

    def stop(self) -> None:
        self.speed = 0.0
        say(f"the motor is off at {self.position.value:.1f} m")


def drive(robot: Robot, goal: float) -> None:
    """Drive to ``goal``, in m. However this ends, the motor is off afterwards."""
    say(f"drives to {goal:g} m")
    forward = goal > robot.position.value
    arrived = robot.position >= goal if forward else robot.position <= goal

    def keep_driving() -> None:
        robot.speed = SPEED if forward else -SPEED
        cpl.wait_for(arrived)

    def watch_bumper() -> None:
        cpl.wait_for(robot.bumper)
        raise Collision(robot.position.value)

    try:
        with cpl.on_suspension(robot.stop), cpl.pursue() as race:
            race.start(cpl.retry_after_suspension, keep_driving)
            if forward:
                race.start(watch_bumper)
    finally:
        robot.stop()


def ring(problem: DoorClosed, retry: cpl.Retry) -> None:
    """A handler: the plan still stands at the door, so it can ring and wait once more, without driving there again."""
    say(f"{problem}: rings the bell")
    retry()


@cpl.handling({DoorClosed: ring})
def pass_the_door(robot: Robot) -> None:
    if not cpl.wait_for(robot.door_open, timeout=5.0):
        raise DoorClosed("the door is closed")
    say("the door is open")


@cpl.plan_function
def fetch_coffee(robot: Robot) -> str:
    for attempt in cpl.attempts(3, on=Collision, pause=2.0):
        with attempt:
            try:
                drive(robot, 4.0)
            except Collision as collision:
                say(f"{collision}: gives way")
                drive(robot, collision.place - 0.5)
                raise
    pass_the_door(robot)
    with cpl.move_on_after(3.0) as patience:
        say("waits for the machine")
        cpl.sleep(10.0)
    return "tea" if patience.expired else "coffee"


def people(robot: Robot, errand: cpl.Task) -> None:
    """What else happens in the corridor."""
    cpl.sleep(7.05)
    robot.chair = None
    say("- somebody takes the chair away")
    cpl.sleep(3.0)
    say("- somebody wants to pass: the robot is told to stand still")
    with cpl.task_suspended(errand):
        cpl.sleep(4.0)
    say("- the corridor is free again")
    cpl.sleep(10.0)
    robot.door_open.value = True
    cpl.sleep(1000.0)


def main() -> str:
    robot = Robot()
    with cpl.par() as world:
        body = world.start(robot.run)
        errand = world.start(fetch_coffee, robot)
        others = world.start(people, robot, errand)
        drink = errand.join()
        say(f"brings {drink}")
        body.evaporate()
        others.evaporate()
    return drink


if __name__ == "__main__":
    cpl.run(main)
