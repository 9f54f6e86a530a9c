"""Folders that a submission has filled, where it had no disk of its own: counted, and removed whatever it did.

A program can make folders that their owner may not read, thousands of folders in each other, names that together are longer than a path
may be, and links to anywhere. So nothing here follows a link, uses a long path or calls itself.
"""

from __future__ import annotations

import contextlib
import os
import stat

_FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)


DEEPEST = 50
"""So many folders may be in each other; a look at thousands of them would take longer than the time between two looks."""


def is_over(folder: str, most_bytes: int, most_files: int) -> bool:
    """Whether a folder has more bytes or more entries than that. What cannot be looked into or is too deep counts as more."""
    total = count = 0
    waiting = [(folder, 0)]
    while waiting:
        path, depth = waiting.pop()
        if depth > DEEPEST:
            return True
        try:
            with os.scandir(path) as entries:
                for entry in entries:
                    count += 1
                    if count > most_files:
                        return True
                    with contextlib.suppress(FileNotFoundError):
                        if entry.is_dir(follow_symlinks=False):
                            waiting.append((entry.path, depth + 1))
                        else:
                            total += entry.stat(follow_symlinks=False).st_size
                if total > most_bytes:
                    return True
        except FileNotFoundError:  # it has just been removed
            continue
        except OSError:
            return True
    return False


def remove(folder: str) -> None:
    """Remove a folder with all that is in it, if it is there. One folder is open at a time, and no path has more than one name."""
    try:
        here = os.open(folder, _FOLDER)
    except FileNotFoundError:
        return
    except PermissionError:
        os.chmod(folder, 0o700)
        here = os.open(folder, _FOLDER)
    left = [_emptied(here)]
    names: list[str] = []
    try:
        while left:
            if left[-1]:
                names.append(left[-1].pop())
                os.chmod(names[-1], 0o700, dir_fd=here)
                here = _instead(here, names[-1])
                left.append(_emptied(here))
            else:
                left.pop()
                if left:
                    here = _instead(here, os.pardir)
                    os.rmdir(names.pop(), dir_fd=here)
    finally:
        os.close(here)
    os.rmdir(folder)


def _instead(here: int, name: str) -> int:
    """Open a folder in or above the open folder ``here``, which is closed."""
    other = os.open(name, _FOLDER, dir_fd=here)
    os.close(here)
    return other


def _emptied(folder: int) -> list[str]:
    """Remove what is in an open folder but the folders; the names of these."""
    os.fchmod(folder, 0o700)
    names = []
    for name in os.listdir(folder):
        if stat.S_ISDIR(os.lstat(name, dir_fd=folder).st_mode):
            names.append(name)
        else:
            os.unlink(name, dir_fd=folder)
    return names
