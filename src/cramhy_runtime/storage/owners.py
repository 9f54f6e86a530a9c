"""Whose file something is, and whether others may use it: what POSIX says by the numbers of users and by the bits of the mode.

Windows has neither, and a browser has one user. There a file counts as this user's own; what keeps others from it is the folder that it
is in. Source: stat(2), inode(7).
"""

from __future__ import annotations

import os

OTHERS = 0o077
"""The bits of a mode that let other users and groups do something."""


def told():
    """Whether the system tells whose a file is."""
    return hasattr(os, "getuid")


def number():
    """The number of this user; 0 where users have none."""
    return os.getuid() if told() else 0


def mine(status):
    """Whether a file, by what ``os.stat`` says of it, is this user's."""
    return not told() or status.st_uid == os.getuid()


def trusted(status):
    """Whether a file is this user's or root's."""
    return not told() or status.st_uid in (0, os.getuid())


def open_to_others(status):
    """Whether the mode of a file lets others than its owner read or write it."""
    return told() and bool(status.st_mode & OTHERS)


def name_of(number):
    """The name of the user with that number; ``None`` where the system has no names of users, or none for this number."""
    try:
        import pwd

        return pwd.getpwuid(number).pw_name
    except (ImportError, KeyError):
        return None
