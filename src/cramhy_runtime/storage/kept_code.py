"""The keeper of compiled code, for all languages: code comes back only while it is what the compiler would make now.

    kept_code.keep(path, label, content)      # after compiling; content: what `marshal` can write, with what it depends on in it
    kept_code.find(path, label)               # before compiling: the content, or `Unusable`
    kept_code.refuse(path, place, reason)     # after compiling what cannot be kept

``label`` is 64 characters that name the text and what compiles it. What else code depends on, the record that a trace has made
(`dependency_tracing`), is part of the content, since a file of Lisp has a record for each form; `dependencies.holds` judges it.
`kept_files` says in which file the content is, and `checksummed_code` proves that nobody else has written it and that no byte has changed.

`not_kept` tells why the code of a file was refused, and where. `show_refusals` lets somebody hear of it at once, as ``--verbose`` does.
"""

from __future__ import annotations

import marshal
import os
from .checksummed_code import Unusable, sealed, unsealed
from .dependency_tracing import untraced
from .kept_files import keep as keep_file
from .kept_files import kept_bytes

TYPE_CHECKING = False
if TYPE_CHECKING:  # as type checkers see it; `typing` itself takes 2 ms to import
    from collections.abc import Callable
    from typing import Any

FIRST_LINE = b"# cramhy kept code 4\n"


class NotKept:
    """Why the code of a file is not kept. place: (file, line, column) of the form that asks for what cannot be compared."""

    def __init__(self, reason: str, place: tuple[str, int, int]):
        self.reason, self.place = reason, place

    def __str__(self) -> str:
        file, line, column = self.place
        return f"{file} is compiled anew each time: {self.reason} (line {line}, column {column})"


class _State:
    """What this process knows of files whose code is not kept."""

    refused: dict[str, NotKept] = {}
    listener: Callable[[str], None] | None = None


def find(path: os.PathLike[str], label: str) -> Any:
    """The content that was kept for ``path`` under that label. Errors: `Unusable`, which says why there is none."""
    try:
        with untraced():  # what is found has a record of its own
            data = kept_bytes(path, lambda place: unsealed(place, FIRST_LINE, label))
        return marshal.loads(data)
    except (OSError, ValueError, EOFError, TypeError) as problem:
        raise Unusable("unreadable", f"no code is kept for {path}: {problem}") from None


def keep(path: os.PathLike[str], label: str, content: Any) -> None:
    """Keep ``content`` for ``path``, unless Python shall write none, or cannot."""
    _State.refused.pop(os.fspath(path), None)
    with untraced():
        keep_file(path, lambda: sealed(FIRST_LINE, label, marshal.dumps(content)))


def refuse(path: os.PathLike[str], place: tuple[str, int, int], reason: str) -> None:
    """The code of ``path`` is not kept, since what it depends on cannot be compared. place: of the form that asks for it."""
    found = _State.refused[os.fspath(path)] = NotKept(reason, place)
    if _State.listener is not None:
        _State.listener(str(found))


def not_kept(path: os.PathLike[str]) -> NotKept | None:
    """Why the code of ``path``, which was compiled in this process, is not kept; ``None`` if it is."""
    return _State.refused.get(os.fspath(path))


def show_refusals(listener: Callable[[str], None] | None) -> None:
    """From now on call ``listener`` with a sentence for each file whose code cannot be kept; ``None``: with none."""
    _State.listener = listener


__all__ = ["FIRST_LINE", "NotKept", "find", "keep", "not_kept", "refuse", "show_refusals"]
