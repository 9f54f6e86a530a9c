"""Transports between random places of the kitchen, and a judge that asks MuJoCo, not the robot, where the thing is then."""

import random
from math import acos, dist, hypot

from cramhy_runtime.robot_world.mujoco_parts import mujoco

from cramhy import robot

KINDS = {"bottle": 4, "bowl": 4, "cup": 4, "cereal": 4, "milk": 4, "spoon": 4, "breakfast-cereal": 2, "fork": 1, "knife": 1, "plate": 1}
"""With how often they are drawn; a mug and a carton of buttermilk, of which no grasp is known, are drawn as often as a plate."""
KINDS |= {"mug": 1, "buttermilk": 1}
NEAR = (0.055, -0.1, 0.05, 0.52)
"""How far beside its target, above it at least and at most (metres), and how much tilted (radians) a thing stands there; the robot's own
tolerances and a little, since the judge looks ten seconds later."""


def spots(draw, count):
    """So many places on the counter that are 24 cm apart."""
    found = []
    for _ in range(10_000):
        spot = (draw.uniform(1.36, 1.5), draw.uniform(-0.1, 1.15))
        if len(found) < count and apart(found, spot):
            found.append(spot)
    return found


def apart(places, spot):
    return all(dist(spot, other) >= 0.24 for other in places)


def target(draw, taken):
    """A place on the island, on the table, or elsewhere on the counter."""
    where, yaw = draw.choice(["island", "table", "counter"]), draw.uniform(-180, 180)
    if where == "island":
        return draw.uniform(-1.05, -0.8), draw.uniform(0.9, 2.1), yaw
    for _ in range(200 if where == "counter" else 0):
        spot = (draw.uniform(1.38, 1.5), draw.uniform(-0.1, 1.15))
        if apart(taken, spot):
            return *spot, yaw
    return draw.uniform(-1.9, -0.9), draw.uniform(-1.1, -0.87), yaw


def height(kind, x, y, yaw):
    """Where the origin of such a thing is when it stands there."""
    made = robot.world()
    made.spawn(kind, robot.at(x, y, 1.05, yaw=yaw), name="probe")
    made.settle()
    return made.pose("probe").origin.z


def mujoco_has(world, name):
    """(position, quaternion) of a thing in MuJoCo's data."""
    core = world.core
    thing = next(thing for thing in core.things.values() if thing.name.name.lower() == name)
    if hasattr(core, "engine"):
        model, data = core.engine.model, core.engine.data
        body = model.body(f"thing {list(core.engine.things).index(thing)}").id
    else:
        model, data = core.scene.model, core.scene.data
        body = next(part.body for part in core.scene.parts if part.thing is thing)
    mujoco.mj_kinematics(model, data)
    return data.xpos[body].copy(), data.xquat[body].copy()


def transported(mode, seed):
    """What `robot.transport` says of the transport of this seed, and whether the thing stands at its target: ("", True) is a success."""
    draw = random.Random(f"transport {seed}")
    kind = draw.choices(list(KINDS), KINDS.values())[0]
    others = [each for each in draw.sample(["cup", "milk", "bowl", "bottle", "cereal"], draw.choice([0, 1, 2, 3])) if each != kind]
    places = spots(draw, 1 + len(others))
    turns = [draw.uniform(-180, 180) for _ in places]
    x, y, yaw = target(draw, places)
    z = height(kind, x, y, yaw) + 0.01
    world = robot.world(mode=mode)
    for each, place, turn in zip([kind, *others], places, turns, strict=False):
        world.spawn(each, robot.at(*place, 0.9 if each == "spoon" else 0.99, yaw=turn), name="it" if each == kind else None)
    world.settle(5)
    start = world.pose("it").origin
    said = ""
    try:
        robot.transport(kind, (start.x, start.y, start.z), robot.at(x, y, z, yaw=yaw))
    except robot.failures.HighLevelFailure as failure:
        said = f"{type(failure).__name__}: {failure}"
    world.settle()
    place, (w, a, b, _) = mujoco_has(world, "it")
    tilted = acos(max(-1.0, min(1.0, 1 - 2 * (a * a + b * b))))
    beside, lowest, highest, most_tilted = NEAR
    near = hypot(place[0] - x, place[1] - y) <= beside and lowest <= place[2] - z <= highest and tilted <= most_tilted
    return said, near and not world.held()
