"""Finding the session of this user that runs on this machine: a file that says where it listens.

A server writes ``session-PID-PORT.json`` into the folder ``cramhy-UID`` below ``$XDG_RUNTIME_DIR``, or below the temporary folder. The
folder must belong to the user alone (0700), the file is readable by the user alone (0600), since it holds the token; it is written
beside its place and moved there, so nobody reads half of it. It goes when the server does. What a session that was killed left behind is
known by its process, or by a port where nobody answers, and swept away by whoever finds it.
"""

from __future__ import annotations

import json
import os
import socket
import stat
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

LONGEST = 1 << 16
PATIENCE = 1.0  # s; loopback answers at once or not at all


class Unsafe(Exception):
    """The folder cannot be had, or it or a file in it is not this user's alone; the text says which, and what to do."""


@dataclass(frozen=True)
class Found:
    """A session: where it listens, its token, its process. ``address``: for clients of rosbridge that know nothing but an address.
    ``url``: of its page. ``started``: nanoseconds since 1970. ``process``: when the process began, as the system says it."""

    host: str
    port: int
    token: str
    pid: int
    address: str
    url: str
    started: int
    process: str


def folder(create=False):
    """The folder of this user; ``None`` when there is none. Raises `Unsafe`."""
    base = os.environ.get("XDG_RUNTIME_DIR") or tempfile.gettempdir()
    uid = os.getuid() if hasattr(os, "getuid") else 0
    path = Path(base) / f"cramhy-{uid}"
    try:
        if create:
            path.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = path.lstat()
    except OSError as problem:
        if not create and isinstance(problem, (FileNotFoundError, NotADirectoryError)):
            return None
        raise Unsafe(f"{path}, where sessions are announced, cannot be {'made' if create else 'looked at'}: {problem.strerror}. Set "
                     "XDG_RUNTIME_DIR to a folder of your own.") from None
    if not stat.S_ISDIR(status.st_mode) or hasattr(os, "getuid") and (status.st_uid != uid or status.st_mode & 0o077):
        raise Unsafe(f"{path} is not a folder that belongs to this user alone, so no session is announced or looked for there. Remove it, "
                     f"or type: chmod 700 {path}")
    return path


def announce(port, token, started, host="127.0.0.1"):
    """Write the file of a server of this process; returns its path."""
    place = folder(create=True)
    path = place / f"session-{os.getpid()}-{port}.json"
    found = Found(host, port, token, os.getpid(), f"ws://{host}:{port}/{token}", f"http://{host}:{port}/#{token}", started,
                  _began(os.getpid()))
    handle, temporary = tempfile.mkstemp(prefix=".session-", dir=place)  # made with the mode 0600
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(asdict(found), file)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return path


def living():
    """The sessions that are alive, newest first. Files of dead ones are removed."""
    place = folder()
    if place is None:
        return []
    found = []
    for path in place.glob("session-*.json"):
        session = _read(path)
        if session is None or not _lives(session):
            path.unlink(missing_ok=True)
        else:
            found.append(session)
    return sorted(found, key=lambda session: session.started, reverse=True)


def current():
    """The newest session that is alive, or ``None``."""
    return next(iter(living()), None)


def _read(path):
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
    except OSError:
        return None
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode) or hasattr(os, "getuid") and (status.st_uid != os.getuid() or status.st_mode & 0o077):
            raise Unsafe(f"{path} can be read or written by others than this user, so it is not trusted. Remove it.")
        try:
            values = json.loads(file.read(LONGEST))
            session = Found(**values)
        except (ValueError, TypeError):
            return None
    kinds = {name: type_ for name, type_ in zip(Found.__dataclass_fields__, (str, int, str, int, str, str, int, str))}
    return session if all(type(getattr(session, name)) is kind for name, kind in kinds.items()) else None


def _lives(session):
    try:
        if os.name == "posix":
            os.kill(session.pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        pass
    if session.process != _began(session.pid):
        return False  # another process has got the number
    try:
        socket.create_connection((session.host, session.port), PATIENCE).close()
    except (OSError, OverflowError):
        return False
    return True


def _began(pid):
    """When a process began, as the system says it, where it says so."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[19]
    except (OSError, IndexError):
        return ""
