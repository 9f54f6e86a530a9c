"""The folders to search for packages and systems. The module needs no Lisp, so the ROS tools start quickly.

A search may reach folders of others: a shared ``/opt``, another user's home, a link into either. The search leaves out all that
the user may not read: for `entries`, `is_folder` and `is_file`, it does not exist. `pathlib` and `os.DirEntry` raise the
system's error instead.
"""

from __future__ import annotations

import os
from pathlib import Path
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    pass


extra_folders: list[str | Path] = per_image([])
"""Folders to search besides the standard ones."""
SKIPPED = {"node_modules", "build", "devel", "venv", "site-packages", "tests"}
"""Names of folders without the user's own sources."""


def search_folders() -> list[Path]:
    """The folders to search for packages and systems, with their sub-folders, in order."""
    folders = [Path(entry) for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]
    folders += [Path(entry) for entry in extra_folders]
    here = Path.cwd()
    folders += [here, *(parent / "src" for parent in [here, *here.parents][:6] if os.path.isdir(parent / "src"))]
    if here.name == "src":
        folders.append(here)
    root = Path(__file__).parents[3]
    folders += [root / "tutorials", Path(__file__).parents[1] / "tutorials"]
    return [folder for folder in dict.fromkeys(folders) if os.path.isdir(folder) and os.access(folder, os.R_OK | os.X_OK)]


def entries(folder: str | Path) -> list[os.DirEntry[str]]:
    """The entries of ``folder``, as `os.DirEntry`, sorted by name; an empty list if it cannot be read."""
    try:
        return sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return []


def is_folder(entry: os.DirEntry[str]) -> bool:
    """Whether an `os.DirEntry` is a folder, or a link to one, that the user may read."""
    try:
        return entry.is_dir()
    except OSError:  # a link into a folder that one may not enter, a circle of links, a file system that is gone
        return False


def is_file(entry: os.DirEntry[str]) -> bool:
    """Whether an `os.DirEntry` is a file, or a link to one, that the user may read."""
    try:
        return entry.is_file()
    except OSError:
        return False
