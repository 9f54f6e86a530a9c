"""Common Lisp at a prompt of Hy, after ``(in-package ...)``.

Hy's REPL (`hy.REPL`) has its own loop: it asks for a line (``raw_input``), reads with the reader of its compiler, runs what comes of it,
and prints the value. A REPL that runs is ``_hy_repl`` in its module. `attend` makes it one of a class of `hy_repl.Attended`, so plans go on
while it waits for a line. `enter` gives it a reader that hands over texts as they are (`TypedReader`), and a prompt that shows the package.
A text is then answered by the same `Listener` as in ``roslisp_repl``. ``(in-hy)`` gives it back its own reader.

Hy reads standard input that is no terminal (``hy < FILE``) to its end, compiles it, and runs it. There, what follows ``(in-package ...)``
is given to a `Console`, as if it had been typed into ``roslisp_repl < FILE`` (`answer_piped`).

Time is the wall's at a prompt, and virtual in a pipe; the variable CRAMHY_TIME says otherwise.
"""

from __future__ import annotations

import functools
import io
import re
import sys
import warnings
from contextlib import contextmanager, nullcontext, redirect_stderr

import hy
from hy.models import Expression, Symbol
from hy.reader import HyReader
from hy.reader.exceptions import LexException

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.conses import list_end
from cramhy_runtime.lisp_core.data import NO_VALUES, Cons, MultipleValues, all_values
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import prin1_to_string, speak
from cramhy_runtime.kernel import signals, standard_input
from cramhy_runtime.languages.commonlisp.reader.reader import incomplete
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of, report
from cramhy_runtime.session import time_setting
from cramhy_runtime.languages import answered_texts
from cramhy_runtime.languages.hy import answer_lists, errors, malformed, module_names, patches, program_texts
from cramhy_runtime.languages.hy.lisp_data import package_of
from cramhy_runtime.languages.hy.reader import TypedReader, is_way_back, more_wanted, rest_of_text, source_of

from .console import Console, exit_status
from .history import History, place
from .hy_repl import Attended, REPL, attended
from .line_input import BROKEN_OFF, Lines
from .listener import Listener, at_the_prompt
from .open_forms import OpenForms, of_lisp
from cramhy_runtime.session.session import Interruption, Session

IN_PACKAGE = sym("IN-PACKAGE")
_IN_PACKAGE = Symbol("in-package")
LAST_ERROR = hy.mangle("*e")
"""Where a REPL of Hy keeps, among its ``locals``, the exception that came last."""
_PS2 = "... "
"""Hy's own prompt for a line that goes on with a form."""
PIPED = "<stdin>"
"""What Hy calls the text that it reads from a pipe."""


def session_of_prompt():
    """The session that is there, in a prompt's time from now on, or a new one. A prompt inside of a plan leaves the plan its time."""
    in_a_plan = kernel.active() is not None and not at_the_prompt()
    session = Session.at_hand(time_setting.decide(default=time_setting.PROMPT))
    if not in_a_plan:
        time_setting.time(time_setting.PROMPT)
    return session


# ------------------------------------------------------------------------------------------------------------ what macros ask


def typed(compiler, goes_on):
    """The Hy model that answers a Lisp form which was typed in Hy, at a prompt or in a pipe; ``None`` if it stands in a file.

    compiler: Hy's compiler, which expands the macro that the form is a call of. goes_on: whether the form is ``in-package``, so that the
    rest of the text is Lisp, too. Raises `hy.PrematureEndOfInput` when the rest is not complete.
    """
    reader = HyReader.current_reader(create=False)
    repl = vars(compiler.module).get("_hy_repl")
    if reader is None:
        return None
    if repl is not None:
        if not compiler.filename.startswith(f"{repl.filename}-"):
            prompt_of(repl)  # a file that is run before the prompt comes
            return None
        text = text_of(compiler)
        if goes_on:
            rest = rest_of_text(reader)
            if incomplete(rest):
                raise more_wanted(compiler.source, compiler.filename)
            text += rest
        return hy.models.Expression([hy.read("hy.I.cramhy_runtime/repl/hy_prompt.enter"), hy.models.Symbol("_hy_repl"), text])
    if compiler.filename == PIPED and goes_on:
        text = text_of(compiler) + rest_of_text(reader)
        return hy.models.Expression(
            [hy.read("hy.I.cramhy_runtime/repl/hy_prompt.answer_piped"), text, compiler.source, compiler.module.__name__]
        )
    return None


def text_of(compiler):
    """The text of the macro call that ``compiler`` expands, as it was typed, or as Hy shows it if another macro has made it."""
    call = compiler.this
    text = source_of(call, compiler.source) if call.start_line is not None else ""
    return text if text.lstrip("( ").startswith(str(call[0])) else hy.repr(call).removeprefix("'")


# ---------------------------------------------------------------------------------------------------------- a prompt of Hy's


def _terminal_lines(repl, in_lisp):
    from .hy_lines import HyLines  # it needs readline, which a browser has not

    return HyLines(repl, in_lisp)


def _listen_no_more(warnings):
    """Leave errors and warnings to Hy. warnings: the stream where they went before."""
    speak(lisp=False)
    conditions.install_debugger(None)
    streams.ERROR_OUTPUT.value = warnings


def _show_prompt(repl, prompt):
    repl.ps1 = prompt
    if hasattr(sys, "ps1"):  # the REPL runs
        sys.ps1 = prompt


def _answer_in_hy(repl, text):
    """Let ``repl`` answer ``text``, to which nothing will be added: where it ends inside of a form, that is an error."""
    compiler = repl.compile
    compiler.allow_incomplete, before = False, compiler.allow_incomplete
    try:
        repl.runsource(text, repl.filename)
    finally:
        compiler.allow_incomplete = before


def _forms(repl, source, filename):
    """The texts of the forms of ``source`` that are answered one by one, and whether the REPL then has to refuse ``source``.

    Hy reads ``source`` as a whole where it is one form, where a form says how the next ones are read, and where it has something to
    say about them. What begins with a form that leads to Lisp is one text. Forms before a bracket too many are answered, too.
    """
    found = []
    try:
        for model in hy.read_many(source, filename, repl.compile.compiler.reader):
            if isinstance(model, Expression) and model and model[0] == _IN_PACKAGE:
                lines = source.split("\n")[model.start_line - 1 :]
                found.append("\n".join([lines[0][model.start_column - 1 :], *lines[1:]]))
                if incomplete(found[-1]):
                    return [], True
                break
            found.append(source_of(model, source))
    except LexException as problem:
        return (found, True) if malformed.BRACKET_TOO_MANY.match(problem.msg) else ([], True)
    except Exception:  # of a reader macro of the user's
        return [], True
    return (found, False) if len(found) > 1 else ([], True)


class HyPrompt(Listener):
    """The Lisp of ``repl``, a `hy.REPL`. ``in_lisp``: whether what is typed there is Lisp now. lines: where its lines come from; by default
    the terminal."""

    def __init__(self, repl, session, lines=None):
        super().__init__(session, lines or _terminal_lines(repl, lambda: self.in_lisp))
        self.repl = repl
        self.in_lisp = False
        self._warnings = streams.ERROR_OUTPUT.value
        self._hy = None  # what the REPL was before it became Lisp's: its reader, its prompt, how it shows values
        self._form = None
        self._rest = None  # the text that follows (in-hy)
        speak(lisp=False)

    # ------------------------------------------------------------------------------------------------ to Lisp, and back to Hy

    def change_over(self):
        """Let the REPL read Lisp from its next text on."""
        speak(lisp=True)
        if not self.in_lisp:
            self.in_lisp = True
            compiler = self.repl.compile.compiler
            self._hy = compiler.reader, self.repl.ps1, self.repl.output_fn
            compiler.reader = TypedReader(hy.read("(. _hy_repl lisp hear)"))
            self.repl.output_fn = shown_by_lisp
        _show_prompt(self.repl, self.session.prompt())

    def change_back(self):
        """Let the REPL read Hy from its next text on."""
        if self.in_lisp:
            self.in_lisp = False
            self.repl.compile.compiler.reader, prompt, self.repl.output_fn = self._hy
            _listen_no_more(self._warnings)
            _show_prompt(self.repl, prompt)

    def write(self, text):
        """What Python's console says by itself; from Python 3.13 on also its goodbye, when a signal ends it and the terminal has gone."""
        if not signals.received:
            self.repl.of_hy.write(text)

    def showtraceback(self):
        """As the REPL's own, with the names as Hy writes them."""
        with redirect_stderr(io.StringIO()) as told:
            self.repl.of_hy.showtraceback()
        sys.stderr.write(as_written(told.getvalue()))
        sys.stderr.flush()

    def showsyntaxerror(self, *places, **texts):
        """As the REPL's own. What it is given depends on Python's version."""
        self.repl.of_hy.showsyntaxerror(*places, **texts)

    def leads_away(self, form, reader):
        self._form = form
        if not (self.in_lisp and is_way_back(form)):
            return False
        self._rest = reader.text[reader.offset :]
        return True

    def show(self, values):
        super().show(values)
        if self.level == 0 and isinstance(self._form, Cons) and self._form.car is IN_PACKAGE:
            self.change_over()

    # ---------------------------------------------------------------------------------------------------------------- texts

    def hear(self, text):
        """Evaluate and print the forms of ``text``, which was typed. What follows ``(in-hy)`` in it is Hy's."""
        standard_input_of_terminal()
        streams.CONSOLE_OUTPUT.column = 0
        self.listen()
        try:
            self._respond(text)
        finally:
            if not self.in_lisp:
                _listen_no_more(self._warnings)
        streams.CONSOLE_OUTPUT.fresh_line()
        streams.CONSOLE_OUTPUT.flush()
        if self._rest is not None:
            rest, self._rest = self._rest, None
            self.change_back()
            if rest.strip():
                _answer_in_hy(self.repl, rest.strip())
        elif self.in_lisp:
            self.change_over()  # the package may be another one

    def _respond(self, text):
        interrupted = False
        while True:
            try:
                return self.interrupted() if interrupted else self.respond(text)
            except kernel.Terminated:
                raise
            except (KeyboardInterrupt, kernel.Abandoned, Interruption):
                interrupted = True

    def raw_input(self, prompt=""):
        """The next text for the REPL, in which nothing is open; plans go on while it waits. Ctrl-C forgets the form that is being typed.

        The REPL reads its text anew whenever a line has come, and a form of many lines would take time in proportion to their square.
        """
        if kernel.active() is None:  # somebody has stopped it
            return self.repl.of_hy.raw_input(prompt)
        kernel.interrupt_over()
        if self.in_lisp:
            self.listen()
        lines, opened = [], None
        while True:
            self.input.before = [*self.repl.buffer, *lines]
            line = self.read_line(prompt)
            if line is BROKEN_OFF:
                self.repl.resetbuffer()
                lines, prompt = [], sys.ps1
            elif line is None:
                unfinished = "\n".join(self.input.before)
                self.repl.resetbuffer()
                if not unfinished.strip():
                    self.change_back()  # the program may go on after its REPL
                    raise EOFError
                self.hear(unfinished) if self.in_lisp else _answer_in_hy(self.repl, unfinished)
                lines, prompt = [], sys.ps1
            else:
                if self.in_lisp:
                    streams.CONSOLE_OUTPUT.record(f"{prompt}{line}\n")
                if not lines:
                    opened = of_lisp() if self.in_lisp else OpenForms(hy=True)
                lines.append(line)
                if opened is not None:
                    opened.read(f"{line}\n")
                if opened is None or not opened.something:
                    text = "\n".join(lines)
                    self.remember("\n".join([*self.repl.buffer, text]))
                    return text
                prompt = self.continuation(opened, sys.ps2) if sys.ps2 == _PS2 else sys.ps2

    # ------------------------------------------------------------------------------------------------------- what is Hy's own

    def runsource(self, source, filename="<stdin>", symbol="exec"):
        """As the REPL's own, and each form of ``source`` is answered. Errors that Hy does not count among them are shown, too.

        Hy shows the value of the last form alone, and many forms come at once when a terminal marks what is pasted.
        """
        with self._goes_on():
            forms, refused = ([], True) if self.in_lisp else _forms(self.repl, source, filename)
            while forms and not self.in_lisp:
                if not self._answered(forms.pop(0), filename, symbol)[0]:
                    self.tell_not_evaluated(" ".join(" ".join(forms).split()))
                    break
            else:
                if forms:
                    self.hear("\n".join(forms))
                elif refused:
                    return self._answered(source, filename, symbol)[1]
        return False

    def _answered(self, source, filename, symbol):
        """Let the REPL answer ``source``, and note that, unless Lisp notes it. Whether there was no error, and whether it wants more."""
        lisp = self.in_lisp or source.lstrip().startswith(f"({_IN_PACKAGE}")
        noted = answered_texts.note(source, "hy") if not lisp else None
        errors, good = self.repl.locals.get(LAST_ERROR), False
        try:
            more = self.repl.of_hy.runsource(source, filename, symbol)
            good = self.repl.locals.get(LAST_ERROR) is errors
        finally:
            if noted is not None:
                noted.end(good)
        return good, more

    def runcode(self, code):
        """As the REPL's own, and the errors that Hy does not count among them are shown, too."""
        with self._goes_on(), self.progress.during():
            self.repl.of_hy.runcode(code)
            if self.repl.last_value == NO_VALUES and type(self.repl.last_value) is MultipleValues:  # a function of Lisp has given none
                self.repl.print_last_value = False

    @contextmanager
    def _goes_on(self):
        """What ends the block does not end the REPL: a failure of a plan, a condition of Lisp, an interrupt.

        They are not below Python's ``Exception``, and a REPL of Hy ends at what is not, but for an interrupt while it has its prompt.
        """
        try:
            yield
        except kernel.Terminated:
            raise
        except Condition:
            self.repl.print_last_value = False
            self.repl.showtraceback()
        except (KeyboardInterrupt, kernel.Abandoned):
            self.repl.print_last_value = False
            if hasattr(sys, "ps1"):  # the loop of the prompt tells of it
                raise KeyboardInterrupt from None
            self.repl.write("\nKeyboardInterrupt\n")  # as that does, in a file that is run before the prompt comes

    def complete_code(self, before):
        """What is done with the syntax tree of each text: ``before(statements, expression)``, and what loops and ``finally`` need."""

        def complete(statements, expression):
            if before is not None:
                before(statements, expression)
            if program_texts.was_typed(self.repl.compile.compiler.hy_compiler.filename):
                module_names.complete_at_prompt(statements, self.repl.module)

        return complete

    def shown_in_hy(self, value):
        """The text that the REPL shows for ``value`` in Hy: what is ours as Lisp prints it in the package of the module.

        Objects of Python's classes are shown as Hy shows them, in a list of Lisp, too. Messages look as on the slides.
        """
        if not answer_lists.is_ours(value):
            return hy.repr(value)
        with binding(PACKAGE, package_of(self.repl.module.__name__)):
            text = prin1_to_string(value)
        if text.startswith("#<PYTHON "):
            return hy.repr(value)
        if "#<PYTHON " in text and type(value) is Cons and list_end(value) is None:
            return f"({' '.join(map(self.shown_in_hy, value))})"
        return text


_MANGLED = re.compile(r"\bhyx_\w+")
_LAST_LINE = re.compile(r"^(?:Name|Attribute|Import|Type)Error\b.*", re.M)


def as_written(text):
    """``text``, a traceback, with the names in its last line as the program has them: ``wait-for``, and not ``wait_for``."""

    def unmangled(found):
        return re.sub(r"(?<=')[a-zA-Z]\w*_\w*(?=')", written, found[0])

    def written(name):
        name_in_hy = hy.unmangle(name[0])
        return name_in_hy if name_in_hy in text else name[0]

    return _LAST_LINE.sub(unmangled, _MANGLED.sub(lambda found: hy.unmangle(found[0]), text))


def shown_by_lisp(value):
    """The text that Hy's REPL shows for ``value``, the last of a file that is run before the prompt comes."""
    streams.CONSOLE_OUTPUT.fresh_line()
    streams.CONSOLE_OUTPUT.flush()
    return "\n".join(map(prin1_to_string, all_values(value)))


def standard_input_of_terminal():
    """Let the wait for a line of the terminal be one that can be woken."""
    if sys.stdin is not None and sys.stdin.isatty():
        standard_input.install()


def prompt_of(repl):
    """The `HyPrompt` of ``repl``."""
    attend(repl)
    return repl.lisp


def attend(repl, session=None, kind=HyPrompt):
    """Let the plans of ``session`` go on while ``repl`` waits for a line, and let Ctrl-C end them and not the REPL.

    session: a `Session`; by default the one that is there, or a new one in wall time. kind: the class of the prompt.
    """
    if getattr(repl, "lisp", None) is None:
        if not isinstance(repl, Attended):
            patches.change_class(repl, attended(type(repl)))
        repl.lisp = kind(repl, session or session_of_prompt())
        if repl.output_fn is hy.repr:  # and not what the user has chosen
            repl.output_fn = repl.lisp.shown_in_hy
        compiler = repl.compile.compiler
        compiler.ast_callback = repl.lisp.complete_code(compiler.ast_callback)


def enter(repl, text):
    """Answer ``text``, a Lisp form typed in Hy and what follows it. Lisp stays if it goes into a package."""
    prompt_of(repl).hear(text)


def go_on_in_lisp(repl):
    """A file that is run before the prompt comes has gone into a package: so does the prompt."""
    prompt_of(repl).change_over()


def go_on_in_hy(repl):
    """A file that is run before the prompt comes has gone back to Hy."""
    prompt_of(repl).change_back()


def run(make_session, banner=None, kind=HyPrompt, farewell=None):
    """``cramhy repl --hy``: a REPL of Hy with the macros of the plan language. Returns the exit status.

    banner: the lines to begin with, or ``None`` for Hy's. kind: the class of the prompt. farewell: what is said at the end, or ``None``.
    """
    try:
        session = make_session()
    except (Exception, Condition) as problem:
        report(condition_of(problem))
        return 1
    try:
        return _repl_of(session, kind, functools.partial(_interact, farewell=farewell), banner).run()
    except SystemExit as leaving:
        return exit_status(leaving)
    finally:
        conditions.install_debugger(None)
        kernel.stop()


def converse(session, lines, text="", begun=lambda repl: None):
    """Answer what ``lines`` brings at a prompt of Hy in ``session``, until their end. Raises SystemExit when the user leaves.

    text: Hy that is answered first. begun: called with the `hy.REPL` before its first prompt.
    """
    repl = _repl_of(session, functools.partial(HyPrompt, lines=lines), banner="")
    begun(repl)
    if text:
        _answer_in_hy(repl, text)
    repl.run()


def _repl_of(session, kind=HyPrompt, interact=None, banner=None):
    """A `hy.REPL` with the macros of the plan language. interact: its loop, a function of the REPL and the banner; by default its own."""
    warnings.filterwarnings("ignore", ".*perhaps you missed a comma", SyntaxWarning)  # Hy has none
    repl = REPL(banner)
    attend(repl, session, kind)
    repl.runsource("(require cramhy *)")
    repl.loop = interact
    return repl


def _interact(repl, banner, farewell=None):
    """The loop of ``repl``. What is typed is kept in our file. That of Hy's prompts has what was typed in the session that ended last.

    Errors are told in our words from the first one on: Hy has put a hook of its own there before its loop begins.
    """
    errors.install()
    with repl.lisp.input.keep(History(place("hy-history"))) if "readline" in sys.modules else nullcontext():
        repl.of_hy.interact(banner, farewell)


# --------------------------------------------------------------------------------------------------------------------- a pipe


class PipedLines(Lines):
    """The lines of standard input, which is a text that is there already."""

    def wait(self, prompt):
        sys.stdout.write(prompt)
        sys.stdout.flush()
        streams.CONSOLE_OUTPUT.column = 0
        line = sys.stdin.readline()
        return line.rstrip("\n") if line else None


class PipedConsole(Console):
    """A `Console` that ends at ``(in-hy)``. ``rest``: what follows that in its text."""

    rest = None

    def leads_away(self, form, reader):
        if is_way_back(form):
            self.rest = reader.text[reader.offset :]
        return self.rest is not None

    def over(self):
        return self.rest is not None


def answer_piped(text, source, module):
    """Answer ``text``, the rest of ``source``, as ``roslisp_repl < FILE`` does. What follows ``(in-hy)`` in it is Hy.

    module: the name of the module that the Hy belongs to.
    """
    sys.stdin = io.StringIO(text)
    console = PipedConsole(lambda: None, PipedLines())
    console.session = Session.at_hand(time_setting.decide())
    warnings = streams.ERROR_OUTPUT.value
    try:
        with console.listening():
            console.converse()
    finally:
        streams.ERROR_OUTPUT.value = warnings
    if console.rest is not None:
        rest = f"{console.rest}\n{sys.stdin.read()}".rstrip("\n")
        before = source.rstrip("\n").removesuffix(rest)
        malformed.evaluate(re.sub(r"[^\n]", " ", before) + rest, PIPED, sys.modules[module])
