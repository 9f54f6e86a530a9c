"""Find and read definitions of messages, in the folders ``msg``, ``srv`` and ``action`` of ROS packages.

The search begins with our own copies of the common packages, in ``definitions/``. Folders added with `add_package_directory`
come next, then the places where all packages are searched: ``ROS_PACKAGE_PATH``, the workspace's ``src``, the current
folder and ``tutorials/``. No search begins before the first question. Source: roslisp.md 12.
"""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime.kernel.late_patterns import late_pattern
from .search_folders import crawl, entries, is_folder
from . import definition_text
from .definition_text import ACTION_PARTS, DefinitionError, action_messages
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator
    from .definition_text import Definition
    from .search_folders import Folder


OURS = Path(__file__).parent / "definitions"
KINDS = ("msg", "srv", "action")

_directories: list[Path] = []
_TYPE_NAME = late_pattern(r"[A-Za-z][A-Za-z0-9_]*$")
_LEGAL = late_pattern(r"[A-Za-z][A-Za-z0-9_-]*$")
_PACKAGE_NAME = late_pattern(r"<name>\s*([\w-]+)\s*</name>")


def add_package_directory(directory: str | Path) -> None:
    """Look for ROS packages in the sub-folders of ``directory`` too."""
    directory = Path(directory)
    if directory not in _directories:
        _directories.append(directory)


def forget_package_directory(directory: str | Path) -> None:
    """Stop looking for ROS packages in the sub-folders of ``directory``, which `add_package_directory` has added."""
    _directories.remove(Path(directory))


def package_folder(package: str) -> Path | None:
    """The folder of the ROS package ``package`` if the package is found and has definitions, else ``None``."""
    if not _LEGAL.match(package):
        return None
    for folder in [OURS, *_directories]:
        if _has_definitions(folder / package):
            return folder / package
    return next((folder for name, folder in _packages_on_path() if name == package), None)


def own_folder(package: str) -> Path | None:
    """The folder of a package that is part of cramhy, with definitions or only with launch files, else ``None``."""
    return OURS / package if _LEGAL.match(package) and os.path.isdir(OURS / package) else None


def own_packages() -> list[str]:
    """The names of the packages that are part of cramhy."""
    return sorted(entry.name for entry in entries(OURS) if os.path.isdir(entry.path) and _LEGAL.match(entry.name))


def known_packages() -> list[str]:
    """The names of all packages with definitions."""
    named = [entry.name for folder in [OURS, *_directories] for entry in entries(folder) if _has_definitions(Path(entry.path))]
    return sorted({*named, *(name for name, _ in _packages_on_path())})


def file_of_type(name: str, kind: str = "msg") -> str:
    """Where a package defines its type ``name``: ``msg/Pose.msg``, and ``action/Cook.action`` for a message of an action."""
    parts = ("ActionGoal", "ActionResult", "ActionFeedback", "Action")
    action = next((name.removesuffix(part) for part in parts if name.endswith(part) and name != part), None)
    return f"action/{action}.action" if action and kind == "msg" else f"{kind}/{name}.{kind}"


def why_missing(package: str, name: str | None = None, kind: str = "msg") -> str:
    """A sentence that says where the type ``name`` of ``package`` was looked for, or any of ``kind`` if ``name`` is ``None``."""
    wanted = file_of_type(name, kind) if name is not None else f"files {kind}/*.{kind}"
    folder = package_folder(package) or next((folder for other, folder in packages() if other == package), None)
    if folder is not None:
        return f"The package {package} has no {wanted} in {folder}."
    article = "" if name is None else "an " if wanted[0] == "a" else "a "
    return f"No package {package} with {article}{wanted} is below {where_searched()}."


def why_no_lisp_package(name: str) -> str | None:
    """As `why_missing`, for a Lisp package called ``MY_MSGS-MSG`` or ``MY_MSGS-SRV``; ``None`` for another name."""
    package, _, kind = name.lower().rpartition("-")
    return why_missing(package, kind=kind) if kind in ("msg", "srv") and package else None


def where_searched() -> str:
    """The places of the search in words: ``ROS_PACKAGE_PATH (/a, /b), the current folder and src of the workspace``."""
    told = [entry if os.path.isdir(entry) else f"{entry}, which is not a folder"
            for entry in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if entry]  # fmt: skip
    return f"ROS_PACKAGE_PATH ({', '.join(told) or 'which is not set'}), the current folder and src of the workspace"


def definition_files(folder: Path, kind: str) -> dict[str, Path]:
    """The definition files of the package in ``folder``, by type name. ``kind``: ``"msg"``, ``"srv"`` or ``"action"``."""
    return {path.stem: path for path in sorted((folder / kind).glob("*." + kind))}


def message_names(folder: Path) -> list[str]:
    """The names of all messages of the package in ``folder``, those of its actions included."""
    names = list(definition_files(folder, "msg"))
    for action in definition_files(folder, "action"):
        names += [*action_messages(action), *(action + part for part in ACTION_PARTS)]
    return list(dict.fromkeys(names))


def has_kind(folder: Path | None, kind: str) -> bool:
    """Whether the package in ``folder`` has definitions of ``kind``: messages (``"msg"``, actions included) or services (``"srv"``).

    ``folder`` is ``None`` for a package that has just been removed; the answer is then false.
    """
    return folder is not None and (os.path.isdir(folder / kind) or kind == "msg" and os.path.isdir(folder / "action"))


def _has_definitions(folder: Path) -> bool:
    return any(os.path.isdir(folder / kind) for kind in KINDS)


def _packages_on_path() -> Iterator[tuple[str, Path]]:
    """Name and folder of each package with definitions, in the order of the search."""
    for folder in crawl():
        if any(kind in folder.entries and is_folder(folder.entries[kind]) for kind in KINDS):
            yield package_name(folder), Path(folder.path)


def packages() -> Iterator[tuple[str, Path]]:
    """Yield name and folder of each package with a manifest in the folders of the search, with definitions or without."""
    for folder in crawl():
        if folder.manifest is not None:
            yield package_name(folder), Path(folder.path)


def package_name(folder: Folder) -> str:
    """The name of the package in ``folder``, as its manifest says; the folder's own name if it has no manifest that can be read."""
    try:
        found = folder.manifest and _PACKAGE_NAME.search(Path(folder.manifest.path).read_text(encoding="utf-8", errors="replace"))
    except OSError:  # the manifest is somebody else's
        found = None
    return found[1] if found else os.path.basename(folder.path)


# ------------------------------------------------------------------------------------------------------- a whole package


class PackageDefinitions:
    """The definitions of a package.

    ``messages``: by name, those of its actions included. ``services``: (request, response) by name. ``actions``: their names.
    """

    __slots__ = ("messages", "services", "actions")

    def __init__(self) -> None:
        self.messages: dict[str, Definition] = {}
        self.services: dict[str, tuple[Definition, ...]] = {}
        self.actions: list[str] = []


def read(package: str) -> PackageDefinitions | None:
    """The `PackageDefinitions` of the package ``package``, or ``None`` if it is not found.

    An error in the definitions raises `DefinitionError`.
    """
    folder = package_folder(package)
    return read_package(package, folder) if folder is not None else None


def read_package(package: str, folder: Path) -> PackageDefinitions:
    """The `PackageDefinitions` of the package in ``folder``. An error in the definitions raises `DefinitionError`."""
    found = PackageDefinitions()
    for name, path in definition_files(folder, "msg").items():
        found.messages[name] = definition_text.parse_message(_text_of(path), package, str(path))
    for name, path in definition_files(folder, "srv").items():
        found.services[name] = definition_text.parse_service(_text_of(path), package, str(path))
    for name, path in definition_files(folder, "action").items():
        found.actions.append(name)
        for part, definition in zip(ACTION_PARTS, definition_text.parse_action(_text_of(path), package, str(path))):
            found.messages.setdefault(name + part, definition)
        for message, text in action_messages(name).items():
            found.messages.setdefault(message, definition_text.parse_message(text, package, str(path)))
    if folder.parent != OURS:
        _check_types(package, folder, found)
    return found


def _text_of(path: Path) -> str:
    if not _TYPE_NAME.match(path.stem):
        raise DefinitionError(
            f"{path}: {path.stem} is not a name for a type.", "Rename the file: letters, digits and underscores, the first one a letter."
        )
    try:
        return path.read_text(encoding="utf-8", errors="replace")  # what is not UTF-8 stands in comments
    except OSError as problem:
        raise DefinitionError(f"{path} cannot be read: {problem.strerror}.", "Make it readable for this user, or remove it.") from None


def _check_types(package: str, folder: Path, found: PackageDefinitions) -> None:
    names: dict[str, Collection[str]] = {package: found.messages}
    for definition in [*found.messages.values(), *(half for service in found.services.values() for half in service)]:
        for field in definition.fields:
            if not field.primitive:
                home, _, name = field.base.partition("/")
                if home not in names:
                    other = package_folder(home)
                    names[home] = message_names(other) if other is not None else ()
                if name not in names[home]:
                    definition_text.unknown_type(field, package, definition.where, names[home], why_missing(home, name))
    for name in found.messages:
        _check_circles(package, found.messages, [name])


def _check_circles(package: str, messages: dict[str, Definition], way: list[str]) -> None:
    definition = messages[way[-1]]
    for field in definition.fields:
        home, _, name = field.base.partition("/")
        if home == package and name in messages:
            if name in way:
                circle = " -> ".join([*way[way.index(name) :], name])
                line, column = field.place
                raise DefinitionError(f"{definition.where}, line {line}, column {column}: A message cannot contain itself: {circle}.",
                                      "Refer to the other one by a number or a name.")  # fmt: skip
            _check_circles(package, messages, [*way, name])
