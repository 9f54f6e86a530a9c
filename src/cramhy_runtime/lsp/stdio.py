"""The pipes to the editor. Bad frames are gone past. What a macro prints goes to standard error, for standard output is the protocol's."""

from __future__ import annotations

import asyncio
import logging
import os
import sys

from pygls.io_ import StdoutWriter, run_async

MOST_BYTES = 64 * 1024 * 1024
"""A message that says it is longer is thrown away unread."""
_LONGEST_HEADER = 200
_NOTHING = b"{}"


class Flag:
    """Tells the loop of pygls to stop."""

    def __init__(self):
        self._set = False

    def set(self):
        self._set = True

    def is_set(self):
        return self._set


class Frames:
    """An `asyncio.StreamReader` that ends where the client ends, and gives nothing for what is no frame."""

    def __init__(self, stream):
        self.stream = stream

    async def readline(self):
        try:
            line = await self.stream.readline()
        except ValueError:  # longer than the limit; it is thrown away
            return b"\r\n"
        return line if len(line) <= _LONGEST_HEADER else b"x\r\n"

    async def readexactly(self, count):
        if count > MOST_BYTES:
            while count > 0:
                part = await self.stream.read(min(count, 1 << 20))
                if not part:
                    return b""
                count -= len(part)
            return _NOTHING
        try:
            return await self.stream.readexactly(count)
        except asyncio.IncompleteReadError:
            return b""


def own_pipes():
    """(input, output) as files for the protocol alone. Descriptor 0 is empty from now on, and 1 leads to standard error."""
    sys.stdout.flush()
    source, target = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return os.fdopen(source, "rb", 0), os.fdopen(target, "wb")


async def serve(server, source, target):
    """Let ``server``, of pygls, answer what comes from the file ``source``, one message after the other, until it ends."""
    loop = asyncio.get_running_loop()
    stream = asyncio.StreamReader(limit=1 << 20)
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(stream), source)
    server._stop_event = Flag()
    server.protocol.set_writer(StdoutWriter(target))
    logger = logging.getLogger("cramhy.lsp")
    await run_async(server._stop_event, Frames(stream), server.protocol, logger, server.report_server_error)
