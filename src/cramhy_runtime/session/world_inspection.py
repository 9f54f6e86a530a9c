"""Inspection of robots' worlds: the things in a world, where they are, who holds them, how joints stand.

What takes MuJoCo time, such as which things touch, is computed when somebody asks: that is an action. This module is needed only where
there is a world, so `inspection` asks `knows` first, which loads nothing.
"""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.printing import prin1_to_string

HOME = "cramhy_runtime.robot_world.world"


def knows(obj):
    """Whether ``obj`` is a world or a thing in one."""
    home = sys.modules.get(HOME)
    return home is not None and isinstance(obj, (home.World, home.Thing))


def told(obj):
    """(title, [(label, value)], [(label of an action, function)]) of a world or a thing."""
    home = sys.modules[HOME]
    if isinstance(obj, home.World):
        return _world(obj)
    return _item(obj) if isinstance(obj, home.Item) else _machine(obj)


def _world(world):
    parts = [(prin1_to_string(name), thing) for name, thing in world.things.items()]
    return (
        f"The object is a world with {len(parts)} thing{'s'[: len(parts) != 1]}.",
        parts,
        [("simulate 1 s", lambda: world.simulate(1.0))],
    )


def _item(item):
    parts = [("Name", item.name), ("Types", list_from(item.types)), ("Pose", item.placement.pose()), ("Mass in kg", item.mass)]
    if item.world is not None:
        parts += [("Held by", machine) for machine, _ in item.world.holders(item.name)]
    return "The object is a thing in a world.", parts, _touching(item)


def _machine(machine):
    parts = [("Name", machine.name), ("Pose", machine.placement.pose())]
    if machine.world is not None:
        parts += [("Holds", machine.world.things[name]) for name in machine.holds if name in machine.world.things]
    parts += [(f"Joint {name}", machine.joint(name)) for name in machine.skeleton.joint_numbers]
    return f"The object is {'furniture' if machine.fixed else 'a machine'} in a world.", parts, _touching(machine)


def _touching(thing):
    if thing.world is None:
        return []
    return [("see what it touches", lambda: [list_from(thing.world.touching(thing.name))]), ("go to its world", lambda: [thing.world])]
