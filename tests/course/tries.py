"""Types what students try at a task, and notes what the check says: each try in a process of its own, in the state in which its page
leaves the student. So no try sees what another one has defined.

``tries/NAME.toml`` has the tries at the task NAME: ``[[lisp.right]]``, ``[[lisp.wrong]]``, ``[[hy.right]]`` and ``[[hy.wrong]]``, each with
its ``kind`` and its ``text``. A wrong one says in ``missing`` what the text of the task asks for and the try has not. Those with
``closed = true`` were not run while the checks were written.

``python -m tests.course.tries [--closed] [PAGE ...]`` prints the verdict on each.
"""

from __future__ import annotations

import functools
import json
import os
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

from .walking import Walk

FOLDER = Path(__file__).parent / "tries"


class Try(NamedTuple):
    """A text that somebody types at a task. sort: "right" or "wrong". missing: of a wrong one, what it has not."""

    task: str
    language: str
    sort: str
    kind: str
    text: str
    missing: str = ""
    closed: bool = False

    @property
    def name(self) -> str:
        """As it is named in a report."""
        return f"{self.task} {self.language} {self.sort}: {self.kind}"


@functools.cache
def tries_at(task: str, language: str) -> tuple[Try, ...]:
    """The tries at a task in a language, as the file has them."""
    table = tomllib.loads((FOLDER / f"{task}.toml").read_text(encoding="utf-8"))[language]
    return tuple(Try(task, language, sort, **{"text": "", **each}) for sort in ("right", "wrong") for each in table[sort])


class Verdict(NamedTuple):
    """What the course said of a try. said: what stands below ``:check``."""

    tried: Try
    passed: bool
    said: str

    @property
    def just(self) -> bool:
        """Whether a right one has passed, or a wrong one has not."""
        return self.passed == (self.tried.sort == "right")


class Tries(Walk):
    """A walk through a page, with tries at its tasks. ``results``: a `Verdict` for each try that ``wanted`` is true of."""

    def __init__(self, page, language, folder, wanted):
        self.results, self.wanted, self._process = [], wanted, os.getpid()
        try:
            super().__init__(page, language, folder)
        finally:
            if os.getpid() != self._process:  # a try whose session has ended by itself
                os._exit(1)

    def _task(self, task):
        for tried in filter(self.wanted, tries_at(task.name, self.language)):
            reading, writing = os.pipe()
            process = os.fork()
            if process == 0:
                os.close(reading)
                shown = len(sys.stdout.getvalue())
                yield from self._typed(tried.text)
                yield ":check"
                if "The debugger is open" in sys.stdout.getvalue()[-200:]:
                    yield "q"
                    yield ":check"
                passed = task.name in self.progress.solved
                with open(writing, "w", encoding="utf-8") as report:
                    json.dump([passed, sys.stdout.getvalue()[shown:].rpartition(":check\n")[2].strip()], report)
                os._exit(0)
            os.close(writing)
            with open(reading, encoding="utf-8") as report:
                text = report.read()
            os.waitpid(process, 0)
            self.results.append(Verdict(tried, *(json.loads(text) if text else (None, "The session has ended."))))
        yield from super()._task(task)


if __name__ == "__main__":
    import tempfile
    import time

    from cramhy_runtime.course import contents

    closed = "--closed" in sys.argv
    names = [name for name in sys.argv[1:] if not name.startswith("--")] or contents.NAMES
    counts: dict[tuple[str, str, bool | None], int] = {}
    for page in names:
        for each in ("lisp", "hy"):
            begun = time.process_time()
            with tempfile.TemporaryDirectory() as folder:
                walk = Tries(page, each, Path(folder), lambda tried: tried.closed == closed)
            for verdict in walk.results:
                key = (each, verdict.tried.sort, verdict.passed)
                counts[key] = counts.get(key, 0) + 1
                print("   " if verdict.just else "***", verdict.tried.name, "| passed" if verdict.passed else f"| {verdict.said}")
            print(f"--- {page} {each}: {time.process_time() - begun:.1f} s", flush=True)
    print(counts)
