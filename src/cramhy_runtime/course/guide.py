"""A student's way through a page in the terminal: which step is shown, and what the commands of ``cramhy learn`` say.

`steps` cuts the page. Nothing here reads lines or evaluates anything: `learn` does.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.typing_names import NamedTuple
from cramhy_runtime.grading import in_session

from . import bodies, checking, contents, files, mistyped, other_packages, rules, shown, slips
from .commands import COMMANDS, WITH_ARGUMENT, command, command_in_form, meant, told_of_open_form
from .parts import Code, File, Task, Text, Typed, text_in
from .progress import Progress
from .reading import PageError, page, pages
from .replay import Replay
from .shown import Style
from .steps import ERROR, MOST, Step, file_shown, session_shown, steps, task_shown

_CALLED = re.compile(r"\(([A-Za-z][^\s()\[\]{}'`\",;:#]*)(?=\s)")
_OF_DEBUGGER = re.compile(r"\d+\] ")
_ASKED = re.compile(r"Write a function `([^`]+)`")
_IN_TEXT = re.compile(r"`([^`]+)`")
_WORD = re.compile(r"(?:[\w-]+[.:]+)*([^\s()\[\]{}'`\",.:;#]+)")
_ATOM = re.compile(r"[^\s()\[\]{}'`\",;:#=]+(?:\s+(?:[^\s()\[\]{}'`\",;:#=]+|\"[^\"]*\"))+")
"""Words without parentheses."""
CHECK_INTERRUPTED = (
    "; The check has not come to its end. If nothing waits in a loop, the turtle's time stands still there: (sleep 0.1) lets it pass."
)
HELP = "; :back goes back, :pages shows all pages, and :help all commands."
"""What is said below the second step of all."""
OVER = "; To see the next step, type :next"

_OUTSIDE = "form not inside a plan."
"""In an error that names the form of the student itself."""
_A_COLON = "a colon stands between a package"
_NOT_STARTED = re.compile(r"No message is there yet|No ROS node runs here")


class Failure(NamedTuple):
    """What the guide is told of an error: its text, whether its place is in a file, and a remark on what the student typed before."""

    told: str
    in_a_file: bool
    led_there: str | None


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
        self._hints: dict[int, int] = {}  # how many hints of a step were shown, by its place
        self._checked = False  # whether the task of this step was checked since the step is shown
        self._begins_anew = False  # whether :type may type the start of a solved task
        self._waiting: list[Typed] = []  # what is still to be typed of this step
        self._read: Typed | None = None  # which of them is being answered
        self._cue: str | None = None
        self._text = ""  # what was typed last
        self._typed: set[str] = set()  # the forms of this page that were typed in this session, squeezed
        self._added: set[str] = set()  # those of them that the text has which was typed last, and none before
        self._defined: set[str] = set()  # the names that were defined in this session
        self._coming = self._by_course = False  # whether :type types the next form, and whether it has typed the one that is answered
        self.replay = Replay(self._typed_before())
        self._arrived()

    def _typed_before(self):
        """The texts that were typed on this page. Who begins the page anew begins them anew."""
        texts = self.progress.typed.setdefault(f"{self.page.name} {self.language}", [])
        if not self.place:
            texts.clear()
        return texts

    @property
    def step(self) -> Step:
        """The step that is shown."""
        return self.steps[self.place]

    def _arrived(self):
        part = self.step.part
        self._waiting = list(getattr(part, self.language)) if isinstance(part, Code) else []
        self._read = self._cue = None
        self._had: set[str] = set()  # what was typed of this step
        self._checked = self._begins_anew = False
        self.progress.page, self.progress.language = self.page.name, self.language
        self.progress.steps[self.page.name] = self.place
        self.progress.keep()

    # -------------------------------------------------------------------------------------------------------------- what is shown

    def greeting(self) -> str:
        """What to show first on the page."""
        if not self.replay.earlier:
            return self.show()
        return "\n".join(
            [self.show(), "; The session is a new one: what you defined on this page before is not there. :replay types it again."]
        )

    def show(self) -> str:
        """The step as text, with what can be typed now."""
        number = contents.NAMES.index(self.page.name) + 1
        head = f"Page {number}, step {self.place + 1} of {len(self.steps)}: {self.page.title}"
        found = [self.style.bold(f"--- {head} ---")]
        found += [shown.text(each, self.style) for each in self.step.texts]
        part = self.step.part
        if isinstance(part, Code):
            found.append(shown.code(session_shown(part, self.language), self.style))
        elif isinstance(part, File):
            found.append(file_shown(getattr(part, self.language)[0], self.step.piece, self.style))
        elif isinstance(part, Task):
            found.append(task_shown(part, self.language, self.style, part.name in self.progress.solved))
        found.append(self._foot())
        return "\n" + "\n\n".join(found)

    def _foot(self):
        part = self.step.part
        if isinstance(part, Task):
            return "; Type your solution, then :check. :hint gives a hint, and :next goes on."
        if isinstance(part, File):
            if not self._is_last_piece():
                return "; :next shows the next part of the file."
            return "; :next writes this file and goes on. Or write it yourself, with an editor."
        if self.place + 1 < len(self.steps):
            if part is None:
                return "; :next shows it." if self.step.texts[-1].rstrip().endswith(":") else "; :next goes on."
            return "; Type what stands behind the prompts, or :type does. :next goes on."
        after = self._after()
        if after is None:
            return self._with_unsolved("; This is the end of the course. :pages shows all pages.")
        return self._with_unsolved(f"; This is the end of the page. :next begins the next one: {page(after).title}.")

    def _is_last_piece(self):
        piece = self.step.piece
        return piece is not None and piece.number == piece.count

    def _with_unsolved(self, told):
        """``told``, and before it how to come to the tasks of this page that are not solved yet."""
        number = contents.NAMES.index(self.page.name) + 1
        unsolved = [
            f"; Not solved yet: {step.part.title} (:page {number} {place})"
            for place, step in enumerate(self.steps, 1)
            if isinstance(step.part, Task) and step.part.name not in self.progress.solved
        ]
        return "\n".join([*unsolved, told])

    def _after(self):
        number = contents.NAMES.index(self.page.name) + 1
        return contents.NAMES[number] if number < len(contents.NAMES) else None

    # -------------------------------------------------------------------------------------------------------------- what is typed

    def typed(self, text: str, behind: str | None = None) -> None:
        """The student has typed ``text``, whole forms. behind: the prompt, where it says which package is meant."""
        self._cue = self._of_words(text) or mistyped.of_form(text, self.language) or rules.of_form(text, self.language)
        if self._in_task() and "prolog" in text:
            self._cue = self._cue or rules.of_predicates(text, checking.predicates(self.step.part.checks))
        self._cue = self._cue or slips.of_line(text, self.language, in_task=self._in_task())
        self._cue = self._cue or bodies.of_form(text, self.language, self._functions() | self._defined, in_task=self._in_task())
        self._by_course, self._coming = self._coming, False
        self._text = text
        here = [form for form, prompt in self._prompts().items() if behind in (None, prompt)]
        self._added = {form for form in map(_squeezed, here) if form in _squeezed(text)} - self._typed
        self._typed |= self._added
        if behind is None or here or not self._prompts():
            self._defined.update(slips.names(text))
        self._read = next((typed for typed in self._waiting if _squeezed(typed.form) == _squeezed(text)), None)
        if self._read is not None and self._read is not self._waiting[0] and _squeezed(text) in self._had:
            self._read = None  # a form that stands twice in the step was typed twice before its second turn

    def _in_task(self):
        return isinstance(self.step.part, Task)

    def _of_words(self, text):
        """What to say of a call without parentheses: words of which the first one is a function of the page; else ``None``."""
        if not _ATOM.fullmatch(text.strip()):
            return None
        first = text.split()[0]
        if not (first in "+-*/" or first.lower() in self._functions()):
            return None
        written = f", as in {slips.EXAMPLE.format(first)}" if self._in_task() and first in "+-*/" else f": ({' '.join(text.split())})"
        return f"; {slips.NAMED[self.language]} took each of these words for a form of its own. A call has parentheses around it{written}"

    def _functions(self):
        """The names, in lower case, that stand behind a parenthesis in the forms of the page up to here."""
        return {name.lower() for text in self._forms() for name in _CALLED.findall(text)}

    def _prompts(self):
        """The forms of the page, each with the prompt behind which the page shows it."""
        parts = [step.part for step in self.steps if isinstance(step.part, Code)]
        return {typed.text: typed.prompt for part in parts for typed in getattr(part, self.language)}

    def _forms(self, among=None):
        """The texts of the forms of this page up to the step that is shown, or of the steps ``among``, each with the number of its step."""
        return {
            typed.text: number
            for number, step in enumerate(self.steps[: self.place + 1] if among is None else among, 1)
            if isinstance(step.part, Code)
            for typed in getattr(step.part, self.language)
            if not _OF_DEBUGGER.match(typed.prompt)
        }

    def _of_missing(self, name):
        """What to say of a name without a meaning; ``None`` if nothing is known of it, or if this task asks for it."""
        told = mistyped.of_name(name, self.language, self._text) or (other_packages.of_name(name) if self.language == "lisp" else None)
        told = told or mistyped.of_text(name if self.language == "hy" else name.lower(), self._text, self._forms())
        if told or (self._in_task() and _asks_for(self.step.part, name)):
            return told
        return _of_task(name, self.page, self.steps) or slips.of_missing(name, *self._untyped(), known=self._words())

    def _untyped(self):
        """The forms of the page up to here that were not typed, the number of the step, and that of the page."""
        forms = [slips.Form(text, step) for text, step in self._forms().items() if _squeezed(text) not in self._typed]
        return forms, self.place + 1, contents.NAMES.index(self.page.name) + 1

    def _words(self):
        """The names that stand in the code of the page, also in that of its texts, but not in what the page shows to fail."""
        found, wrong = [], {typed.form for typed in _all_typed(self.page) if _fails(typed)}
        for part in self.page.parts:
            if isinstance(part, Code):
                found += [typed.form for typed in getattr(part, self.language) if typed.form not in wrong]
            elif isinstance(part, (Task, Text)):
                found += [each for each in _IN_TEXT.findall(text_in(part.markdown, self.language)) if each not in wrong]
                found += [part.start.get(self.language, "")] if isinstance(part, Task) else []
        return _WORD.findall(" ".join(found))

    def of_debugger(self) -> str:
        """What to say when the debugger has opened."""
        more = " You need not read the choices." if self.page.name in contents.NAMES[:3] else ""
        cue, self._cue = self._cue, None
        return "\n".join(filter(None, [cue, f"; q leads back to the prompt.{more}"]))

    def failed(self, missing: str | None = None, error: Failure | None = None) -> None:
        """What was typed last has failed, or was ended by Ctrl-C. missing: the name that was not defined. error: what is known of it."""
        if self.language == "hy" and (missing is not None or (error is not None and _A_COLON in error.told)):
            self._cue = self._cue or other_packages.of_dot(self._text, missing)
        self._cue = self._cue or slips.of_failed_form(self._text, self.language, in_task=self._in_task())
        self._cue = self._cue or mistyped.of_failed_form(self._text, self.language, self.replay.texts)
        if missing is not None:
            self._cue = self._cue or self._of_missing(missing)
        elif error is not None:
            self._cue = self._cue or slips.of_error(error.told, self._text, self.language)
            self._cue = self._cue or mistyped.of_error(error.told, self._text, self.language)
            self._cue = self._cue or slips.of_unready(*self._untyped(), told=error.told)
            if error.in_a_file or _NOT_STARTED.search(error.told):
                self._cue = self._cue or slips.of_unready(*self._untyped()) or (error.led_there if _OUTSIDE not in error.told else None)
        self.replay.failed()
        if self._read is not None and _fails(self._read):  # as it should
            self._cue = None
            self._waiting.remove(self._read)
        elif missing is not None or error is not None:
            self._typed -= self._added
        self._read = None

    def cue(self) -> str | None:
        """What to say before the next prompt, once."""
        if self.replay.was_answered():
            self.progress.keep()
        some = bool(self._waiting)
        if self._read is not None:
            self._waiting.remove(self._read)
            self._had.add(_squeezed(self._read.form))
            self._read = None
        while self._waiting and _OF_DEBUGGER.match(self._waiting[0].prompt):  # it was left in another way than the page shows
            self._waiting.pop(0)
        if some and not self._waiting:
            self._cue = OVER
        elif self._by_course and self._waiting:
            self._cue = self._cue or _left(self._waiting)
        self._by_course = False
        cue, self._cue = self._cue, None
        return cue

    # ------------------------------------------------------------------------------------------------------------------ commands

    def types_into_debugger(self) -> bool:
        """Whether what :type would type now belongs into the debugger, as the page shows."""
        return bool(self._waiting) and _OF_DEBUGGER.match(self._waiting[0].prompt) is not None

    def do(self, name: str, argument: str = "") -> str:
        """Carry out a command, but not ``check``; what to say."""
        return getattr(self, f"_{name}")(*([argument] if name in WITH_ARGUMENT else []))

    def _next(self):
        said = []
        if isinstance(self.step.part, File) and self._is_last_piece():
            said = [self._provide(over=False)]
        elif isinstance(self.step.part, Task) and self.step.part.name not in self.progress.solved:
            why = "The task is not solved yet" if self._checked else "You have not typed :check for this task"
            title = self.step.part.title
            said = [f"; {why}: {title}{'' if title.endswith('?') else '.'} :back leads back to it."]
        elif told := self._passed_over():
            said = [told]
        if self.place + 1 < len(self.steps):
            self.place += 1
            self._arrived()
            return "\n".join([*said, self.show(), *([HELP] if self.place == 1 and self.page.name == contents.NAMES[0] else [])])
        after = self._after()
        if after is None:
            return "\n".join([*said, self._foot()])
        self._leave(after)
        return "\n".join(said)

    def _passed_over(self):
        """What to say of the forms of this step that were not typed; ``None`` if all were."""
        left = [text for text, number in self._forms().items() if number == self.place + 1 and self._is_left(text)]
        if not left:
            return None
        number = contents.NAMES.index(self.page.name) + 1
        told = ", ".join(slips.first_line(text) for text in left[:2]) + (f" and {len(left) - 2} more" if len(left) > 2 else "")
        if not any(slips.is_needed(text) for text in left):
            return f"; Not typed: {told}"
        them = "it" if len(left) == 1 else "them"
        told += "" if told.endswith("...") else "."
        return f"; Not typed: {told} What comes later may need {them}: :page {number} {self.place + 1} leads back."

    def _is_left(self, text):
        return _squeezed(text) not in self._typed and not (slips.names(text) and slips.names(text) <= self._defined)

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
        count = self._hints.get(self.place, 0)
        if count == len(part.hints):
            self._hints[self.place] = 0
            return "; There are no more hints. :hint begins with the first one again."
        self._hints[self.place] = count + 1
        head = self.style.bold(f"Hint {count + 1} of {len(part.hints)}")
        return f"{head}\n\n{shown.text(text_in(part.hints[count], self.language), self.style)}"

    def _type(self):
        part = self.step.part
        if self._waiting:
            self.replay.type(self._waiting[0].text)
            self._coming = True
            return ""
        if isinstance(part, Task):
            if self.language not in part.start:
                return "; A task is for you to type. :hint gives a hint."
            if part.name in self.progress.solved and not self._begins_anew:
                self._begins_anew = True
                return "; This task is solved, and your solution counts. To begin anew, with the form above in its place, type :type again."
            self.replay.type(part.start[self.language].rstrip("\n"))
            return ""
        return "; This step has nothing more to type. :next goes on."

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
            "written": f"; Written: {files.shown(name)}",
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
        return "\n".join([*lines, "; :page 3 goes to page 3, and :page 3 2 to its step 2."])

    def _page(self, argument):
        wanted, _, number = argument.partition(" ")
        found = None
        if wanted.isdecimal() and 1 <= int(wanted) <= len(contents.NAMES):
            found = contents.NAMES[int(wanted) - 1]
        elif wanted in contents.NAMES:
            found = wanted
        if found is None:
            return f"; Which page? Type :page and a number from 1 to {len(contents.NAMES)}. :pages shows them."
        if number:
            count = len(self.steps if found == self.page.name else steps(page(found), self.language))
            if not number.isdecimal() or not 1 <= int(number) <= count:
                return f"; Which step? Page {wanted} has the steps 1 to {count}."
            if found == self.page.name:
                self.place = int(number) - 1
                self._arrived()
                return self.show()
            self.progress.steps[found] = int(number) - 1
        self._leave(found)
        return ""

    def _replay(self):
        count = self.replay.begin()
        return f"; Typed again: {count} text{'s' * (count != 1)}." if count else "; There is nothing to type again."

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
        self._checked = True
        found = checking.check(part.name, language=self.language, evaluate=evaluate)
        if found["passed"]:
            self.progress.solved.add(part.name)
            self.progress.keep()
            return "\n".join([*_filled(found["told"], self.style), OVER])
        more = self._hints.get(self.place, 0) < len(part.hints)
        hint = "; :hint gives a hint." if more else "; :hint shows the hints again."
        missing = in_session.missing_name(found["told"])
        unprepared = self._of_missing(missing) if missing is not None else None
        unprepared = unprepared or _of_error_in_check("\n".join(found["told"][:1]), self.language)
        unprepared = unprepared or slips.of_unprepared(*self._untyped())
        return "\n".join(["Not yet.", *_short(_filled(found["told"], self.style)), *filter(None, [unprepared]), hint])


def _filled(texts, style):
    return [line for text in texts for line in shown.fitted(text, style).split("\n")]


def _short(lines):
    """The lines of a verdict, without their middle if they are so many that the first ones leave the screen."""
    if len(lines) <= MOST:
        return lines
    left = len(lines) - MOST + 1
    return [*lines[: MOST - 5], f"  [... {left} lines more]", *lines[MOST - 5 + left :]]


def _of_error_in_check(told, language):
    """What to say of an error that a check met, if its place in the student's form shows a slip; else ``None``."""
    if "ended with an error" not in told:
        return None
    return slips.of_failed_form(told, language, in_task=True) or mistyped.of_error(told, told, language)


def _left(waiting):
    """What to say of the forms of this step that are left when :type has typed one."""
    count = sum(not _OF_DEBUGGER.match(typed.prompt) for typed in waiting)
    return f"; Left of this step: {count} form{'s' * (count != 1)}. :type types the next one."


def _of_task(name, page, steps):
    """What to say of a name that another task of this page asks for; else ``None``."""
    number = contents.NAMES.index(page.name) + 1
    for place, step in enumerate(steps, 1):
        if isinstance(step.part, Task) and _asks_for(step.part, name):
            shown = name.lower().replace("_", "-")
            return f"; {shown} is the function of another task, {step.part.title}: :page {number} {place} leads to it."
    return None


def _all_typed(page):
    """What is typed on a page, in both languages."""
    return [typed for part in page.parts if isinstance(part, Code) for lines in (part.lisp, part.hy) for typed in lines]


def _asks_for(task, name):
    """Whether a student is to write the function ``name`` for a task."""
    asked = _ASKED.search(task.markdown)
    return asked is not None and asked[1] == name.lower().replace("_", "-")


def _fails(typed):
    """Whether the page shows that a form leads to an error."""
    return any(line.startswith(ERROR) for line in typed.answer.splitlines())


def _squeezed(form):
    """The form without what does not matter: its lines, blanks inside of parentheses at their ends, and case."""
    return re.sub(r"(?<=[(\[]) | (?=[)\]])|(?<=[^\s'`,#@]) (?=[(\[])|(?<=[)\]]) (?=\S)", "", " ".join(form.split())).lower()


__all__ = ["COMMANDS", "Failure", "Guide", "PageError", "command", "command_in_form", "meant", "told_of_open_form"]
