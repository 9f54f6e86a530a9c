"""The server: a socket on loopback, or a Unix socket, that Emacs connects to.

It listens only if somebody asks (law 9). The first message of a client must be the user's secret, see `secret`, and nothing else that it
sends reaches the session before. Clients that have not said it are few, do not stay long, and make way for newer ones, so they
cannot keep those out that know it.

The socket belongs to a thread of the kernel's making (`kernel.asyncio_thread`). It cuts the bytes into frames and posts them into the
kernel's inbox, and does nothing else; it never touches a task (law 4). `connection` does the rest, with the baton.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import os
import signal
from collections import deque

from cramhy_runtime import kernel, storage
from cramhy_runtime.kernel.asyncio_thread import Company
from cramhy_runtime.kernel.images import per_image

from cramhy_runtime.session import requests

from . import secret, streams, wire
from .connection import Connection
from .errors import ServerError
from .sockets import Listening

LONGEST_STOP = 5.0  # s that the thread gets to end
FIRST_MESSAGE = 5.0  # s that a client gets to say the secret
MOST_CLIENTS = 32
MOST_STRANGERS = 64  # that have not said the secret yet
QUIET = 10.0  # s between two lines about clients that were sent away; a flood of them is no flood of lines
MOST_WAITING = 500  # messages of a client that the kernel has not read yet; then the thread reads no more of them
MOST_UNREAD = 32 << 20  # bytes that a client has not read
SHARE = 0.3  # of the processor while the kernel computes: a user waits for each answer


class Server:
    """A running server, made by `serve`. address: a port number of loopback, or the path of a Unix socket."""

    def __init__(self, session, log, address=None, alone=False):
        secret.current()
        self.session, self.log, self.alone = session, log, alone
        self.kernel = kernel.active()
        self.connections: list[Connection] = []
        self.closed = False
        self.listening = Listening(address)
        self.socket, self.address = self.listening.socket, self.listening.address
        self.kernel.count_outside(1)
        self.company = Company(self._main, "cramhy swank", self.kernel)
        self.company.share.share = SHARE
        self.kernel.at_stop(self.close)
        requests.ask_whoever_asked()

    @property
    def port(self):
        """The port that it listens on, ``None`` at a Unix socket."""
        return self.address if isinstance(self.address, int) else None

    def close(self):
        """End the server and its connections. To be called with the baton. Does nothing a second time."""
        if self.closed:
            return
        self.closed = True
        for connection in list(self.connections):
            connection.close()
        streams.route_no_more(self)
        self.company.share.forgiven = True
        self.company.call(self._stop)
        self.company.join(LONGEST_STOP)
        self.listening.close()
        self.kernel.count_outside(-1)
        self.kernel.not_at_stop(self.close)

    # ------------------------------------------------------------------------------------------------------------ the kernel

    def joined(self, line):
        """A client has said the secret. Called in the scheduler."""
        if self.closed:
            return line.end()
        streams.route(self, self.alone)
        connection = Connection(self, line)
        line.connection = connection
        self.connections.append(connection)
        return None

    def quit(self):
        """End the session, through the cleanup of its plans, as a signal that ends a process does. Called with the baton."""
        self.kernel.terminate(signal.SIGTERM)

    def left(self, connection):
        """A connection is over. Called with the baton."""
        if connection in self.connections:
            self.connections.remove(connection)

    # ------------------------------------------------------------------------------------------------------------ the thread

    async def _main(self):
        self._ended = asyncio.Event()
        self._lines, self._strangers = set(), deque()
        self._told, self._untold = None, 0  # when a line told of a stranger last, and how many have come since
        server = await asyncio.start_server(self._meet, sock=self.socket, limit=1 << 16)
        if self.closed:
            server.close()
            return
        await self._ended.wait()
        server.close()
        for writer in [*self._strangers, *(line.writer for line in self._lines)]:
            with contextlib.suppress(Exception):
                writer.close()

    def _stop(self):
        ended = getattr(self, "_ended", None)
        if ended is not None:
            ended.set()

    async def _meet(self, reader, writer):
        with contextlib.closing(writer):
            self._strangers.append(writer)
            while len(self._strangers) > MOST_STRANGERS:
                self._strangers.popleft().transport.abort()  # the one that has said nothing for longest
            refused = await self._refusal(reader)
            if writer in self._strangers:
                self._strangers.remove(writer)
            if refused is None and not writer.is_closing():
                await self._serve(reader, writer)
            elif refused:
                self._tell_of_stranger(refused)

    async def _refusal(self, reader):
        """Why a client is sent away, a text that follows "A client was sent away"; ``""`` if it has gone, ``None`` if it may come in."""
        try:
            said = await asyncio.wait_for(_first_message(reader), FIRST_MESSAGE)
            if not hmac.compare_digest(said, secret.current()):
                return f": its first message is not the secret that stands in {secret.PLACE}."
        except (wire.FrameError, ServerError) as problem:
            return f". {problem}"
        except TimeoutError:
            return f": it has not said the secret within {FIRST_MESSAGE:g} s."
        except (asyncio.IncompleteReadError, ConnectionError):
            return ""
        return f": {MOST_CLIENTS} are connected." if len(self._lines) >= MOST_CLIENTS else None

    async def _serve(self, reader, writer):
        line = Line(self, writer)
        self._lines.add(line)
        try:
            self.kernel.post(lambda: self.joined(line))
            await self._read(reader, line)
        except (asyncio.IncompleteReadError, ConnectionError, TimeoutError):
            pass  # it is gone
        except wire.FrameError as problem:
            self._tell(f"A client was sent away. {problem}")
        finally:
            self._lines.discard(line)
            self.kernel.post(line.is_lost)

    async def _read(self, reader, line):
        while True:
            length = wire.length_of(await reader.readexactly(wire.LENGTH))
            data = await reader.readexactly(length)
            line.hear(data)
            while line.waiting > MOST_WAITING:
                await asyncio.sleep(0.01)

    def _tell(self, text):
        self.kernel.post(lambda: self.log(text))

    def _tell_of_stranger(self, why):
        now = asyncio.get_running_loop().time()
        if self._told is not None and now < self._told + QUIET:
            self._untold += 1
            return
        more = f" So were {self._untold} more since the last line." if self._untold else ""
        self._told, self._untold = now, 0
        self._tell(f"A client was sent away{why}{more}")


async def _first_message(reader):
    """The first frame of a client, bytes; ``b""`` where it is too long for a secret."""
    length = wire.length_of(await reader.readexactly(wire.LENGTH))
    return await reader.readexactly(length) if length <= secret.LONGEST else b""


class Line:
    """The way between a client and its `Connection`: frames in, frames out."""

    def __init__(self, server, writer):
        self.server, self.writer = server, writer
        self.connection = None
        self.waiting = 0
        self._out = deque()
        self._called = False

    # the thread's side

    def hear(self, data):
        self.waiting += 1
        self.server.kernel.post(lambda: self._deliver(data))

    def shut(self):
        with contextlib.suppress(Exception):
            self.writer.close()

    def _write(self):
        self._called = False
        out = []
        while self._out:
            out.append(self._out.popleft())
        if self.writer.is_closing():
            return
        if self.writer.transport.get_write_buffer_size() > MOST_UNREAD:
            self.server._tell("A client was sent away: it does not read what it is sent.")
            self.writer.transport.abort()
        else:
            self.writer.write(b"".join(out))

    # the kernel's side

    def _deliver(self, data):
        self.waiting -= 1
        if self.connection is not None and not self.connection.closed:
            self.connection.receive(data)

    def is_lost(self):
        if self.connection is not None:
            self.connection.lost()

    def send(self, data):
        """Send the bytes of a frame, soon."""
        self._out.append(data)
        if not self._called:
            self._called = True
            self.server.company.call(self._write)

    def end(self):
        """End the connection when all is sent."""
        self.server.company.call(self.shut)


_servers = per_image([])


def serve(session, log, address=None, port_file=None, alone=False):
    """Start a server for ``session``, whose kernel is active; returns the `Server`. To be called with the baton.

    log: a function that tells the user a line of text. address: a port of loopback, ``None`` or 0 for a free one, or the path of a
    Unix socket. port_file: a file that the port is written into, for a program that waits for it. alone: whether the
    session has no prompt of its own. Raises `ServerError`.
    """
    server = Server(session, log, address, alone)
    _servers[:] = [each for each in _servers if not each.closed]
    _servers.append(server)
    if port_file is not None:
        try:
            _write_port(port_file, server.address)
        except OSError as problem:
            server.close()
            raise ServerError(f"The port cannot be written into {port_file}: {problem.strerror}.") from None
    return server


def _write_port(path, address):
    """Write the port into a file that appears as a whole, since Emacs reads it as soon as it is there.

    Emacs names a file in the folder for temporary files, where somebody may have put a link; that one is replaced, and not followed.
    """
    storage.write_whole(path, f"{address}\n".encode(), follow=os.fspath(path).startswith(("/dev/", "/proc/")))


def running():
    """The servers of the current image that listen."""
    return [server for server in _servers if not server.closed]
