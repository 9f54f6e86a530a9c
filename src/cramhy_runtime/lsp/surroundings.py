"""What surrounds a text: the system that it is a file of, and the image in which it is compiled.

A file of a system is compiled after the systems that it depends on and the files before it. What comes with cramhy is loaded. Files of the
user are only checked (`text_checking`): their macros, packages and definitions take effect, and nothing else of them runs. An image is kept
until one of its files changes, and a copy of it, which takes milliseconds, is made for each check.
"""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import PACKAGE
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.loader import decoded
from cramhy_runtime.languages.commonlisp.systems.system_definitions import System
from cramhy_runtime.languages.commonlisp.systems.text_checking import check_text
from cramhy_runtime.session.image import Image
from cramhy_runtime.session.session import Session

FOLDERS_UP = 4
MOST_KEPT = 40
"""So many images are kept for systems and their files."""


class Surroundings:
    """Makes the images in which texts are checked.

    Three kinds are kept: one for each folder of systems, in which its ``.asd`` files have been read, one for each system, in which what it
    depends on is there, and one for each of its files, in which the files before it have been checked. Each is a copy of the one before.
    """

    def __init__(self):
        self._bare = None
        self._kept = {}  # what it is for → (stamps of files, Image, the image that it is a copy of)
        self._members = {}  # folder → {name of a system: [paths of its files]}

    def image_for(self, path):
        """A new image in which a text at ``path`` can be checked. path: of its file, or ``None``."""
        with self._around(path).entered():
            return Image(as_now=True)

    def warm(self, asd):
        """Prepare for the files of the systems in the file ``asd``."""
        self._of_folder(Path(asd))
        for name in self._members[Path(asd).parent]:
            self._of_system(Path(asd), name)

    def _around(self, path):
        asd = None if path is None else _definition_of(path)
        if asd is None:
            return self._of_nothing()
        path = Path(path)
        image, _ = self._of_folder(asd)
        system = next((name for name, paths in self._members[asd.parent].items() if path in paths), None)
        if system is None:
            return image
        files = self._members[asd.parent][system]
        image, stamps = self._of_system(asd, system)
        for number, file in enumerate(files[: files.index(path)]):
            image, stamps = self._made((asd, system, number, file), image, stamps, lambda seen: _check_file(file, seen))
        return image

    def _of_nothing(self):
        if self._bare is None:
            self._bare = Image()
            with session_in(self._bare):
                pass
        return self._bare

    def _of_folder(self, asd):
        def read(seen):
            for other in sorted(asd.parent.glob("*.asd")):
                seen.add(str(other))
                systems.load_asd(other)
            mine = [each for each in systems.systems.values() if isinstance(each, System) and each.file and each.file.parent == asd.parent]
            self._members[asd.parent] = {each.name: [component.pathname for component in systems.files_of(each)] for each in mine}

        self._members.setdefault(asd.parent, {})
        return self._made((asd.parent,), self._of_nothing(), {}, read)

    def _of_system(self, asd, name):
        image, stamps = self._of_folder(asd)
        return self._made((asd, name), image, stamps, lambda seen: _depend(systems.systems[name], seen, set()))

    def _made(self, key, before, stamps, prepare):
        """(Image, stamps) for ``key``: the one that is kept, or a copy of the image ``before`` in which ``prepare`` has run.

        stamps: {path: stamp} of the files that ``before`` was made of. prepare: gets a set, to which it adds the paths that it reads.
        """
        kept = self._kept.get(key)
        if kept is not None and kept[2] is before and kept[0] == {file: _stamp(file) for file in kept[0]}:
            self._kept[key] = self._kept.pop(key)  # used last
            return kept[1], kept[0]
        with before.entered():
            image = Image(as_now=True)
        seen = set()
        with session_in(image):
            try:
                prepare(seen)
            except (Exception, Condition):  # checking the .asd file or the file before tells it
                pass
        if kept is not None:
            self._kept.pop(key)[1].forget()
        stamps = {**stamps, **{file: _stamp(file) for file in seen}}
        self._kept[key] = stamps, image, before
        while len(self._kept) > MOST_KEPT:
            self._kept.pop(next(iter(self._kept)))[1].forget()
        return image, stamps

    def forget(self):
        """Drop what is kept."""
        for _, image, _ in self._kept.values():
            image.forget()
        self._kept.clear()


class session_in:
    """``with session_in(image):`` the image is current and has a kernel in virtual time, which is stopped at the end."""

    def __init__(self, image):
        self.image = image

    def __enter__(self):
        self.image.enter()
        try:
            return Session(time="virtual", turtlesim=False)
        except BaseException:
            self.image.leave()
            raise

    def __exit__(self, *problem):
        try:
            kernel.stop()
        finally:
            self.image.leave()


def _stamp(file):
    try:
        status = os.stat(file)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _definition_of(path):
    """The ``.asd`` file that may have ``path`` as a component: the nearest above it, or ``None``."""
    path = Path(path)
    if path.suffix == ".asd":
        return None
    for folder in list(path.parents)[:FOLDERS_UP]:
        found = sorted(folder.glob("*.asd"))
        if found:
            return next((asd for asd in found if _names(asd, path.stem)), found[0])
    return None


def _names(asd, stem):
    try:
        text = asd.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    return f'"{stem}"' in text and (not stem == "package" or "test" not in asd.stem)


def _depend(system, files, seen):
    for name, _ in system.depends_on:
        name = str(name).lower()
        if name in seen:
            continue
        seen.add(name)
        if systems.is_provided(name) or f"{name}.asd" in systems.libraries() or name in systems.libraries():
            systems.load_system(name)
            continue
        other = systems.systems.get(name) or systems.find_system(name)  # that of the same folder comes before others of its name
        files.add(str(other.file))
        _depend(other, files, seen)
        for component in systems.files_of(other):
            _check_file(component.pathname, files)


def _check_file(path, files):
    files.add(str(path))
    with binding(PACKAGE, COMMON_LISP_USER):
        check_text(decoded(path), str(path), lambda told: None, lambda problem: None)
