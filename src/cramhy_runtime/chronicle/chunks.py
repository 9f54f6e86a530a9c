"""The chunk of a recording that is being filled: the records of its messages as bytes, until `writing.Writer` packs and writes it.

mcap's own writer makes an object of each message and writes its fields one after the other, which takes 12 microseconds. Here a message
costs one.
"""

from __future__ import annotations

import struct

_MESSAGE = struct.Struct("<BQHIQQ")  # opcode, length of the rest, channel, number in the channel, when it was logged, when published
_INDEX = struct.Struct("<BQHI")  # opcode, length of the rest, channel, bytes of the entries
_REST = _MESSAGE.size - 9


class Chunk:
    """The records of a chunk, and where in it the messages of each channel are.

    statistics: those of the writer, which are brought up to date when the chunk is packed.
    """

    def __init__(self, statistics):
        from mcap.data_stream import RecordBuilder

        self._statistics, self._builder = statistics, RecordBuilder()
        self.reset()

    def reset(self):
        """Begin the next chunk."""
        self.count = self.num_messages = 0
        self.message_start_time = self.message_end_time = 0
        self.message_indices = {}
        self._records = []

    def add(self, channel, number, time, data):
        """Add a message: the id of its channel, how many were before it there, nanoseconds, bytes."""
        index = self.message_indices.get(channel)
        if index is None:
            index = self.message_indices[channel] = Index(channel)
        index.entries += time, self.count
        self._records += _MESSAGE.pack(5, _REST + len(data), channel, number, time, time), data
        self.count += _MESSAGE.size + len(data)
        self.num_messages += 1

    def add_channel(self, channel):
        """Add a ``mcap.records.Channel``, or a ``Schema``."""
        channel.write(self._builder)
        record = self._builder.end()
        self._records.append(record)
        self.count += len(record)

    def end(self):
        """The bytes of the chunk."""
        indices, statistics = self.message_indices.values(), self._statistics
        if indices:
            self.message_start_time = min(min(index.entries[::2]) for index in indices)
            self.message_end_time = max(max(index.entries[::2]) for index in indices)
            begin = min(statistics.message_start_time, self.message_start_time) if statistics.message_count else self.message_start_time
            statistics.message_start_time = begin
            statistics.message_end_time = max(statistics.message_end_time, self.message_end_time)
            statistics.message_count += self.num_messages
            for index in indices:
                statistics.channel_message_counts[index.channel] += len(index.entries) // 2
        return b"".join(self._records)


class Index:
    """Where the messages of a channel are in a chunk. ``entries``: of each message when it was, and where its record begins."""

    __slots__ = ("channel", "entries")

    def __init__(self, channel):
        self.channel, self.entries = channel, []

    def write(self, stream):
        """Write the record to a ``mcap.data_stream.RecordBuilder``."""
        size = 8 * len(self.entries)
        stream.write(_INDEX.pack(7, size + 6, self.channel, size) + struct.pack(f"<{len(self.entries)}Q", *self.entries))


__all__ = ["Chunk"]
