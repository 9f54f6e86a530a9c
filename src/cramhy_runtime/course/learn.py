"""``cramhy learn``: the course in the terminal. The prompt is that of ``roslisp_repl`` or ``cramhy repl --hy``, with a few commands more.

Each page has an image of its own, so what was defined on one page is not there on another, and answers come as the page shows them. The
commands begin with a colon. The lines that are typed go by `Guided.read_line`, which carries commands out and lets all others pass.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
from pathlib import Path

import hy

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import source_places
from cramhy_runtime.lisp_core.condition_types import UnboundVariable, UndefinedFunction
from cramhy_runtime.lisp_core.conditions import guarded
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.advice import explanation
from cramhy_runtime.repl import hy_prompt, prompt_words
from cramhy_runtime.repl.console import Console
from cramhy_runtime.repl.line_input import BROKEN_OFF, Lines
from cramhy_runtime.repl.listener import Listener, at_the_prompt
from cramhy_runtime.session import Image
from cramhy_runtime.session.session import Interruption

from . import asked, contents, files, guide, slips
from .checking import hy_evaluator, lisp_evaluator
from .guide import Failure, Guide
from .progress import Progress
from .reading import PageError
from .shown import Style, filled, fitted

if TYPE_CHECKING:
    from collections.abc import Callable

    from cramhy_runtime.session.session import Session

LEADS_AWAY = ("next", "back", "page", "replay", "check")
"""Commands that wait until the debugger is left: a form typed there belongs to it."""
FOLDER = "cramhy-course"
"""The folder for files of the student, below the one where ``cramhy learn`` was typed."""
_PROMPT = re.compile(r"\s*(?:[A-Z][A-Z-]*> |=> )")


class Guided(Listener):
    """A listener with a guide, which carries out the commands among the lines."""

    guide: Guide
    _greeted = False
    _answered_there: bool | None = None  # whether a form was answered in the debugger that is open; ``False``: and that was told

    def read_line(self, prompt: str) -> Any:
        """The next line that is not a command; ``None`` when the page is left."""
        if not self._greeted:
            self._greeted = True
            if isinstance(self.input, Lines):
                self.input.heed = self._heed
            self.tell(self.guide.greeting())
        if self.failed():
            self.guide.failed(*self.failure())
        while not self.guide.over:
            if self._begins() and not self.level and (cue := self.guide.cue()):
                self.tell(cue)
            if self._begins() and self.level and self._answered_there:
                self.tell("; You are in the debugger still. q leads back to the prompt.")
                self._answered_there = False
            line = self.guide.replay.line()
            if line is not None:
                streams.CONSOLE_OUTPUT.write(f"{prompt}{line}\n")
                return line
            line = super().read_line(prompt)
            if line is None or line is BROKEN_OFF:
                return line
            if not self._begins():
                told, forget = self._heed([*self.input.before, line])
                if told:
                    self.say(told)
                if forget:
                    continue
                return line
            line = _PROMPT.sub("", line, count=1)  # copied from the page with what stands before it
            found = guide.command(line)
            if found is not None and (line.lstrip().startswith(":") or not self.is_variable(line.split()[0])):
                self._carry_out(line, *found)
            elif not self.level and (told := guide.meant(line)):
                self.tell(told)
            else:
                return line
        return None

    def tell(self, text: str) -> None:
        """Say ``text`` of the guide's, with its remarks filled to the width of the terminal."""
        self.say(self._filled(text))

    def _filled(self, text):
        return "\n".join(filled(line, self.guide.style) if line.startswith("; ") else line for line in text.split("\n"))

    def _heed(self, lines):
        """What to say of the lines of a form that is open, or ``None``, and whether the last one is a command and no part of it."""
        told = guide.told_of_open_form(lines, "lisp" if self.reads_lisp() else "hy")
        return (self._filled(told) if told else None), guide.command_in_form(lines[-1]) is not None

    def _begins(self):
        """Whether the line that is read begins a form."""
        return not getattr(self.input, "before", ())

    def _carry_out(self, line, name, argument):
        if isinstance(self.input, Lines):
            self.input.remember(line.strip())
        try:
            if self.ctrl_c_came():
                kernel.interrupt()
            if self.level and (name in LEADS_AWAY or name == "type" and not self.guide.types_into_debugger()):
                self.tell(f"; The debugger is open. Type q first, and then :{name}.")
            elif name != "check":
                if told := self.guide.do(name, argument):
                    self.tell(told)
            elif not at_the_prompt():
                self.tell("; The debugger of a plan is open. Leave it first: type q. Then check.")
            else:
                self.tell(self.guide.check(self.evaluator()))
        except kernel.Terminated:
            raise
        except (KeyboardInterrupt, kernel.Abandoned, Interruption):
            self.interrupted()
            if name == "check":
                self.tell(guide.CHECK_INTERRUPTED)

    def remember(self, text: str) -> None:
        super().remember(text)
        if not self.level:
            self.guide.replay.was_read(text)
        elif self._answered_there is None:
            self._answered_there = True
        self.guide.typed(text, self.prompt_of_text())

    def prompt_of_text(self) -> str | None:
        """The prompt behind which the text was typed, if it says of which package the names in it are."""
        return None

    def announce(self, condition: Any, restarts: list[Any]) -> None:
        self.guide.failed(_name_of(condition), _failure(condition))
        super().announce(condition, restarts)
        self.tell(self.guide.of_debugger())
        self._answered_there = None

    def dialogue(self, condition: Any, restarts: list[Any]) -> Any:
        """As of the prompt. A choice that wants a value asks for it in the words of the course."""
        with asked.by(self, super().read_line):
            return super().dialogue(condition, restarts)

    def choices(self, restarts: list[Any]) -> list[str]:
        """Those of the innermost error. The choices of errors before it were shown with them; they keep their numbers of now."""
        own = next((number for number, restart in enumerate(restarts, 1) if symbol_name(restart.name) == "ABORT"), len(restarts))
        if not self.level or own == len(restarts):
            return super().choices(restarts)
        return [*super().choices(restarts[:own]), f"  {own} and more: the choices of the errors before"]

    def forget_interrupt(self) -> None:
        self.guide.failed()
        super().forget_interrupt()

    def failed(self) -> bool:
        """Whether the text that was read last has failed without a debugger."""
        return False

    def failure(self) -> tuple[str | None, Failure | None]:
        """Of the text that was read last and has failed: the name whose value it has not found, and what else is known of the error."""
        return None, None

    def evaluator(self) -> Callable[[str], list[Any]]:
        """The function by which a check evaluates texts."""
        raise NotImplementedError

    def is_variable(self, word: str) -> bool:
        """Whether the student has given the word a value, so that it is not a command."""
        raise NotImplementedError

    def reads_lisp(self) -> bool:
        """Whether what is typed is Lisp now."""
        return True


class LispPrompt(Guided, Console):
    """The prompt of Common Lisp."""

    def over(self) -> bool:
        return self.guide.over

    def explained(self, condition):
        return fitted(slips.in_words_of_lisp(super().explained(condition)), self.guide.style)

    def prompt_of_text(self):
        return None if self.level else self.session.prompt()

    def evaluator(self):
        return lisp_evaluator(self.session)

    def is_variable(self, word):
        return prompt_words.word(word, (word.lower(),)) is None


class HyPrompt(Guided, hy_prompt.HyPrompt):
    """The prompt of Hy. After ``(in-package ...)`` it is one of Lisp, where tasks are checked in Lisp's words."""

    _error: Exception | None = None

    def evaluator(self):
        return lisp_evaluator(self.session) if self.in_lisp else hy_evaluator(self.repl.module)

    def is_variable(self, word):
        return word in self.repl.locals

    def reads_lisp(self):
        return self.in_lisp

    def runcode(self, code):
        try:
            super().runcode(code)
        except KeyboardInterrupt:
            self.guide.failed()
            raise

    def showtraceback(self):
        with _in_words_of_pages(self.guide.style):
            super().showtraceback()

    def showsyntaxerror(self, *places, **texts):
        with _in_words_of_pages(self.guide.style):
            super().showsyntaxerror(*places, **texts)

    def failed(self):
        before, self._error = self._error, self.repl.locals.get(hy_prompt.LAST_ERROR)
        return self._error is not before

    def failure(self):
        return _name_of(self._error), _failure(self._error)


@contextlib.contextmanager
def _in_words_of_pages(style):
    """What the block prints of an error of Hy is shown in the words of the pages, in lines that fit the terminal."""
    with contextlib.redirect_stderr(io.StringIO()) as told:
        yield
    sys.stderr.write(fitted(slips.in_words_of_hy(told.getvalue()), style))
    sys.stderr.flush()


def _name_of(error: Any) -> str | None:
    """The name that an error says not to be defined, as Lisp and Hy write it; ``None`` for other errors."""
    if isinstance(error, NameError):
        return hy.unmangle(error.name) if error.name else None
    return symbol_name(error.name) if isinstance(error, (UnboundVariable, UndefinedFunction)) and is_symbol(error.name) else None


def _failure(error: Any) -> Failure:
    """What the guide is told of ``error``, which is being shown."""
    place = getattr(error, "position", None) or source_places.exception_position(error)
    led = source_places.typed_position(error, sys._getframe(1))
    line = source_places.excerpt(led).splitlines()
    return Failure(
        guarded(lambda: explanation(from_python(error)), lambda problem: ""),
        place is not None and not source_places.is_typed(place[0]),
        f"; In what you have typed, this leads there: {line[0].strip()}" if line else None,
    )


def run(
    make_session: Callable[[contextlib.ExitStack], Session],
    language: str | None = None,
    page: str | None = None,
    top: Path | None = None,
    progress: Progress | None = None,
    style: Style | None = None,
    lines: Lines | None = None,
) -> int:
    """Go through the course from a page on, until the student leaves. Returns the exit status.

    make_session: makes the session of a page; it gets a stack that is closed when the page is left. language: "lisp" or "hy"; ``None``:
    that of the last time, at first Lisp. page: the name of the first page, ``None``: the one that was shown last. top: the folder for
    files of the student. progress, style: by default those of the user and of the terminal. lines: where lines come from, by default from
    standard input. Raises `PageError` if there is no such page, or if the folder cannot be used.
    """
    progress, style = progress or Progress.kept(), style or Style.of_terminal()
    language = language or progress.language or "lisp"
    name = page or (progress.page if progress.page in contents.NAMES else None) or contents.NAMES[0]
    top = _absolute(top or Path(FOLDER))
    status = 0
    while name is not None and not status:
        way = Guide(name, language, progress, style)
        with Image(), contextlib.ExitStack() as closings:
            closings.enter_context(_warnings_filled(style.width))
            closings.enter_context(_in_work_folder(way, top))
            status = _go(way, lambda closings=closings, page=way.page: _session_for(page, make_session(closings)), lines)
        name = way.leaves_for
    return status


def _absolute(folder):
    try:
        return folder.absolute()
    except FileNotFoundError:
        raise PageError("The folder in which you are is not there any more. Go to another one, and begin again: cd") from None


@contextlib.contextmanager
def _warnings_filled(width):
    """During the block warnings are filled to so many columns."""
    stream = streams.CONSOLE_OUTPUT
    before, stream.filled_to = stream.filled_to, width
    try:
        yield
    finally:
        stream.filled_to = before


def _session_for(page, session):
    files.choose_package(page)
    return session


def _go(way, make_session, lines):
    if way.language == "hy":

        class OfPage(HyPrompt):
            guide = way

            def __init__(self, repl, session):
                super().__init__(repl, session)
                self.input = lines or self.input
                self.failed()  # an error of the page before is not one of this page

        sys.modules.pop("__console__", None)  # in which Hy's prompt of the page before has evaluated
        return hy_prompt.run(make_session, "", kind=OfPage, farewell="")
    prompt = LispPrompt(make_session, lines)
    prompt.guide = way
    return prompt.run()


@contextlib.contextmanager
def _in_work_folder(way, top):
    """Let the current folder be that of the page, with the files of earlier pages. Modules of Python in it are forgotten afterwards."""
    before = str(_absolute(Path()))
    try:
        place = files.work_folder(way.page, way.language, top)
        if place is not None:
            os.chdir(place)
            files.provide_earlier(way.page, way.language)
    except OSError as problem:
        os.chdir(before)
        raise PageError(
            f"The folder {top} for the files of the course cannot be used ({problem.filename}: {problem.strerror}). Name another one: "
            "cramhy learn --folder FOLDER"
        )
    if place is None:
        yield
        return
    sys.path.insert(0, str(place))
    packages = {each.name for each in place.iterdir() if each.is_dir()}
    others = _modules(lambda name, module: name.partition(".")[0] in packages)  # of these names from elsewhere, say a program's
    for name in others:
        del sys.modules[name]
    try:
        yield
    finally:
        os.chdir(before)
        sys.path.remove(str(place))
        for name in _modules(lambda name, module: _stands_in(module, place)):
            del sys.modules[name]
        sys.modules.update(others)


def _modules(wanted):
    return {name: module for name, module in list(sys.modules.items()) if wanted(name, module)}


def _stands_in(module, place):
    places = [getattr(module, "__file__", None), *getattr(module, "__path__", [])]
    return any(str(each).startswith(f"{place}{os.sep}") for each in places)
