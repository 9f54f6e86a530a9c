"""A student's way through a page in the terminal: which step is shown, and what the commands of ``cramhy learn`` say.

A step is some text, and then code to type, a file or a task. Nothing here reads lines or evaluates anything: `learn` does.
"""

from __future__ import annotations

import difflib
from typing import NamedTuple

from . import checking, contents, files, shown
from .parts import Code, File, Page, Task, Text, text_in
from .progress import Progress
from .reading import PageError, page, pages
from .shown import Style

COMMANDS = {
    "next": ("n", "the next step, or the next page"),
    "back": ("b", "the step before"),
    "again": ("a", "this step, shown again"),
    "hint": ("h", "the next hint for the task"),
    "check": ("c", "look whether the task is solved"),
    "write": ("w", "write the file of this step, over one of your own, too"),
    "pages": ("p", "all pages, and what you have solved"),
    "page": ("", "go to a page, by its number: :page 3"),
    "help": ("?", "this list"),
    "quit": ("q", "leave; cramhy learn goes on here"),
}
"""The commands: the short name of each, and what it does."""
_SHORT = {short: name for name, (short, _) in COMMANDS.items() if short}
WITH_ARGUMENT = ("page",)
OVER = "; To see the next step, type :next"


class Step(NamedTuple):
    """What is shown at once: texts (Markdown), and then perhaps a part to do something with."""

    texts: tuple[str, ...]
    part: Code | File | Task | None


def steps(wanted: Page, language: str) -> list[Step]:
    """The steps of a page for those who learn in ``language``. Code and files of the other language are left out, or only shown."""
    found, texts = [], []
    for part in wanted.parts:
        if isinstance(part, Text):
            texts += filter(None, [text_in(part.markdown, language)])
        elif isinstance(part, Task) or getattr(part, language):
            found.append(Step(tuple(texts), part))
            texts = []
        elif isinstance(part, Code):
            block = "".join(f"{typed.prompt}{typed.form}\n{typed.answer}" for typed in part.lisp or part.hy)
            texts.append(f"```\n{block}```")
    if texts or not found:
        found.append(Step(tuple(texts), None))
    return found


def command(line: str) -> tuple[str, str] | None:
    """(name, argument) of the command that a line is, with or without the colon in front; ``None`` if it is none."""
    words = line.strip().lower().split()
    if not 1 <= len(words) <= 2:
        return None
    word = words[0].removeprefix(":")
    name = word if word in COMMANDS else _SHORT.get(word) if words[0].startswith(":") else None
    if name is None or (len(words) == 2) != (name in WITH_ARGUMENT):
        return (name, "") if name in WITH_ARGUMENT and words[0].startswith(":") else None
    return name, words[1] if len(words) == 2 else ""


def meant(line: str) -> str | None:
    """What to say of a line with one word and a colon in front that is almost a command; ``None`` for any other line."""
    word = line.strip().lower()
    if not word.startswith(":") or len(word.split()) != 1:
        return None
    near = difflib.get_close_matches(word[1:], COMMANDS, 1, 0.65)
    return f"; There is no command {word}. Did you mean :{near[0]}?" if near else None


class Guide:
    """The way through the page ``name`` in ``language``, "lisp" or "hy".

    ``leaves_for``: the name of the page to which a command leads, or ``None``. ``over``: whether this page is to be left.
    """

    def __init__(self, name: str, language: str, progress: Progress, style: Style):
        self.page, self.language, self.progress, self.style = page(name), language, progress, style
        self.steps = steps(self.page, language)
        self.place = min(progress.steps.get(name, 0), len(self.steps) - 1)
        self.leaves_for: str | None = None
        self.over = False
        self.hints = 0
        self._waiting: list[str] = []  # what is still to be typed of this step
        self._cue: str | None = None
        self._arrived()

    @property
    def step(self) -> Step:
        """The step that is shown."""
        return self.steps[self.place]

    def _arrived(self):
        self.hints = 0
        part = self.step.part
        self._waiting = [_squeezed(typed.form) for typed in getattr(part, self.language)] if isinstance(part, Code) else []
        self._cue = None
        self.progress.page = self.page.name
        self.progress.steps[self.page.name] = self.place
        self.progress.keep()

    # -------------------------------------------------------------------------------------------------------------- what is shown

    def show(self) -> str:
        """The step as text, with what can be typed now."""
        number = contents.NAMES.index(self.page.name) + 1
        head = f"Page {number}, step {self.place + 1} of {len(self.steps)}: {self.page.title}"
        found = ["", self.style.bold(f"--- {head} ---")]
        found += [shown.text(each, self.style) for each in self.step.texts]
        part = self.step.part
        if isinstance(part, Code):
            typed = getattr(part, self.language)
            found.append(shown.code("".join(f"{each.prompt}{each.form}\n{each.answer}" for each in typed), self.style))
        elif isinstance(part, File):
            found.append(self._file(*getattr(part, self.language)))
        elif isinstance(part, Task):
            found.append(self._task(part))
        found.append(self._foot())
        return "\n\n".join(found)

    def _file(self, name, text):
        return f"{self.style.bold(f'The file {name}')}\n\n{shown.code(text, self.style)}"

    def _task(self, task):
        solved = " (solved)" if task.name in self.progress.solved else ""
        found = [self.style.bold(f"Task: {task.title}{solved}"), shown.text(text_in(task.markdown, self.language), self.style)]
        if self.language in task.start:
            found += ["Begin with this, and change it:", shown.code(task.start[self.language], self.style)]
        return "\n\n".join(found)

    def _foot(self):
        part = self.step.part
        if isinstance(part, Task):
            return "; Type your solution at the prompt. Then type :check, or :hint for a hint. :next goes on."
        if isinstance(part, File):
            return "; :next writes this file and goes on. You can also write it yourself, with an editor."
        if self.place + 1 < len(self.steps):
            return "; Type what stands behind the prompts. :next goes on, and :help shows all commands."
        after = self._after()
        if after is None:
            return "; This is the end of the course. :pages shows all pages."
        return f"; This is the end of the page. :next begins the next one: {page(after).title}."

    def _after(self):
        number = contents.NAMES.index(self.page.name) + 1
        return contents.NAMES[number] if number < len(contents.NAMES) else None

    # -------------------------------------------------------------------------------------------------------------- what is typed

    def typed(self, text: str) -> None:
        """The student has typed ``text``, whole forms."""
        if not self._waiting:
            return
        squeezed = _squeezed(text)
        if squeezed in self._waiting:
            self._waiting.remove(squeezed)
            if not self._waiting:
                self._cue = OVER

    def cue(self) -> str | None:
        """What to say before the next prompt, once."""
        cue, self._cue = self._cue, None
        return cue

    # ------------------------------------------------------------------------------------------------------------------ commands

    def do(self, name: str, argument: str = "") -> str:
        """Carry out a command, but not ``check``; what to say."""
        return getattr(self, f"_{name}")(*([argument] if name in WITH_ARGUMENT else []))

    def _next(self):
        said = []
        if isinstance(self.step.part, File):
            said = [self._provide(over=False)]
        if self.place + 1 < len(self.steps):
            self.place += 1
            self._arrived()
            return "\n".join([*said, self.show()])
        after = self._after()
        if after is None:
            return "\n".join([*said, self._foot()])
        self._leave(after)
        return "\n".join(said)

    def _back(self):
        if self.place:
            self.place -= 1
            self._arrived()
            return self.show()
        number = contents.NAMES.index(self.page.name)
        if not number:
            return "; This is the first step of the first page."
        self._leave(contents.NAMES[number - 1])
        return ""

    def _again(self):
        return self.show()

    def _hint(self):
        part = self.step.part
        if not isinstance(part, Task):
            return "; Only tasks have hints, and this step is not one. :next goes on."
        if self.hints == len(part.hints):
            self.hints = 0
            return "; There are no more hints. :hint begins with the first one again."
        self.hints += 1
        head = self.style.bold(f"Hint {self.hints} of {len(part.hints)}")
        return f"{head}\n\n{shown.text(text_in(part.hints[self.hints - 1], self.language), self.style)}"

    def _write(self):
        if not isinstance(self.step.part, File):
            return "; This step has no file to write."
        return self._provide(over=True)

    def _provide(self, over):
        name, text = getattr(self.step.part, self.language)
        try:
            done = files.provide(name, text, over)
        except OSError as problem:
            return f"; {name} cannot be written: {problem.strerror}."
        return {
            "written": f"; Written: {name}",
            "there": f"; {name} is there already, as it is shown.",
            "other": f"; {name} is there already, with a text of your own. It stays. :write replaces it, and keeps yours as {name}.old.",
        }[done]

    def _pages(self):
        lines = []
        for number, each in enumerate(pages(), 1):
            mark = "->" if each is self.page else "  "
            tasks = each.tasks
            solved = sum(task.name in self.progress.solved for task in tasks)
            lines.append(f" {mark} {number:2}  {each.title:48} {f'{solved} of {len(tasks)} tasks solved' if tasks else ''}".rstrip())
        return "\n".join([*lines, "; :page 3 goes to page 3."])

    def _page(self, argument):
        found = None
        if argument.isdigit() and 1 <= int(argument) <= len(contents.NAMES):
            found = contents.NAMES[int(argument) - 1]
        elif argument in contents.NAMES:
            found = argument
        if found is None:
            return f"; Which page? Type :page and a number from 1 to {len(contents.NAMES)}. :pages shows them."
        self._leave(found)
        return ""

    def _help(self):
        lines = [f"  :{name:7} {f':{short}' if short else '':4} {told}" for name, (short, told) in COMMANDS.items()]
        return "\n".join(
            ["Type forms, as at every prompt, or one of these commands:", *lines, "; (help) shows what else the prompt understands."]
        )

    def _quit(self):
        self.over = True
        return ""

    def _leave(self, name):
        self.over, self.leaves_for = True, name

    # --------------------------------------------------------------------------------------------------------------------- tasks

    def check(self, evaluate) -> str:
        """Check the task of this step; what to say. evaluate: as of `checking.check`."""
        part = self.step.part
        if not isinstance(part, Task):
            return "; Only tasks are checked, and this step is not one. :next goes on."
        found = checking.check(part.name, language=self.language, evaluate=evaluate)
        if found["passed"]:
            self.progress.solved.add(part.name)
            self.progress.keep()
            return "\n".join([*found["told"], OVER])
        hint = "; :hint gives a hint." if self.hints < len(part.hints) else "; :hint shows the hints again."
        return "\n".join(["Not yet.", *found["told"], hint])


def _squeezed(form):
    return " ".join(form.split()).lower()


__all__ = ["command", "COMMANDS", "Guide", "meant", "PageError", "Step", "steps"]
