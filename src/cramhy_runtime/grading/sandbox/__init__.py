"""A sandbox for a process that runs what a student has handed in: no files of others, no network, no other programs, limits.

Where `bubblewrap` is installed and works, the process joins a sandbox of it: name spaces of its own, and a disk in memory. Elsewhere the
process locks itself up: `folders` are rules of Linux for files (Landlock). In both cases come `limits`, those of POSIX (processor time,
memory, size of files), and `system_calls`, a filter of Linux (seccomp): no new processes, no sockets, no signals to others. The process
gives up its capabilities (`linux`). None of this needs rights, and none of it can be undone from inside.

Elsewhere (macOS, an old Linux) some locks are missing. `close` tells which ones hold, and ``docs/how-to/grading.md`` says what that means.

Where the parts are: ``bubblewrap`` · ``limits`` · ``system_calls``, ``call_numbers`` (seccomp) · ``folders`` (what may be read, Landlock) ·
``removal`` (folders without bubblewrap) · ``linux`` (calls that Python does not have).
"""

from __future__ import annotations

from . import folders, limits, linux, system_calls


def close(scratch: str, seconds: int, megabytes: int, joined: bool, hidden: list[str]) -> list[str]:
    """Lock the calling process up; the names of the locks that hold.

    scratch: the folder where it may write. seconds: of processor time. megabytes: of memory. joined: whether it is in a sandbox of
    bubblewrap's. hidden: folders that it must not read.
    """
    held = limits.set_limits(seconds, megabytes)
    if joined:
        held += ["bubblewrap", "files", "network", "signals"]
    elif folders.close(scratch, hidden):
        held.append("files")
    try:
        linux.drop_rights()
    except OSError:  # not Linux
        pass
    if system_calls.close():
        held += [name for name in ("network", "processes", "signals") if name not in held]
    return held
