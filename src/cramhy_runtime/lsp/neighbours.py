"""The other files of the system that a text is a file of, as texts."""

from __future__ import annotations

import os
from pathlib import Path

from cramhy_runtime.languages.commonlisp.systems import systems

from .texts import Text

MOST_KEPT = 400
_kept: dict[str, tuple[object, Text]] = {}  # path → (stamp, Text)


def files(document):
    """The paths of the other files of the systems beside the file of ``document``."""
    if document.path is None or document.kind in ("hy", "xml"):
        return []

    def paths():
        mine = Path(document.path)
        return [
            component.pathname
            for system in list(systems.systems.values())
            if isinstance(system, systems.System) and system.file and system.file.parent in mine.parents
            for component in systems.files_of(system)
            if component.pathname != mine and component.pathname.is_file()
        ]

    return list(dict.fromkeys(document.in_image(paths, [])))


def texts(document, others=()):
    """[(path, `Text`)] of the other files. others: {path: Text} of those that are open in the editor."""
    return [(str(path), others[str(path)] if str(path) in others else text_of(str(path))) for path in files(document)]


def text_of(path):
    """The `Text` of a file as it is now."""
    try:
        status = os.stat(path)
        stamp = status.st_mtime_ns, status.st_size
        kept = _kept.get(path)
        if kept is not None and kept[0] == stamp:
            return kept[1]
        text = Text(Path(path).read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return Text("")
    if len(_kept) >= MOST_KEPT:
        _kept.clear()
    _kept[path] = stamp, text
    return text
