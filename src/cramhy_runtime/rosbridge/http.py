"""Requests before they are any: connections that say nothing, or say it too slowly, are ended.

uvicorn's own protocol waits for ever for the rest of a request, and for a client that does not read. Here a connection must have asked,
and taken its answer, in time, each time anew, unless it becomes a WebSocket; and there are not more of them than clients are allowed,
with some for files of the page.
"""

from __future__ import annotations

CHUNK = 8192  # bytes that are read at once: what they cost is the least that the thread spends before it looks at its share again
SPARE = 50  # connections beside those that are WebSockets


def make_protocol(limits):
    """uvicorn's protocol for HTTP/1.1, with the limits."""
    from uvicorn.protocols.http.h11_impl import H11Protocol

    most = limits.connections + SPARE

    class Impatient(H11Protocol):
        """Ends a connection that has not asked within `Limits.first_message`, since it began or had its last answer, or does not read."""

        _patience = None

        def connection_made(self, transport):
            super().connection_made(transport)
            transport.max_size = CHUNK
            if len(self.connections) > most:
                transport.abort()
                return
            self._be_patient()

        def _be_patient(self):
            self._forgive()
            self._patience = self.loop.call_later(limits.first_message, self._end)

        def _forgive(self):
            if self._patience is not None:
                self._patience.cancel()

        def _end(self):
            if self.cycle is not None and not self.cycle.response_complete and not self.flow.write_paused:
                self._be_patient()  # it is we who are slow
            elif self.transport.get_protocol() is self:  # and not a WebSocket's
                self.transport.abort()

        def on_response_complete(self):
            self._be_patient()
            super().on_response_complete()

        def connection_lost(self, exc):
            self._forgive()
            super().connection_lost(exc)

    return Impatient
