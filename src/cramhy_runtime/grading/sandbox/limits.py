"""The limits of POSIX for one process: processor time, memory, the size of a file, the number of open files."""

from __future__ import annotations

MEGABYTE = 1024 * 1024
FOR_STACKS = 64 * 64
"""Megabytes of addresses beside the memory: each task of a plan has a stack, which takes 64 of them and hardly any memory. So that limit is
a wide one, and the fork server looks at the memory that is really used."""
LARGEST_FILE = 4 * MEGABYTE
OPEN_FILES = 64


def set_limits(seconds, megabytes):
    """Limit the calling process; the names of the limits that hold. seconds: of processor time. megabytes: of memory."""
    try:
        import resource
    except ImportError:  # Windows, a browser
        return []
    held = []
    for name, limit, value in (
        ("time", "RLIMIT_CPU", seconds),
        ("memory", "RLIMIT_AS", (megabytes + FOR_STACKS) * MEGABYTE),
        ("file size", "RLIMIT_FSIZE", LARGEST_FILE),
        ("open files", "RLIMIT_NOFILE", OPEN_FILES),
        ("core", "RLIMIT_CORE", 0),
    ):
        try:
            resource.setrlimit(getattr(resource, limit), (value, value + (name == "time")))
            held.append(name)
        except (AttributeError, ValueError, OSError):  # this system has none of the name, or does not take the number
            continue
    return held
