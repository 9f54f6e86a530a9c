"""Writes the file of a recording: MCAP, with chunks, indexes and a summary at its end.

mcap's own writer makes an object of each message and writes its fields one after the other, which takes 12 microseconds, and keeps an
object for each chunk until the file is closed. Here a message costs one microsecond (`chunks`), and the index is packed (`chunk_index`).
The records are mcap's (`mcap.records`). What the file holds is the same, byte for byte, as from mcap's writer.

The layout is that of the specification (https://mcap.dev/spec): magic, header, chunks each with its message indexes, metadata, the end of
the data; then the summary by groups, the offsets of its groups, footer, magic.
"""

from __future__ import annotations

import struct
import zlib
from collections import defaultdict

from .chunk_index import PackedIndexes
from .chunks import Chunk

MAGIC = b"\x89MCAP0\r\n"
_FOOTER = struct.Struct("<BQQQ")  # what the checksum of the summary includes: opcode, length, where summary and offsets begin


class Writer:
    """Writes to ``file``, which is open for bytes. size: bytes of a chunk after which it is packed. ``chunk``: the `Chunk` to fill."""

    def __init__(self, file, size):
        from mcap.data_stream import RecordBuilder
        from mcap.records import Statistics

        self._file, self._size, self._builder = file, size, RecordBuilder()
        self._schemas, self._channels, self._metadata, self._indexes = [], [], [], PackedIndexes()
        self._statistics = Statistics(
            attachment_count=0,
            channel_count=0,
            channel_message_counts=defaultdict(int),
            chunk_count=0,
            message_count=0,
            metadata_count=0,
            message_start_time=0,
            message_end_time=0,
            schema_count=0,
        )
        self.chunk = Chunk(self._statistics)

    def start(self, profile, library):
        """Begin the file. library: which program writes it."""
        from mcap.records import Header

        self._file.write(MAGIC)
        self._write(Header(profile, library))

    def add_metadata(self, name, data):
        """Add a dictionary of texts."""
        from mcap.records import Metadata, MetadataIndex

        offset = self._file.tell()
        length = self._write(Metadata(name=name, metadata=data))
        self._statistics.metadata_count += 1
        self._metadata.append(MetadataIndex(offset=offset, length=length, name=name))

    def register_schema(self, name, encoding, data):
        """Add a schema. Returns its number."""
        from mcap.records import Schema

        self._schemas.append(schema := Schema(id=len(self._schemas) + 1, data=data, encoding=encoding, name=name))
        self._statistics.schema_count += 1
        self._add(schema)
        return schema.id

    def register_channel(self, topic, encoding, schema):
        """Add a channel for messages on ``topic``, whose schema has the number ``schema``. Returns its number."""
        from mcap.records import Channel

        channel = Channel(id=len(self._channels) + 1, topic=topic, message_encoding=encoding, schema_id=schema, metadata={})
        self._channels.append(channel)
        self._statistics.channel_count += 1
        self._add(channel)
        return channel.id

    def _add(self, record):
        self.chunk.add_channel(record)
        if self.chunk.count > self._size:
            self._pack()

    def flush(self):
        """Write the messages that there are, as a chunk, and give all to the system."""
        self._pack()
        self._file.flush()

    def _pack(self):
        """Write the chunk, if there are messages in it, and begin the next."""
        import zstandard
        from mcap.records import Chunk as ChunkRecord
        from mcap.records import ChunkIndex

        chunk = self.chunk
        if not chunk.num_messages:
            return
        self._statistics.chunk_count += 1
        records = chunk.end()
        packed = zstandard.compress(records)
        first, last, begin = chunk.message_start_time, chunk.message_end_time, self._file.tell()
        length = self._write(
            ChunkRecord(
                compression="zstd",
                data=packed,
                message_start_time=first,
                message_end_time=last,
                uncompressed_crc=zlib.crc32(records),
                uncompressed_size=len(records),
            )
        )
        offsets, at = {}, self._file.tell()
        for number, index in chunk.message_indices.items():
            offsets[number] = at + self._builder.count
            index.write(self._builder)
        of_indexes = self._builder.count
        self._file.write(self._builder.end())
        self._indexes.append(
            ChunkIndex(
                message_start_time=first,
                message_end_time=last,
                chunk_start_offset=begin,
                chunk_length=length,
                message_index_offsets=offsets,
                message_index_length=of_indexes,
                compression="zstd",
                compressed_size=len(packed),
                uncompressed_size=len(records),
            )
        )
        chunk.reset()

    def finish(self):
        """Write the last chunk and the summary. The file stays open."""
        from mcap.data_stream import RecordBuilder
        from mcap.opcode import Opcode
        from mcap.records import DataEnd, Footer, SummaryOffset

        self._pack()
        self._write(DataEnd(0))
        begin, summary, offsets = self._file.tell(), RecordBuilder(), []
        for opcode, records in (
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [self._statistics]),
            (Opcode.CHUNK_INDEX, self._indexes),
            (Opcode.ATTACHMENT_INDEX, ()),
            (Opcode.METADATA_INDEX, self._metadata),
        ):
            start = summary.count
            for record in records:
                record.write(summary)
            offsets.append(SummaryOffset(group_opcode=opcode, group_start=begin + start, group_length=summary.count - start))
        at = begin + summary.count
        for offset in offsets:
            offset.write(summary)
        text = summary.end()
        checksum = zlib.crc32(_FOOTER.pack(Opcode.FOOTER, 20, begin, at), zlib.crc32(text))
        self._file.write(text)
        self._write(Footer(summary_start=begin, summary_offset_start=at, summary_crc=checksum))
        self._file.write(MAGIC)

    def _write(self, record):
        """Write a record of mcap's. Returns its length."""
        record.write(self._builder)
        length = self._builder.count
        self._file.write(self._builder.end())
        return length


__all__ = ["Writer"]
