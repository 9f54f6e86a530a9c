"""A sandbox for a process that runs what a student has handed in: limits of the system, no network, no other programs, no files of others.

Three locks, each as far as the system has it. `limits` are those of POSIX: processor time, memory, size of files. `system_calls` is a
filter of Linux (seccomp): no sockets, no new processes, no signals to others. `folders` are rules of Linux, too (Landlock): what may be
read, and the one folder where something may be written. None of them needs rights, and none of them can be opened again from inside.

Elsewhere (macOS, Windows, an old Linux) some locks are missing. `close` tells which ones hold, and ``docs/how-to/grading.md`` says what
that means.

Where the parts are: ``limits`` · ``system_calls``, ``call_numbers`` (seccomp) · ``folders`` (Landlock).
"""

from __future__ import annotations

from . import folders, limits, system_calls


def close(scratch, seconds, megabytes):
    """Put the calling process into the sandbox; the names of the locks that hold.

    scratch: the folder where it may write. seconds: of processor time. megabytes: of memory.
    """
    held = limits.set_limits(seconds, megabytes)
    held += ["files"] if folders.close(scratch) else []
    held += ["network", "processes", "signals"] if system_calls.close() else []
    return held
