"""Requests before they are any, and WebSockets before they have shown a token: uvicorn's protocols, with limits.

uvicorn waits for ever for the rest of a request, and for a client that does not read. Here a connection must have asked, and taken its
answer, in time, each time anew, unless it becomes a WebSocket; and of those that have not, the longest waiting one goes when there are too
many (`door`). A WebSocket may send little before it has shown the token, and it cannot keep its socket after we have closed it.
"""

from __future__ import annotations

from .door import WaitingRoom

CHUNK = 8192  # bytes that are read at once: what they cost is the least that the thread spends before it looks at its share again
EXTENSION = "cramhy"  # the place in the scope of a WebSocket where its protocol stands


def make_protocol(limits):
    """uvicorn's protocol for HTTP/1.1, with the limits."""
    from uvicorn.protocols.http.h11_impl import H11Protocol

    rooms = {}

    def room_in(loop):
        if loop not in rooms:
            rooms[loop] = WaitingRoom(loop, limits.strangers, limits.first_message, lambda one, late: one.end())
        return rooms[loop]

    class Impatient(H11Protocol):
        """Waits in a room of strangers, but for while it is we who answer, and when it has become a WebSocket."""

        def connection_made(self, transport):
            super().connection_made(transport)
            transport.max_size = CHUNK
            self.room = room_in(self.loop)
            self.room.enter(self)

        def end(self):
            """End the connection; false when it is we who are slow."""
            if self.cycle is not None and not self.cycle.response_complete and not self.flow.write_paused:
                return False
            self.transport.abort()
            return True

        def handle_websocket_upgrade(self, event):
            self.room.leave(self)
            super().handle_websocket_upgrade(event)

        def on_response_complete(self):
            self.room.enter(self)
            super().on_response_complete()

        def connection_lost(self, exc):
            self.room.leave(self)
            super().connection_lost(exc)

    return Impatient


def make_websocket(limits):
    """uvicorn's protocol for WebSockets, with the limits."""
    from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

    class Modest(WebSocketsSansIOProtocol):
        """Takes short messages only, until `trust`; stands in the scope of its connection."""

        def __init__(self, *arguments, **keywords):
            super().__init__(*arguments, **keywords)
            self._take(limits.first_size)

        def _take(self, size):
            name = "max_message_size" if hasattr(self.conn, "max_message_size") else "max_size"  # before websockets 16
            setattr(self.conn, name, size)

        def trust(self):
            """Take messages of the size that clients may send."""
            self._take(limits.message)

        def abandon(self, seconds=0.0):
            """Close the socket, after so many seconds, whether the other side says good-bye or not."""
            if seconds:
                self.loop.call_later(seconds, self.transport.abort)
            else:
                self.transport.abort()

        def handle_cont(self, event):
            if len(self.frames) > limits.fragments:
                self.transport.abort()
            else:
                super().handle_cont(event)

        async def run_asgi(self):
            self.scope["extensions"][EXTENSION] = self
            await super().run_asgi()

    return Modest
