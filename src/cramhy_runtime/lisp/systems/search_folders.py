"""Where packages and systems are looked for; with no Lisp, so that the ROS tools start quickly."""

from __future__ import annotations

import os
from pathlib import Path

extra_folders: list = []
"""Folders to look in besides the standard ones."""
SKIPPED = {"node_modules", "build", "devel", "venv", "site-packages", "tests"}
"""Names of folders that hold no sources of the user's."""


def search_folders():
    """The folders below which packages and systems are looked for, in order."""
    folders = [Path(entry) for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]
    folders += [Path(entry) for entry in extra_folders]
    here = Path.cwd()
    folders += [here, *(parent / "src" for parent in [here, *here.parents][:6] if (parent / "src").is_dir())]
    if here.name == "src":
        folders.append(here)
    root = Path(__file__).parents[4]
    folders += [root / "tutorials", Path(__file__).parents[2] / "tutorials"]
    return [folder for folder in dict.fromkeys(folders) if os.path.isdir(folder) and os.access(folder, os.R_OK | os.X_OK)]
