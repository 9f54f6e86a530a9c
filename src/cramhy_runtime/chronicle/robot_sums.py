"""What messages about a robot's world add up to; see ``merge.py``."""

from __future__ import annotations

from cramhy_runtime.ros.messages import message_class_exact

TYPE, TOPIC = "cramhy_msgs/RobotWorld", "/cramhy/robot_world"


class RobotChanges:
    """The sum of messages about a robot's world: all motions one after the other, and the last marks."""

    def __init__(self):
        self.type = message_class_exact(TYPE)
        self.clear()

    def clear(self):
        self.stamp, self.complete, self.things, self.removed, self.steps, self.marks = 0.0, False, {}, [], [], []

    @property
    def changed(self):
        return bool(self.complete or self.things or self.removed or self.steps or self.marks)

    def add(self, message):
        self.stamp = message.stamp
        if message.complete:
            self.clear()
            self.stamp, self.complete = message.stamp, True
        for gone in message.removed:
            self.things.pop(gone, None)
            self.removed.append(gone)
        self.things.update((thing.name, thing) for thing in message.things)
        self.steps += message.steps
        self.marks = message.marks or self.marks

    def message(self, complete=None):
        """The sum as one message."""
        everything = True if self.complete or complete else None
        return self.type(self.stamp, everything, list(self.things.values()), list(self.removed), list(self.steps), list(self.marks))


class RobotState:
    """What there is now: the things, where they are, and the marks."""

    def __init__(self):
        self.type, self.step = message_class_exact(TYPE), message_class_exact("cramhy_msgs/WorldStep")
        self.stamp, self.things, self.states, self.marks = 0.0, {}, {}, []

    def add(self, message):
        self.stamp = message.stamp
        if message.complete:
            self.things, self.states, self.marks = {}, {}, []
        for gone in message.removed:
            self.things.pop(gone, None)
            self.states.pop(gone, None)
        self.things.update((thing.name, thing) for thing in message.things)
        for step in message.steps:
            self.states.update((state.name, state) for state in step.states if state.name in self.things)
        self.marks = message.marks or self.marks

    def message(self, complete=None):
        """Everything, as one message."""
        steps = [self.step(0.0, list(self.states.values()))] if self.states else []
        return self.type(self.stamp, True, list(self.things.values()), [], steps, list(self.marks))

    def copy(self):
        """What it is now, for `message` later. The things are shared: messages are never changed."""
        other = type(self)()
        other.stamp, other.things, other.states, other.marks = self.stamp, dict(self.things), dict(self.states), self.marks
        return other

    def __len__(self):
        return 2 * len(self.things)
