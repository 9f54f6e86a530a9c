"""Code that is kept in a file: who wrote it and whether it is undamaged is known before anybody reads it.

``marshal`` believes every byte that it is given, and what it gives is run. So a file is used only if it belongs to this user or to root,
others may not write to it or to its folder, it is not a symbolic link, and its SHA-256 checksum is right. The checksum finds damage; it is
not a signature, and against other users the owner protects.

The file: a first line that says what it is, 32 bytes of checksum, 64 characters of label (what the code was made from), the content.
"""

from __future__ import annotations

import os
import stat

from . import owners
from .partial_names import CAREFULLY, NO_LINKS

LABEL = 64


class Unusable(Exception):
    """Why the file is not used. ``kind``: ``"missing"``, ``"unreadable"``, ``"distrusted"``, ``"foreign"`` (another kind of file, or of
    another version of cramhy), ``"damaged"``, or ``"outdated"`` (the label is another one)."""

    def __init__(self, kind, why):
        super().__init__(why)
        self.kind = kind


def _digest(data):
    from .digests import sha256  # a prompt that loads nothing does without it

    return sha256(data).digest()


def sealed(line, label, content):
    """The bytes of a file. line: bytes with a newline. label: a text of 64 ASCII characters. content: bytes."""
    body = label.encode("ascii") + content
    return line + _digest(body) + body


def unsealed(path, line, label, in_folder=True):
    """The content of the file ``path``. in_folder: whether its folder must be safe, too. Errors: `Unusable`."""
    data = trusted_bytes(path, in_folder)
    start = len(line)
    if not data.startswith(line):
        raise Unusable("foreign", f"{path} is not a file of code, or one of another version of cramhy")
    if len(data) < start + 32 + LABEL or _digest(data[start + 32 :]) != data[start : start + 32]:
        raise Unusable("damaged", f"{path} is damaged")
    if data[start + 32 : start + 32 + LABEL] != label.encode("ascii"):
        raise Unusable("outdated", f"{path} was made from something else, or by another version of cramhy or Python")
    return data[start + 32 + LABEL :]


def trusted_bytes(path, in_folder=True, mapped=False):
    """What is in the file ``path``, which only this user or root can have written. in_folder: as for `unsealed`. Errors: `Unusable`.

    mapped: as an ``mmap``, where the system lets a file be replaced meanwhile. Only what is looked at is read then. It is for files that
    are replaced as a whole, as `kept_files` does it: a map breaks when its file is cut off.
    """
    path = os.fspath(path)
    if mapped and os.name == "posix":
        from mmap import ACCESS_READ, mmap  # before the file is open: to load it needs one more, and a process may have few
    try:
        if in_folder:
            folder = os.path.dirname(path)
            complaint = distrust_of_folder(folder)
            if complaint:
                raise Unusable("distrusted", complaint)
        handle = os.open(path, os.O_RDONLY | (CAREFULLY if in_folder else CAREFULLY & ~NO_LINKS))
        with open(handle, "rb") as file:
            status = os.fstat(handle)
            if not stat.S_ISREG(status.st_mode):
                raise Unusable("distrusted", f"{path} is not a file")
            complaint = _distrust(status, path)
            if complaint:
                raise Unusable("distrusted", complaint)
            if mapped and os.name == "posix" and status.st_size:
                return mmap(handle, 0, access=ACCESS_READ)
            return file.read()
    except FileNotFoundError:
        raise Unusable("missing", f"{path} does not exist") from None
    except OSError as problem:
        raise Unusable("unreadable", f"{path} cannot be read: {problem.strerror}") from None


def _distrust(status, path):
    """Why others may have written this; "" if they cannot have."""
    if not owners.trusted(status):
        return f"{path} belongs to another user ({_user(status.st_uid)})"
    if owners.told() and status.st_mode & stat.S_IWOTH:
        return f"{path} can be written to by everybody"
    return ""


def distrust_of_folder(folder):
    """Why others may have put files into ``folder``; "" if they cannot have. Errors: `OSError` when it cannot be looked at."""
    link = os.lstat(folder)
    if stat.S_ISLNK(link.st_mode) and not owners.trusted(link):
        return f"{folder} is a link that belongs to another user ({_user(link.st_uid)})"
    return _distrust(os.stat(folder), folder)


def _user(number):
    return owners.name_of(number) or f"number {number}"
