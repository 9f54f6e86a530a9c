"""One WebSocket: it is let in, read with measure, and written to as it reads. All of this is in the server's thread.

A client that has shown its token gets a `protocol.Session` in the kernel. Reading stops while `Limits.waiting` of its operations wait
there, and slows down when they come too fast. What waits to be sent is in its `Outbox`; the writer takes from it when the socket has
room, and what stays too long there closes the connection, with the reason.
"""

from __future__ import annotations

import asyncio
import time

from .guard import Bucket, query_of, same
from .http import EXTENSION
from .joined_nodes import SERVER
from .outbox import Outbox, reason_text
from .parsing import Fragments, Malformed, parse
from .protocol import Session

POLICY, TOO_MUCH, LATER = 1008, 1013, 1013
PONG = {"op": "pong"}
"""What answers an operation "ping", without the plan: a page cannot see the pings of WebSockets, and has to know whether we live."""
ENDED = 1001, "The session has ended."


class Gone(Exception):
    """The client has closed the connection."""


class Left(Exception):
    """We close it: code and reason."""

    def __init__(self, code, reason):
        super().__init__(reason)
        self.code = code


class Connection:
    """See the top of this file. ``session``: `protocol.Session`, made and used in the kernel only."""

    def __init__(self, server, scope, receive, send):
        self.server, self.scope, self.limits = server, scope, server.limits
        self._receive, self._send = receive, send
        self.outbox = Outbox(server.limits)
        self.session = None
        self.hidden = False
        self.waiting = 0
        self.fragments = Fragments(server.limits)
        self.complaints = []
        self._stirred = asyncio.Event()
        self._room = asyncio.Event()
        self._room.set()
        self._ending = None
        self._sending = False
        self._tasks = ()
        self._task = None
        self._protocol = scope["extensions"].get(EXTENSION)
        self.trusted = False

    # ---------------------------------------------------------------------------------------------------------- letting in

    async def run(self, refusal):
        """From the request to the end of the connection."""
        if (await self._receive())["type"] != "websocket.connect":
            return
        token = self.server.guard.token_of(self.scope) if refusal is None else None
        if refusal is None and token is not None and not same(token, self.server.token):
            refusal = 403, "This is not the token of this session, or no address of it."
        if refusal is None and token is not None and self._full():
            refusal = 503, self._full()
        if refusal is not None:
            await self._refuse(*refusal)
            return
        offered = self.scope.get("subprotocols") or ()
        subprotocol = "rosbridge_v2" if "rosbridge_v2" in offered else None
        await self._send({"type": "websocket.accept", "subprotocol": subprotocol, "headers": [(b"server", SERVER.encode())]})
        self._task = asyncio.current_task()
        self.server.connections.add(self)
        try:
            if self.server.closed:  # while it was let in
                raise Left(*ENDED)
            if token is None:
                await self._wait_for_token()
            else:
                self.hidden = query_of(self.scope).get("hidden") == ["1"]
            self.trusted = True
            self._protocol.trust()
            await self._serve()
        except Gone:
            pass
        except Left as left:
            await self._close(left.code, str(left))
        except OSError:
            pass  # the connection broke while we wrote
        finally:
            self.server.connections.discard(self)
            self._leave()

    def _full(self):
        """Why no further client is let in, or ""."""
        if sum(other.trusted for other in self.server.connections) < self.limits.connections:
            return ""
        return f"{self.limits.connections} clients are connected; more are not allowed."

    async def _refuse(self, status, text):
        body = (text + "\n").encode()
        await self._send(
            {
                "type": "websocket.http.response.start",
                "status": status,
                "headers": [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(body)).encode())],
            }
        )
        await self._send({"type": "websocket.http.response.body", "body": body})

    async def _wait_for_token(self):
        self.server.strangers.enter(self)
        try:
            message = parse(await self._text(), self.limits.depth)
        except asyncio.CancelledError:
            self._leave_if_asked()
            raise
        except Malformed:
            message = None
        finally:
            self.server.strangers.leave(self)
        if not self.server.guard.lets_in(message):
            raise Left(POLICY, 'The first message must be {"op": "auth", "token": "..."} with the token of this session.')
        if self._full():
            raise Left(LATER, self._full())
        self.hidden = message.get("hidden") is True

    def give_up(self, late):
        """The token has not come in time (LATE), or others wait, too many of them."""
        if late:
            self.end(
                LATER, f'No token came within {self.limits.first_message:g} s. The first message must be {{"op": "auth", "token": "..."}}.'
            )
        else:
            self._protocol.abandon()
        return True

    # ------------------------------------------------------------------------------------------------------------- reading

    async def _serve(self):
        self.server.post(self._open)
        reader, writer = asyncio.ensure_future(self._read()), asyncio.ensure_future(self._write())
        self._tasks = reader, writer
        try:
            done, _ = await asyncio.wait(self._tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in self._tasks:
                task.cancel()
            await asyncio.gather(*self._tasks, return_exceptions=True)
        for task in done:
            if task.cancelled():
                self._leave_if_asked()
            task.result()

    async def _text(self):
        while True:
            message = await self._receive()
            kind = message["type"]
            if kind == "websocket.receive":
                text = message.get("text")
                return message["bytes"] if text is None else text
            if kind == "websocket.disconnect":
                raise Gone

    async def _read(self):
        bucket = Bucket(self.limits.operations, self.limits.burst, time.monotonic())
        while True:
            text = await self._text()
            found = self._understood(text)
            if found is not None and found["op"] == "ping":
                self.outbox.put(PONG)
                self.stir()
            elif found is not None:
                self.waiting += 1
                self.server.post(lambda found=found: self._do(found))
            pause = bucket.take(time.monotonic())
            if pause > 0:
                await asyncio.sleep(pause)
            if self.waiting >= self.limits.waiting:
                self._room.clear()
                await self._room.wait()

    def _understood(self, text):
        """The operation in a message; ``None`` for a fragment that waits for others, and for what is none, which the client is told."""
        try:
            found = parse(text, self.limits.depth)
            while found["op"] == "fragment":
                whole = self.fragments.add(found)
                if whole is None:
                    return None
                found = parse(whole, self.limits.depth)
            return found
        except Malformed as problem:
            status = {"op": "status", "level": "error", "msg": str(problem)}
            if isinstance(problem.id, str) and len(problem.id) <= self.limits.name:
                status["id"] = problem.id
            self.outbox.put(status)
            self.stir()
            self._complain()
            return None

    def _complain(self):
        now = time.monotonic()
        self.complaints = [moment for moment in self.complaints if now - moment < 60] + [now]
        if len(self.complaints) > self.limits.complaints:
            raise Left(POLICY, f"More than {self.limits.complaints} messages in a minute were none that rosbridge knows.")

    # -------------------------------------------------------------------------------------------------------------- writing

    def stir(self):
        """There may be something to send, or a reason to close, which does not wait for a client that does not read."""
        self._stirred.set()
        if self._sending and (self.outbox.reason is not None or self._ending is not None):
            self._tasks[1].cancel()

    def _leave_if_asked(self):
        if self.outbox.reason is not None:
            raise Left(TOO_MUCH, self.outbox.reason)
        if self._ending is not None:
            raise Left(*self._ending)

    async def _write(self):
        outbox, send, stirred, loop = self.outbox, self._send, self._stirred, asyncio.get_running_loop()
        while True:
            stirred.clear()
            if outbox.reason is not None:
                self._leave_if_asked()
            frames, pause = outbox.next(time.monotonic())
            for frame in frames:
                self._sending = True
                await send({"type": "websocket.send", "bytes" if frame.__class__ is bytes else "text": frame})
                self._sending = False
            if not frames:
                self._leave_if_asked()  # what was said before is heard, such as the last command of a plan
                reminder = None if pause is None else loop.call_later(pause, stirred.set)
                await stirred.wait()
                if reminder is not None:
                    reminder.cancel()

    def end(self, code, reason):
        """Close the connection soon; returns the task that ends with it."""
        self._ending = code, reason
        if self._tasks:
            self.stir()
        else:
            self._task.cancel()  # it still waits for the token
        return self._task

    async def _close(self, code, reason):
        farewell = {"type": "websocket.close", "code": code, "reason": reason_text(reason)}
        self._protocol.abandon(self.limits.closing)
        try:
            await asyncio.wait_for(self._send(farewell), self.limits.closing)
        except (TimeoutError, OSError):
            pass

    # ---------------------------------------------------------------------------------------------------- in the kernel

    def _open(self):
        self.session = Session(self.server.hub, self.outbox, self._after, self.hidden)

    def _do(self, found):
        try:
            if self.session is not None:
                self.session.receive(found)
        finally:
            self.server.hand_out(self._done)

    def _leave(self):
        if not self.trusted:
            return

        def leave():
            if self.session is not None:
                self.session.close()

        self.server.post(leave)

    def _done(self):
        self.waiting -= 1
        if self.waiting <= self.limits.waiting // 2:
            self._room.set()

    def _after(self, seconds, function):
        """Have FUNCTION called in the kernel SECONDS of the wall from now."""
        self.server.hand_out(lambda: self.server.company.loop.call_later(seconds, self.server.post, function))
