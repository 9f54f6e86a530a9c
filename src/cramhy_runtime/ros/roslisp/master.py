"""The address of the master: from ``start-ros-node``, ``*default-master-uri*`` or ``ROS_MASTER_URI``.

The master is the graph in this process. Its address is that in the environment, or port 11311 of this machine. If a program names
another address, `connection_problem` tries to connect. Usually no master is there, and the program gets the error of the
connection. If one answers, it is the master of a real ROS, which sessions reach by another way. Source: roslisp.md 2.1 step 6,
2.5, 8.4.
"""

from __future__ import annotations

import errno
import os

from ... import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.data import LispString
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from ..signatures import Text


LOOPBACK, DEFAULT_PORT = "127.0.0.1", 11311
DEFAULT = f"http://{LOOPBACK}:{DEFAULT_PORT}"
HANDSHAKE_SECONDS = 1.0
MASTER_URI = special("ROSLISP::*MASTER-URI*")
DEFAULT_MASTER_URI = special("ROSLISP::*DEFAULT-MASTER-URI*")


class Uri:
    """The address of a master (``make-uri``)."""

    lisp_name = "ROSLISP::URI"
    __slots__ = ("address", "port")

    def __init__(self, address: str, port: int):
        self.address, self.port = address, port


def make_uri(address: str, port: int) -> Uri:
    """An address for ``start-ros-node``: host ``address`` and number ``port``."""
    return Uri(address, port)


def master_uri() -> Uri | None:
    """The `Uri` in use, or ``None`` before the first node."""
    return MASTER_URI.value


def chosen_uri(given: Text | Uri | None = None) -> Uri:
    """The `Uri` for a starting node: ``given`` (text, a `Uri`, or ``None``), else the user's default, else the environment's.

    A malformed address is an error.
    """
    if isinstance(given, Uri):
        return Uri(_dotted(given.address), given.port)
    if given is None:
        given = DEFAULT_MASTER_URI.value
        if given is None:
            given = os.environ.get("ROS_MASTER_URI") or DEFAULT
    if not isinstance(given, (str, LispString)) or not str(given):
        return conditions.error(
            SimpleError(
                "Master uri needs to be supplied either as an argument to start-ros-node, or through the environment "
                "variable ROS_MASTER_URI, or by setting the lisp variable *default-master-uri*"
            )
        )
    return _parsed(str(given)) or conditions.error(SimpleError("~a", f"Malformed URI {given}"))


def _parsed(text: str) -> Uri | None:
    scheme, separator, rest = text.rstrip("/").partition("://")
    host, colon, port = rest.partition(":")
    return Uri(_dotted(host), int(port)) if scheme == "http" and separator and host and port.isdecimal() else None


def _dotted(host: str) -> str:
    return LOOPBACK if host == "localhost" else host


def is_here(uri: Uri | None) -> bool:
    """Whether ``uri`` is the address of the master in this process."""
    own = _parsed(os.environ.get("ROS_MASTER_URI") or DEFAULT)
    return uri is not None and (uri.address, uri.port) in {(LOOPBACK, DEFAULT_PORT), *([(own.address, own.port)] if own else [])}


def connection_problem(uri: Uri | None) -> str | None:
    """The reason, as text, why the node cannot use the master at ``uri``; ``None`` for the master in this process.

    For another address, it tries to connect for one second at most.
    """
    return None if is_here(uri) else kernel.run_blocking(_try_to_connect, str(uri.address), uri.port)


def _try_to_connect(host: str, port: int) -> str:
    import socket  # few programs ever need it

    try:
        socket.create_connection((host, port), timeout=HANDSHAKE_SECONDS).close()
    except socket.gaierror as problem:
        return f'Name service error in "getaddrinfo": {problem.errno} ({problem.strerror})'
    except TimeoutError:
        return f'Socket error in "connect": ETIMEDOUT ({os.strerror(errno.ETIMEDOUT)})'
    except (OSError, OverflowError) as problem:
        number = getattr(problem, "errno", None)
        text = os.strerror(number) if number else str(problem)
        return f'Socket error in "connect": {errno.errorcode.get(number, "EINVAL")} ({text})'
    return (
        f"a master outside of this process answers there. Start the session with --ros ws://{host}:9090 to work with its nodes, "
        "through the rosbridge server on that machine; without :master-uri the node is started here."
    )
