"""How far a student is: the step and the language of the last time, the tasks that are solved, what was typed.

A file keeps it between two runs.

The file is ``learn.json`` beside the history of the prompts (`repl.history.place`). Where it cannot be read or written, the course begins
with its first page, or goes on without keeping anything.
"""

from __future__ import annotations

import json
import os

from cramhy_runtime import storage
from cramhy_runtime.repl.history import place

LARGEST = 1_000_000  # bytes of a file of ours


class Progress:
    """path: of the file, or ``None`` for none. ``page``: the name of the page that was shown last, or ``None``. ``language``: "lisp" or
    "hy", in which the student learned last, or ``None``. ``solved``: names of tasks.

    ``steps``: for each page the number of the step that was shown last, from 0. ``typed``: what was typed on a page in a language, by the
    name of the page and the language with a space between them; see `replay`.
    """

    def __init__(self, path: str | None = None):
        self.path = path
        self.page: str | None = None
        self.language: str | None = None
        self.steps: dict[str, int] = {}
        self.solved: set[str] = set()
        self.typed: dict[str, list[str]] = {}
        self._read()

    @classmethod
    def kept(cls) -> Progress:
        """That of this user."""
        return cls(place("learn.json"))

    def _read(self):
        try:
            if self.path is None or os.path.getsize(self.path) > LARGEST:
                return
            with open(self.path, encoding="utf-8") as file:
                table = json.load(file)
            page, steps, solved = table["page"], table["steps"], table["solved"]
            if not isinstance(page, str) or not all(isinstance(name, str) for name in [*steps, *solved]):
                return
            if not all(isinstance(step, int) and step >= 0 for step in steps.values()):
                return
            typed, language = table.get("typed", {}), table.get("language")  # an older cramhy has not kept them
            if language not in (None, "lisp", "hy"):
                return
            if not all(isinstance(text, str) for texts in typed.values() for text in texts):
                return
            self.typed = {name: list(texts) for name, texts in typed.items()}
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            return  # it was never there, or is no file of ours
        self.page, self.language, self.steps, self.solved = page, language, dict(steps), set(solved)

    def keep(self) -> None:
        """Write the file, if that is possible."""
        if self.path is None:
            return
        table = {"page": self.page, "language": self.language, "steps": self.steps, "solved": sorted(self.solved), "typed": self.typed}
        try:
            os.makedirs(os.path.dirname(self.path), exist_ok=True)
            storage.write_whole(self.path, json.dumps(table), durable=False)
        except OSError:
            pass
