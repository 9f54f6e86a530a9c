"""Writing a recording: every message of every topic, and everything that plans do, into a file in the format MCAP.

Foxglove opens it, and so does any tool that reads MCAP: a channel per topic, messages as JSON, the schemas beside them, times of the
plan on the ROS epoch. In virtual time the same run gives the same bytes (law 5), so a recording can be compared with another one.

Nobody waits for the file. A message is made JSON when it is sent, some microseconds, and goes into a chunk in memory; a chunk is packed
and written when it is full, or when the plan's time has gone on by `FLUSH`; a full one takes one to three milliseconds. So a process
that is killed leaves a file that lacks its last moments only. When the disk is full the recording ends with a warning, the plan does not.

A recording has its name from the beginning if no file has it. An older file of that name stays until the new recording is complete, and is
replaced then; if the new one is cut off, both stay, the new one under a name like ``x.recovered.mcap`` (`storage.growing`).
"""

from __future__ import annotations

import errno
import os
from decimal import Decimal
from functools import partial

from cramhy_runtime import __version__, kernel, storage
from cramhy_runtime.lisp_core.condition_types import SimpleWarning
from cramhy_runtime.lisp_core.conditions import warn
from ..ros import graph
from ..ros.message_json import MessageJsonError, text_of, to_record_text
from . import chronicler, robot_scene, scene
from .recordings import RecordingError, needs_mcap
from .writing import Writer
from .schemas import schema_text
from .merge import TOPICS
from cramhy_runtime.kernel.typing_names import Self

CHUNK = 256 * 1024
"""Bytes of a chunk before it is packed."""
FLUSH = 2_000_000_000
"""Nanoseconds of plan time after which a chunk is written though it is not full."""


class Recorder:
    """A recording that is being written to the file ``path``; ``close`` ends it. Usable as a context manager.

    ``messages``: how many have been written. ``problem``: why nothing more is written, or ``None``.
    """

    def __init__(self, path, program=()):
        needs_mcap("Recording")
        if kernel.active() is None:
            raise RecordingError(f"Nothing can be recorded in {path}: no session runs. Start one first, by the REPL or kernel.start().")
        self.path = os.fspath(path)
        self.kernel, self.graph = kernel.active(), graph.active()
        self.messages, self.problem, self.closed = 0, None, False
        self._epoch = int(Decimal(repr(float(self.kernel.epoch))) * 1_000_000_000)
        self._time = None
        self._flushed = self._now()
        self._channels = {}  # (topic, type) -> [id, messages so far]
        self._subscriptions = {}
        self._robots = None
        self._scene = scene.Scene()
        for recovered in storage.tidy(os.path.dirname(os.path.realpath(self.path))):
            warn(SimpleWarning("A recording was cut off when its process was killed. It is now ~a.", recovered))
        self._part = None
        try:
            self._part = storage.growing(self.path)
            self._writer = Writer(self._part.file, CHUNK)
            self._chunk = self._writer.chunk
            self._writer.start(profile="", library=f"cramhy {__version__}")
            self._writer.add_metadata("cramhy", self._about(program))
            self._writer.flush()  # whenever the process is killed, the file is a recording
        except BaseException as problem:
            if self._part is not None:
                self._part.discard()
            if not isinstance(problem, OSError):
                raise
            if problem.errno == errno.EBUSY and self._part is None:
                raise RecordingError(f"The recording {path} cannot be written: {problem.strerror}. Choose another name.") from None
            raise RecordingError(f"The recording {path} cannot be written: {storage.why(problem)}") from None
        self._node = self.graph.node(self._free_name(), hidden=True)
        self._chronicler = chronicler.active()
        for kind, message in self._chronicler.state.messages().items():
            if any(value for value in message.values()[1:] if value is not True):
                self._event(kind, message)
        self._chronicler.listeners.append(self._event)
        for name in self.graph.visible_topics():
            self._listen(name)
        self.graph.on_change.append(self._changed)
        if not self.kernel.clock.virtual:
            self.kernel.watch_instants(self._idle)
        self.kernel.at_stop(self.close)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _about(self, program):
        seed = self.kernel.seed
        return {
            "version": __version__,
            "time": "virtual" if self.kernel.clock.virtual else "wall",
            "seed": "" if seed is None else str(seed),
            "epoch": repr(float(self.kernel.epoch)),
            "program": "\n".join(str(file) for file in program),
        }

    def _free_name(self):
        number = 1
        while f"/cramhy_recorder{number}" in self.graph.nodes:
            number += 1
        return f"cramhy_recorder{number}"

    # ------------------------------------------------------------------------------------------------------------ the topics

    def _changed(self, kind, name, there):
        if kind == "topic":
            if there:
                self._listen(name)
            else:
                subscription = self._subscriptions.pop(name, None)
                if subscription is not None:
                    self._node.unsubscribe(subscription)

    def _listen(self, name):
        topic = self.graph.topics[name]
        if name in self._subscriptions or name in TOPICS.values() or name == "/cramhy/pace":
            return
        subscription = self._node.subscribe(name, topic.type, partial(self._write, name))
        self._subscriptions[name] = subscription
        for publication in topic.publications:  # also of nodes that accept connections in their next tick only
            publication.connect(subscription)

    def _event(self, kind, message):
        if kind == "fluents" and message.removed:
            if not message.fluents:
                return
            message = message.copy()  # when garbage is found depends on more than the run
            message.removed = []
        self._write(TOPICS[kind], message)
        if kind == "world":
            self._draw(self._scene.update(message, self._now()))
        elif kind == "robots":
            self._draw_robots(message)

    def _draw(self, update):
        if update is not None:
            self._put(scene.TOPIC, scene.TYPE, update, scene.schema_text)

    def _draw_robots(self, message):
        if self._robots is None:
            self._robots = robot_scene.RobotScene()
        update, frames, joints = self._robots.update(message, self._now())
        if update is not None:
            self._put(robot_scene.TOPIC, scene.TYPE, text_of(update), scene.schema_text)
        if frames is not None:
            self._put(robot_scene.FRAMES_TOPIC, robot_scene.FRAMES_TYPE, text_of(frames), robot_scene.frames_schema_text)
        for one in joints:
            self._write(robot_scene.JOINTS_TOPIC, one)

    # -------------------------------------------------------------------------------------------------------------- the file

    def _now(self):
        time = self.kernel.clock.now()
        if time != self._time:  # several messages belong to each instant
            self._time, self._nanoseconds = time, self._epoch + round(time * 1e9)
        return self._nanoseconds

    def _write(self, topic, message):
        try:
            text = to_record_text(message)
        except MessageJsonError as problem:
            warn(SimpleWarning("A message on ~a is not in the recording ~a: ~a", topic, self.path, str(problem)))
            return
        self._put(topic, message.ros_type, text, schema_text, message.__class__)

    def _put(self, topic, kind, text, schema, *of):
        """Write the JSON of a message; ``schema(*of)`` is asked for when it is the first one of its type on ``topic``."""
        if self.closed:
            return
        data, chunk = text.encode(), self._chunk
        try:
            channel = self._channels.get((topic, kind)) or self._channel(topic, kind, schema(*of))
            now = self._now()
            chunk.add(channel[0], channel[1], now, data)
            channel[1] += 1
            self.messages += 1
            if chunk.count > CHUNK:
                self._writer.flush()
        except OSError as problem:
            self._give_up(problem)
        else:
            if now - self._flushed >= FLUSH:
                self._flush(now)

    def _flush(self, now):
        """Write the chunk, if its messages have waited for long enough."""
        if now - self._flushed >= FLUSH:
            self._flushed = now
            try:
                self._writer.flush()
            except OSError as problem:
                self._give_up(problem)

    def _idle(self):
        """In wall time the prompt may wait for hours, and what happened before it shall be in the file."""
        self._flush(self._now())

    def _channel(self, topic, kind, schema):
        number = self._writer.register_schema(kind, "jsonschema", schema)
        self._channels[topic, kind] = channel = [self._writer.register_channel(topic, "json", number), 0]
        return channel

    def _give_up(self, problem):
        self.problem = f"{problem.strerror or problem}"
        self._let_go()
        kept = self._part.keep()
        place = "" if kept in (self.path, self._part.place) else f" What it has is in {kept}, since the file of that name is an older one."
        warn(SimpleWarning("The recording ~a ends here: ~a~a The plan goes on.", self.path, storage.why(problem), place))

    def _let_go(self):
        self.closed = True
        self.kernel.not_at_stop(self.close)
        self.kernel.unwatch_instants(self._idle)
        if self._event in self._chronicler.listeners:
            self._chronicler.listeners.remove(self._event)
        if self._changed in self.graph.on_change:
            self.graph.on_change.remove(self._changed)
        self._node.shutdown()
        chronicler.dismiss()

    def close(self) -> None:
        """Write what is left, and close the file. Closing twice is closing once."""
        if self.closed:
            return
        self._chronicler.look()
        self._draw(self._scene.rest(self._now()))
        if self.closed:  # there was no room for the rest
            return
        self._let_go()
        try:
            self._writer.finish()
            self._part.finish(lost=False)
        except OSError as problem:
            self._give_up(problem)
