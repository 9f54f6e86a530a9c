"""The folders to search for packages and systems, and the crawl below them. The module needs no Lisp, so the ROS tools start quickly.

The crawl below an entry of ``ROS_PACKAGE_PATH`` is that of rospack 2.6: to any depth, through symbolic links, but not into folders whose
name begins with a dot, not below a package (a folder with a ``package.xml`` or a ``manifest.xml``), not into a folder with a file
``CATKIN_IGNORE``, and not below one with a file ``rospack_nosubdirs``. rospack follows a circle of links until the system stops it; here
each folder is visited once, and a folder itself goes before a link to it. Below the other folders, such as the current one, which may be
anywhere, the crawl is not deep (`_DEPTH`), and folders without the user's own sources are left out (`SKIPPED`).

rospack keeps what it found in a file for 60 seconds. Here it is kept only `crawling_once` a system, whose parts are looked for many times:
a package that is made while the prompt waits is found at once.

A search may reach folders of others: a shared ``/opt``, another user's home, a link into either. The search leaves out all that
the user may not read: for `entries`, `is_folder` and `is_file`, it does not exist. `pathlib` and `os.DirEntry` raise the
system's error instead.
"""

from __future__ import annotations

import os
from contextlib import contextmanager
from pathlib import Path
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    Waiting = tuple[str, str | None, int]  # a folder's path, its real path if that is known, and how deep to go below it


extra_folders: list[str | Path] = per_image([])
"""Folders to search besides the standard ones."""
SKIPPED = {"node_modules", "build", "devel", "venv", "site-packages", "tests"}
"""Names of folders without the user's own sources."""
_DEPTH = 4
"""How many folders deep the search goes below a folder that is not on ``ROS_PACKAGE_PATH``: ``src/a_stack/a_package/a_folder``."""
_ANY_DEPTH = 1000
"""What rospack calls too deep."""
_kept: list[dict[Path, Crawl]] = per_image([])


def on_package_path() -> list[Path]:
    """The folders that the variable ``ROS_PACKAGE_PATH`` names, in order."""
    folders = [Path(os.path.expanduser(entry)) for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]
    return [folder for folder in dict.fromkeys(folders) if _may_be_read(folder)]


def search_folders() -> list[Path]:
    """The folders to search for packages and systems, with their sub-folders, in order."""
    folders = [*on_package_path(), *(Path(entry) for entry in extra_folders)]
    here = Path.cwd()
    folders += [here, *(parent / "src" for parent in [here, *here.parents][:6] if os.path.isdir(parent / "src"))]
    if here.name == "src":
        folders.append(here)
    root = Path(__file__).parents[3]
    folders += [root / "tutorials", Path(__file__).parents[1] / "tutorials"]
    return [folder for folder in dict.fromkeys(folders) if _may_be_read(folder)]


def _may_be_read(folder: Path) -> bool:
    return os.path.isdir(folder) and os.access(folder, os.R_OK | os.X_OK)


# --------------------------------------------------------------------------------------------------------------- the crawl


class Folder:
    """A folder that a crawl visits.

    ``path``: its path, a string. ``entries``: what is in it, as `os.DirEntry` by name. ``manifest``: its ``package.xml`` or
    ``manifest.xml``, or ``None`` if it is not a package. ``within``: whether it is part of a package that was visited before.
    """

    __slots__ = ("path", "entries", "manifest", "within")

    def __init__(self, path: str, found: dict[str, os.DirEntry[str]], manifest: os.DirEntry[str] | None, within: bool):
        self.path, self.entries, self.manifest, self.within = path, found, manifest, within

    def files(self, ending: str) -> Iterator[Path]:
        """Yield the paths of the files in this folder whose names end in ``ending``."""
        for name, entry in self.entries.items():
            if name.endswith(ending) and is_file(entry):
                yield Path(entry.path)


class _Memory:
    """What an iterator gives, for several readers. Nothing is taken from the iterator before a reader asks for it."""

    __slots__ = ("_source", "_taken")

    def __init__(self, source: Iterator[Folder]):
        self._source, self._taken = source, list[Folder]()

    def __iter__(self) -> Iterator[Folder]:
        number = 0
        while True:
            while number < len(self._taken):
                yield self._taken[number]
                number += 1
            try:
                self._taken.append(next(self._source))
            except StopIteration:
                return


class Crawl:
    """What is below the folder ``root``, as `Folder` objects; nothing is looked at before it is asked for.

    ``whole``: whether ``root`` is crawled as rospack does it; else not deep. ``folders``: those that rospack visits. ``insides``: the
    folders inside of packages.
    """

    def __init__(self, root: Path, whole: bool):
        self.root = root
        self._whole = whole
        self._visited: set[str] = set()
        self._packages: list[tuple[Folder, str, int]] = []
        top: Waiting = (str(root), os.path.realpath(root), _ANY_DEPTH if whole else _DEPTH)
        self.folders = _Memory(self._visit([top], False))
        self.insides = _Memory(self._inside_of_packages())

    def _inside_of_packages(self) -> Iterator[Folder]:
        for _ in self.folders:
            pass
        for package in self._packages:
            yield from self._visit(self._sub_folders(*package, []), True)

    def _visit(self, waiting: list[Waiting], within: bool) -> Iterator[Folder]:
        """Yield the folders that are ``waiting`` (each as path, real path, depth), and those below them; links to folders last."""
        links: list[Waiting] = []
        while waiting or links:
            path, real, depth = waiting.pop() if waiting else links.pop(0)
            if real is None:
                real = os.path.realpath(path)
            if real in self._visited:
                continue
            self._visited.add(real)
            found = {entry.name: entry for entry in entries(path)}
            if "CATKIN_IGNORE" in found and is_file(found["CATKIN_IGNORE"]):
                continue
            manifest = found.get("package.xml") or found.get("manifest.xml")
            folder = Folder(path, found, manifest, within)
            yield folder
            if "rospack_nosubdirs" in found:
                continue
            if manifest is not None and not within:
                self._packages.append((folder, real, depth))
            else:
                waiting += self._sub_folders(folder, real, depth, links)

    def _sub_folders(self, folder: Folder, real: str, depth: int, links: list[Waiting]) -> list[Waiting]:
        """The folders in ``folder``, the first one last; what is a link joins ``links``."""
        if not depth:
            return []
        leave_out = SKIPPED if folder.within or folder.manifest is not None or not self._whole else ()
        found: list[Waiting] = []
        for name, entry in folder.entries.items():
            if name[0] == "." or name.startswith("__") or name in leave_out or not is_folder(entry):
                continue
            if _is_link(entry):
                links.append((entry.path, None, depth - 1))
            else:
                found.append((entry.path, os.path.join(real, name), depth - 1))
        return found[::-1]


def crawls(on_path_only: bool = False) -> Iterator[Crawl]:
    """Yield the `Crawl` of each folder of the search, in its order. ``on_path_only``: of the entries of ``ROS_PACKAGE_PATH``."""
    whole = {*on_package_path(), *map(Path, extra_folders)}
    known = _kept[-1] if _kept else {}
    for root in on_package_path() if on_path_only else search_folders():
        if root not in known:
            known[root] = Crawl(root, root in whole)
        yield known[root]


def crawl() -> Iterator[Folder]:
    """Yield the folders that rospack visits, below all folders of the search."""
    for each in crawls():
        yield from each.folders


@contextmanager
def crawling_once() -> Iterator[None]:
    """While the block runs, each folder is crawled once."""
    if _kept:
        yield
        return
    _kept.append({})
    try:
        yield
    finally:
        _kept.clear()


def look_again() -> bool:
    """Forget what is kept `crawling_once`, because something was not found; whether anything was kept."""
    known = bool(_kept and _kept[-1])
    if known:
        _kept[-1].clear()
    return known


# ------------------------------------------------------------------------------------------------------------- one folder


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


def _is_link(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_symlink()
    except OSError:
        return True
