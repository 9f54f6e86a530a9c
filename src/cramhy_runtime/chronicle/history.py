"""What was published before, in chapters: so that a page which comes late can scroll back.

A chapter is the state at its beginning and the messages that followed. The newest is still being written; when it is long enough the
next begins, and the oldest are forgotten when all together hold too much. What is counted are the things in messages (turtles,
strokes, tasks, fluents). The messages are packed as they come, as JSON through one compressor for each chapter, some ten bytes a thing
where a message of Python objects takes some hundred; they are read again only when somebody asks. So a session of hours holds two or three
megabytes of its past, soon after its beginning.
"""

from __future__ import annotations

import json
import zlib

from ..ros.message_json import MessageJsonError, from_json, to_json_text
from ..ros.messages import message_class_exact
from .merge import KINDS, TYPES

MOST = 60_000
"""Things that are kept: eight minutes of one turtle that drives and draws."""
CHAPTER = 2_000
"""Things in the messages of a chapter after which a new one begins, if they are not fewer than what its state costs."""


class Packed:
    """Pairs (kind, message) in a row, compressed."""

    def __init__(self):
        self._packer, self._bytes = zlib.compressobj(), bytearray()

    def append(self, kind, message):
        """Add a message; one that JSON cannot hold, which no client could be sent, is left out."""
        try:
            text = f'["{kind}",{to_json_text(message)}]'
        except (MessageJsonError, ValueError):
            return
        self._bytes += self._packer.compress(text.encode("utf-8", "surrogatepass") + b"\n")

    def close(self):
        """Nothing more is added: give back what the compressor needs, a quarter of a megabyte."""
        if self._packer is not None:
            self._bytes += self._packer.flush()
            self._bytes, self._packer = bytes(self._bytes), None

    def read(self):
        """The messages in their order, by kind."""
        data = self._bytes if self._packer is None else bytes(self._bytes) + self._packer.copy().flush()
        found = {kind: [] for kind in KINDS}
        for line in zlib.decompress(data).decode("utf-8", "surrogatepass").split("\n")[:-1]:
            kind, values = json.loads(line)
            found[kind].append(from_json(message_class_exact(TYPES[kind]), values))
        return found


class Chapter:
    """``number`` counts from 1. ``begin`` and ``end`` are plan times, ``state`` is the `State` at the beginning, ``packed`` the messages
    after it. ``first`` and ``size`` say how much the state holds, and how much that and the messages do."""

    __slots__ = ("number", "begin", "end", "state", "packed", "first", "size")

    def __init__(self, number, now, state):
        self.number, self.begin, self.end, self.state = number, now, now, state
        self.packed = Packed()
        self.first = self.size = 1 + len(state) // 4  # most of it is shared with other chapters

    @property
    def later(self):
        """The messages that followed, kind → list."""
        return self.packed.read()


class History:
    """The chapters that are kept, the oldest first."""

    def __init__(self, most=MOST, chapter=CHAPTER):
        self.most, self.chapter = most, chapter
        self.chapters = []
        self.size = 0

    def add(self, published, state):
        """Note what was published at one moment, pairs (kind, message); ``state`` is the `State` that it led to."""
        chapter = self.chapters[-1] if self.chapters else None
        if chapter is None or chapter.size - chapter.first >= max(self.chapter, chapter.first):
            self._begin(published[-1][1].stamp, state)
            return
        for kind, message in published:
            size = _size(message)
            chapter.packed.append(kind, message)
            chapter.size += size
            self.size += size
            chapter.end = message.stamp
        self._forget()

    def _begin(self, now, state):
        number = self.chapters[-1].number + 1 if self.chapters else 1
        if self.chapters:
            self.chapters[-1].end = now
            self.chapters[-1].packed.close()
        self.chapters.append(Chapter(number, now, state.copy()))
        self.size += self.chapters[-1].size
        self._forget()

    def _forget(self):
        while self.size > self.most and len(self.chapters) > 1:
            self.size -= self.chapters.pop(0).size

    @property
    def numbers(self):
        """(number of the oldest chapter, of the newest); zeros when there is none."""
        return (self.chapters[0].number, self.chapters[-1].number) if self.chapters else (0, 0)

    def get(self, number):
        """The chapter of that number, or for 0 the newest; ``None`` if it is not there."""
        if not self.chapters:
            return None
        index = -1 if number == 0 else number - self.chapters[0].number
        return self.chapters[index] if -1 <= index < len(self.chapters) and (index >= 0 or number == 0) else None


def _size(message):
    return 1 + sum(len(value) for value in message.values() if value.__class__ is list)
