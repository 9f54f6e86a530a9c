"""``roslisp_repl``: the prompt and the debugger.

The prompt shows the package, values come one a line, ``; No value`` where there are none. An error opens the debugger *before*
anything unwinds: it shows what happened, where, what to try, and the restarts by number; forms can be evaluated there. Ctrl-C
ends the running form through its cleanup and returns to the prompt. On a terminal, prompt_toolkit edits the line if it is
installed; from a pipe, lines are read and nothing is echoed but prompts and answers.
"""

from __future__ import annotations

import sys

from cramhy_runtime import kernel
from cramhy_runtime.cpl import current_task
from cramhy_runtime.lisp import conditions
from cramhy_runtime.lisp.streams import streams
from cramhy_runtime.lisp.streams.console_ready import readable
from cramhy_runtime.lisp.tools.advice import explanation
from cramhy_runtime.lisp.conditions import Condition
from cramhy_runtime.lisp.packages import COMMON_LISP, printed, sym, symbol_name, symbol_package

from . import backtrace, commands
from . import session
from .session import Interruption, condition_of, handle_interrupts, signalled_here


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


def at_the_prompt():
    """Whether the task that runs is the one that reads and evaluates forms."""
    return kernel.current() is kernel.active().main


class Input:
    """Where lines come from: a terminal, with editing if possible, or a pipe."""

    def __init__(self):
        self.interactive = sys.stdin.isatty()
        self.editor = None
        self.turn = 0  # counts the calls of `line`
        if self.interactive:
            try:
                from prompt_toolkit import PromptSession
                from prompt_toolkit.history import InMemoryHistory

                self.editor = PromptSession(history=InMemoryHistory())
            except ImportError:
                pass  # the terminal's own line editing will do

    def line(self, prompt, interrupted=lambda: False):
        """The next line without its end; ``None`` at the end of input, or when ``interrupted()`` on a terminal."""
        streams.CONSOLE_OUTPUT.fresh_line()
        sys.stdout.flush()
        if self.editor is not None:
            try:
                return self.editor.prompt(prompt)
            except EOFError:
                return None
        self.turn = mine = self.turn + 1
        sys.stdout.write(prompt)
        sys.stdout.flush()
        streams.CONSOLE_OUTPUT.column = 0
        while self.interactive:
            ready = readable(sys.stdin, 0.1)
            if interrupted():
                return None
            if self.turn != mine:  # Ctrl-C broke this call off, but its thread waits on: the line is for the next call
                return None
            if ready or ready is None:  # None: reading has to wait, and cannot be broken off
                break
        line = sys.stdin.readline()
        return line.rstrip("\n") if line else None


class Console:
    """The read-eval-print loop. ``make_session`` is called once the prompt is needed."""

    def __init__(self, make_session, lines=None):
        self.make_session = make_session
        self.input = lines or Input()
        self.session = None
        self.level = 0

    def run(self):
        """Until the end of input or ``(quit)``. Returns the exit status."""
        try:
            self.session = self.make_session()
        except (Exception, Condition) as problem:
            report(condition_of(problem))
            return 1
        handle_interrupts()
        conditions.install_debugger(self.debug)
        streams.ERROR_OUTPUT.value = streams.CONSOLE_OUTPUT  # warnings belong to the transcript
        try:
            while True:
                text = self.read_text(self.session.prompt())
                if text is None:
                    if self.input.interactive:
                        print()
                    return 0
                self.session.with_abort(lambda text=text: self.evaluate(text))
        except SystemExit as leaving:
            return leaving.code or 0
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
            except (KeyboardInterrupt, kernel.Interrupted):
                kernel.interrupt_over()
                lines = []
                print()
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

    def wait_for_line(self, prompt):
        # In virtual time the clock stands still at the prompt; in wall time the turtle goes on while we wait. In both cases
        # others who are connected (a server listens) are heard and answered meanwhile.
        if not at_the_prompt():
            return self.wait_for_line_in_a_task(prompt)
        if self.session.virtual and not kernel.active().hears_outside:
            with session.keyboard_interrupts():
                kernel.settle()  # Ctrl-C that came too late for the last form is for the prompt
                return self.input.line(prompt)
        return kernel.run_blocking(self.input.line, prompt)

    def wait_for_line_in_a_task(self, prompt):
        """In the debugger of a plan's task, which keeps the baton: all others wait for the user. Ctrl-C ends the whole form."""
        interrupted = kernel.active().interrupt_waits
        line = self.input.line(prompt, interrupted)
        if line is None and interrupted():
            kernel.yield_()  # the main task hears of it, and evaporates the plan with this task
        return line

    # ---------------------------------------------------------------------------------------------------------- evaluating

    def evaluate(self, text):
        """Evaluate and print every form of ``text``; a line that is a ROS command is carried out."""
        try:
            if commands.is_command(text):
                return commands.run_line(text, streams.CONSOLE_OUTPUT.write)
            for form, reader in self.session.forms(text):
                self.show(self.session.evaluate(form, reader))
        except Interruption:
            streams.CONSOLE_OUTPUT.fresh_line()
            print("; Interrupted.")
        except Condition as condition:
            # a failure that left the form without a debugger, such as one of another task
            streams.CONSOLE_OUTPUT.fresh_line()
            print(f"{condition_type(condition)}\n{explanation(condition)}")
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
            return print(f"There is no choice {text}; they go from 0 to {len(restarts) - 1}.")
        chosen = "ABORT" if name in ("Q", "QUIT", "ABORT") else name
        for restart in restarts:
            if symbol_name(restart.name) == chosen and "(" not in text and (text.startswith(":") or chosen == "ABORT"):
                return conditions.invoke_restart_interactively(restart)
        return self.session.with_abort(lambda: self.evaluate(text), f"Return to debugger level {self.level - 1}.")
