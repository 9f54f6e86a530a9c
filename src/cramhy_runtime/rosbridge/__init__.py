"""rosbridge v2 (JSON over WebSocket): how everything outside of the process speaks to the graph, and how a session joins a real ROS.

Where the parts are:

* `protocol`     one client's operations, done on the graph; `hub` what the clients share there; `rosapi` what they may ask
* `parsing`, `encoding`, `outbox`, `raw`  what comes in, what goes out, how much may wait, the bytes of ROS 1
* `operation_fields`  the fields of an operation; `joined_nodes` the nodes of a session that has joined, `told_nodes` what it tells of them
* `no_answers`   what a caller hears instead of an answer, for both ends
* `server`       sockets and pages in a thread beside the kernel; `connection` one client there; `authentication`, `http` before it is one
* `attachment`   the other way round: a session as the client of a real ROS
* `uplink`       its connection, `refusal` why it does not come about, `addresses` its name, `outbound_queue` what waits while it is lost
* `remote_types`     services and parameters of a real ROS; `service_proxies` those of the plan there
* `guard`        who is let in, and how much is allowed; `sessions` how a program finds the session of its user, and
                 `processes` whether that is surely dead

Importing this package imports none of them, and starting a session loads nothing of it (law 9).
"""

from __future__ import annotations

TYPE_CHECKING = False  # as type checkers know it by its name

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Any

    from .attachment import Link
    from .server import Server


def start(session: Any = None, port: int | None = None, pages: Any = None, origins: Iterable[str] = (), limits: Any = None) -> Server:
    """Let other programs of this user connect; the `server.Server`. See `server.serve`."""
    from .server import serve

    return serve(session, pages, port, origins, limits)


def attach(url: str, patience: float = 10.0) -> Link:
    """Join this session to a real ROS through its rosbridge server; the `attachment.Link`. See `attachment.join`."""
    from .attachment import join

    return join(url, patience)
