"""The connection of a joined session: roslibpy's, with a heartbeat, and an end by which everything has arrived.

roslibpy connects, reads and writes WebSockets, and connects anew. It notices nothing when the network just stops to carry: what is sent
then waits in the socket, and arrives in a burst minutes later. So the server is sent a ping every `TICK` s (every WebSocket server answers
it by itself, without ROS):

* Without any sign of life for `HOLD` s after a ping the line is ``quiet``: messages should wait here, where the old ones can be dropped.
* After `STALL` s the connection is aborted. The system throws away what it has not delivered, and roslibpy begins a new connection.
* A pong says that all arrived that was sent before its ping: see ``acknowledged``.

The heartbeat counts its own ticks, so a machine that slept, or a session that was stopped, is not taken for a stalled network. All of it is
in roslibpy's thread; what happens there is posted to the kernel. At the end a last call is answered before the socket closes, since
rosbridge throws away what a client that closes has sent last.
"""

from __future__ import annotations

import json

from . import addresses
from .refusal import Refusal

TICK = 0.1  # s
HOLD = 0.2  # s without a sign of life until messages wait here
STALL = 2.0  # s without a sign of life until the connection is given up
LONGEST = 10.0  # s that a pong may take while other data comes
CONNECTING = 5.0  # s for one attempt to connect
LONGEST_DELAY = 1.0  # s between two attempts
FAREWELL = 1.0  # s that the other side gets to say that it has heard everything
LAST_CALL = "/rosapi/get_time"
SILENCE = f"nothing has come from there for {STALL:g} s"
DEAFNESS = f"what is sent has not arrived there for {LONGEST:g} s"


class Uplink:
    """The connection to the rosbridge server at ``url``. To be used with the baton.

    ``open``: whether operations can be sent; ``quiet``: whether signs of life are missing; ``acknowledged``: the number, as `send` gives
    it, up to which the other side has read. ``server``: what the server calls itself. ``shown``: its address without the token.
    ``on_open()``, ``on_lost(reason)``, ``on_flow()`` (quiet no more), and ``on_operation(operation)`` are called in the kernel.
    """

    def __init__(self, url, kernel):
        import roslibpy

        self.url, self.shown, self.kernel = url, addresses.shown(url), kernel
        self.refusal = Refusal(url)
        self.open = self.quiet = False
        self.server = ""
        self.acknowledged = self._numbers = self._written = 0
        self.on_open = self.on_flow = lambda: None
        self.on_lost = self.on_operation = lambda _: None
        self._protocol = self._mark = self._left = None
        self._silent = self._overdue = 0
        self._why = ""
        uplink = self

        class Ros(roslibpy.Ros):
            def connect(self):
                uplink._watch(self.factory)  # first: the reactor may run already, and be quick
                super().connect()

        self.ros = Ros(url)

    def _watch(self, factory):
        factory.maxDelay = LONGEST_DELAY
        usual = getattr(factory, "protocol", None)
        if not hasattr(usual, "connectionLost"):
            raise RuntimeError("ROSLIBPY_TRANSPORT chooses another transport than twisted, which joining a robot needs. Unset it.")
        factory.protocol = watched(usual, self)
        factory.setProtocolOptions(openHandshakeTimeout=CONNECTING)
        begun = factory.startedConnecting

        def started(connector):
            connector.timeout = CONNECTING
            begun(connector)

        factory.startedConnecting = started

    # --------------------------------------------------------------------------------------------------- with the baton

    def run(self, patience):
        """Connect, and wait for it outside of the kernel. Raises roslibpy's ``RosTimeoutError`` after ``patience`` s."""
        self.ros.run(patience)

    def send(self, operation):
        """Write an operation, a dictionary of plain data; its number. One that is sent when it is not open is lost."""
        from twisted.internet import reactor

        self._numbers += 1
        number, text = self._numbers, json.dumps(operation).encode()
        reactor.callFromThread(self._write, number, text)
        return number

    def leave(self, operations=(), patience=FAREWELL, returning=0.0):
        """End the connection, or the attempts at one; waits for it. OPERATIONS are the last ones.

        patience: seconds that the server gets to read everything. returning: seconds to wait for a lost connection.
        Returns whether the server has read everything.
        """
        from twisted.internet import defer, reactor, threads

        @defer.inlineCallbacks
        def go():  # in roslibpy's thread
            if self._protocol is None and returning:
                yield self._until("open", returning)
            self.ros.factory.stopTrying()
            protocol = self._protocol
            if protocol is None:
                return False
            for operation in operations:
                protocol.sendMessage(json.dumps(operation).encode())
            heard = True
            if operations or self._written > self.acknowledged:
                protocol.sendMessage(json.dumps({"op": "call_service", "id": LAST_CALL, "service": LAST_CALL, "args": {}}).encode())
                heard = yield self._until("last call", patience)
            if self._protocol is not None:
                self._protocol._manual_disconnect = True
                self._protocol.sendClose()
                yield self._until("lost", FAREWELL)
            if self._protocol is not None:
                self._protocol.transport.abortConnection()
            return heard

        return threads.blockingCallFromThread(reactor, go) if reactor.running else False

    # ----------------------------------------------------------------------------------------------- in roslibpy's thread

    def _until(self, event, seconds):
        """A Deferred that is true when EVENT comes within so many seconds, false when not."""
        from twisted.internet import defer, reactor

        found = defer.Deferred()
        self._left = event, found
        return found.addTimeout(seconds, reactor, lambda *_: False)

    def _happens(self, event):
        if self._left is not None and self._left[0] == event:
            _, found = self._left
            self._left = None
            if not found.called:
                found.callback(True)

    def _write(self, number, text):
        if self._protocol is not None:
            self._protocol.sendMessage(text)
            self._written = number

    def opened(self, protocol):
        from twisted.internet import reactor

        self._protocol, self.open, self.quiet = protocol, True, False
        self._mark, self._silent, self._overdue, self._why = None, 0, 0, ""
        self.kernel.post(lambda: self.on_open())
        self._happens("open")
        reactor.callLater(TICK, self._beat, protocol)

    def lost(self, protocol):
        if self._protocol is protocol:
            self._protocol, self.open, self.quiet = None, False, False
            why = self._why
            self.kernel.post(lambda: self.on_lost(why))
            self._happens("lost")

    def _beat(self, protocol):
        from twisted.internet import reactor

        if self._protocol is not protocol:
            return
        reactor.callLater(TICK, self._beat, protocol)
        if self._mark is None:
            self._mark, self._silent, self._overdue = self._written, 0, 0
            protocol.sendPing()
            return
        self._silent += 1
        self._overdue += 1
        if self._silent * TICK >= HOLD - TICK / 2:
            self.quiet = True
        silent, deaf = self._silent * TICK >= STALL - TICK / 2, self._overdue * TICK >= LONGEST
        if silent or deaf:
            self._why = SILENCE if silent else DEAFNESS
            protocol.transport.abortConnection()

    def lives(self):
        """Something has come."""
        self._silent = 0
        if self.quiet:
            self.quiet = False
            self.kernel.post(lambda: self.on_flow())

    def ponged(self):
        if self._mark is not None:
            self.acknowledged, self._mark = self._mark, None

    def heard(self, payload):
        try:
            operation = json.loads(payload)
        except ValueError:
            return
        if isinstance(operation, dict):
            if operation.get("id") == LAST_CALL:
                self._happens("last call")
            else:
                self.kernel.post(lambda: self.on_operation(operation))


def watched(usual, uplink):
    """The class of protocols that roslibpy shall use for UPLINK, in the place of the USUAL one."""

    class Watched(usual):
        def onConnect(self, response):
            uplink.server = response.headers.get("server", "")
            super().onConnect(response)

        def onOpen(self):
            super().onOpen()
            uplink.opened(self)

        def dataReceived(self, data):
            uplink.lives()
            super().dataReceived(data)

        def onPong(self, payload):
            uplink.ponged()

        def onMessage(self, payload, isBinary):
            if not isBinary:
                uplink.heard(payload)

        def onClose(self, wasClean, code, reason):
            super().onClose(wasClean, code, reason)
            uplink.refusal.closed(self.factory, str(reason))

        def connectionLost(self, reason):
            uplink.refusal.lost(self.factory, reason.value)
            uplink.lost(self)
            super().connectionLost(reason)

    return Watched
