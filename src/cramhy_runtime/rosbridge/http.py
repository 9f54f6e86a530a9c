"""Requests before they are any: connections that say nothing, or say it too slowly, are ended.

uvicorn's own protocol waits for ever for the first line of a request. Here a connection must have sent its request's head in time, and
there are not more of them than clients are allowed, with some for files of the page.
"""

from __future__ import annotations

CHUNK = 8192  # bytes that are read at once: what they cost is the least that the thread spends before it looks at its share again
SPARE = 50  # connections beside those that are WebSockets


def make_protocol(limits):
    """uvicorn's protocol for HTTP/1.1, with the limits."""
    from uvicorn.protocols.http.h11_impl import H11Protocol

    most = limits.connections + SPARE

    class Impatient(H11Protocol):
        """Ends a connection that has not sent a request's head within `Limits.first_message`."""

        def connection_made(self, transport):
            super().connection_made(transport)
            transport.max_size = CHUNK
            if len(self.connections) > most:
                transport.abort()
                return
            self._patience = self.loop.call_later(limits.first_message, self._lose_patience)

        def _lose_patience(self):
            if self.scope is None:
                self.transport.abort()

        def connection_lost(self, exc):
            patience = getattr(self, "_patience", None)
            if patience is not None:
                patience.cancel()
            super().connection_lost(exc)

    return Impatient
