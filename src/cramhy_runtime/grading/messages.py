"""Messages between the processes of grading: a length and JSON, over a pipe or a socket."""

from __future__ import annotations

import json
import os
import struct
from cramhy_runtime.kernel.typing_names import Any


def send(sink: int, message: Any) -> None:
    """Write a message. sink: a file descriptor."""
    data = packed(message)
    while data:
        data = data[os.write(sink, data) :]


def packed(message: Any) -> bytes:
    """A message as it is sent."""
    data = json.dumps(message).encode()
    return struct.pack(">Q", len(data)) + data


def receive(source: int) -> Any:
    """The next message of a file descriptor, ``None`` at its end."""
    head = _exactly(source, 8)
    data = _exactly(source, struct.unpack(">Q", head)[0]) if head is not None else None
    return None if data is None else json.loads(data)


def _exactly(source, count):
    pieces = []
    while count:
        piece = os.read(source, min(count, 1 << 20))
        if not piece:
            return None
        pieces.append(piece)
        count -= len(piece)
    return b"".join(pieces)
