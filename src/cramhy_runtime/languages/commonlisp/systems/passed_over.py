"""A user's system that has the name of one of cramhy's: cramhy's is loaded, and a warning says where the other one is and how it is chosen.

Law: of a checkout of CRAM or of roslisp nothing is told. Cramhy's systems are there instead of those, and it has them all.
"""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import warn
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from cramhy_runtime.ros.search_folders import crawls
from cramhy_runtime.storage.dependency_tracing import is_library

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

OF_ROBOTS = ("actionlib", "cl-bullet", "cl-tf", "cl-transforms", "cl-urdf", "cl-utils", "cram-", "cffi-ros-utils", "roslisp")
"""How names of systems begin that are made for CRAM or ROS. Others are libraries of all Lisps, which a folder of these has, too."""
MANY = 5
"""A checkout with more of cramhy's systems than this is one of CRAM or of roslisp."""

_told: set[str] = per_image(set())


def warn_of_another(name: str, ours: str, contains: Callable[[str], bool]) -> None:
    """Warn, once, if a user has a system ``name`` on ROS_PACKAGE_PATH or in the workspace.

    ours: where the one is that is loaded. contains: whether cramhy contains a system of a name.
    """
    if name in _told or not name.startswith(OF_ROBOTS):
        return
    _told.add(name)
    theirs = next((path for root, path in _asd_files() if path.stem == name and not _is_originals(path, root, contains)), None)
    if theirs is not None:
        text = (
            "The system ~A is loaded from ~A, and not from ~A, which has the same name.~%"
            "To choose that one, load it first: (asdf:load-asd ~S)"
        )
        warn(text, name, ours, str(theirs), str(theirs))


def _asd_files() -> Iterator[tuple[Path, Path]]:
    """Each root of the search, and an ``.asd`` file below it that is not cramhy's own."""
    for crawl in crawls():
        for folders in (crawl.folders, crawl.insides):
            for folder in folders:
                if "roslisp_ignore" not in folder.entries:
                    for path in folder.files(".asd"):
                        if not is_library(str(path)):
                            yield crawl.root, path


def _is_originals(path: Path, root: Path, contains: Callable[[str], bool]) -> bool:
    """Whether ``path``, which was found below ``root``, is in a checkout of CRAM or roslisp."""
    home = _checkout(path, root)
    return len({other.stem for _, other in _asd_files() if home in other.parents and contains(other.stem)}) > MANY


def _checkout(path: Path, root: Path) -> Path:
    """The repository that ``path`` is in; without one, the folder in ``src`` of a workspace, or all below ``root``."""
    for folder in path.parents:
        if os.path.exists(folder / ".git") and folder != root.parent:
            return folder
        if folder == root:
            break
    return root / path.relative_to(root).parts[0] if root.name == "src" else root
