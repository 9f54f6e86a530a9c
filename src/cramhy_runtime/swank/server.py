"""The server: a socket on loopback, or a Unix socket, that Emacs connects to.

It listens only if somebody asks (law 9). With the file ``~/.slime-secret``, which SLIME reads too, the first message of a client must be
the secret. The file counts only if nobody else may read or write it.

The socket belongs to a thread of the kernel's making (`kernel.asyncio_thread`). It cuts the bytes into frames and posts them into the
kernel's inbox, and does nothing else; it never touches a task (law 4). `connection` does the rest, with the baton.
"""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import os
import signal
import socket
import stat
from collections import deque
from pathlib import Path

from cramhy_runtime import kernel, storage
from cramhy_runtime.kernel.asyncio_thread import Company
from cramhy_runtime.kernel.images import per_image

from cramhy_runtime.session import requests

from . import streams, wire
from .connection import Connection

HOST = "127.0.0.1"
SECRET = "~/.slime-secret"
LONGEST_STOP = 5.0  # s that the thread gets to end
FIRST_MESSAGE = 10.0  # s that a client gets to say the secret
MOST_CLIENTS = 32
MOST_WAITING = 500  # messages of a client that the kernel has not read yet; then the thread reads no more of them
MOST_UNREAD = 32 << 20  # bytes that a client has not read
SHARE = 0.3  # of the processor while the kernel computes: a user waits for each answer
LONGEST_SECRET = 4096  # bytes


class ServerError(Exception):
    """A server that cannot start; the text says why and what to do."""


class Server:
    """A running server, made by `serve`. address: a port number of loopback, or the path of a Unix socket."""

    def __init__(self, session, log, address=None, alone=False):
        self.secret = _secret()
        self.session, self.log, self.alone = session, log, alone
        self.kernel = kernel.active()
        self.connections: list[Connection] = []
        self.closed = False
        self.socket, self.address = _listen(address)
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
        self.socket.close()
        if self.port is None:
            with contextlib.suppress(OSError):
                os.unlink(self.address)
        self.kernel.count_outside(-1)
        self.kernel.not_at_stop(self.close)

    # ------------------------------------------------------------------------------------------------------------ the kernel

    def joined(self, line):
        """A client has said the secret, if there is one. Called in the scheduler."""
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
        self._lines = set()
        server = await asyncio.start_server(self._meet, sock=self.socket, limit=1 << 16)
        if self.closed:
            server.close()
            return
        await self._ended.wait()
        server.close()
        for line in list(self._lines):
            line.shut()

    def _stop(self):
        ended = getattr(self, "_ended", None)
        if ended is not None:
            ended.set()

    async def _meet(self, reader, writer):
        if self.secret is None and self.port is not None and _of_another_user(writer.get_extra_info("peername"), self.port):
            self._tell(f"A client of another user was sent away. A secret in {SECRET} lets those in who know it.")
            writer.close()
            return
        if len(self._lines) >= MOST_CLIENTS:
            self._tell(f"A client was sent away: {MOST_CLIENTS} are connected.")
            writer.close()
            return
        line = Line(self, writer)
        self._lines.add(line)
        try:
            if self.secret is None or await self._knows_secret(reader):
                self.kernel.post(lambda: self.joined(line))
                await self._read(reader, line)
        except (asyncio.IncompleteReadError, ConnectionError, TimeoutError):
            pass  # it is gone
        except wire.FrameError as problem:
            self._tell(f"A client was sent away. {problem}")
        finally:
            self._lines.discard(line)
            self.kernel.post(line.is_lost)
            writer.close()

    async def _knows_secret(self, reader):
        said = b""
        with contextlib.suppress(asyncio.IncompleteReadError, wire.FrameError, TimeoutError):
            length = wire.length_of(await asyncio.wait_for(reader.readexactly(wire.LENGTH), FIRST_MESSAGE))
            if length <= LONGEST_SECRET:
                said = await asyncio.wait_for(reader.readexactly(length), FIRST_MESSAGE)
        known = hmac.compare_digest(said, self.secret)
        if not known:
            self._tell(f"A client was sent away: its first message is not the secret that stands in {SECRET}.")
        return known

    async def _read(self, reader, line):
        while True:
            length = wire.length_of(await reader.readexactly(wire.LENGTH))
            data = await reader.readexactly(length)
            line.hear(data)
            while line.waiting > MOST_WAITING:
                await asyncio.sleep(0.01)

    def _tell(self, text):
        self.kernel.post(lambda: self.log(text))


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


# -------------------------------------------------------------------------------------------------------------- what it needs


def _secret():
    """The secret of this user, bytes, or ``None``. It is the first line of the file, as SLIME reads it."""
    path = Path(SECRET).expanduser()
    try:
        status = path.stat()
        if os.name == "posix" and (status.st_uid != os.getuid() or stat.S_IMODE(status.st_mode) & 0o077):
            raise ServerError(
                f"{SECRET} holds the secret for Emacs, and others may read or write it. Type: chmod 600 {SECRET}, and see that it is yours."
            )
        with path.open("rb") as file:
            first = file.readline(LONGEST_SECRET).rstrip(b"\n")
    except FileNotFoundError:
        return None
    except OSError as problem:
        raise ServerError(f"{SECRET}, the secret for Emacs, cannot be read: {problem.strerror}.") from None
    return first


def _of_another_user(peer, port):
    """Whether Linux says that the client at ``peer``, (host, port), belongs to another user. Other systems do not tell."""
    try:
        with open("/proc/net/tcp", encoding="ascii") as table:
            rows = [row.split() for row in table]
        mine = os.getuid()
    except (OSError, AttributeError):
        return False
    ours, theirs = f":{port:04X}", f":{peer[1]:04X}"
    owners = [int(row[7]) for row in rows[1:] if row[1].endswith(theirs) and row[2].endswith(ours)]
    return bool(owners) and owners[0] not in (mine, 0)


def _listen(address):
    """(socket, where it listens): on loopback at the port ``address`` (``None`` or 0: a free one), or at the path of a Unix socket."""
    at_path = isinstance(address, str)
    found = socket.socket(socket.AF_UNIX if at_path else socket.AF_INET, socket.SOCK_STREAM)
    try:
        if at_path:
            before = os.umask(0o077)  # nobody else may connect
            try:
                found.bind(address)
            finally:
                os.umask(before)
        else:
            if os.name == "posix":
                found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            found.bind((HOST, address or 0))
        found.listen(8)
    except (OSError, OverflowError) as problem:
        found.close()
        why = getattr(problem, "strerror", None) or problem
        where = address if at_path else f"port {address} of {HOST}"
        raise ServerError(f"The server for Emacs cannot listen on {where}: {why}. Choose another place, or none for a free port.") from None
    found.setblocking(False)
    return found, address if at_path else found.getsockname()[1]


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
    """Write the port into a file that appears as a whole, since Emacs reads it as soon as it is there."""
    storage.write_whole(path, f"{address}\n".encode())


def running():
    """The servers of the current image that listen."""
    return [server for server in _servers if not server.closed]
