"""What surrounds a text: the system that it is a file of, and the image in which it is compiled.

A file of a system is compiled after the systems that it depends on and the files before it. What comes with cramhy is loaded. Files of the
user are only checked (`text_checking`): their macros, packages and definitions take effect, and nothing else of them runs. An image is kept
until one of its files changes, and a copy of it, which takes milliseconds, is made for each check.
"""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime import kernel
from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.dynamic import binding
from cramhy_runtime.ground.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import PACKAGE
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.loader import decoded
from cramhy_runtime.languages.commonlisp.systems.system_definitions import System
from cramhy_runtime.languages.commonlisp.systems.text_checking import check_text
from cramhy_runtime.session.image import Image
from cramhy_runtime.session.session import Session

FOLDERS_UP = 4
MOST_KEPT = 8
"""So many images are kept for systems."""


class Surroundings:
    """Makes the images in which texts are checked."""

    def __init__(self):
        self._bare = None
        self._kept = {}  # (path of the .asd, path of the file) → (stamps of files, Image)

    def image_for(self, path):
        """A new image in which a text at ``path`` can be checked. path: of its file, or ``None``."""
        with self._around(path).entered():
            return Image(as_now=True)

    def _around(self, path):
        if self._bare is None:
            self._bare = Image()
            with session_in(self._bare):
                pass
        asd = None if path is None else _definition_of(path)
        if asd is None:
            return self._bare
        key = asd, path
        stamps, image = self._kept.get(key, (None, None))
        if image is not None and stamps == {file: _stamp(file) for file in stamps}:
            return image
        with self._bare.entered():
            image = Image(as_now=True)
        files = {str(asd)}
        with session_in(image):
            try:
                _prepare(asd, Path(path), files)
            except (Exception, Condition):  # checking the .asd file or the file before tells it
                pass
        self._keep(key, ({file: _stamp(file) for file in files}, image))
        return image

    def _keep(self, key, kept):
        _, old = self._kept.pop(key, (None, None))
        if old is not None:
            old.forget()
        self._kept[key] = kept
        while len(self._kept) > MOST_KEPT:
            self._kept.pop(next(iter(self._kept)))[1].forget()

    def forget(self):
        """Drop what is kept."""
        for _, image in self._kept.values():
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


def _prepare(asd, path, files):
    """Bring the current image to where the file ``path`` of a system in ``asd`` is about to be compiled. files: gets what was read."""
    for other in sorted(asd.parent.glob("*.asd")):
        systems.load_asd(other)
    mine = [each for each in list(systems.systems.values()) if isinstance(each, System) and each.file and each.file.parent == asd.parent]
    system = next((each for each in mine if path in [component.pathname for component in systems.files_of(each)]), None)
    if system is None:
        return
    files.add(str(system.file))
    _depend(system, files, set())
    for component in systems.files_of(system):
        if component.pathname == path:
            return
        _check_file(component.pathname, files)


def _depend(system, files, seen):
    for name, _ in system.depends_on:
        name = str(name).lower()
        if name in seen:
            continue
        seen.add(name)
        if systems.is_provided(name) or f"{name}.asd" in systems.libraries() or name in systems.libraries():
            systems.load_system(name)
            continue
        other = systems.find_system(name)
        files.add(str(other.file))
        _depend(other, files, seen)
        for component in systems.files_of(other):
            _check_file(component.pathname, files)


def _check_file(path, files):
    files.add(str(path))
    with binding(PACKAGE, COMMON_LISP_USER):
        check_text(decoded(path), str(path), lambda told: None, lambda problem: None)
