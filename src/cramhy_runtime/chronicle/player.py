"""Replaying a recording: its messages are published again, on their topics and at their times, in a session without plans.

So whoever looks on, a page above all, sees what there was, and can have it slower, faster, step by step, or from another moment on. The
node ``/cramhy`` tells it as it does in a session with plans (`board`); the other topics are those of a node ``/replay``. Going to another
time, everything is published as it was then. The states on the way are kept now and then, so that going back does not begin at the
beginning.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import Cell
from .. import kernel
from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime.lisp_core.conditions import warn
from ..ros import graph
from ..ros.message_json import MessageJsonError, from_json
from ..ros.messages import message_class_exact
from .service_node import PERIOD, Board
from .history import History
from .recordings import RecordingError, read
from .merge import TOPICS, State

KINDS_BY_TOPIC = {topic: kind for kind, topic in TOPICS.items()}
LANDMARK = 2000
"""Messages after which the state is kept, to go back to."""
MOST_LANDMARKS = 64
"""States that are kept; with more, every other one goes, and they are twice as far from each other."""
MOST_AT_ONCE = 2000
"""Messages that are published at one moment when nothing holds the replay back."""

_active = Cell(None, fresh=True)


class Moment:
    """What there was at a time: the `State`, and of other topics the last message."""

    __slots__ = ("time", "count", "state", "last")

    def __init__(self, time, count, state, last):
        self.time, self.count, self.state, self.last = time, count, state, last

    def copy(self):
        return Moment(self.time, self.count, self.state.copy(), dict(self.last))


class Player:
    """A replay. ``position``: seconds of the recording's plan. ``speed``: its seconds per second of the kernel's clock, ``None`` for at
    once. ``paused``. ``ended``: whether everything has been published. Made by `chronicle.replay`."""

    def __init__(self, recording, speed=1.0):
        self.recording = recording
        self.kernel = kernel.active()
        self.types = {}
        self._node = graph.active().node("replay")
        self._find_types()
        self.publications = {topic: self._node.advertise(topic, cls) for topic, cls in self.types.items() if topic not in KINDS_BY_TOPIC}
        self._start = recording.begin
        self._landmarks, self._distance = [], LANDMARK
        self._go_to(Moment(self._start, 0, State(), {}))
        self.speed, self.paused = _speed(speed), False
        self.pace_type = message_class_exact("cramhy_msgs/Pace")
        self.board = Board(self)
        self._seen = self.kernel.now()
        self._timer = self.kernel.call_every(PERIOD, self._tick)

    def _find_types(self):
        for topic, name in self.recording.topics.items():
            cls = message_class_exact(name) if name.count("/") == 1 else None
            if cls is None:
                self.recording.skipped[topic] = f"its type {name} is not known here; is its package on ROS_PACKAGE_PATH?"
            elif topic not in KINDS_BY_TOPIC or name.startswith("cramhy_msgs/"):
                self.types[topic] = cls
        if not self.types:
            self._node.shutdown()
            reasons = "; ".join(f"of {topic}, {why}" for topic, why in self.recording.skipped.items()) or "it has no messages"
            raise RecordingError(f"{self.recording.path} cannot be replayed: {reasons}.")

    # ------------------------------------------------------------------------------------------------------------- its owner

    def close(self) -> None:
        """End the replay, and take its nodes off the graph."""
        self._timer.cancel()
        self.board.close()
        self._node.shutdown()
        if _active.value is self:
            _active.value = None

    @property
    def position(self) -> float:
        return self.now.time

    @property
    def state(self):
        return self.now.state

    @property
    def ended(self) -> bool:
        return self._next is None

    def look(self):
        """The state is always that of the position."""

    def pace_message(self):
        """How the replay goes, a ``cramhy_msgs/Pace``."""
        return self.pace_type(
            stamp=self.position,
            virtual=True,
            paused=True if self.paused else None,
            speed=self.speed or 0.0,
            busy=None if self.paused or self.ended else True,
            recording=self.recording.name,
            begin=self._start,
            end=self.recording.end,
        )

    def set_pace(self, paused: bool, speed: float | None) -> None:
        """Go on with ``speed`` recorded seconds per second (``None``: at once), or stand still."""
        self.speed, self.paused = _speed(speed), paused
        self._seen = self.kernel.now()

    def step(self, seconds: float) -> None:
        """Publish what comes in the next ``seconds``, and pause."""
        if not 0 < seconds < float("inf"):
            raise ValueError(f"A step takes a time above zero, in seconds, but not {seconds}.")
        self.paused = True
        self._publish_until(self.position + seconds)
        self._publish_now()

    def move_thing(self, name: str, x: float, y: float, z: float) -> None:
        """What is past stays as it was. Errors: ValueError."""
        raise ValueError("This is a recording: its objects stay where they were, and cannot be moved by hand.")

    def seek(self, stamp: float) -> None:
        """Go to the time ``stamp``, or the nearest that there is, and publish everything as it was then."""
        if stamp != stamp:
            raise ValueError("The time to go to is not a number.")
        stamp = min(max(stamp, self._start), self.recording.end)
        landmark = next((each for each in reversed(self._landmarks) if each.time <= stamp), None)
        if stamp < self.position or landmark is not None and landmark.time > self.position:
            self._go_to(landmark.copy() if landmark else Moment(self._start, 0, State(), {}))
        while self._next is not None and self._next[1] <= stamp:
            self._take()
        self.now.time = stamp
        for kind, message in self.state.messages().items():
            message = message.copy()
            message.stamp = stamp
            self.board.add(kind, message)
        self.board.history = History()  # it was of another past
        self._seen = self.kernel.now()
        self._publish_now()
        for topic, message in self.now.last.items():  # after it is told that this is another time: a page begins its log anew then
            self.publications[topic].publish(message)

    def _publish_now(self):
        """Publish on the board though it may be too soon: who has asked for it does not wait."""
        self.board.next = -1.0
        self.board.publish()

    # ---------------------------------------------------------------------------------------------------------- going along

    def _go_to(self, moment):
        self.now = moment
        self._messages = self.recording.numbered(moment.count)
        self._next = None
        self._fetch()

    def _fetch(self):
        self._next = next(self._messages, None)

    def _take(self):
        """Let the next message happen, without publishing it: (topic, message), or ``None`` if it is none that can be read."""
        number, seconds, topic, _, data = self._next
        now = self.now
        now.time, now.count = max(now.time, seconds), number
        self._fetch()
        cls, taken = self.types.get(topic), None
        if cls is not None:
            try:
                message = from_json(cls, data)
            except MessageJsonError as problem:
                if topic not in self.recording.skipped:
                    self.recording.skipped[topic] = str(problem)
                    warn(SimpleWarning("~a", f"Messages on {topic} are left out of the replay: {problem}"))
            else:
                taken = topic, message
                kind = KINDS_BY_TOPIC.get(topic)
                if kind is not None:
                    now.state.add(kind, message)
                else:
                    now.last[topic] = message
        if number - (self._landmarks[-1].count if self._landmarks else 0) >= self._distance:
            self._landmarks.append(now.copy())
            if len(self._landmarks) > MOST_LANDMARKS:
                del self._landmarks[::2]
                self._distance *= 2
        return taken

    def _tick(self):
        now = self.kernel.now()
        passed, self._seen = now - self._seen, now
        if not self.paused and not self.ended:
            self._publish_until(
                float("inf") if self.speed is None else self.position + passed * self.speed, MOST_AT_ONCE if self.speed is None else None
            )
        self.board.publish()

    def _publish_until(self, time, most=None):
        count = 0
        while self._next is not None and self._next[1] <= time and (most is None or count < most):
            count += 1
            taken = self._take()
            if taken is not None:
                topic, message = taken
                kind = KINDS_BY_TOPIC.get(topic)
                if kind is not None:
                    self.board.add(kind, message)
                else:
                    self.publications[topic].publish(message)
        if time < float("inf"):
            self.now.time = min(max(self.position, time), max(self.recording.end, self.position))


def _speed(speed):
    if speed is None:
        return None
    if not speed > 0:
        raise ValueError(f"A speed is a number above zero, in recorded seconds per second, but not {speed:g}.")
    return None if speed == float("inf") else float(speed)


def replay(path, speed=1.0):
    """See `chronicle.replay`."""
    from . import chronicler

    if kernel.active() is None:
        raise RecordingError(f"Nothing can be replayed from {path}: no session runs. Start one first, by the REPL or kernel.start().")
    if chronicler.there() is not None:
        raise RecordingError(
            f"{path} cannot be replayed in a session that is watched or recorded itself. Use a session of its own: cramhy replay {path}"
        )
    recording = read(path)
    if there() is not None:
        _active.value.close()
    _active.value = Player(recording, speed)
    if recording.cut:
        warn(SimpleWarning("~a", recording.cut))
    for topic, why in recording.skipped.items():
        warn(SimpleWarning("~a", f"{topic} is left out of the replay: {why}."))
    return _active.value


def there():
    """The `Player` of the active kernel, or ``None``."""
    return _active.value if _active.value is not None and _active.value.kernel is kernel.active() else None
