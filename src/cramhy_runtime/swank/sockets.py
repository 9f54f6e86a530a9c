"""Where a server listens: at a port of loopback, or at the path of a Unix socket.

A Unix socket listens before it has its name, and gets the name by a hard link. So nobody sees one that is half made, its mode does not
depend on the umask. A socket that refuses connections has been left by a process that is dead, and is removed. Sessions that start at once
find out one after another whether it does, each with a lock on the folder, so none removes the socket that another has just put there.
"""

from __future__ import annotations

import contextlib
import os
import select
import socket
import stat

from cramhy_runtime.storage import owners, partial_names

from .errors import ServerError

HOST = "127.0.0.1"
WAITING = 100  # clients that the system lets wait
PATIENCE = 1.0  # s that a session gets to take a connection, or to leave the lock; on this machine both are done at once
TRIES = 100


class Listening:
    """A socket that listens. ``socket``: Python's. ``address``: its port, or its path as it was given."""

    def __init__(self, address):
        """Listen at the port ``address`` (``None`` or 0: a free one), or at the path ``address``. Raises `ServerError`."""
        self._path = self._status = None
        at_path = isinstance(address, str)
        try:
            self.socket = self._at_path(address) if at_path else _at_port(address or 0)
        except (OSError, OverflowError) as problem:
            why = getattr(problem, "strerror", None) or problem
            where = address if at_path else f"port {address} of {HOST}"
            raise ServerError(
                f"The server for Emacs cannot listen on {where}: {why}. Choose another place, or none for a free port."
            ) from None
        self.socket.setblocking(False)
        self.address = address if at_path else self.socket.getsockname()[1]

    def close(self):
        """Listen no more. The name of a Unix socket goes, if it still stands for this socket."""
        with contextlib.suppress(OSError):  # the name goes first: as long as the socket answers, no other session takes its place
            if self._path is not None and os.path.samestat(os.lstat(self._path), self._status):
                os.unlink(self._path)
        self.socket.close()

    def _at_path(self, path):
        if not hasattr(socket, "AF_UNIX"):
            raise ServerError("This system has no Unix sockets. Choose a port, with --port.")
        folder = os.path.dirname(path) or "."
        _check(folder)
        unnamed = os.path.join(folder, f".{os.urandom(4).hex()}")  # short, since a name of a socket has room for 107 bytes
        found = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            with contextlib.suppress(OSError):  # Linux makes the name with this mode; others have to wait for the next lines
                os.fchmod(found.fileno(), 0o600)
            found.bind(unnamed)
            os.chmod(unnamed, 0o600)
            found.listen(WAITING)
            _give(unnamed, path)
            self._path, self._status = os.path.abspath(path), os.lstat(unnamed)
        except BaseException:
            found.close()
            raise
        finally:
            with contextlib.suppress(OSError):
                os.unlink(unnamed)
        return found


def _at_port(port):
    found = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind((HOST, port))
        found.listen(WAITING)
    except BaseException:
        found.close()
        raise
    return found


def _check(folder):
    """Refuse a folder in which other users could put a socket of theirs in the place of ours."""
    status = os.stat(folder)
    mode = status.st_mode
    if not owners.trusted(status) or owners.told() and mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
        raise ServerError(
            f"{folder} is a folder in which other users could replace the socket for Emacs. Choose one of your own, such as "
            f"{os.environ.get('XDG_RUNTIME_DIR') or '~'}, or type: chmod go-w {folder}"
        )


def _give(unnamed, path):
    """Give the socket ``unnamed`` the name ``path``, if that is free, or if a dead process has left it."""
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
    try:
        _lock(folder, path)
        with contextlib.suppress(FileExistsError):
            return os.link(unnamed, path, follow_symlinks=False)
        _remove_dead(path)
        os.link(unnamed, path, follow_symlinks=False)
    except FileExistsError:  # put there by a session that knows no lock
        raise _lives(path) from None
    finally:
        os.close(folder)


def _lock(folder, path):
    """Take the lock that sessions hold on the open ``folder`` while they look at ``path``. Raises `ServerError` if others keep it."""
    for _ in range(TRIES):
        try:
            return partial_names.lock(folder, wait=False)
        except BlockingIOError:
            select.select([], [], [], PATIENCE / TRIES)
    raise ServerError(f"Other sessions try to listen on {path} at the same time. Choose another place for this one.")


def _remove_dead(path):
    """Remove the socket ``path`` that a dead process has left. Raises `ServerError` if it is anything else."""
    try:
        status = os.lstat(path)
    except FileNotFoundError:
        return
    if not stat.S_ISSOCK(status.st_mode):
        raise ServerError(f"The server for Emacs cannot listen on {path}: there is something else of that name. Choose another one.")
    if not owners.mine(status):
        name = owners.name_of(status.st_uid) or status.st_uid
        raise ServerError(
            f"The server for Emacs cannot listen on {path}: a socket of another user, {name}, is there. Choose another place."
        )
    if not _refuses(path):
        raise _lives(path)
    with contextlib.suppress(FileNotFoundError):
        os.unlink(path)


def _refuses(path):
    """Whether nobody listens at the socket ``path``."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
        client.settimeout(PATIENCE)
        try:
            client.connect(path)
        except ConnectionRefusedError:
            return True
        except OSError:
            pass  # its queue is full, or it has gone, which the next try shows
    return False


def _lives(path):
    return ServerError(f"Another session listens on {path}. Connect to that one, end it, or choose another place for this one.")
