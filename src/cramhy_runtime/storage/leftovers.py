"""What processes that were killed left unfinished: removed, or recovered if it can be read as it is.

A file that was to be written in one go is of no use, and is removed. A recording can be read as far as it goes, so it gets a name beside
the file that it was to replace: ``x.mcap`` is recovered as ``x.recovered.mcap``. Files that belong to other users are left alone, and so
are those that a living process holds the lock of.
"""

from __future__ import annotations

import os
import stat

from . import owners
from .partial_names import CAREFULLY, RECORDING, fcntl, free_name, lock, parsed, same_file

_tidied = set()


def tidy_once(folder):
    """`tidy`, the first time that this process writes into ``folder``; recordings stay for the next start, which tells of them."""
    if folder not in _tidied:
        _tidied.add(folder)
        tidy(folder, recordings=False)


def tidy(folder, recordings=True):
    """Remove what dead processes left unfinished in ``folder``, and recover their recordings. Returns the recordings' new names.

    recordings: whether these are looked at, too; somebody has to tell the user where they are now.
    """
    recovered = []
    try:
        with os.scandir(folder or ".") as entries:
            found = sorted((entry.path, *parts) for entry in entries if (parts := parsed(entry.name)))
    except OSError:
        return []  # a folder that cannot be looked at holds nothing that could be tidied
    for path, name, ending in found:
        if ending == RECORDING and not recordings:
            continue
        try:
            kept = _dealt_with(path, os.path.join(folder, name) if ending == RECORDING else None)
        except OSError:
            continue  # somebody holds it, or has removed it, or it may not be touched
        if kept:
            recovered.append(kept)
    return recovered


def _dealt_with(path, recording):
    """Remove the file, or recover it as ``recording`` if that is a name, unless somebody holds it; the new name if there is one."""
    handle = os.open(path, os.O_RDWR | CAREFULLY)
    try:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode) or not owners.mine(status):
            return None
        if fcntl is None:  # what is open cannot be removed, by us neither
            os.close(handle)
            handle = None
        elif not lock(handle, wait=False) or not same_file(handle, path):
            return None
        if recording and status.st_size:
            kept = free_name(recording)
            os.rename(path, kept)
            return kept
        os.unlink(path)
        return None
    finally:
        if handle is not None:
            os.close(handle)
