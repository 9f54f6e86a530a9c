"""What messages about changes add up to: one message about many changes, or all that there is now.

Each sum takes the messages of one topic in order (`add`). `message` gives what they come to: the changes since `clear`, or, where the
first of them was complete, everything. Pages get their messages merged so that they come at most 60 times a second, late joiners and
chapters of the past get the whole, and a recording that is replayed adds up to what there was at any of its moments.
"""

from __future__ import annotations

from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.turtlesim.strokes import PIECE, Ink
from cramhy_runtime.turtlesim.dimensions import EXTENT

from . import robot_sums


class Things:
    """The sum of messages that hold things with an ``id``, and the ids of those that are ``removed``.

    whole: it is a `State`'s, which is only ever asked for everything. Then no ids are kept of what is gone: in hours they are many.
    """

    def __init__(self, ros_type, field, whole=False):
        self.type, self.field, self.whole = message_class_exact(ros_type), field, whole
        self.clear()

    def clear(self):
        """Begin anew, with no change."""
        self.stamp, self.complete, self._things, self._copied, self.removed = 0.0, False, {}, (), []

    @property
    def things(self):
        """The things by their ids. A copy keeps them in a row until somebody asks, which takes a fifth of the memory."""
        if self._things is None:
            self._things, self._copied = {thing.id: thing for thing in self._copied}, ()
        return self._things

    @property
    def changed(self):
        return bool(self.complete or len(self) or self.removed)

    def add(self, message):
        self.stamp = message.stamp
        if message.complete:
            self.complete, self._things, self._copied, self.removed = True, {}, (), []
        things = self.things
        for thing in getattr(message, self.field):
            things[thing.id] = thing
        for gone in message.removed:
            things.pop(gone, None)
            self.removed.append(gone)
        if self.complete or self.whole:
            self.removed = []

    def message(self, complete=None):
        """The sum as one message; ``complete``: that it is everything there is."""
        everything = True if self.complete or self.whole or complete else None
        removed = [] if everything else list(self.removed)
        return self.type(stamp=self.stamp, complete=everything, removed=removed, **{self.field: list(self._row())})

    def _row(self):
        return self._copied if self._things is None else self._things.values()

    def copy(self):
        """What it is now, for `message` later."""
        other = type(self)(whole=self.whole)
        other.stamp, other.complete, other._things, other._copied = self.stamp, self.complete, None, tuple(self._row())
        return other

    def __len__(self):
        return len(self._row())


class TaskTrees(Things):
    def __init__(self, whole=False):
        super().__init__("cramhy_msgs/TaskTree", "tasks", whole)


class FluentLists(Things):
    def __init__(self, whole=False):
        super().__init__("cramhy_msgs/Fluents", "fluents", whole)


class Latest:
    """The sum of messages each of which tells everything: the last one."""

    def __init__(self, ros_type="cramhy_msgs/ProcessModules"):
        self.type = message_class_exact(ros_type)
        self.clear()

    def clear(self):
        self.last = None

    @property
    def changed(self):
        return self.last is not None

    def add(self, message):
        self.last = message

    def message(self, complete=None):
        return self.type() if self.last is None else self.last

    def copy(self):
        other = type(self)()
        other.last = self.last
        return other

    def __len__(self):
        return 0 if self.last is None else 1


class WorldChanges:
    """The sum of messages about the turtles' world: where the turtles are last, and every stroke since the last new paper."""

    def __init__(self):
        self.type = message_class_exact("cramhy_msgs/World")
        self.clear()

    def clear(self):
        self.last, self.complete, self.strokes = None, False, []

    @property
    def changed(self):
        return self.last is not None

    def add(self, message):
        if message.complete:
            self.complete = True
        if self.last is None or message.complete or message.clears != self.last.clears:
            self.strokes = []
        self.strokes += message.strokes
        self.last = message

    def message(self, complete=None):
        message = self.last.copy()
        message.complete, message.strokes = True if self.complete else None, list(self.strokes)
        return message


class WorldState:
    """The world as it is. Its strokes are thinned out piece by piece and kept as ink, 20 bytes each.

    Copies share the ink, of which they know how much there was: it only grows, until there is new paper or no more room.
    """

    def __init__(self):
        self.type, self.stroke_type = message_class_exact("cramhy_msgs/World"), message_class_exact("cramhy_msgs/Stroke")
        self.last, self.ink, self.amount, self.borrowed, self.recent = None, Ink(), 0, False, []

    def add(self, message):
        if self.last is None or message.complete or message.clears != self.last.clears:
            self.ink, self.amount, self.borrowed, self.recent = Ink(), 0, False, []
        self.recent += [
            (each.x2, EXTENT - each.y2, each.x1, EXTENT - each.y1, (each.r, each.g, each.b), each.width) for each in message.strokes
        ]
        if len(self.recent) >= PIECE:
            self._thin_out()
        self.last = message

    def _thin_out(self):
        if self.borrowed or not self.ink.room_for(len(self.recent)):  # what others share stays as it is
            self.ink, self.borrowed = self.ink.first(self.amount), False
        self.ink.take_thinned(self.recent)
        self.amount, self.recent = len(self.ink), []

    def message(self, complete=None):
        if self.last is None:
            return self.type(complete=True)
        make, ink = self.stroke_type, self.ink.first(self.amount)
        ink.take(self.recent)
        message = self.last.copy()
        message.complete = True
        message.strokes = [make(x1, y1, x2, y2, *colour, width) for x1, y1, x2, y2, colour, width in ink.strokes()]
        return message

    def copy(self):
        """What it is now, for `message` later. The recent strokes become ink, since as Python's objects they take ten times as much."""
        if self.recent:
            self._thin_out()
        other = type(self)()
        other.last, other.ink, other.amount, other.borrowed = self.last, self.ink, self.amount, True
        return other

    def __len__(self):
        return 0 if self.last is None else len(self.last.turtles) + self.amount // 10 + len(self.recent) // 3


KINDS = ("world", "tasks", "fluents", "modules", "robots")
TOPICS = {
    "world": "/cramhy/world",
    "tasks": "/cramhy/tasks",
    "fluents": "/cramhy/fluents",
    "modules": "/cramhy/process_modules",
    "robots": robot_sums.TOPIC,
}
TYPES = {
    "world": "cramhy_msgs/World",
    "tasks": "cramhy_msgs/TaskTree",
    "fluents": "cramhy_msgs/Fluents",
    "modules": "cramhy_msgs/ProcessModules",
    "robots": robot_sums.TYPE,
}
CHANGES = {"world": WorldChanges, "tasks": TaskTrees, "fluents": FluentLists, "modules": Latest, "robots": robot_sums.RobotChanges}


class State:
    """Everything as it is now: the sum of all messages of each kind."""

    def __init__(self):
        self.sums = {
            "world": WorldState(),
            "tasks": TaskTrees(whole=True),
            "fluents": FluentLists(whole=True),
            "modules": Latest(),
            "robots": robot_sums.RobotState(),
        }

    def add(self, kind, message):
        self.sums[kind].add(message)

    def messages(self):
        """Kind → the complete message."""
        return {kind: made.message(True) for kind, made in self.sums.items()}

    def copy(self):
        other = type(self)()
        other.sums = {kind: made.copy() for kind, made in self.sums.items()}
        return other

    def __len__(self):
        return sum(map(len, self.sums.values()))
