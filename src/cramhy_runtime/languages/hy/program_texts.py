"""Which of the texts that Hy reads is a program, and in which file it stands.

Hy tells a text by its name: the path of a file, ``<string>`` for ``hy -c``, ``<stdin>`` for a text that is piped into ``hy``. A prompt
puts a number behind the name: ``<stdin>-3`` was typed, ``plan.hy-0`` is the file of ``hy -i plan.hy``, and ``<string>-0`` the text of
``hy -i -c``. ``<string>`` is also what Python and Hy call any text that a program evaluates. Hy 1.2, for early releases of Python 3.12,
puts a sum of the text in the place of the number, and takes the brackets away. `name_as_later_releases` mends both for what is typed.
"""

from __future__ import annotations

import os
import re
import sys
from types import ModuleType

from cramhy_runtime.ground.source_places import keep_text

_NUMBER = re.compile(r"-(?:\d+|[0-9a-f]{40})\Z")


def is_program(filename: str) -> bool:
    """Whether the text of that name is a program that stands in a file, in a pipe or in the command line, and was not typed."""
    return os.path.isfile(filename) or _is_no_file(filename) or before_the_prompt(filename) is not None


def before_the_prompt(filename: str) -> str | None:
    """The name without its number of a text that is run before a prompt comes; ``None`` for any other text."""
    name, numbered = _NUMBER.subn("", filename)
    return name if numbered and name != "<stdin>" and (os.path.isfile(name) or _is_no_file(name)) else None


def was_typed(filename: str) -> bool:
    """Whether the text of that name was typed at a prompt of Hy's."""
    return _NUMBER.search(filename) is not None and not is_program(filename)


def keep(filename: str, text: str) -> None:
    """Let errors show the lines of the program ``text``, and the name of its file."""
    if not os.path.isfile(filename):
        file = before_the_prompt(filename)
        keep_text(filename, text, file if file is not None and os.path.isfile(file) else None)


def _is_no_file(filename: str) -> bool:
    return filename == "<stdin>" or filename == "<string>" and sys.argv[:1] == ["-c"]


class TypedName(str):
    """The name of a text that is typed; Hy 1.2 cannot take its brackets away."""

    __slots__ = ()

    def strip(self, characters: str | None = None, /) -> str:
        return str(self)


class _Numbers:
    """In the place of ``hashlib``: each text has the next number as its sum."""

    def __init__(self) -> None:
        self.count = 0

    def sha1(self, text: bytes) -> _Numbers:
        self.count += 1
        return self

    def hexdigest(self) -> str:
        return str(self.count)


def name_as_later_releases(repl_module: ModuleType) -> None:
    """Let the prompts of the module ``hy.repl`` call what is typed ``<stdin>-3``, as those of Hy 1.3 do, if it has a `TypedName`."""
    if isinstance(getattr(repl_module, "hashlib", None), ModuleType):
        setattr(repl_module, "hashlib", _Numbers())


__all__ = ["TypedName", "before_the_prompt", "is_program", "keep", "name_as_later_releases", "was_typed"]
