"""Where compiled code is kept: beside what it was made from, in ``__pycache__``, or in the user's cache folder.

The second place is for cramhy's own sources, for those that this user cannot write beside, and for those beside which others could put
files. `drop_old` keeps it from growing for ever.
"""

from __future__ import annotations

import errno
import os
import sys
import zlib
from pathlib import Path

from .atomic_write import write_whole
from .checksummed_code import Unusable, distrust_of_folder

OLD = 180 * 24 * 3600
"""Seconds after which nobody misses a file in the user's cache folder."""


class _Own:
    """How the paths of cramhy's own sources begin."""

    folders: tuple[str, ...] = (os.path.dirname(os.path.dirname(os.path.abspath(__file__))) + os.sep,)


def kept_path(path):
    """Where the compiled form of ``path`` is kept. `OSError` if there is no place at all."""
    beside = _beside(path)
    if not str(path).startswith(_Own.folders):
        folder = beside.parent
        there = os.path.lexists(folder)
        if os.access(folder if there else path.parent, os.W_OK) and not (there and distrust_of_folder(folder)):
            return beside
    text = str(path).encode(errors="surrogatepass")
    return _cache() / f"{zlib.crc32(text):08x}{zlib.adler32(text):08x}-{beside.name}"  # a hash would have to be loaded


def keep_own_beside():
    """From now on keep the code of cramhy's own sources beside them, as it is shipped."""
    _Own.folders = ()


def _cache():
    """The folder of this user for what is kept nowhere else. Errors: `OSError`."""
    base = os.environ.get("XDG_CACHE_HOME", "")
    base = base if os.path.isabs(base) else os.path.expanduser("~/.cache")
    if not os.path.isabs(base):
        raise FileNotFoundError(errno.ENOENT, "This user has no folder", base)
    return Path(base, "cramhy")


def drop_old(suffix):
    """Remove files in the user's cache folder whose names end with ``suffix`` and that were written `OLD` seconds before the newest one."""
    try:
        files = [(entry.stat().st_mtime, entry.path) for entry in os.scandir(_cache()) if entry.name.endswith(suffix)]
        newest = max(files)[0] if files else 0
        for written, path in files:
            if written < newest - OLD:
                os.unlink(path)
    except OSError:
        pass  # another process was faster, or there is no such folder


def _beside(path):
    return path.parent / "__pycache__" / f"{path.name}.{sys.implementation.cache_tag}.cramhy"


def kept_bytes(path, read):
    """What ``read(place)`` returns of the compiled form of ``path``. Errors: those of ``read``.

    The user's cache comes first. Where that has nothing that can be used, there may be something beside the source: the wheel brings it
    along.
    """
    place, beside = kept_path(path), _beside(path)
    try:
        return read(place)
    except (Unusable, OSError) as problem:
        if place == beside:
            raise
        try:
            return read(beside)
        except (Unusable, OSError) as other:
            raise other if getattr(problem, "kind", "") == "missing" else problem from None


def keep(path, make):
    """Keep the bytes that ``make()`` returns as the compiled form of ``path``, unless Python shall write none, or cannot."""
    if sys.dont_write_bytecode:
        return
    try:
        target = kept_path(path)
        if not target.parent.is_dir():
            os.makedirs(target.parent.parent, mode=0o755, exist_ok=True)
            os.mkdir(target.parent, 0o755)  # others must not be able to write there, whatever the umask is
        if not distrust_of_folder(target.parent):
            # without waiting for the disk: the checksum shows what a breakdown left
            write_whole(target, make(), mode=0o644, durable=False, follow=False)
    except OSError:
        pass  # a folder that cannot be written only means compiling again next time
