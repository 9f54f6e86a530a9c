"""How unfinished files are recognised: by their names, and by the locks that the processes that write them hold on them."""

from __future__ import annotations

import os
import re

try:
    import fcntl
except ImportError:  # Windows, where a file that is open cannot be removed
    fcntl = None

PART, RECORDING = ".cramhy-part", ".cramhy-recording"
_NAME = re.compile(rf"\.(.+)\.[0-9a-f]{{16}}({re.escape(PART)}|{re.escape(RECORDING)})", re.S)
_LONGEST = {PART: 40, RECORDING: 200}
"""Bytes of a file's name that the name of its part repeats: a name has room for 255."""
BINARY = getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_NOINHERIT", 0)
NO_LINKS = getattr(os, "O_NOFOLLOW", 0)
CAREFULLY = NO_LINKS | getattr(os, "O_NONBLOCK", 0) | BINARY
"""For a file that others may have put there: no link is followed, no pipe is waited for."""


def part_name(path, ending):
    """A name for an unfinished file ``path``, beside it, that nobody can foretell."""
    folder, name = os.path.split(path)
    name = os.fsdecode(os.fsencode(name)[: _LONGEST[ending]])
    return os.path.join(folder, f".{name}.{os.urandom(8).hex()}{ending}")


def parsed(name):
    """(the name of the file that was to be, ending) of the name of an unfinished file; ``None`` of another name."""
    match = _NAME.fullmatch(name)
    return match and match.groups()


def free_name(path):
    """A name beside ``path`` that no file has: ``x.recovered.mcap`` for ``x.mcap``, ``x.recovered-2.mcap``, and so on."""
    folder, name = os.path.split(path)
    stem, ending = os.path.splitext(name)
    number = 1
    while True:
        more = ".recovered" if number == 1 else f".recovered-{number}"
        found = os.path.join(folder, os.fsdecode(os.fsencode(stem)[: _LONGEST[RECORDING]]) + more + ending)
        if not os.path.lexists(found):
            return found
        number += 1


def forget(*names):
    """Remove files that nobody wants, as far as that is possible; ``None`` among the names stands for no file."""
    for name in names:
        if name is not None:
            try:
                os.unlink(name)
            except OSError:
                pass  # somebody else removed it, or the next start does


def lock(handle, wait=True):
    """Take the lock that shows that this process lives; whether the file system has such locks. `BlockingIOError` without ``wait``."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        raise
    except OSError:
        return False
    return True


def is_being_written(name):
    """Whether a living process holds the lock on the file ``name``."""
    try:
        handle = os.open(name, os.O_RDWR | CAREFULLY)
    except OSError:
        return False
    try:
        lock(handle, wait=False)
    except BlockingIOError:
        return True
    finally:
        os.close(handle)
    return False


def same_file(handle, name):
    """Whether the open file is the one that has the name."""
    try:
        return os.path.samestat(os.fstat(handle), os.lstat(name))
    except FileNotFoundError:
        return False
