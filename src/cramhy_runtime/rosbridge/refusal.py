"""Why a rosbridge server does not let us in, as far as roslibpy's connection tells it: what the user can do something about.

Autobahn only logs such a reason, and roslibpy tries for ever. Here the protocol of a `roslibpy.Ros` is replaced by one that keeps the
reason and ends the wait for the connection. The logs of both libraries are left to those who ask for them.
"""

from __future__ import annotations

import logging
import re

ADDRESS = "The session prints its address with the right one when it starts with --serve (docs/ros-bridge.md)."
WRONG = "{url} is refused: the token in this address is wrong. " + ADDRESS
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


class Refusal:
    """Why the server at ``url`` refuses us: ``why``, a text, or ``None`` as long as it does not. ``waited_for``: whether somebody waits
    for the connection, so that a refusal shall end the wait; roslibpy's topics, which wait for its return, shall not be told."""

    def __init__(self, url):
        self.url, self.why, self.waited_for = url, None, True
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
            def onClose(self, wasClean, code, reason):
                super().onClose(wasClean, code, reason)
                refusal.closed(self.factory, str(reason))

            def connectionLost(self, reason):
                refusal.lost(self.factory, reason.value)
                super().connectionLost(reason)

        return Watched

    def closed(self, factory, reason):
        """The connection ended with this REASON of the server's, or of autobahn's. In roslibpy's thread."""
        if re.search(r"upgrade failed \[40[13]", reason):
            self._is(factory, WRONG)
        elif '"op": "auth"' in reason:
            self._is(factory, MISSING)

    def lost(self, factory, problem):
        """The transport ended with PROBLEM, an exception. In roslibpy's thread."""
        if self.url.startswith("wss:") and re.search("wrong version number|unknown protocol|record layer", repr(problem)):
            self._is(factory, PLAIN)

    def _is(self, factory, text):
        self.why = text.format(url=self.url, plain=re.sub("^wss", "ws", self.url))
        if self.waited_for:
            factory.emit("ready", None)
