"""``roslisp_repl``: the prompt and the debugger.

The prompt shows the package, values come one a line, ``; No value`` where there are none. An error opens the debugger *before*
anything unwinds: it shows what happened, where, what to try, and the restarts by number; forms can be evaluated there. Ctrl-C
ends the running form through its cleanup and returns to the prompt. On a terminal, prompt_toolkit edits the line if it is
installed; from a pipe, lines are read and nothing is echoed but prompts and answers.
"""

from __future__ import annotations

import sys
from contextlib import nullcontext

from cramhy_runtime import kernel
from cramhy_runtime.cpl import current_task
from cramhy_runtime.lisp import conditions
from cramhy_runtime.lisp.streams import streams
from cramhy_runtime.lisp.tools.advice import explanation
from cramhy_runtime.lisp.conditions import Condition
from cramhy_runtime.lisp.packages import COMMON_LISP, printed, sym, symbol_name, symbol_package

from . import backtrace, commands
from .lines import BROKEN_OFF, Lines, standard_lines
from .session import Interruption, condition_of, signalled_here


def condition_type(condition):
    """The name of the class of ``condition`` as the debugger shows it."""
    from cramhy_runtime.lisp.objects.classes import class_name

    name = class_name(type(condition))
    return symbol_name(name) if symbol_package(name) in (COMMON_LISP, None) else printed(name)


def report(condition, file=None):
    """Print an error that ends a program."""
    streams.CONSOLE_OUTPUT.fresh_line()
    streams.CONSOLE_OUTPUT.flush()
    print("\n".join([f"cramhy: {condition_type(condition)}", explanation(condition), *backtrace.lines(condition)]), file=file or sys.stderr)


def exit_status(leaving):
    """The exit status that a SystemExit asks for, as Python understands it: a text is printed, and is a failure."""
    code = leaving.code
    if code is None or isinstance(code, int):
        return code or 0
    print(code, file=sys.stderr)
    return 1


def at_the_prompt():
    """Whether the task that runs is the one that reads and evaluates forms."""
    return kernel.current() is kernel.active().main


class Console:
    """The read-eval-print loop. ``make_session`` is called once the prompt is needed."""

    def __init__(self, make_session, lines=None):
        self.make_session = make_session
        self.input = lines
        self.session = None
        self.level = 0

    def run(self):
        """Until the end of input or ``(quit)``. Returns the exit status."""
        try:
            self.session = self.make_session()
        except (Exception, Condition) as problem:
            report(condition_of(problem))
            return 1
        self.input = self.input or standard_lines()
        conditions.install_debugger(self.debug)
        streams.ERROR_OUTPUT.value = streams.CONSOLE_OUTPUT  # warnings belong to the transcript
        interrupted = False
        try:
            while True:
                try:
                    if interrupted:  # told here, where another interrupt is heard
                        self.interrupted()
                        interrupted = False
                    text = self.read_text(self.session.prompt())
                    if text is None:
                        if self.input.interactive:
                            streams.CONSOLE_OUTPUT.write("\n")
                        return 0
                    self.session.with_abort(lambda text=text: self.evaluate(text))
                except kernel.Terminated:
                    raise
                except (KeyboardInterrupt, kernel.Abandoned, Interruption):  # between two steps of ours, as while values are printed
                    interrupted = True
        except SystemExit as leaving:
            return exit_status(leaving)
        finally:
            conditions.install_debugger(None)
            kernel.stop()

    # ------------------------------------------------------------------------------------------------------------- reading

    def read_text(self, prompt):
        """Lines until they make whole forms; ``None`` at the end of input. Ctrl-C forgets a form that is being typed."""
        from cramhy_runtime.lisp.reader.reader import incomplete

        lines = []
        while True:
            try:
                line = self.wait_for_line(prompt if not lines else "")
            except kernel.Terminated:
                raise
            except (KeyboardInterrupt, kernel.Abandoned):
                if not at_the_prompt():
                    raise
                line = BROKEN_OFF
            if line is BROKEN_OFF:
                lines = []
                self.forget_interrupt()
                streams.CONSOLE_OUTPUT.write("\n")
                continue
            if line is None:
                return "\n".join(lines) if lines else None
            streams.CONSOLE_OUTPUT.record(f"{'' if lines else prompt}{line}\n")
            lines.append(line)
            text = "\n".join(lines)
            if not text.strip():
                lines = []
            elif not incomplete(text):
                return text
            elif self.ctrl_c_came():
                lines = []
                streams.CONSOLE_OUTPUT.write("\n")

    def wait_for_line(self, prompt):
        """The next line; ``None`` at the end of input, `BROKEN_OFF` after Ctrl-C.

        In virtual time the clock stands still at the prompt; in wall time the turtle goes on while we wait. In both cases others who
        are connected (a server listens) are heard and answered meanwhile. In the debugger of a plan's task, which keeps the baton, all
        others wait for the user; there Ctrl-C ends the whole form.
        """
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
        streams.CONSOLE_OUTPUT.fresh_line()
        streams.CONSOLE_OUTPUT.write("; Interrupted.\n")
        streams.CONSOLE_OUTPUT.flush()

    # ---------------------------------------------------------------------------------------------------------- evaluating

    def evaluate(self, text):
        """Evaluate and print every form of ``text``; a line that is a ROS command is carried out."""
        try:
            if self.ctrl_c_came():
                kernel.interrupt()
            if commands.is_command(text):
                return commands.run_line(text, streams.CONSOLE_OUTPUT.write)
            for form, reader in self.session.forms(text):
                self.show(self.session.evaluate(form, reader))
        except Interruption:
            self.interrupted()
        except Condition as condition:
            # a failure that left the form without a debugger, such as one of another task
            streams.CONSOLE_OUTPUT.fresh_line()
            streams.CONSOLE_OUTPUT.write(f"{condition_type(condition)}\n{explanation(condition)}\n")
        except Exception as exception:
            self.debug(condition_of(exception))

    def show(self, values):
        """Print values, each on a line of its own."""
        from cramhy_runtime.lisp.printer.printer import prin1_to_string

        output = streams.CONSOLE_OUTPUT
        output.fresh_line()
        if not values:
            output.write("; No value\n")
        for value in values:
            output.write(prin1_to_string(value) + "\n")
        output.flush()

    # ------------------------------------------------------------------------------------------------------------ debugger

    def debug(self, condition):
        """The debugger: on top of the stack that signalled ``condition``. It is left by a restart."""
        if not at_the_prompt() and current_task() is None:
            return  # a task of the machine's: what it fails with is reported
        signalled_here(condition)
        restarts = conditions.compute_restarts(condition)
        if not restarts:
            return
        self.announce(condition, restarts)
        self.level += 1
        try:
            while True:
                text = self.read_text(f"{self.level - 1}] ")
                if text is None:
                    return conditions.invoke_restart(sym("ABORT"))
                self.answer(text.strip(), restarts)
        finally:
            self.level -= 1

    def announce(self, condition, restarts):
        output = streams.CONSOLE_OUTPUT
        output.fresh_line()
        width = max(len(symbol_name(restart.name)) for restart in restarts)
        lines = ["", f"debugger invoked on a {condition_type(condition)}:", explanation(condition), *backtrace.lines(condition), "",
                 "restarts (type a number to choose one, or a form to evaluate):"]
        lines += [f"  {index}: [{symbol_name(restart.name):{width}}] {restart.report()}" for index, restart in enumerate(restarts)]
        output.write("\n".join(lines) + "\n")
        output.flush()

    def answer(self, text, restarts):
        """What the user typed in the debugger: the number or the name of a restart, or a form."""
        name = text.lstrip(":").upper()
        if text.isdigit():
            if int(text) < len(restarts):
                return conditions.invoke_restart_interactively(restarts[int(text)])
            return streams.CONSOLE_OUTPUT.write(f"There is no choice {text}; they go from 0 to {len(restarts) - 1}.\n")
        chosen = "ABORT" if name in ("Q", "QUIT", "ABORT") else name
        for restart in restarts:
            if symbol_name(restart.name) == chosen and "(" not in text and (text.startswith(":") or chosen == "ABORT"):
                return conditions.invoke_restart_interactively(restart)
        return self.session.with_abort(lambda: self.evaluate(text), f"Return to debugger level {self.level - 1}.")
