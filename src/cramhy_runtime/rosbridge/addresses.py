"""Addresses of rosbridge servers: ``ws://HOST:PORT``, with a token behind it where the server is a session of cramhy.

A token opens the session to everybody who has it, so an address is `shown` without it wherever others may read: in error messages, log
lines, and the messages on ``/rosout`` that a recording keeps.
"""

from __future__ import annotations

from urllib.parse import urlsplit

HIDDEN = "/..."


def is_address(text):
    """Whether a rosbridge server could be at ``text``, a string: ``ws://HOST:PORT`` or ``wss://HOST:PORT``, and a path."""
    try:
        parts = urlsplit(text)
        good = parts.scheme in ("ws", "wss") and bool(parts.hostname) and parts.port != 0 and not parts.fragment
    except ValueError:  # a port beyond 65535, brackets that never close
        return False
    return good and not any(letter.isspace() or not letter.isprintable() for letter in text)


def has_token(url):
    """Whether the address ``url`` has something behind host and port, which may be a token."""
    parts = urlsplit(url)
    return bool(parts.path.strip("/") or parts.query or parts.password)


def shown(url):
    """The address ``url`` as it may be shown to everybody: ``ws://robot:9090/...`` when it has a token."""
    if not has_token(url):
        return url
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc.rpartition('@')[2]}{HIDDEN}"


def with_token(url, token):
    """The address ``url``, which has no token, with this one."""
    return f"{url.rstrip('/')}/{token}"
