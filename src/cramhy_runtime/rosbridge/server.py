"""The server: a socket on loopback, WebSockets that speak rosbridge, and the files of a page, in a thread beside the kernel.

Three parties: the kernel, which has the graph; the thread of the server (`kernel.company`), which has the sockets; and the clients. What a
client sends is parsed in the thread and posted to the kernel, a limited number at a time: who sends faster than the plan takes
notice is not read meanwhile. What the graph has for clients is handed to the thread in a list, and the kernel never looks back.
While the plan computes, the thread has a small share of the processor, so that no flood slows it down (see `company`).

In wall time messages are read while the prompt waits, and the turtle goes on. In virtual time the clock stands still at the prompt, but
messages are read and answered; while somebody waits for an answer, plan time passes as far as the answer needs (see `protocol`).

The application is plain ASGI, with one guard for pages and WebSockets and nothing to route, so uvicorn and websockets are enough: there is
no starlette in between. Their versions in pyproject.toml are the first with uvicorn's ``websockets-sansio`` and websockets' ``proxy``.

The server is a task of the kernel's, too: it is closed when that is, with all its clients (law 1).
"""

from __future__ import annotations

import asyncio
import os
import socket
import sys
from collections import deque
from http import HTTPStatus
from importlib import metadata

from cramhy_runtime.kernel.images import per_image
from .. import kernel
from ..extras import install_command
from cramhy_runtime.kernel.asyncio_thread import Company, thread_time
from ..ros import graph
from . import sessions
from .connection import ENDED, Connection
from .authentication import Door, WaitingRoom
from .guard import HEADERS, Guard, Limits, new_token
from .hub import Hub
from .rosapi import RosApi

HOST = "127.0.0.1"
BACKLOG = 1024  # connections that the system keeps until the server takes them: one that finds no place tries again a second later
LONGEST_STOP = 5.0  # s that the thread gets to end
RENEW = 1.0  # s between two looks whether the session is still announced


class ServerError(Exception):
    """A server that cannot start; the text says why and what to do."""


class Server:
    """A running server; made by `serve`. port, token: where it listens, and what clients must show. url: of its page, with the token
    in the fragment. address: for clients of rosbridge, with the token in the path."""

    def __init__(self, here, pages, port, origins, limits):
        self.graph, self.kernel, self.limits = here, here.kernel, limits
        self.pages = pages or {}
        self.token = new_token()
        self.socket = _listen(port)
        self.port = self.socket.getsockname()[1]
        self.announcement = self._announce()  # before anything else is there that would have to be taken back
        self.url = f"http://{HOST}:{self.port}/#{self.token}"
        self.address: str = f"ws://{HOST}:{self.port}/{self.token}"
        self.guard = Guard(self.token, self.port, origins)
        self.hub = Hub(here, self.hand_out, limits)
        self.rosapi = RosApi(here, limits)
        self.connections = set()
        self.strangers = self.door = None
        self.closed = False
        self._out = deque()
        self._called = False
        self._uvicorn = self._stopping = None
        self.kernel.count_outside(1)  # with the baton, so that the next prompt knows; `outside_source` is for other threads
        self.company = Company(self._main, "cramhy rosbridge", self.kernel)
        self.kernel.at_stop(self.close)

    def _announce(self):
        try:
            return sessions.announce(self.port, self.token)
        except (sessions.Unsafe, OSError) as problem:
            self.socket.close()
            raise ServerError(f"The server cannot be announced to the other programs of this user. {problem}") from None

    @property
    def file(self):
        """The path of the file that announces the server."""
        return self.announcement.path

    def close(self) -> None:
        """End the server and its clients; what they had on the graph goes. To be called with the baton. Does nothing a second time."""
        if self.closed:
            return
        self.closed = True
        self.announcement.close()
        self.hub.answer_all()
        self.company.share.forgiven = True
        self.company.call(self._stop_soon)
        self.company.join(LONGEST_STOP)
        self.announcement.close()  # its thread may just have written it again
        self.hub.close()  # only now: what clients were to hear still had to reach them
        self.rosapi.close()
        self.socket.close()
        self.kernel.count_outside(-1)
        self.kernel.not_at_stop(self.close)

    stop = close

    # ------------------------------------------------------------------------------------------------- between the two sides

    def hand_out(self, function):
        """Have FUNCTION called in the server's thread, after what was handed out before."""
        self._out.append(function)
        if not self._called:
            self._called = True
            self.company.call(self._take)

    def _take(self):
        self._called = False
        out = self._out
        while out:
            try:
                out.popleft()()
            except Exception as problem:
                self.report(problem)
        for connection in self.connections:
            connection.stir()

    def post(self, function):
        """Have FUNCTION called in the kernel, unless that has ended; what it costs the kernel is the server's to pay."""

        def run():
            if self.closed:
                return
            began = thread_time()
            try:
                function()
            finally:
                self.company.share.charge(thread_time() - began)

        self.kernel.post(run)

    def report(self, problem):
        """A defect of the server's own, from its thread: the user is told, and the session goes on."""
        self.kernel.post(lambda: kernel.unhandled(kernel.current(), problem))

    # ------------------------------------------------------------------------------------------------------------ the thread

    async def _main(self):
        import uvicorn

        from .http import make_protocol, make_websocket

        loop, limits = asyncio.get_running_loop(), self.limits
        asking = WaitingRoom(loop, limits.strangers, limits.first_message, lambda one, late: one.end(late))
        self.strangers = WaitingRoom(loop, limits.strangers, limits.first_message, lambda one, late: one.give_up(late))
        # A thread that sleeps off what it overspent (`company`) may be late with a pong that an honest client sent in time.
        config = uvicorn.Config(
            self.application, interface="asgi3", loop="asyncio", http=make_protocol(asking), ws=make_websocket(limits), lifespan="off",
            log_config=None, log_level=100, access_log=False, server_header=False, date_header=False, proxy_headers=False,
            ws_max_size=self.limits.message, ws_per_message_deflate=False, ws_ping_interval=20.0, ws_ping_timeout=120.0,
            timeout_keep_alive=5, timeout_graceful_shutdown=1, h11_max_incomplete_event_size=16384,
        )  # fmt: skip
        self._uvicorn = served = uvicorn.Server(config)
        if self.closed:
            return

        def protocol():
            return config.http_protocol_class(config=config, server_state=served.server_state, app_state=served.lifespan.state, _loop=loop)

        self.door = Door(loop, self.socket, limits, self.token, protocol)
        loop.call_soon(self.door.open)  # when uvicorn is ready
        loop.call_later(RENEW, self._renew, loop)
        await served.serve([])

    def _renew(self, loop, told=False):
        if self.closed:
            return
        try:
            self.announcement.renew()
            told = False
        except sessions.Unsafe as problem:
            if not told:
                text = f"; Other programs cannot find this session any more. {problem}"
                self.kernel.post(lambda: sys.stderr and print(text, file=sys.stderr, flush=True))
            told = True
        loop.call_later(RENEW, self._renew, loop, told)

    def _stop_soon(self):
        self._stopping = asyncio.ensure_future(self._stop())  # the loop itself keeps no task alive

    async def _stop(self):
        """End the connections, each with the reason, and then uvicorn, which would close them with a mere number."""
        if self.door is not None:
            self.door.close()
        ending = [connection.end(*ENDED) for connection in list(self.connections)]
        if ending:
            await asyncio.wait(ending, timeout=self.limits.closing)
        if self._uvicorn is not None:
            self._uvicorn.should_exit = True

    async def application(self, scope, receive, send):
        """The ASGI application."""
        refusal = self.guard.refusal(scope)
        if scope["type"] == "websocket":
            connection = Connection(self, scope, receive, send)
            try:
                await connection.run(refusal)
            except asyncio.CancelledError:
                raise
            except Exception as problem:
                self.report(problem)
        elif scope["type"] == "http":
            status, kind, body, headers = self._page(scope) if refusal is None else (refusal[0], "text/plain", refusal[1] + "\n", {})
            await _respond(scope, send, status, kind, body, headers)

    def _page(self, scope):
        path = scope["path"]
        found = self.pages(path) if callable(self.pages) else self.pages.get(path)
        if found is None:
            if path == "/" and not self.pages:
                return 200, "text/plain", "A session of cramhy. It speaks rosbridge v2 over WebSockets.\n", {}
            return 404, "text/plain", "There is nothing here.\n", {}
        body, kind, *headers = found
        return 200, kind, body() if callable(body) else body, headers[0] if headers else {}


async def _respond(scope, send, status, kind, body, headers):
    data = body.encode() if isinstance(body, str) else body
    kind += "; charset=utf-8" if kind.startswith("text/") or kind.endswith(("javascript", "json")) else ""
    fields = {"content-type": kind, "content-length": str(len(data)), **HEADERS, **{name.lower(): value for name, value in headers.items()}}
    if status == HTTPStatus.METHOD_NOT_ALLOWED:
        fields["allow"] = "GET, HEAD"
    fields["connection"] = "close"  # the next request takes its place behind those that others have made meanwhile
    lines = [(name.encode("latin-1"), value.encode("latin-1")) for name, value in fields.items()]
    await send({"type": "http.response.start", "status": status, "headers": lines})
    await send({"type": "http.response.body", "body": b"" if scope["method"] == "HEAD" else data})


def _listen(port):
    found = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # what is left of connections to a session that was killed keeps nobody from its port; Windows means more
            found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind((HOST, port or 0))
        found.listen(BACKLOG)
    except (OSError, OverflowError) as problem:
        found.close()
        why = getattr(problem, "strerror", None) or problem
        raise ServerError(
            f"The server cannot listen on port {port} of {HOST}: {why}. Choose another port, or none for a free one."
        ) from None
    found.setblocking(False)
    return found


def need_extra():
    """Raise `ServerError` when what the server is made of is not installed."""
    missing = []
    for name in ("uvicorn", "websockets"):
        try:
            metadata.version(name)
        except metadata.PackageNotFoundError:
            missing.append(name)
    if missing:
        raise ServerError(
            f"The server needs {', '.join(missing)}, which {'is' if len(missing) == 1 else 'are'} not installed. "
            f"Type: {install_command('web')}"
        )
    # Here and not in the server's thread, which would have to save up for them while a plan computes.
    import uvicorn.lifespan.off  # noqa: F401
    import uvicorn.protocols.http.h11_impl  # noqa: F401
    import uvicorn.protocols.websockets.websockets_sansio_impl  # noqa: F401


_servers = per_image({})


def serve(here=None, pages=None, port=None, origins=(), limits=None):
    """Start a server for the active kernel, or for the kernel or session HERE; returns the `Server`.

    pages: static files: a mapping, or a function, from a path ("/", "/view.js") to ``(body, media type)`` or
    ``(body, media type, headers)``, where body is bytes, text, or a function that gives one; it is called in the server's thread. port:
    where to listen on loopback, ``None`` or 0 for a free one. origins: pages of other servers that may connect ("https://app.foxglove.dev").
    limits: `guard.Limits`. Raises `ServerError`. To be called with the baton.
    """
    need_extra()
    active = kernel.active()
    if active is None or here not in (None, active) and getattr(here, "kernel", active) is not active:
        raise ServerError(
            "A server belongs to the kernel that is active, and this is another one, or none. Call kernel.start() or make a session first."
        )
    running = _servers.get(active)
    if running is not None and not running.closed:
        raise ServerError(f"This session has a server already, on port {running.port}. Close it first, or use it.")
    _servers.clear()  # those of kernels before are closed
    server = _servers[active] = Server(graph.active(), pages, port, tuple(origins), limits or Limits())
    return server


def running():
    """The server of the active kernel, or ``None``."""
    found = _servers.get(kernel.active())
    return None if found is None or found.closed else found
