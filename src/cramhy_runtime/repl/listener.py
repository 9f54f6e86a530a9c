"""What a prompt of Lisp does with the texts that are typed at it: evaluate them, show their values, open the debugger.

It has no loop of its own. `Console` (``console.py``) asks it for one text after the other; a REPL of Hy (``hy_prompt.py``) has its own
loop, and gives it the texts that Hy has read. So both answer, and both fail, in the same words.

The prompt shows the package, values come one a line, ``; No value`` where there are none. An error opens the debugger *before*
anything unwinds: it shows what happened, where, what to try, and the restarts by number; forms can be evaluated there. Ctrl-C
ends the running form through its cleanup.
"""

from __future__ import annotations

import re
import sys
from contextlib import contextmanager, nullcontext

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime import kernel
from cramhy_runtime.cpl import current_task
from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.languages.commonlisp.printer.printing_support import with_readable_input
from cramhy_runtime.languages.commonlisp.streams import streams
from cramhy_runtime.languages.commonlisp.tools import backtrace
from cramhy_runtime.languages.commonlisp.tools.advice import explanation, typed_meanwhile
from cramhy_runtime.languages.commonlisp.tools.describing import describe
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of, condition_type
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.packages import sym, symbol_name
from cramhy_runtime.lisp_core.printing import report_of, speak
from cramhy_runtime.lisp_core.source_places import circumstance

from . import commands, prompt_words
from .line_input import BROKEN_OFF, Lines
from .open_forms import of_lisp
from .progress import Progress
from cramhy_runtime.session.boot import boot
from cramhy_runtime.session.session import Interruption, leave, signalled_here, value_text


ABORT = sym("ABORT")
MOST_TOLD = 300
"""Characters that are shown of a text that was not evaluated."""


def at_the_prompt():
    """Whether the task that runs is the one that reads and evaluates forms."""
    return kernel.current() is kernel.active().main


_TOKEN = late_pattern(r"""#?\\.|;[^\n]*|"(?:\\.|[^"\\])*"?|\|[^|]*\|?|[()]""", re.S)


def rest_of(reader, begun=None):
    """The forms that ``reader`` has not read of its text, in one line. begun: where a form begins that could not be read."""
    text, depth = reader.text, 0
    for token in _TOKEN.finditer(text, begun) if begun is not None else ():
        if depth == 0 and token.start() >= reader.offset:
            break  # it is no list
        depth += {"(": 1, ")": -1}.get(token[0], 0)
        if depth == 0 and token[0] == ")" and token.end() > reader.offset:
            reader.offset = token.end()
            break
    reader.skip_blank()
    return " ".join(text[reader.offset :].split())


def tell_interrupted():
    """Tell that Ctrl-C ended a form."""
    streams.CONSOLE_OUTPUT.fresh_line()
    streams.CONSOLE_OUTPUT.write("; Interrupted.\n")
    streams.CONSOLE_OUTPUT.flush()


class Listener:
    """Answers the texts of a ``session``. ``input``: the `Lines` that the debugger reads."""

    def __init__(self, session=None, lines=None):
        self.session = session
        self.input = lines
        self.level = 0
        self.progress = Progress()
        self.behind = str  # a function that gives what stands behind the form that is evaluated, in its text

    @contextmanager
    def listening(self):
        """While the block runs, errors open our debugger, and warnings belong to the transcript."""
        self.listen()
        try:
            yield
        finally:
            conditions.install_debugger(None)

    def listen(self):
        speak(lisp=True)
        conditions.install_debugger(self.debug)
        streams.ERROR_OUTPUT.value = streams.CONSOLE_OUTPUT

    def leads_away(self, form, reader):
        """Whether ``form``, read at the prompt, ends the Lisp of it. ``reader``: stands behind the form."""
        return False

    # ------------------------------------------------------------------------------------------------------------- reading

    def read_text(self, prompt):
        """Lines until they make whole forms; ``None`` at the end of input. Ctrl-C forgets a form that is being typed."""
        from cramhy_runtime.languages.commonlisp.reader.reader import incomplete

        lines, opened = [], None
        while True:
            self.input.before = lines
            line = self.read_line(prompt if not lines else self.continuation(opened))
            if line is BROKEN_OFF:
                lines = []
                continue
            if line is None:
                return "\n".join(lines) if lines else None
            boot()  # the prompt does without what forms need
            streams.CONSOLE_OUTPUT.record(f"{'' if lines else prompt}{line}\n")
            if not lines:
                opened = of_lisp()
            lines.append(line)
            if opened is not None:
                opened.read(f"{line}\n")
            if opened is None or not opened.something:
                text = "\n".join(lines)
                if not text.strip():
                    lines = []
                    continue
                if not incomplete(text):
                    self.remember(text)
                    return text
            if self.ctrl_c_came():
                lines = []
                streams.CONSOLE_OUTPUT.write("\n")

    def continuation(self, opened, otherwise=""):
        """The prompt of a line that goes on with a form: what is open, on a terminal that somebody looks at. Else it is ``otherwise``.

        opened: the `OpenForms` of the lines before, or ``None`` where nobody knows.
        """
        if not getattr(self.input, "shows_open", False):
            return otherwise
        return "... " if opened is None else opened.prompt()

    def remember(self, text):
        """Keep ``text``, whole forms, in the history of what was typed. The number of a restart, and the way out, mean nothing later."""
        of_debugger = self.level and (text.strip().isdigit() or prompt_words.word(text, (*prompt_words.OUT, *prompt_words.BACK)))
        if isinstance(self.input, Lines) and not of_debugger:
            self.input.remember(text)

    def read_line(self, prompt):
        """The next line; ``None`` at the end of input, `BROKEN_OFF` after Ctrl-C, which is dealt with."""
        try:
            line = self.wait_for_line(prompt)
        except kernel.Terminated:
            raise
        except (KeyboardInterrupt, kernel.Abandoned):
            if not at_the_prompt():
                raise
            line = BROKEN_OFF
        if line is BROKEN_OFF:
            self.forget_interrupt()
            if not getattr(self.input, "ended", False):
                streams.CONSOLE_OUTPUT.write("\n")
        return line

    def wait_for_line(self, prompt):
        """The next line; ``None`` at the end of input, `BROKEN_OFF` after Ctrl-C.

        In virtual time the clock stands still at the prompt; in wall time the turtle goes on while we wait. In both cases others who
        are connected (a server listens) are heard and answered meanwhile. In the debugger of a plan's task, which keeps the baton, all
        others wait for the user; there Ctrl-C ends the whole form.
        """
        if isinstance(self.input, Lines):
            self.input.prepare(at_the_prompt())
        wake = self.input.wake if getattr(self.input, "can_be_woken", False) else None
        with kernel.woken_by(wake) if wake else nullcontext():
            if not self.keeps_baton():
                line = kernel.run_blocking(self.input.line, prompt)
            else:
                if at_the_prompt():
                    kernel.settle()  # Ctrl-C that came too late for the last form is for the prompt
                line = self.input.line(prompt)
            if line is BROKEN_OFF:
                if not at_the_prompt() and not kernel.active().interrupted:
                    kernel.interrupt()  # the key was read as a character
                kernel.yield_()  # what woke us is raised here; in a plan's task the main task hears of it, and ends the plan
        if isinstance(self.input, Lines):
            self.input.taken()
        return line

    def ctrl_c_came(self):
        """Whether Ctrl-C was pressed right after the line that was read."""
        return isinstance(self.input, Lines) and self.input.take_pressed()

    def keeps_baton(self):
        """Whether everything else stands still while we wait for a line."""
        if not at_the_prompt():
            return True
        can_be_interrupted = not isinstance(self.input, Lines) or self.input.can_be_woken
        return self.session.virtual and not kernel.active().hears_outside and can_be_interrupted

    def forget_interrupt(self):
        kernel.interrupt_over()
        if isinstance(self.input, Lines):
            self.input.dealt_with()

    def interrupted(self):
        """Tell that a form was interrupted; its plan has been cleaned up."""
        self.forget_interrupt()
        tell_interrupted()

    # ---------------------------------------------------------------------------------------------------------- evaluating

    def respond(self, text):
        """Answer ``text``, in a place to which the debugger can return."""
        self.session.with_abort(lambda: self.evaluate(text))

    def evaluate(self, text):
        """Evaluate and print every form of ``text``; a line that is a ROS command is carried out.

        Where a form ends otherwise than by its values, the rest of the text is not evaluated, and that is told: when the debugger opens,
        or else when the form has ended.
        """
        reader, begun = None, 0  # where the form begins that is being read
        told = ""  # of what stands behind the form, by the debugger that it has opened

        def behind():
            nonlocal told
            told = rest_of(reader) if reader is not None and begun is None else ""
            return told

        before, self.behind = self.behind, behind
        try:
            if self.ctrl_c_came():
                kernel.interrupt()
            if commands.is_command(text):
                return commands.run_line(text, streams.CONSOLE_OUTPUT.write)
            if prompt_words.word(text, prompt_words.HELP):
                return self.help()
            if self.level == 0:
                if prompt_words.word(text, prompt_words.LEAVING):
                    leave()
                if prompt_words.word(text, prompt_words.BACKTRACE):
                    return self.say("There is no error here. In the debugger, backtrace shows the calls that led to it.")
                if prompt_words.word(text, prompt_words.KEYS):
                    return self.say("; This is the prompt: no debugger is open. (exit) ends the session.")
            reader = self.reader_of(text)
            for form in self.session.forms(reader):
                begun = None
                if self.level == 0 and self.leads_away(form, reader):
                    reader = None
                    return None
                if prompt_words.call(form, prompt_words.HELP):
                    self.help(form)
                else:
                    with self.progress.during():
                        values = self.session.evaluate(prompt_words.leaving_form(form), reader)
                    self.show(values)
                begun = reader.offset
            reader = None
        except SystemExit:
            reader = None
            raise
        except Interruption:
            self.interrupted()
        except Condition as condition:
            # a failure that left the form without a debugger, such as one of another task
            streams.CONSOLE_OUTPUT.fresh_line()
            streams.CONSOLE_OUTPUT.write(f"{condition_type(condition)}\n{explanation(condition)}\n")
        except Exception as exception:
            self.debug(condition_of(exception))
        finally:
            self.behind = before
            if reader is not None and (rest := rest_of(reader, begun)) != told:
                self.tell_not_evaluated(rest)

    def reader_of(self, text):
        """A reader of ``text``, which knows where it stands: in a file, if an editor has sent it."""
        sent = self.input.sent if isinstance(self.input, Lines) else None
        if sent is None or sent[0].strip() != text.strip():
            return self.session.reader(text)
        return self.session.reader_in_file(*sent)

    def tell_not_evaluated(self, text, so_far=False):
        """Tell that ``text``, which stands behind a form that failed, was not evaluated. Closing parentheses alone are no forms.

        so_far: whether a choice of the debugger may go on with it.
        """
        if text.strip(") "):
            text = text if len(text) <= MOST_TOLD else f"{text[:MOST_TOLD]} ..."
            streams.CONSOLE_OUTPUT.fresh_line()
            streams.CONSOLE_OUTPUT.write(f"; Not evaluated{' so far' if so_far else ''}: {text}\n")
            streams.CONSOLE_OUTPUT.flush()

    def say(self, text):
        """Print lines that are no values."""
        output = streams.CONSOLE_OUTPUT
        output.fresh_line()
        output.write(text + "\n")
        output.flush()

    def help(self, form=None):
        """Show what can be typed here; for ``(help name)`` what the name means."""
        if form is not None and isinstance(form.cdr, Cons):
            describe(prompt_words.meant(form.cdr.car))
        else:
            self.say(prompt_words.help_text(getattr(self.input, "edits", False), self.level))

    def show(self, values):
        """Print values, each on a line of its own."""
        output = streams.CONSOLE_OUTPUT
        output.fresh_line()
        if not values:
            output.write("; No value\n")
        for value in values:
            output.write(value_text(value) + "\n")
        output.flush()

    # ------------------------------------------------------------------------------------------------------------ debugger

    def debug(self, condition):
        """The debugger: on top of the stack that signalled ``condition``. It is left by a restart."""
        if not at_the_prompt() and current_task() is None:
            return None  # a task of the machine's: what it fails with is reported
        signalled_here(condition)
        restarts = conditions.compute_restarts(condition)
        if not restarts:
            return None
        return with_readable_input(lambda: self.dialogue(condition, restarts))

    def dialogue(self, condition, restarts):
        """Tell of ``condition`` and answer what the user types, until a restart leaves it."""
        self.announce(condition, restarts)
        self.level += 1
        try:
            with self.input.choosing(condition, restarts) if isinstance(self.input, Lines) else nullcontext():
                while True:
                    text = self.read_text(f"{self.level - 1}] ")
                    if text is None:
                        if not any(restart.name is ABORT for restart in restarts):
                            return None  # nobody has a place to go on: the error is raised
                        return conditions.invoke_restart(ABORT)
                    self.answer(text.strip(), restarts, condition)
        finally:
            self.level -= 1

    def announce(self, condition, restarts):
        output = streams.CONSOLE_OUTPUT
        output.fresh_line()
        lines = [
            "",
            f"debugger invoked on a {condition_type(condition)}:",
            self.explained(condition),
            *backtrace.lines(condition),
            "",
            "restarts (type a number to choose one, or a form to evaluate):",
        ]
        output.write("\n".join([*lines, *self.choices(restarts)]) + "\n")
        self.tell_not_evaluated(self.behind(), so_far=True)
        output.flush()

    def explained(self, condition):
        """What the debugger tells of ``condition``, below its type."""
        return explanation(condition)

    def choices(self, restarts):
        """The lines that offer ``restarts`` by number."""
        width = max(len(symbol_name(restart.name)) for restart in restarts)
        return [f"  {index}: [{symbol_name(restart.name):{width}}] {report_of(restart)}" for index, restart in enumerate(restarts)]

    @typed_meanwhile()
    @circumstance.begins_with
    def answer(self, text, restarts, condition):
        """What the user typed in the debugger of ``condition``: the number or the name of a restart, a word, or a form."""
        if text.isdigit():
            if int(text) < len(restarts):
                return conditions.invoke_restart_interactively(restarts[int(text)])
            return streams.CONSOLE_OUTPUT.write(f"There is no choice {text}; they go from 0 to {len(restarts) - 1}.\n")
        aborts = [restart for restart in restarts if symbol_name(restart.name) == "ABORT"]
        if aborts and prompt_words.word(text, prompt_words.BACK):
            return conditions.invoke_restart_interactively(aborts[0])
        if aborts and prompt_words.word(text, prompt_words.OUT):
            return conditions.invoke_restart_interactively(aborts[-1])
        if prompt_words.word(text, prompt_words.BACKTRACE):
            return self.say("\n".join(backtrace.calls(condition, sys._getframe(1))))
        for restart in restarts:
            if text.startswith(":") and symbol_name(restart.name) == text[1:].upper():
                return conditions.invoke_restart_interactively(restart)
        return self.session.with_abort(lambda: self.evaluate(text), f"Return to debugger level {self.level - 1}.")
