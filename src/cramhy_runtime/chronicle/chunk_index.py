"""The index of a recording's chunks while it is written: packed, since the file gets it at its end only.

mcap's own writer keeps an object for each chunk until the file is closed, with the place of each topic in it: over a kilobyte, and a
session in wall time writes 1800 chunks in an hour. Packed they take a fifth of that.
"""

from __future__ import annotations

import struct

_FIXED = struct.Struct("<7QBH")  # what a chunk has once; the length of the name of its compression, the number of its topics
_PLACE = struct.Struct("<HQ")  # a channel, and the offset of its index


class PackedIndexes:
    """A list of ``mcap.records.ChunkIndex`` as far as a writer uses one: `append`, iteration and length."""

    def __init__(self):
        self._packed, self._length = bytearray(), 0

    def __len__(self):
        return self._length

    def append(self, index):
        name, places = index.compression.encode(), index.message_index_offsets
        self._packed += _FIXED.pack(
            index.message_start_time,
            index.message_end_time,
            index.chunk_start_offset,
            index.chunk_length,
            index.message_index_length,
            index.compressed_size,
            index.uncompressed_size,
            len(name),
            len(places),
        )
        self._packed += name
        for place in places.items():
            self._packed += _PLACE.pack(*place)
        self._length += 1

    def __iter__(self):
        from mcap.records import ChunkIndex

        at = 0
        for _ in range(self._length):
            start, end, offset, length, index_length, compressed, uncompressed, name, topics = _FIXED.unpack_from(self._packed, at)
            at += _FIXED.size + name
            places = dict(_PLACE.iter_unpack(self._packed[at : at + topics * _PLACE.size]))
            compression = self._packed[at - name : at].decode()
            at += topics * _PLACE.size
            yield ChunkIndex(
                message_start_time=start,
                message_end_time=end,
                chunk_start_offset=offset,
                chunk_length=length,
                message_index_offsets=places,
                message_index_length=index_length,
                compression=compression,
                compressed_size=compressed,
                uncompressed_size=uncompressed,
            )
