"""Folders and files that belong together: all of them are made, or none is left."""

from __future__ import annotations

import os

from .partial_names import forget
from .atomic_write import write_whole


class Tree:
    """What is made in the body of a ``with``; left by an error or another jump, what was not there before is gone again."""

    def __init__(self):
        self._files, self._folders = [], []

    def __enter__(self):
        return self

    def folder(self, path):
        """Make the folder ``path`` and those above it that are missing. Errors: `OSError`."""
        path = os.fspath(path)
        missing = []
        while path and not os.path.isdir(path):
            missing.append(path)
            path = os.path.dirname(path.rstrip("/"))
        for each in reversed(missing):
            try:
                os.mkdir(each)
            except FileExistsError:
                if not os.path.isdir(each):
                    raise
            else:
                self._folders.append(each)

    def write(self, path, content, mode=None):
        """`write_whole`."""
        new = not os.path.lexists(path)
        write_whole(path, content, mode)
        if new:
            self._files.append(path)

    def __exit__(self, kind, problem, places):
        if kind is None:
            return
        forget(*self._files)
        for folder in reversed(self._folders):
            try:
                os.rmdir(folder)
            except OSError:
                pass  # somebody else has put something there
