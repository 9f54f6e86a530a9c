"""Types mistakes of readers at the prompt of ``cramhy learn``, and looks whether the screen says what helps.

``slips_typed/CLASS.toml`` has ten mistakes of a class, the reader's and its siblings: ``[[slip]]`` with its ``language``, its ``page``, where
``at`` it is typed, its ``text``, and in ``says`` what the screen has to say. ``silent`` has what it must not say. ``at`` is the name of a task,
or how a form of the page begins. All forms of the page up to there were typed before, but those of ``without``. ``closed``: it was not run
while the messages were written.

Each mistake is typed in a process of its own, which begins with the page as the reader has come there.

``python -m tests.course.slips_typed [--closed] [--show] [CLASS ...]`` prints what came of each.
"""

from __future__ import annotations

import functools
import json
import os
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import NamedTuple

from cramhy_runtime.course.parts import Code, Task
from cramhy_runtime.course.steps import steps

from .walking import Walk, solution

FOLDER = Path(__file__).parent / "slips_typed"


class Slip(NamedTuple):
    """A mistake that is typed, and what the screen says of it."""

    sort: str
    language: str
    page: str
    at: str
    text: str
    says: tuple[str, ...] = ()
    silent: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    closed: bool = False

    @property
    def name(self) -> str:
        """As it is named in a report."""
        return f"{self.sort} {self.language} {self.page} {self.at}: {' '.join(self.text.split())[:70]}"


@functools.cache
def slips_of(sort: str) -> tuple[Slip, ...]:
    """The mistakes of a class."""
    table = tomllib.loads((FOLDER / f"{sort}.toml").read_text(encoding="utf-8"))
    lists = ("says", "silent", "without")
    return tuple(Slip(sort, **{key: tuple(each[key]) if key in lists else each[key] for key in each}) for each in table["slip"])


def words(shown: str) -> str:
    """The words of the screen, without the line ends that the width made."""
    return " ".join(shown.replace("\n;", " ").split())


class Typing(Walk):
    """A walk through a page, with mistakes on the way. ``results``: for each mistake, what the screen has shown."""

    def __init__(self, page, language, folder, wanted):
        self.results, self.wanted, self._process = {}, wanted, os.getpid()
        try:
            super().__init__(page, language, folder)
        finally:
            if os.getpid() != self._process:
                os._exit(1)

    def _lines(self):
        left = list(self.wanted)
        without = {text for slip in left for text in slip.without}
        for step in steps(self.page, self.language):
            for slip in [slip for slip in left if self._is_at(step.part, slip.at)]:
                left.remove(slip)
                yield from self._tried(slip)
            if not left:
                break
            if isinstance(step.part, Code):
                for typed in getattr(step.part, self.language):
                    if not typed.text.startswith(tuple(without) or "\0"):
                        yield from typed.form.split("\n")
            elif isinstance(step.part, Task):
                yield from (line for line in solution(step.part.name, self.language).splitlines() if line.strip())
            yield ":next"
        yield ":quit"

    def _is_at(self, part, at):
        if isinstance(part, Task):
            return part.name == at
        return isinstance(part, Code) and any(each.text.startswith(at) for each in getattr(part, self.language))

    def _tried(self, slip):
        reading, writing = os.pipe()
        process = os.fork()
        if process == 0:
            os.close(reading)
            begin = len(self.out.getvalue())
            yield from slip.text.strip("\n").split("\n")
            yield ";;;"
            with open(writing, "w", encoding="utf-8") as report:
                json.dump(self.out.getvalue()[begin:], report)
            os._exit(0)
        os.close(writing)
        with open(reading, encoding="utf-8") as report:
            text = report.read()
        os.waitpid(process, 0)
        self.results[slip] = json.loads(text) if text else "The session has ended."


def typed_slips(wanted) -> dict[Slip, str]:
    """What the screen has shown of each of the mistakes ``wanted``."""
    found: dict[Slip, str] = {}
    for key in sorted({(slip.page, slip.language, slip.without) for slip in wanted}):
        with tempfile.TemporaryDirectory() as folder:
            some = [slip for slip in wanted if (slip.page, slip.language, slip.without) == key]
            found.update(Typing(key[0], key[1], Path(folder), some).results)
    return found


def faults(slip: Slip, shown: str) -> list[str]:
    """What the screen should have said and has not, and what it should not have said."""
    said = words(shown)
    return [f"not said: {each}" for each in slip.says if each not in said] + [f"said: {each}" for each in slip.silent if each in said]


if __name__ == "__main__":
    sorts = [name for name in sys.argv[1:] if not name.startswith("--")] or sorted(file.stem for file in FOLDER.glob("*.toml"))
    closed, show = "--closed" in sys.argv, "--show" in sys.argv
    wanted = [slip for sort in sorts for slip in slips_of(sort) if slip.closed == closed or "--all" in sys.argv]
    results = typed_slips(wanted)
    good = 0
    for slip in wanted:
        wrong = faults(slip, results.get(slip, "Its place was not found."))
        good += not wrong
        print("***" if wrong else "   ", slip.name, *wrong, sep="\n      ")
        if show or wrong:
            print("\n".join(f"        | {line}" for line in results.get(slip, "Its place was not found.").splitlines()))
    print(f"{good} of {len(wanted)}")
