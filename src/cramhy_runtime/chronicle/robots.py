"""What the robot's world looks like: what its things are made of, where they are, motion by motion, and what the plan considers.

Nothing of MuJoCo is loaded for it: a world that is shown has loaded it. While nobody looks on, nothing of this is there.
"""

from __future__ import annotations

import math
from collections import deque

from ..robot_world import remarks, shown
from ..ros.messages import message_class_exact
from ..ros.wire import ros_text

MOST_NOTES = 500
"""Motions between two looks that are kept; of more, every second one."""
MOST_GRASPS = 24
"""Poses of tools that are told."""
FARTHEST = 100.0
"""How far from the middle of the world a hand may put something, m."""


class Robots:
    """Watches the world that is shown, as soon as there is one. `take` gives what is new as a ``cramhy_msgs/RobotWorld``, or ``None``."""

    def __init__(self, now):
        self.now = now
        self.type = message_class_exact("cramhy_msgs/RobotWorld")
        self.forms = None  # how things become messages; it needs MuJoCo
        self.world = self.notes = None
        self.whole = False  # whether all that there is must be told
        self.labels = {}  # name of a thing -> as it is told
        self.costmap, self.grasps, self.seen = None, deque(maxlen=MOST_GRASPS), {}
        self.changed = self.remarked = False

    def begin(self):
        shown.watch(self._note)
        remarks.listen(self._remark)
        if shown.current() is not None:
            self._adopt(shown.current())

    def end(self):
        shown.unwatch(self._note)
        remarks.unlisten(self._remark)
        self.world = self.notes = None

    def _adopt(self, world):
        """Another world is shown, or none any more."""
        self.whole, self.world, self.notes, self.labels = True, world, None, {}
        self.costmap, self.seen = None, {}
        self.grasps.clear()
        self.changed = self.remarked = False
        if world is not None:
            from ..robot_world.notes import Notes

            self.notes = Notes(world, MOST_NOTES)

    def _note(self, world):
        if world is shown.current():
            if world is not self.world:
                self._adopt(world)
            else:
                self.changed = self.notes.add(world) or self.changed

    def _remark(self, kind, value):
        self.remarked = True
        if kind == "costmap":
            self.costmap = value
        elif kind == "grasp":
            machine, goal, reached = value
            if machine.world is self.world:
                self.grasps.append((machine.name, machine.placement @ goal, reached))
        else:
            self.seen.update((value,))

    def take(self):
        """What has happened in the world since the last call."""
        world = shown.current()
        if world is not self.world:
            self._adopt(world)
        if not (self.whole or world is not None and (self.changed or self.remarked)):
            return None
        message = self.type(stamp=self.now(), complete=True if self.whole else None)
        if world is not None:
            if self.forms is None:
                from . import robot_forms as forms

                self.forms = forms
            if self.whole or self.changed:
                self._tell_motions(message)
            if self.whole or self.remarked:
                message.marks = [self._marks()]
        self.whole = self.changed = self.remarked = False
        return message

    def _tell_motions(self, message):
        worlds = self.notes.take()
        before, now = {} if self.whole else worlds[0].things, worlds[-1].things
        gone = [name for name in before if name not in now]
        message.removed = [self.labels.pop(name) for name in gone]
        new = [name for name, thing in now.items() if name not in before or self.forms.differs(before[name], thing)]
        message.things = [self.forms.thing(self._label(name), now[name]) for name in new]
        first = [self.forms.step(None, worlds[0], self.labels)] if self.whole else []
        steps = [self.forms.step(one, other, self.labels) for one, other in zip(worlds, worlds[1:])]
        message.steps = first + [step for step in steps if step.states]
        for name in gone:
            self.remarked = self.seen.pop(name, None) is not None or self.remarked

    def _label(self, name):
        """What a thing is called for those who look on: small letters, and a number if two things would be called alike."""
        if name not in self.labels:
            text = ros_text(str(getattr(name, "name", name)).lower())
            taken, label, number = set(self.labels.values()), text, 2
            while label in taken:
                label, number = f"{text} ({number})", number + 1
            self.labels[name] = label
        return self.labels[name]

    def _marks(self):
        grasps = [(self.labels.get(name, ""), place, good) for name, place, good in self.grasps]
        seen = [(self.labels[name], place, True) for name, place in self.seen.items() if place is not None and name in self.labels]
        return self.forms.marks(self.costmap, grasps, seen)

    # ------------------------------------------------------------------------------------------------------------ by hand

    def move(self, label, x, y, z):
        """Put an object somewhere by hand, where it falls until it lies; where that is. Errors: ValueError says why it cannot be."""
        world = shown.current()
        if world is None:
            raise ValueError("Nothing can be moved by hand: the session has no robot world. (robot.world() makes one.)")
        found = {told: name for name, told in self.labels.items()} if world is self.world else {}
        thing = world.things.get(found.get(label, label))
        if thing is None:
            raise ValueError(f"There is nothing called {label} in the robot's world.")
        from . import robot_forms

        if not robot_forms.movable(thing):
            raise ValueError(f"{label} cannot be moved by hand: only free objects can, and it is part of the house or a robot.")
        if not all(math.isfinite(value) and abs(value) <= FARTHEST for value in (x, y, z)):
            raise ValueError(f"{label} cannot be put at ({x:g}, {y:g}, {z:g}): a place is three numbers of metres, up to {FARTHEST:g}.")
        holders = world.holders(thing.name)
        if holders:
            machine, link = holders[0]
            holder = self.labels.get(machine.name, str(machine.name))
            raise ValueError(f"{label} cannot be moved by hand: {holder} holds it with {link}. Let the plan put it down first.")
        return robot_forms.let_go(world, thing, (x, y, z))
