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
    """Remove a folder with all that is in it. The folders in it are moved up to its top first, so no path gets long."""
    try:
        top = os.open(folder, _FOLDER)
    except FileNotFoundError:
        return
    try:
        number = 0
        os.fchmod(top, 0o700)
        while names := os.listdir(top):
            for name in names:
                number = _remove_one(top, name, number)
    finally:
        os.close(top)
    os.rmdir(folder)


def _remove_one(top: int, name: str, number: int) -> int:
    """Remove an entry of the folder ``top``; the folders in it become entries of ``top``. The next free number for their names."""
    if not stat.S_ISDIR(os.lstat(name, dir_fd=top).st_mode):
        os.unlink(name, dir_fd=top)
        return number
    os.chmod(name, 0o700, dir_fd=top)
    inside = os.open(name, _FOLDER, dir_fd=top)
    try:
        for each in os.listdir(inside):
            if stat.S_ISDIR(os.lstat(each, dir_fd=inside).st_mode):
                os.chmod(each, 0o700, dir_fd=inside)  # a folder that cannot be written cannot be moved
                while True:
                    number += 1
                    with contextlib.suppress(FileExistsError):
                        _move(each, inside, f".moved-{number}", top)
                        break
            else:
                os.unlink(each, dir_fd=inside)
    finally:
        os.close(inside)
    os.rmdir(name, dir_fd=top)
    return number


def _move(name: str, source: int, new: str, target: int) -> None:
    """Move a folder to a name that nothing has. Raises `FileExistsError`."""
    with contextlib.suppress(FileNotFoundError):
        os.lstat(new, dir_fd=target)
        raise FileExistsError(new)
    os.rename(name, new, src_dir_fd=source, dst_dir_fd=target)
