"""The secret that lets a client in: the first line of the file ``~/.slime-secret``, which SLIME sends by itself.

Loopback does not tell users of a machine apart, and what the kernel of Linux tells of a connection's owner comes too late for a client that
closes at once. So a client always has to show that it may read a file of this user's. Where the file is missing it is made, with 256
random bits. A file whose text others may know is refused: one that is empty, a link, somebody else's, or open to others.
"""

from __future__ import annotations

import os
import secrets
import stat

from cramhy_runtime import storage
from cramhy_runtime.storage import owners
from cramhy_runtime.storage.partial_names import CAREFULLY

from .errors import ServerError

PLACE = "~/.slime-secret"
LONGEST = 4096  # bytes
MADE_OF = 32  # random bytes


def current():
    """The secret of this user, bytes. It is made if there is none. Raises `ServerError`, whose text says which command mends it."""
    path = os.path.expanduser(PLACE)
    try:
        try:
            return _read(path)
        except FileNotFoundError:
            _make(path)
            return _read(path)
    except OSError as problem:
        raise ServerError(f"{PLACE}, the secret for Emacs, cannot be read: {storage.why(problem)}") from None


def _read(path):
    try:
        handle = os.open(path, os.O_RDONLY | CAREFULLY)
    except OSError:
        if os.path.islink(path):
            _refuse("is a link, and not a file of its own")
        raise
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            _refuse("is not a file", "rm -r")
        if not owners.mine(status):
            _refuse(f"belongs to another user, {owners.name_of(status.st_uid) or status.st_uid}", "rm -f")
        if owners.open_to_others(status):
            _refuse("may be read or written by other users, so it is not a secret any more")
        first = os.read(handle, LONGEST + 2).partition(b"\n")[0].rstrip(b"\r")
    finally:
        os.close(handle)
    if not first.strip():
        _refuse("is empty: its first line is the secret")
    if len(first) > LONGEST:
        _refuse(f"has a first line of more than {LONGEST} bytes")
    return first


def _refuse(what, command="rm"):
    raise ServerError(
        f"{PLACE}, the secret for Emacs, {what}. Type: {command} {PLACE}. Then start again: a new one is made, which SLIME reads by itself."
    )


def _make(path):
    """Make the file, unless another session makes it at the same moment."""
    folder = os.path.dirname(path)
    try:
        status = os.stat(folder)
        if not owners.trusted(status):
            raise ServerError(
                f"{PLACE}, the secret for Emacs, is not made in {folder}: that folder belongs to another user, "
                f"{owners.name_of(status.st_uid) or status.st_uid}. Set HOME to your own one."
            )
        storage.write_new(path, f"{secrets.token_hex(MADE_OF)}\n".encode(), 0o600)
    except FileExistsError:
        pass
    except OSError as problem:
        raise ServerError(
            f"{PLACE}, the secret for Emacs, cannot be made: {storage.why(problem)} "
            "Set HOME to a folder of yours, for Emacs and for this session."
        ) from None
