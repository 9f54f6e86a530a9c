"""The page of a tab as the one client of its session: operations of rosbridge over a message port.

It is for a port what the server and the connections of the room rosbridge are for sockets. The protocol, the hub and the outbox are the
same. There is one thread, so "the server's thread" is whoever calls.
"""

from __future__ import annotations

import time

from ..rosbridge.guard import Limits
from ..rosbridge.hub import Hub
from ..rosbridge.outbox import Outbox
from ..rosbridge.parsing import Malformed, parse
from ..rosbridge.protocol import Session
from ..rosbridge.rosapi import RosApi
from ..kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..ros.graph import Graph

PONG = '{"op":"pong"}'


class Port:
    """Connects the page with a graph, until the graph's kernel stops.

    say: sends a text to the page. later: calls a function after some seconds of the wall, outside of all tasks.
    """

    def __init__(self, here: Graph, say: Callable[[str], object], later: Callable[[float, Callable[[], object]], object]):
        self._kernel, self._say, self._later = here.kernel, say, later
        limits = Limits()
        self._depth = limits.depth
        self._hub = Hub(here, self._hand_out, limits)
        self._rosapi = RosApi(here, limits)
        self._limits = limits
        self._outbox = Outbox(limits)
        self._client: Session | None = None
        self._closed = self._called = self._reminded = False
        self._out: list[Callable[[], object]] = []
        self._kernel.count_outside(1)
        self._kernel.at_stop(self.close)

    def receive(self, text: str) -> None:
        """Take a message of the page. JavaScript calls it, between two turns."""
        if self._closed:
            return
        try:
            operation = parse(text, self._depth)
        except Malformed as problem:
            self._outbox.put({"op": "status", "level": "error", "msg": str(problem)})
            self._flush()
            return
        if operation["op"] == "ping":
            self._say(PONG)
        else:
            self._kernel.post(lambda: self._do(operation))

    def close(self) -> None:
        """End the connection. Does nothing a second time."""
        if self._closed:
            return
        self._closed = True
        self._hub.answer_all()
        self._flush()
        self._hub.close()
        self._rosapi.close()
        self._kernel.count_outside(-1)
        self._kernel.not_at_stop(self.close)

    def _do(self, operation):
        if self._closed:
            return
        if operation["op"] == "auth":  # a page that was loaded anew, or that lost its patience, begins anew
            if self._client is not None:
                self._client.close()
            self._outbox = Outbox(self._limits)
            self._client = Session(self._hub, self._outbox, self._after, True)
        elif self._client is not None:
            self._client.receive(operation)
        self._flush()

    def _hand_out(self, function):
        """What a plan says is sent when the event loop has its next turn: many messages in one go, and none in the plan's way."""
        self._out.append(function)
        if not self._called:
            self._called = True
            self._later(0, self._take)

    def _take(self):
        self._called = False
        out, self._out = self._out, []
        for function in out:
            function()
        self._flush()

    def _flush(self):
        while True:
            frames, pause = self._outbox.next(time.monotonic())
            for frame in frames:
                self._say(frame)
            if not frames:
                if pause is not None and not self._reminded:
                    self._reminded = True
                    self._later(pause, self._remind)
                return

    def _remind(self):
        self._reminded = False
        if not self._closed:
            self._flush()

    def _after(self, seconds, function):
        self._later(seconds, lambda: self._kernel.post(function))
