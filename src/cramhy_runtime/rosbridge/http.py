"""Requests before they are any, and WebSockets before they have shown a token: uvicorn's protocols, with limits.

uvicorn waits for ever for the rest of a request, and for a client that does not read. Here a connection must have asked, and taken its
answer, in time, each time anew, unless it becomes a WebSocket; and of those that have not, the longest waiting one goes when there are too
many (`door`). A WebSocket may send little before it has shown the token, and it cannot keep its socket after we have closed it.
"""

from __future__ import annotations

CHUNK = 8192  # bytes that are read at once: what they cost is the least that the thread spends before it looks at its share again
TOO_LONG = 1009  # the code with which a WebSocket is closed that sends too much
EXTENSION = "cramhy"  # the place in the scope of a WebSocket where its protocol stands


def make_protocol(room):
    """uvicorn's protocol for HTTP/1.1; ``room``: the `door.WaitingRoom` of those that have not finished a request."""
    from uvicorn.protocols.http.h11_impl import H11Protocol

    class Impatient(H11Protocol):
        """Waits in a room of strangers, but for while it is we who answer, and when it has become a WebSocket."""

        def connection_made(self, transport):
            super().connection_made(transport)
            transport.max_size = CHUNK
            room.enter(self)

        def end(self, late):
            """End the connection; false when it has not been answered in time because we are slow."""
            if late and self.cycle is not None and not self.cycle.response_complete and not self.flow.write_paused:
                return False
            self.transport.abort()
            return True

        def handle_websocket_upgrade(self, event):
            room.leave(self)
            super().handle_websocket_upgrade(event)

        def on_response_complete(self):
            room.enter(self)
            super().on_response_complete()

        def connection_lost(self, exc):
            room.leave(self)
            super().connection_lost(exc)

    return Impatient


def make_websocket(limits):
    """uvicorn's protocol for WebSockets, with the limits."""
    from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

    class Modest(WebSocketsSansIOProtocol):
        """Takes few bytes, until `trust`; stands in the scope of its connection."""

        trusted = False
        heard = 0

        def trust(self):
            """Take messages as clients may send them."""
            self.trusted = True

        def data_received(self, data):
            if not self.trusted:  # websockets has a limit too, but it takes a new one only for the message after the next
                self.heard += len(data)
                if self.heard > limits.first_size and not self.close_sent:
                    self.conn.fail(TOO_LONG, f"{limits.first_size} bytes may come before the token.")
                    self.transport.write(b"".join(self.conn.data_to_send()))
                    self.transport.close()
                    return
            super().data_received(data)

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
