"""Calls of Linux that Python does not have in all versions, by ctypes. Each raises `OSError`. Source: their manual pages, section 2."""

from __future__ import annotations

import ctypes
import functools
import os

NEW_MOUNT, NEW_UTS, NEW_IPC, NEW_USER, NEW_PID, NEW_NET = (1 << bit for bit in (17, 26, 27, 28, 29, 30))
NO_NEW_PRIVILEGES, PARENT_DEATH_SIGNAL, SUBREAPER, DROP_BOUND, AMBIENT, CLEAR_AMBIENT = 38, 1, 36, 24, 47, 4
_VERSION_3 = 0x20080522


@functools.cache
def library() -> ctypes.CDLL:
    """The C library. Raises `OSError` if there is none to load."""
    return ctypes.CDLL(None, use_errno=True)


def call(name: str, *words: object) -> int:
    """What a function of the C library returns. Raises `OSError` for a negative number, and if it has no such function."""
    try:
        function = getattr(library(), name)
    except AttributeError:
        raise OSError(f"The C library has no {name}.")
    found = function(*words)
    if found < 0:
        number = ctypes.get_errno()
        raise OSError(number, f"{name}: {os.strerror(number)}")
    return found


def prctl(option: int, value: int = 0) -> None:
    """Call prctl with one value."""
    call("prctl", option, ctypes.c_ulong(value), ctypes.c_ulong(0), ctypes.c_ulong(0), ctypes.c_ulong(0))


def mount_tmpfs(place: str, options: str) -> None:
    """Mount a tmpfs without device files and programs. options: such as "size=32m,nr_inodes=2000"."""
    call("mount", b"tmpfs", os.fsencode(place), b"tmpfs", ctypes.c_ulong(2 | 4 | 8), options.encode())


def drop_rights() -> None:
    """Give up all capabilities for good: those that the process has, and those that a program could give it."""
    prctl(NO_NEW_PRIVILEGES, 1)
    for number in range(64):
        try:
            prctl(DROP_BOUND, number)
        except OSError:  # the kernel has no more of them; or this user has none, and cannot get one
            break
    call("prctl", AMBIENT, ctypes.c_ulong(CLEAR_AMBIENT), ctypes.c_ulong(0), ctypes.c_ulong(0), ctypes.c_ulong(0))
    call("capset", (ctypes.c_uint32 * 2)(_VERSION_3, 0), (ctypes.c_uint32 * 6)())
