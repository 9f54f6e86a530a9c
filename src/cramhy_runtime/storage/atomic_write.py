"""Writing the whole of a file, or nothing of it."""

from __future__ import annotations

import os
from contextlib import contextmanager

from .leftovers import tidy_once
from .partial_files import Part


def write_whole(path, content, mode=None, durable=True, follow=True):
    """Make ``content`` the whole of the file ``path``; if that fails, the file is as it was.

    content: bytes, or a text, which is written in UTF-8. mode: the permissions of the file, less the umask; without it those of the file
    that is replaced, or the usual ones. durable: whether to wait until the disk has it. follow: whether a link is followed; without, the
    link itself is replaced, which somebody may have planted. Errors: `OSError` with ``path`` as ``filename``; `reasons.why` explains it.
    """
    data = content.encode("utf-8") if isinstance(content, str) else content
    with writing(path, mode, durable, follow) as file:
        file.write(data)


def write_new(path, content, mode):
    """Make a new file ``path`` with the bytes ``content``, all at once. `FileExistsError` if something has that name, also a link.

    Of several processes that do so at the same moment one succeeds, and the others find its file complete. mode: see `write_whole`.
    """
    part = Part(path, mode, follow=False)
    try:
        part.file.write(content)
    except BaseException:
        part.discard()
        raise
    part.finish(replace=False)


@contextmanager
def writing(path, mode=None, durable=True, follow=True):
    """A binary file to write to, which becomes the file ``path`` when the body ends without an error. Arguments: those of `write_whole`."""
    tidy_once(os.path.dirname(os.path.realpath(path) if follow else os.path.abspath(path)))
    part = Part(path, mode, follow=follow)
    try:
        yield part.file
    except OSError as problem:
        part.discard()
        if problem.filename is None:  # the disk's; others have a file of their own
            problem.filename = part.path
        raise
    except BaseException:
        part.discard()
        raise
    part.finish(durable)
