"""A disk that fails once, at the n-th call: `open`, `write`, `fsync`, `close`, `rename` and their relatives."""

from __future__ import annotations

import errno
import os
from contextlib import contextmanager
from io import FileIO

from cramhy_runtime.storage import partial_files

ERRORS = (errno.ENOSPC, errno.EDQUOT, errno.EIO)
CALLS = ("open", "replace", "rename", "link", "mkdir", "fsync", "fchmod")


class Disk:
    """Counts the calls that touch files below ``folder``; the one with the number ``fails`` fails. ``called``: the names of all.

    It counts, and fails, in the body of ``with disk:`` only.
    """

    def __init__(self, folder, fails, number):
        self.folder, self.fails, self.number = str(folder), fails, number
        self.called = []
        self.counts = False

    def __enter__(self):
        self.counts = True

    def __exit__(self, *_):
        self.counts = False

    @property
    def fired(self):
        return len(self.called) >= self.fails

    def count(self, name, path=None):
        if not self.counts:
            return
        self.called.append(name)
        if len(self.called) == self.fails:
            raise OSError(self.number, os.strerror(self.number), path)

    def concerns(self, thing):
        return isinstance(thing, int) or os.fspath(thing).startswith(self.folder)


@contextmanager
def failing(folder, fails, monkeypatch):
    """A `Disk` below ``folder`` whose call number ``fails`` fails; the reason changes with the number."""
    disk = Disk(folder, fails, ERRORS[fails % len(ERRORS)])

    class Failing(FileIO):
        def write(self, data):
            try:
                disk.count("write")
            except OSError:
                super().write(bytes(data)[: len(data) // 2])  # a disk that is full takes a part
                raise
            return super().write(data)

        def close(self):
            open_before = not self.closed
            super().close()
            if open_before:
                disk.count("close")

    def guarded(name, original):
        def call(*arguments, **options):
            if arguments and disk.concerns(arguments[0]):
                disk.count(name, None if isinstance(arguments[0], int) else arguments[0])
            return original(*arguments, **options)

        return call

    with monkeypatch.context() as patch:
        patch.setattr(partial_files, "FileIO", Failing)
        for name in CALLS:
            if hasattr(os, name):
                patch.setattr(os, name, guarded(name, getattr(os, name)))
        yield disk


def each_failure(folder, monkeypatch, limit=200):
    """Yields a `Disk` for each call that can fail, until there was none left; the body of the loop runs with it."""
    for number in range(1, limit):
        with failing(folder, number, monkeypatch) as disk:
            yield disk
        if not disk.fired:
            assert number > 1, "nothing was written at all"
            return
    raise AssertionError("it never came to an end")
