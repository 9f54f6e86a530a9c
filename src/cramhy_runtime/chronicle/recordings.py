"""Reading a recording: what `recorder` wrote, or another tool that writes MCAP with ROS messages as JSON.

A file that was cut off, because the process that wrote it was killed, is read as far as whole chunks go, and says so (`Recording.cut`).
Whatever the bytes are, there is either a `Recording` or a `RecordingError`. What cannot be replayed of a file, topics with messages of
another encoding or of types that nobody knows here, is told in `Recording.skipped`.
"""

from __future__ import annotations

import io
import json
import os
from decimal import Decimal, InvalidOperation

from ..extras import install_command
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator


LARGEST_CHUNK = 1 << 28
"""Bytes of a chunk once it is unpacked; a larger one is no honest chunk."""


class RecordingError(ValueError):
    """A file that cannot be written, or is no recording. The text names the file, the reason and a remedy."""


def needs_mcap(what):
    """The package mcap with its modules ``writer`` and ``stream_reader``; a `RecordingError` that tells how to get it if need be."""
    try:
        import mcap
        import mcap.stream_reader
        import mcap.writer
    except ImportError:
        raise RecordingError(f"{what} needs the Python package mcap, which is not installed. Type: {install_command('record')}") from None
    return mcap


class Recording:
    """What is in a file. ``about``: what the recorder wrote of itself: version, time, seed, epoch, program, texts all of them.

    topics: name → type, of the topics whose messages can be read. skipped: name → why not, of the others. begin, end: times of the first
    and last message, in seconds of the plan. cut: what is wrong with the end of the file, or "". count: how many messages there are.
    """

    def __init__(self, path: str):
        self.path, self.name = path, os.path.basename(path)
        self.about: dict[str, str] = {}
        self.topics: dict[str, str] = {}
        self.skipped: dict[str, str] = {}
        self.cut = ""
        self.count = 0
        self._schemas, self._channels = {}, {}
        self._chunks = []  # (first time, last time, how many, a packed chunk or a list of messages), in order
        self._loose = []
        self._epoch = None

    # ---------------------------------------------------------------------------------------------------------- building it

    def _take(self, record):
        kind = type(record).__name__
        if kind == "Schema":
            self._schemas[record.id] = record
        elif kind == "Channel":
            self._take_channel(record)
        elif kind == "Message":
            self._loose.append(record)
        elif kind == "Metadata" and record.name == "cramhy":
            self.about = dict(record.metadata)

    def _take_chunk(self, chunk, records):
        messages = [record for record in records if type(record).__name__ == "Message"]
        for record in records:
            if type(record).__name__ != "Message":
                self._take(record)
        if messages:
            times = [message.log_time for message in messages]
            self.count += len(messages)
            self._chunks.append((min(times), max(times), len(times), chunk))

    def _take_channel(self, channel):
        schema = self._schemas.get(channel.schema_id)
        if schema is not None and schema.name.startswith("foxglove."):
            return  # drawn for Foxglove, of what other topics tell
        self._channels[channel.id] = (channel.topic, "" if schema is None else schema.name)
        if channel.message_encoding != "json":
            self.skipped[channel.topic] = f"its messages are encoded as {channel.message_encoding or 'nothing known'}, not as JSON"
        elif schema is None:
            self.skipped[channel.topic] = "it does not say what type its messages have"
        else:
            self.topics[channel.topic] = schema.name

    def _finish(self):
        if self._loose:
            loose = sorted(self._loose, key=lambda message: message.log_time)
            self.count += len(loose)
            self._chunks.append((loose[0].log_time, loose[-1].log_time, len(loose), loose))
            self._loose = []
        self._chunks.sort(key=lambda chunk: chunk[0])
        if any(after[0] < before[1] for before, after in zip(self._chunks, self._chunks[1:])):
            messages = [message for *_, chunk in self._chunks for message in _messages(chunk)]
            messages.sort(key=lambda message: message.log_time)
            self._chunks = [(messages[0].log_time, messages[-1].log_time, len(messages), messages)]
        try:
            self._epoch = int(Decimal(self.about.get("epoch", "")) * 1_000_000_000)
        except (InvalidOperation, OverflowError, ValueError):
            self._epoch = self._chunks[0][0] if self._chunks else 0

    # -------------------------------------------------------------------------------------------------------------- using it

    @property
    def begin(self) -> float:
        return self._seconds(self._chunks[0][0]) if self._chunks else 0.0

    @property
    def end(self) -> float:
        return self._seconds(self._chunks[-1][1]) if self._chunks else 0.0

    def _seconds(self, time):
        return (time - self._epoch) / 1e9

    def messages(self) -> Iterator[tuple[float, str, str, dict[str, Any]]]:
        """Yields (seconds of the plan, topic, type, data as ``json.loads`` gives them) in order; of topics in `topics` only."""
        for _, *message in self.numbered():
            yield tuple(message)

    def numbered(self, after=0):
        """As `messages`, with the number of each message in front, of those with a number higher than ``after``."""
        number = 0
        for _, _, count, chunk in self._chunks:
            if number + count <= after:
                number += count
                continue
            for message in _messages(chunk):
                number += 1
                topic, kind = self._channels.get(message.channel_id, ("", ""))
                if number <= after or topic not in self.topics:
                    continue
                try:
                    data = json.loads(message.data)
                except (ValueError, RecursionError):
                    continue  # written by somebody who says JSON and writes something else
                yield number, self._seconds(message.log_time), topic, kind, data


def read(path):
    """The `Recording` in the file ``path``. Errors: `RecordingError`, when there is none, and when the file is no recording."""
    reader = needs_mcap("Reading a recording").stream_reader
    path = os.fspath(path)
    try:
        with open(path, "rb") as file:
            content = file.read()
    except OSError as problem:
        raise RecordingError(f"The recording {path} cannot be read: {problem.strerror or problem}.") from None
    if not content.startswith(b"\x89MCAP"):
        raise RecordingError(
            f"{path} is no recording: it does not begin as files of the format MCAP do. What cramhy records with "
            "--record x.mcap can be replayed."
        )
    found = Recording(path)
    complete = False
    try:
        for record in reader.StreamReader(io.BytesIO(content), emit_chunks=True, record_size_limit=len(content)).records:
            kind = type(record).__name__
            if kind == "Chunk":
                if record.uncompressed_size > LARGEST_CHUNK:
                    raise ValueError(f"a chunk of {record.uncompressed_size} bytes")
                found._take_chunk(record, reader.breakup_chunk(record, validate_crc=True))
            else:
                found._take(record)
            complete = complete or kind == "DataEnd"
    except Exception:  # broken bytes have broken the reader, in one of many ways
        if not complete:
            found.cut = (
                f"The recording {path} is damaged or cut off, as when the process that wrote it was killed; "
                f"what comes before that is there."
            )
    found._finish()
    if not found.topics and not found.about:
        if found.skipped:
            reasons = "; ".join(f"of {name}, {why}" for name, why in found.skipped.items())
            raise RecordingError(f"{path} cannot be replayed: {reasons}.")
        raise RecordingError(
            f"{path} is no recording that could be read: "
            + ("it is cut off before its first message." if found.cut else "there is nothing in it.")
        )
    return found


def _messages(chunk):
    """The messages of a chunk in the order of their times."""
    if chunk.__class__ is list:
        return chunk
    from mcap.stream_reader import breakup_chunk

    found = [record for record in breakup_chunk(chunk) if type(record).__name__ == "Message"]
    return sorted(found, key=lambda message: message.log_time)
