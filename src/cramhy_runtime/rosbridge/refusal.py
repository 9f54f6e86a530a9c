"""roslibpy's connection: how it begins and ends, why a server does not let us in, and what it complains of later.

Autobahn only logs such a reason, and roslibpy tries for ever; it has no ear for the operation ``status`` either. Here the protocol of a
`roslibpy.Ros` is replaced by one that keeps the reason, ends the wait for the connection, and hands complaints on. The logs of both
libraries are left to those who ask for them.
"""

from __future__ import annotations

import logging
import re

FAREWELL = 1.0  # s that the other side gets to say that it has heard everything

ADDRESS = "The session prints its address with the right one when it starts with --serve (docs/ros-bridge.md)."
REFUSED = "{url} is refused: the server answered {answer}. If it is a session of cramhy, the token in this address is wrong. " + ADDRESS
OTHER = "{url} is refused: the server answered {answer}. Is it a rosbridge server, and is this its address?"
MISSING = "{url} is refused: the token is missing in this address. " + ADDRESS
PLAIN = "The server at {url} does not speak TLS. Try {plain}"


def connect(url):
    """A `roslibpy.Ros` that connects to URL, and its `Refusal`."""
    import roslibpy

    refusal = Refusal(url)

    class Watched(roslibpy.Ros):
        def connect(self):
            refusal.watch(self.factory)  # first: the reactor may run already, and be quick
            super().connect()

    return Watched(url), refusal


def leave(ros):
    """End the connection of a `roslibpy.Ros`, or its attempts at one. What was sent before has arrived then, if the other side still
    answers: the last message of a plan may be the command to stop."""
    from twisted.internet import reactor, threads
    from twisted.internet.defer import Deferred

    def close():  # in roslibpy's thread
        ros.factory.stopTrying()
        if not ros.is_connected:
            return None
        gone = Deferred()
        gone.addTimeout(FAREWELL, reactor, lambda *_: None)
        ros.on("close", lambda *_: gone.called or gone.callback(None))
        ros.emit("closing")
        ros.factory.on_ready(lambda protocol: protocol.send_close())
        return gone

    if reactor.running:
        threads.blockingCallFromThread(reactor, close)


class Refusal:
    """Why the server at ``url`` refuses us: ``why``, a text, or ``None`` as long as it does not. ``waited_for``: whether somebody waits
    for the connection, so that a refusal shall end the wait; roslibpy's topics, which wait for its return, shall not be told.
    ``complained``: gets the text of each status of the server's, in roslibpy's thread."""

    def __init__(self, url):
        self.url, self.why, self.waited_for = url, None, True
        self.complained = lambda text: None
        for library in ("twisted", "autobahn", "roslibpy"):
            logger = logging.getLogger(library)
            if not logger.handlers:
                logger.addHandler(logging.NullHandler())  # else Python writes their warnings to the terminal

    def watch(self, factory):
        """Look at what becomes of the connections of roslibpy's FACTORY."""
        usual = getattr(factory, "protocol", None)
        if hasattr(usual, "connectionLost"):  # roslibpy can be told to do without twisted
            factory.protocol = self._protocol(usual)

    def _protocol(self, usual):
        refusal = self

        class Watched(usual):
            def __init__(self, *arguments, **keywords):
                super().__init__(*arguments, **keywords)
                self._message_handlers["status"] = lambda message: refusal.complained(str(message.get("msg", "")))

            def onClose(self, wasClean, code, reason):
                super().onClose(wasClean, code, reason)
                refusal.closed(self.factory, str(reason))

            def connectionLost(self, reason):
                refusal.lost(self.factory, reason.value)
                super().connectionLost(reason)

        return Watched

    def closed(self, factory, reason):
        """The connection ended with this REASON of the server's, or of autobahn's. In roslibpy's thread."""
        answer = re.search(r'upgrade failed \[(\d+)\]: ([^"]*)', reason)
        if answer:
            self._is(factory, REFUSED if answer[1] in ("401", "403") else OTHER, " ".join(answer.groups()).rstrip())
        elif '"op": "auth"' in reason:
            self._is(factory, MISSING)

    def lost(self, factory, problem):
        """The transport ended with PROBLEM, an exception. In roslibpy's thread."""
        if self.url.startswith("wss:") and re.search("wrong version number|unknown protocol|record layer", repr(problem)):
            self._is(factory, PLAIN)

    def _is(self, factory, text, answer=""):
        self.why = text.format(url=self.url, answer=answer, plain=re.sub("^wss", "ws", self.url))
        if self.waited_for:
            factory.emit("ready", None)
