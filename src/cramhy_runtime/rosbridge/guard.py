"""Who may speak to the server, and how much: names of the host, origins, the token, limits.

Law 9: nothing listens unless asked to, and then on loopback, with a token. Loopback alone protects from other machines, but not
from pages in the user's own browser, nor from the machine's other users. So there are fixed lists for the header ``Host`` (a
page that has its own name point to 127.0.0.1 is found out by that) and for ``Origin``, on plain requests and on the upgrade to a
WebSocket; and whoever wants to say anything needs the token. It can be brought in four ways:

* as the first message, ``{"op": "auth", "token": "…"}``: our page does that, with the token from the fragment of its address,
  which browsers send to nobody;
* in the path, ``ws://127.0.0.1:PORT/TOKEN``: for clients that know nothing but an address (roslibpy, roslib, Foxglove);
* as a query, ``ws://127.0.0.1:PORT/?token=TOKEN``: likewise, and for our tools, which learn with the handshake whether they are let in;
* as the ``mac`` of rosbridge's own first message ``auth``, made as the ROS package rosauth makes it, with the token for its secret.

No path is ever logged. Tokens are compared in constant time.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from dataclasses import dataclass
from urllib.parse import parse_qs

TOKEN_BYTES = 24
CLOCK_SKEW = 5  # s; how old or how early rosauth's time stamp may be

HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
"""What stands in every answer to a plain request. No header of CORS is among them, so other pages cannot read any answer."""


@dataclass(frozen=True)
class Limits:
    """How much clients may ask. Times are seconds of the wall, sizes bytes."""

    connections: int = 100  # of clients that have shown the token
    silent: int = 400  # connections that have said nothing yet
    strangers: int = 64  # connections without a token that have not finished a request, and as many WebSockets
    first_message: float = 1.0  # until a stranger must have said something, have finished its request, have shown the token
    first_size: int = 1 << 16  # of the message that brings the token
    message: int = 1 << 20  # one frame, or one message made of frames
    reassembled: int = 8 << 20  # what the fragments of one client that wait for others may hold
    fragments: int = 1000  # of one message
    depth: int = 50  # of nested arrays and objects
    operations: float = 500.0  # a second and client; beyond that it is read more slowly
    burst: int = 1000  # operations that may come at once
    waiting: int = 16  # operations of one client that wait for the plan to take notice
    complaints: int = 100  # status messages a minute about what a client sent; after that it is closed
    nodes: int = 50  # of one process that has joined
    subscriptions: int = 200
    advertisements: int = 200
    services: int = 100
    calls: int = 100  # unanswered calls of one client, or unanswered calls to the services of one
    answer: float = 60.0  # until a client must have answered a call of a service that it offers
    parameters: int = 2000  # values that all clients together may add to the parameters
    parameter: int = 1 << 20  # of one parameter's value, as JSON
    parameter_bytes: int = 8 << 20  # of all that clients have set
    turtles: int = 100  # that clients may spawn in one simulator
    programs: int = 20  # that one client may have started
    latched: int = 8 << 20  # of the latched messages of one client
    name: int = 500  # characters of a name, a type or an id
    buffer: int = 16 << 20  # bytes that wait to be sent to one client
    messages: int = 10_000  # messages of a topic that wait for the server's thread, or to be sent to one client
    heavy: int = 32 << 20  # of the texts and arrays in these messages
    closing: float = 2.0  # that a connection gets to say good-bye


def new_token():
    """A token that nobody guesses; it may stand in paths and fragments."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def same(given, token):
    """Whether two tokens are the same, in a time that tells nothing."""
    return isinstance(given, str) and hmac.compare_digest(given.encode("utf-8", "replace"), token.encode())


class Guard:
    """Decides about requests. port: of the server. origins: pages of other servers that may connect, such as Foxglove's."""

    def __init__(self, token, port, origins=(), now=time.time_ns):
        self.token = token
        self._now = now
        self.hosts = frozenset(f"{name}:{port}" for name in ("127.0.0.1", "localhost"))
        self.origins = frozenset([f"http://{host}" for host in self.hosts] + [origin.rstrip("/") for origin in origins])

    def refusal(self, scope):
        """What is wrong with a request (an ASGI scope of HTTP or of a WebSocket): status and text; ``None`` when nothing is."""
        headers = scope["headers"]
        hosts = [value for name, value in headers if name == b"host"]
        if len(hosts) != 1 or hosts[0].decode("latin-1").lower() not in self.hosts:
            return 421, "This server answers to 127.0.0.1 and localhost only, with its port."
        origins = [value.decode("latin-1") for name, value in headers if name == b"origin"]
        if len(origins) > 1 or any(origin not in self.origins for origin in origins):
            return 403, "Pages of other servers may not connect. One that you trust can be named with --origin."
        if scope["type"] == "http":
            if scope["method"] not in ("GET", "HEAD"):
                return 405, "Only GET and HEAD are answered here."
            if (
                not origins
                and any(name == b"sec-fetch-site" and value == b"cross-site" for name, value in headers)
                and not any(name == b"sec-fetch-mode" and value == b"navigate" for name, value in headers)
            ):
                return 403, "Pages of other servers may not load anything from here."
        return None

    def token_of(self, scope):
        """The token in the address of a request for a WebSocket; ``None`` when there is none, "" when the path is something else."""
        path = scope["path"].strip("/")
        if path:
            return path if "/" not in path else ""
        given = query_of(scope).get("token")
        return None if not given else given[0] if len(given) == 1 else ""

    def lets_in(self, message):
        """Whether the first MESSAGE of a client, a parsed one, shows the token."""
        if not isinstance(message, dict) or message.get("op") != "auth":
            return False
        if "token" in message:
            return same(message["token"], self.token)
        return self._rosauth(message)

    def _rosauth(self, message):
        try:
            mac, client, dest, rand, level = (message[key] for key in ("mac", "client", "dest", "rand", "level"))
            begin, end = (_seconds(message[key]) for key in ("t", "end"))
        except (KeyError, TypeError, ValueError):
            return False
        if not all(isinstance(text, str) for text in (mac, client, dest, rand, level)):
            return False
        now = self._now() / 1e9
        text = f"{self.token}{client}{dest}{rand}{begin}{level}{end}"
        right = hashlib.sha512(text.encode("utf-8", "replace")).hexdigest()
        return same(mac, right) and abs(now - begin) <= CLOCK_SKEW and now <= end


def query_of(scope):
    """What stands after the question mark in the address of a request: lists of values by name."""
    try:
        return parse_qs(scope.get("query_string", b"").decode("latin-1"), keep_blank_values=True, max_num_fields=10)
    except ValueError:
        return {"token": [""]}


def _seconds(value):
    if isinstance(value, dict):
        value = value["secs"]
    if value.__class__ is not int:
        raise TypeError
    return value


class Bucket:
    """A right to so many things a second, of which BURST may be saved up (times in seconds)."""

    __slots__ = ("_rate", "_burst", "_left", "_time")

    def __init__(self, rate, burst, now):
        self._rate, self._burst, self._left, self._time = rate, burst, burst, now

    def take(self, now):
        """Take one; how long to wait before the next, 0 while there are some."""
        self._left = min(self._burst, self._left + (now - self._time) * self._rate) - 1
        self._time = now
        return 0.0 if self._left >= 0 else -self._left / self._rate
