"""Where compiled code is kept: beside what it was made from, in ``__pycache__``, or in the user's cache folder.

The second place is for sources that this user cannot write beside, or where others could put files.
"""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

from .atomic_write import write_whole
from .checksummed_code import Unusable, distrust_of_folder


def kept_path(path):
    """Where the compiled form of ``path`` is kept: beside it if that is possible and safe. `OSError` if there is no place at all."""
    beside = _beside(path)
    folder = beside.parent
    there = os.path.lexists(folder)
    if os.access(folder if there else path.parent, os.W_OK) and not (there and distrust_of_folder(folder)):
        return beside
    base = os.environ.get("XDG_CACHE_HOME", "")
    base = base if os.path.isabs(base) else os.path.expanduser("~/.cache")
    if not os.path.isabs(base):
        raise FileNotFoundError(errno.ENOENT, "This user has no folder", base)
    from .digests import sha256  # a prompt that keeps its files elsewhere does without it

    digest = sha256(str(path).encode(errors="surrogatepass")).hexdigest()
    return Path(base, "cramhy") / f"{digest[:16]}-{beside.name}"


def _beside(path):
    return path.parent / "__pycache__" / f"{path.name}.{sys.implementation.cache_tag}.cramhy"


def kept_bytes(path, read):
    """What ``read(place)`` returns of the compiled form of ``path``. Errors: those of ``read``.

    The user's cache comes first. Where that has nothing that can be used, there may be something beside a source that this user cannot
    write beside: the wheel brings it along.
    """
    place, beside = kept_path(path), _beside(path)
    try:
        return read(place)
    except (Unusable, OSError):
        if place == beside:
            raise
        try:
            return read(beside)
        except (Unusable, OSError):
            pass
        raise


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
