"""Packages of catkin as zip files: how files leave a tab, for a machine with CRAM, and come back.

`exported` takes the package that a file belongs to, as it is. Files that are in no package get one: ``package.xml``, ``CMakeLists.txt``
and an ``.asd`` that names them, as in the course's own package. `imported` unpacks such a file, wherever it was made. It looks at the whole
file before it writes, so a file that is cut short, too large, or that would write elsewhere changes nothing.

Sources: REP 127 and 140 (package.xml), ASDF's manual (defsystem), APPNOTE.TXT of PKWARE (zip).
"""

from __future__ import annotations

import io
import os
import re
import shutil
import stat
import tempfile
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree

from .. import storage
from ..ros import new_packages

MOST_BYTES = 20_000_000  # of all files of a package
MOST_FILES = 2_000
HIDDEN = ("__pycache__", "__MACOSX")
MOMENT = (2000, 1, 1, 0, 0, 0)
"""The date of all files, so that the same files make the same zip."""
DEPENDS = (
    "roslisp cram-language turtlesim-msg turtlesim-srv std_srvs-srv cl-transforms geometry_msgs-msg cram-designators cram-prolog "
    "cram-process-modules cram-language-designator-support cram-executive"
).split()
"""The systems that the course's own system depends on."""
ROS_DEPENDS = (
    "cram_language turtlesim roslisp cl_transforms geometry_msgs std_srvs cram_prolog cram_designators cram_process_modules cram_executive"
).split()
_LOADS = re.compile(r"""load-system\s+(?:"([\w.-]+)"\s+)?[:'"#]*([\w-]+)""", re.I)
_NAME = re.compile(r"[a-z][a-z0-9_]*")


class UnfitPackage(Exception):
    """The package cannot be exported, or the file imported. The text says why and what to try."""


class AlreadyThere(Exception):
    """There is a folder of that name (``args[0]``) already."""


# ---------------------------------------------------------------------------------------------------------------- export


def exported(folder: str | os.PathLike[str], path: str, name: str) -> tuple[str, bytes]:
    """(name of the zip file, its bytes) with the package below ``folder`` that the file ``path`` belongs to.

    path: relative to ``folder``. name: of the package for the files that belong to none. Errors: `UnfitPackage`, `OSError`.
    """
    folder = Path(folder)
    files = sorted(_files(folder))
    homes = {file.parent for file in files if file.name == "package.xml"}
    package = _home(PurePosixPath(path), homes)
    if package is not None:
        found = {str(file.relative_to(package)): (folder / file).read_bytes() for file in files if _home(file, homes) == package}
        return f"{package.name or name}.zip", _zipped(_checked_name(package.name or name, lower=False), found)
    loose = {str(file): (folder / file).read_bytes() for file in files if _home(file, homes) is None}
    if not loose:
        raise UnfitPackage("There is no file to export yet. Write one in the editor first.")
    return f"{name}.zip", _zipped(_checked_name(name), _wrapped(name, loose))


def _home(file, homes):
    """The folder of the package that ``file`` is in, or ``None``."""
    return next((parent for parent in file.parents if parent in homes), None)


def _files(folder):
    for place, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".") and name not in HIDDEN]
        for name in names:
            if not name.startswith("."):
                yield PurePosixPath(Path(place, name).relative_to(folder).as_posix())


def _checked_name(name, lower=True):
    if lower and not _NAME.fullmatch(name):
        raise UnfitPackage(
            f'"{name}" cannot be the name of a package: it begins with a lower-case letter, and has letters, digits and _ in it.'
        )
    return name


def _wrapped(name, loose):
    """The files of a new package ``name``: those of ``loose``, and what a package has to have."""
    found = {
        "package.xml": new_packages.manifest(name, ROS_DEPENDS, "Plans that were written in a browser.", ["depend"]).encode(),
        "CMakeLists.txt": new_packages.cmake_lists(name, ROS_DEPENDS).encode(),
    }
    if any(file.endswith(".asd") for file in loose):  # they say themselves where the files of their systems are
        return {**found, **loose}
    programs = [PurePosixPath(file) for file in loose if file.endswith((".lisp", ".hy"))]
    programs.sort(key=lambda file: (file.stem != "package", str(file)))
    components = list(dict.fromkeys(str(file.with_suffix("")) for file in programs))
    loaded = [
        match[2].lower()
        for file in programs
        for match in _LOADS.finditer(loose[str(file)].decode(errors="replace"))
        if match[2].lower() != "load-system"
    ]
    system = name.replace("_", "-")
    found[f"{system}.asd"] = ASD.format(
        system=system,
        depends="\n               ".join(dict.fromkeys([*DEPENDS, *loaded])),
        components="\n     ".join(f'(:file "{each}")' for each in components),
    ).encode()
    return {**found, **{f"src/{file}": content for file, content in loose.items()}}


def _zipped(top, files):
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as target:
        for file, content in sorted(files.items()):
            entry = zipfile.ZipInfo(f"{top}/{file}", MOMENT)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            target.writestr(entry, content)
    return buffer.getvalue()


ASD = """;; The files are loaded in this order. Change it if one needs another that stands below it.
(defsystem {system}
  :depends-on ({depends})
  :components
  ((:module "src"
    :serial t
    :components
    ({components}))))
"""


# ---------------------------------------------------------------------------------------------------------------- import


def imported(data: bytes, folder: str | os.PathLike[str], replace: bool = False) -> list[str]:
    """Unpack the zip file ``data`` below ``folder``. Returns the paths of its files, relative to ``folder``.

    replace: whether a folder that is there already gives way. Errors: `UnfitPackage`, `AlreadyThere`, `OSError`.
    """
    folder = Path(folder)
    files = _unpacked(data)
    tops = {file.parts[0] for file in files if len(file.parts) > 1}
    if not any(file.name == "package.xml" or file.suffix in (".lisp", ".hy", ".asd") for file in files):
        raise UnfitPackage("There is no package in this file: it has neither a package.xml nor a file of Lisp or Hy.")
    if len(tops) != 1 or any(len(file.parts) == 1 for file in files):  # no folder around it, as when a folder's content is packed
        top = _name_in(files.get(PurePosixPath("package.xml"))) or "imported"
        files = {PurePosixPath(top, file): content for file, content in files.items()}
        tops = {top}
    (top,) = tops
    if (folder / top).exists():
        if not replace:
            raise AlreadyThere(top)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".") as aside:  # where what was there stays until all has been written
        if (folder / top).exists():
            (folder / top).rename(Path(aside, "before"))
        try:
            for file, content in files.items():
                target = folder / file
                target.parent.mkdir(parents=True, exist_ok=True)
                storage.write_whole(target, content, durable=False)
        except OSError:
            shutil.rmtree(folder / top, ignore_errors=True)
            if Path(aside, "before").exists():
                Path(aside, "before").rename(folder / top)
            raise
    return sorted(map(str, files))


def _name_in(text):
    """The name that a ``package.xml`` says, or ``None``."""
    try:
        name = (ElementTree.fromstring(text).findtext("name") or "").strip() if text else ""
    except ElementTree.ParseError:
        return None
    return name if re.fullmatch(r"[\w-]+", name) else None


def _unpacked(data):
    """{path: content} of the files of a zip, after a look at all of them."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as source:
            entries = [
                entry for entry in source.infolist() if not entry.is_dir() and not set(PurePosixPath(entry.filename).parts) & set(HIDDEN)
            ]
            if len(entries) > MOST_FILES or sum(entry.file_size for entry in entries) > MOST_BYTES:
                raise UnfitPackage(
                    f"This file is too large: a package may have {MOST_FILES:,} files with {MOST_BYTES // 1_000_000} MB in all."
                )
            return {_checked_path(entry): source.read(entry) for entry in entries}
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, ValueError) as problem:
        raise UnfitPackage("This file is not a zip file, or it is broken or cut short. Fetch it again, and import that.") from problem
    except RuntimeError as problem:  # Python's word for a password that is missing
        raise UnfitPackage("This zip file is locked with a password. Pack the package without one.") from problem


def _checked_path(entry):
    path = PurePosixPath(entry.filename)
    leaves = path.is_absolute() or ".." in path.parts or "\\" in entry.filename or ":" in entry.filename or not path.parts
    if leaves or stat.S_ISLNK(entry.external_attr >> 16):
        raise UnfitPackage(f"This file would write outside of its own folder: {entry.filename!r}. Nothing of it was unpacked.")
    return path
