"""Why a rosbridge server does not let a session in.

Autobahn only logs such a reason, and roslibpy tries for ever. Here the reason is kept, and the wait for the connection ends. The logs of
both libraries are left to those who ask for them.
"""

from __future__ import annotations

import logging
import re

from . import addresses

ADDRESS = "The session prints its address with the right one when it starts with --serve (docs/ros-bridge.md)."
REFUSED = "{url} is refused: the server answered {answer}. If it is a session of cramhy, the token in this address is wrong. " + ADDRESS
OTHER = "{url} is refused: the server answered {answer}. Is it a rosbridge server, and is this its address?"
MISSING = "{url} is refused: the token is missing in this address. " + ADDRESS
PLAIN = "The server at {url} does not speak TLS. Try {plain}"


class Refusal:
    """Why the server at ``url`` refuses us: ``why``, a text, or ``None`` as long as it does not. ``waited_for``: whether somebody waits
    for the connection, so that a refusal shall end the wait."""

    def __init__(self, url):
        self.url, self.why, self.waited_for = url, None, True
        for library in ("twisted", "autobahn", "roslibpy"):
            logger = logging.getLogger(library)
            if not logger.handlers:
                logger.addHandler(logging.NullHandler())  # else Python writes their warnings to the terminal

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
        url = addresses.shown(self.url)
        self.why = text.format(url=url, answer=answer, plain=re.sub("^wss", "ws", url))
        if self.waited_for:
            factory.emit("ready", None)
