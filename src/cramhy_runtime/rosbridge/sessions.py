"""Finding the session of this user that runs on this machine: a file that says where it listens.

A server writes ``session-PID-PORT-RANDOM.json`` into the folder ``cramhy-UID`` below ``$XDG_RUNTIME_DIR``, or below the temporary folder.
The folder must belong to the user alone (0700), the file is readable by the user alone (0600), since it holds the token; it is written
beside its place and moved there, so nobody reads half of it.

The file goes with the server. A session that was killed leaves its file behind; the next program that looks removes it, but only when its
process is surely dead (`processes`). A session that does not answer, or that runs in another container, keeps its file. If somebody
removes the file all the same, or the folder, the session writes it again (`Announcement.renew`).
"""

from __future__ import annotations

import json
import os
import secrets
import socket
import stat
import sys
import tempfile
import time
from dataclasses import MISSING, asdict, dataclass, fields
from pathlib import Path

from cramhy_runtime.storage import owners
from cramhy_runtime.storage.partial_names import CAREFULLY
from . import processes
from .processes import Identity

LONGEST = 1 << 16
PATIENCE = 1.0  # s; loopback answers at once or not at all
LEFTOVER = 3600.0  # s after which an unfinished file is a leftover, though its process is not known to be dead


class Unsafe(Exception):
    """The folder cannot be had, or it or a file in it is not this user's alone; the text says which, and what to do."""


@dataclass(frozen=True)
class Found:
    """A session: where it listens, its token, its process. ``address``: for clients of rosbridge that know nothing but an address.
    ``url``: of its page. ``started``: nanoseconds since 1970. ``process``, ``machine``, ``boot``, ``namespace``: see
    `processes.Identity`."""

    host: str
    port: int
    token: str
    pid: int
    address: str
    url: str
    started: int
    process: str = ""
    machine: str = ""
    boot: str = ""
    namespace: str = ""

    @property
    def identity(self):
        """The `processes.Identity` of its process."""
        return Identity(self.pid, self.machine, self.boot, self.namespace, self.process)


# ---------------------------------------------------------------------------------------------------------------- the folder


_told = set()


def base():
    """The folder in which the folders of users are. A relative XDG_RUNTIME_DIR does not count, and that is said once on stderr
    (XDG Base Directory Specification: "All paths set in these environment variables must be absolute")."""
    given = os.environ.get("XDG_RUNTIME_DIR")
    if given and os.path.isabs(given):
        return Path(given)
    try:
        found = Path(tempfile.gettempdir())
    except OSError as problem:
        raise Unsafe(
            f"There is no temporary folder in which sessions could be announced: {problem.strerror or problem}. Set "
            "XDG_RUNTIME_DIR to a folder of your own."
        ) from None
    if given and given not in _told and sys.stderr is not None:
        _told.add(given)
        print(
            f"; XDG_RUNTIME_DIR is {given}, a relative path, and is ignored. Sessions are announced below {found}.",
            file=sys.stderr,
            flush=True,
        )
    return found


def folder(create=False, path=None):
    """The folder of this user, or ``path``; ``None`` when there is none. Raises `Unsafe`."""
    path = path or base() / f"cramhy-{owners.number()}"
    try:
        if create:
            path.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = path.lstat()
    except OSError as problem:
        if not create and isinstance(problem, (FileNotFoundError, NotADirectoryError)):
            return None
        raise Unsafe(
            f"{path}, where sessions are announced, cannot be {'made' if create else 'looked at'}: {problem.strerror}. Set "
            "XDG_RUNTIME_DIR to a folder of your own."
        ) from None
    if not stat.S_ISDIR(status.st_mode) or not owners.mine(status) or owners.open_to_others(status):
        raise Unsafe(
            f"{path} is not a folder that belongs to this user alone, so no session is announced or looked for there. Remove it, "
            f"or type: chmod 700 {path}"
        )
    return path


# ------------------------------------------------------------------------------------------------------------ announcing


class Announcement:
    """The file of a server of this process. ``path``: of the file."""

    def __init__(self, port, token, host="127.0.0.1"):
        """Write the file. Raises `Unsafe`."""
        me = self._identity = processes.own()
        self.found = Found(
            host,
            port,
            token,
            me.pid,
            f"ws://{host}:{port}/{token}",
            f"http://{host}:{port}/#{token}",
            time.time_ns(),
            me.began,
            me.machine,
            me.boot,
            me.namespace,
        )
        self._name = f"session-{me.pid}-{port}-{secrets.token_hex(4)}.json"
        self._mark = None
        self.closed = False
        place = folder(create=True)
        sweep(place, trusting=True)
        self.path = place / self._name
        self._write(place)

    def _write(self, place):
        me = self._identity
        temporary = None
        try:
            handle, temporary = tempfile.mkstemp(prefix=f".session-{me.pid}-{me.began}-{me.place}-", dir=place)  # has the mode 0600
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                json.dump(asdict(self.found), file)
            self._mark = _mark(os.stat(temporary))
            os.replace(temporary, self.path)
        except OSError as problem:
            _remove(temporary)
            raise Unsafe(
                f"A file cannot be written in {place}, where sessions are announced: {problem.strerror}. Make room there, or set "
                "XDG_RUNTIME_DIR to a folder of your own."
            ) from None
        except BaseException:
            _remove(temporary)
            raise

    def renew(self):
        """Write the file again if it, or the folder, has been removed or replaced; whether it was necessary. Raises `Unsafe`."""
        try:
            if _mark(self.path.lstat()) == self._mark:
                return False
        except OSError:
            pass
        if self.closed:
            return False
        self._write(folder(True, self.path.parent))  # whatever the environment says by now
        if self.closed:  # the session has ended meanwhile
            self.close()
        return True

    def close(self):
        """Remove the file. Does nothing when it is not there, or when another file stands in its place."""
        self.closed = True
        try:
            if _mark(self.path.lstat()) == self._mark:
                self.path.unlink()
        except OSError:
            pass


def _mark(status):
    """What tells one file from another that has taken its name."""
    return status.st_dev, status.st_ino, status.st_size


def announce(port, token, host="127.0.0.1"):
    """Write the file of a server of this process; the `Announcement`. Raises `Unsafe`."""
    return Announcement(port, token, host)


# --------------------------------------------------------------------------------------------------------------- finding


def living():
    """The sessions that answer, newest first. What processes that are surely dead left behind is removed."""
    place = folder()
    return [] if place is None else sorted(filter(_answers, sweep(place)), key=lambda session: session.started, reverse=True)


def current():
    """The newest session that answers, or ``None``."""
    return next(iter(living()), None)


def sweep(place, trusting=False):
    """Remove what processes that are surely dead left in the folder ``place``; the sessions that are left, whether they answer or not.

    A file that others can read or write is `Unsafe`; with ``trusting`` it is left alone, for who only wants to clean up.
    """
    here = processes.own()
    left, gone = [], []
    for path in place.glob("session-*.json"):
        try:
            session = _read(path)
        except Unsafe:
            if not trusting:
                raise
            continue
        if session is None:
            continue
        if session is BROKEN or processes.dead(session.identity, here):
            _remove(path)
            gone.append(session)
        else:
            left.append(session)
    ports = {session.port for session in left}
    for session in gone:
        if session is not BROKEN and session.port not in ports:
            _remove(place / f"page-{session.port}.html")  # it leads a browser to the session's page
    for path in place.glob(".session-*"):
        if _is_leftover(path, here):
            _remove(path)
    return left


def _is_leftover(path, here):
    """Whether a file that was to become a session's has been left by a process that is dead, or that has not finished it for long."""
    pid, began, where, _ = [*path.name.removeprefix(".session-").split("-", 3), "", "", "", ""][:4]
    if where and where == here.place and pid.isdecimal():
        return processes.dead(Identity(int(pid), here.machine, here.boot, here.namespace, began), here)
    try:
        return time.time_ns() / 1e9 - path.lstat().st_mtime > LEFTOVER
    except OSError:
        return False


def _remove(path):
    try:
        if path is not None:
            os.unlink(path)
    except OSError:
        pass


BROKEN = object()
"""What a file holds in which no session stands. A session's own file is never like that, since it is moved into its place as a whole."""


def _read(path):
    """The session in a file; ``None`` when it cannot be read, `BROKEN` when it holds none. Raises `Unsafe`."""
    try:
        handle = os.open(path, os.O_RDONLY | CAREFULLY)
    except OSError:
        return None
    status = os.fstat(handle)
    if not stat.S_ISREG(status.st_mode) or not owners.mine(status) or owners.open_to_others(status):
        os.close(handle)
        raise Unsafe(f"{path} can be read or written by others than this user, so it is not trusted. Remove it.")
    with os.fdopen(handle, "rb") as file:
        try:
            values = json.loads(file.read(LONGEST))
        except OSError:
            return None
        except (ValueError, RecursionError):
            return BROKEN
    if not isinstance(values, dict):
        return BROKEN
    kept = {field.name: values.get(field.name, field.default) for field in fields(Found)}  # another version may write more or less
    kinds = {"int": int, "str": str}
    if any(value is MISSING or type(value) is not kinds[field.type] for field, value in zip(fields(Found), kept.values())):
        return BROKEN
    return Found(**kept)


def _answers(session):
    """Whether somebody listens where the session said. One that is too slow to answer counts: it says so to who connects."""
    try:
        socket.create_connection((session.host, session.port), PATIENCE).close()
    except TimeoutError:
        return True
    except (OSError, OverflowError, UnicodeError):
        return False
    return True
