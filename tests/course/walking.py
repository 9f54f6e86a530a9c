"""Walks through a page of ``cramhy learn`` as a student does who types everything, and notes what the checks say.

A solution of the task NAME is in ``solutions/NAME.lisp`` and ``solutions/NAME.hy``. Other ones, and wrong ones, are typed by `tries`.
"""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

from cramhy_runtime.course import learn, reading
from cramhy_runtime.course.steps import ERROR, steps
from cramhy_runtime.course.parts import Code, Task
from cramhy_runtime.course.progress import Progress
from cramhy_runtime.course.shown import Style
from cramhy_runtime.repl.line_input import Lines
from cramhy_runtime.repl.session import Session

SOLUTIONS = Path(__file__).parent / "solutions"
ENDINGS = {"lisp": ".lisp", "hy": ".hy"}


def solution(name, language):
    return (SOLUTIONS / f"{name}{ENDINGS[language]}").read_text(encoding="utf-8")


class Script(Lines):
    """The lines of a generator, which goes on when the next line is wanted."""

    def __init__(self, lines):
        super().__init__()
        self.coming = lines

    def wait(self, prompt):
        line = next(self.coming, None)
        print(f"{prompt}{line if line is not None else ''}")
        return line

    def keep(self, history):
        return contextlib.nullcontext()


def fails(text):
    """Whether an answer shows an error."""
    return any(line.startswith(ERROR) for line in text.splitlines())


class Walk:
    """What came of a walk. ``verdicts``: (task, "nothing", "start" or "solution") → whether the check passed. ``text``: the screen.
    ``wrong``: forms with errors that the page does not show, or without those that it shows."""

    def __init__(self, page, language, folder):
        self.verdicts, self.progress, self.wrong = {}, Progress(), []
        self.page, self.language = reading.page(page), language
        out = self.out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            self.status = learn.run(
                lambda closings: Session(time="virtual"), language, page, folder, self.progress, Style(), Script(self._lines())
            )
        self.text = out.getvalue()

    def _lines(self):
        for step in steps(self.page, self.language):
            if isinstance(step.part, Code):
                for typed in getattr(step.part, self.language):
                    before = len(self.out.getvalue())
                    yield from typed.form.split("\n")
                    shown = self.out.getvalue()[before:]
                    if fails(shown) != fails(typed.answer):
                        self.wrong.append(shown)
            elif isinstance(step.part, Task):
                yield from self._task(step.part)
            yield ":next"
        yield ":quit"

    def _typed(self, text):
        yield from (line for line in text.splitlines() if line.strip())

    def _task(self, task):
        tries = [("nothing", ""), ("start", task.start.get(self.language)), ("solution", solution(task.name, self.language))]
        for kind, text in tries:
            if text is None:
                continue
            yield from self._typed(text)
            yield ":check"
            self.verdicts[task.name, kind] = task.name in self.progress.solved
            self.progress.solved.discard(task.name)
