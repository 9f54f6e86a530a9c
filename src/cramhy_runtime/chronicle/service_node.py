"""The hidden node ``/cramhy``: topics and services for whoever looks on, a page above all.

Topics: ``/cramhy/world``, ``/cramhy/tasks``, ``/cramhy/fluents``, ``/cramhy/process_modules``, ``/cramhy/robot_world`` tell what has
changed, each at most 60 times a second of the wall, merged (`sums`); ``/cramhy/pace`` tells how plan time passes, and keeps its last
message for late subscribers.
Services: ``/cramhy/get_state`` gives everything as it is, ``/cramhy/get_history`` what was published before, ``/cramhy/set_pace`` and
``/cramhy/step`` hold plan time back, ``/cramhy/seek`` goes to a time of a recording.

What is told comes from an owner, a session with plans (`chronicler`) or a recording that is replayed (`player`); it has ``state``, the
`sums.State` of now; ``look()``, to bring that up to date; ``pace_message()``; and ``set_pace(paused, speed)``, ``step(seconds)``,
``seek(stamp)`` and ``move_thing(name, x, y, z)``, which raise ValueError or KernelError for what cannot be.
"""

from __future__ import annotations

import time

from cramhy_runtime import kernel
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact, service_type_exact
from cramhy_runtime.ros.services import Refusal
from cramhy_runtime.ros.wire import as_float
from .history import History
from .merge import CHANGES, KINDS, TOPICS, TYPES

PERIOD = 1 / 60
"""Seconds of the wall between two messages on a topic, at least."""


class Board:
    """The node, and what waits to be published on it. ``wall``: a clock in seconds, for tests."""

    def __init__(self, owner, wall=time.monotonic):
        self.owner, self.wall = owner, wall
        self.node = node = graph.active().node("cramhy", hidden=True)
        self.publications = {kind: node.advertise(TOPICS[kind], message_class_exact(TYPES[kind])) for kind in KINDS}
        self.pace = node.advertise("/cramhy/pace", message_class_exact("cramhy_msgs/Pace"), latch=True)
        self.pending = {kind: CHANGES[kind]() for kind in KINDS}
        self.history = History()
        self.next = -1.0
        self.told_pace = None
        for name, kind, handler in (
            ("get_state", "GetState", self._get_state),
            ("get_history", "GetHistory", self._get_history),
            ("set_pace", "SetPace", self._set_pace),
            ("step", "Step", self._step),
            ("seek", "Seek", self._seek),
            ("move_thing", "MoveThing", self._move_thing),
        ):
            self._serve(name, service_type_exact(f"cramhy_msgs/{kind}"), handler)

    def close(self):
        """Take the node off the graph."""
        self.node.shutdown()

    @property
    def due(self):
        """Whether enough time has passed since the last messages."""
        return self.wall() >= self.next

    def add(self, kind, message):
        """Have ``message``, about a change, published when it is time."""
        self.pending[kind].add(message)

    def publish(self):
        """Publish what has changed, if it is time, and how plan time passes, if that is another than before."""
        now = self.wall()
        if now < self.next:
            return
        self.next = now + PERIOD
        published = []
        for kind, changes in self.pending.items():
            if changes.changed:
                message = changes.message()
                published.append((kind, message))
                changes.clear()
                self.publications[kind].publish(message)
        if published:
            self.history.add(published, self.owner.state)
        self.tell_pace()

    def tell_pace(self):
        """Publish how plan time passes, if it has changed; while it is paused, also where it stands, for a step may change nothing else."""
        message = self.owner.pace_message()
        told = message.values() if message.paused is True else message.values()[1:]
        if told != self.told_pace:
            self.told_pace = told
            self.pace.publish(message)

    # -------------------------------------------------------------------------------------------------------------- services

    def _serve(self, name, service_type, handler):
        def answer(request):
            try:
                return service_type.response(**handler(request))
            except (ValueError, kernel.KernelError) as problem:
                raise Refusal(str(problem)) from None

        self.node.serve(f"/cramhy/{name}", service_type, answer)

    def _get_state(self, request):
        self.owner.look()
        return {**self.owner.state.messages(), "pace": self.owner.pace_message()}

    def _get_history(self, request):
        chapter = self.history.get(request.chapter)
        oldest, newest = self.history.numbers
        if chapter is None:
            kept = f"those from {oldest} to {newest} are" if newest else "nothing has been published yet"
            raise ValueError(f"There is no chapter {request.chapter}: {kept}{' kept' if newest else ''}.")
        return {
            "chapter": chapter.number,
            "oldest": oldest,
            "newest": newest,
            "begin": chapter.begin,
            "end": chapter.end,
            **chapter.state.messages(),
            **{f"later_{kind}": messages for kind, messages in chapter.later.items()},
        }

    def _set_pace(self, request):
        speed = as_float(request.speed)
        if not (speed == 0 or speed > 0):
            raise ValueError(f"A speed is a number of plan seconds per second, or 0, as fast as the machine computes, but not {speed:g}.")
        self.owner.set_pace(request.paused is True, speed or None)
        return self._pace_response()

    def _step(self, request):
        self.owner.step(as_float(request.seconds))
        return self._pace_response()

    def _seek(self, request):
        self.owner.seek(as_float(request.stamp))
        return self._pace_response()

    def _move_thing(self, request):
        place = self.owner.move_thing(request.name, *map(as_float, (request.x, request.y, request.z)))
        self.next = -1.0  # who moved it sees it at once
        self.owner.look()
        return dict(zip("xyz", place))

    def _pace_response(self):
        self.tell_pace()
        return {"pace": self.owner.pace_message()}
