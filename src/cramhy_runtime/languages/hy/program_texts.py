"""Which of the texts that Hy reads is a program, and in which file it stands.

Hy tells a text by its name: the path of a file, ``<string>`` for ``hy -c``, ``<stdin>`` for a text that is piped into ``hy``. A prompt
puts a number behind the name: ``<stdin>-3`` was typed, ``plan.hy-0`` is the file of ``hy -i plan.hy``, and ``<string>-0`` the text of
``hy -i -c``. ``<string>`` is also what Python and Hy call any text that a program evaluates.
"""

from __future__ import annotations

import os
import re
import sys

from cramhy_runtime.lisp_core.source_places import keep_text

_NUMBER = re.compile(r"-\d+\Z")


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


__all__ = ["before_the_prompt", "is_program", "keep", "was_typed"]
