"""What a cell says of an error: the text of the prompt's debugger, and the restarts that there were.

A cell ends when its error is told, so a notebook that runs by itself never hangs. After ``%debugger on`` a cell asks instead: a number
takes a restart, a form is evaluated where the error arose, and an empty line ends the cell.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import symbol_name
from cramhy_runtime.lisp_core.printing import prin1_to_string, report_of
from cramhy_runtime.languages.commonlisp.tools import backtrace
from cramhy_runtime.languages.commonlisp.tools.advice import explanation, report_text
from cramhy_runtime.languages.commonlisp.tools.error_reports import condition_of, condition_type
from cramhy_runtime.session.session import signalled_here


class Told:
    """An error as a cell tells it: ``name`` its type, ``text`` what it says, ``lines`` all that is shown, ``condition`` itself.

    in_hy: whether the cell is one of Hy, where an exception of Python keeps its name."""

    def __init__(self, condition, restarts=(), in_hy=False):
        self.condition = condition
        cause = condition.__cause__ if in_hy else None
        self.name = type(cause).__name__ if isinstance(cause, Exception) else str(condition_type(condition))
        self.text = report_text(condition)
        self.restarts = [f"[{symbol_name(each.name) if each.name is not None else ''}] {report_of(each)}" for each in restarts]
        self.lines = [self.name, *explanation(condition).splitlines(), *backtrace.lines(condition)]
        if self.restarts:
            self.lines += ["", "restarts (%debugger on lets a cell ask which to take):"]
            self.lines += [f"  {number}: {each}" for number, each in enumerate(self.restarts)]


def told_of(failure, in_hy=False):
    """The `Told` of an exception that ended a cell, whose stack has gone. in_hy: see `Told`."""
    return Told(condition_of(failure), in_hy=in_hy)


class CellDebugger:
    """The debugger of one cell.

    ask: a function of a prompt that gives the line typed, or ``None`` where nobody can be asked. write: a function that prints a text.
    in_hy: a function that says whether the cell is one of Hy. ``told``: the `Told` of the first error that nobody handled, or ``None``. It
    is made where the stack still stands.
    """

    def __init__(self, session, write, ask=None, in_hy=lambda: False):
        self.session, self.write, self.ask, self.in_hy = session, write, ask, in_hy
        self.told = None
        self.level = 0

    def __call__(self, condition):
        signalled_here(condition)
        restarts = conditions.compute_restarts(condition)
        told = Told(condition, restarts, self.in_hy())
        if self.told is None:
            self.told = told
        if self.ask is None or not restarts:
            return  # the condition is raised, and ends the cell through the cleanup of its plan
        self.dialogue(told, restarts)

    def dialogue(self, told, restarts):
        """Answer what the user types, until a restart leaves it or an empty line ends the cell."""
        self.write("\n".join([f"debugger invoked on a {told.name}:", *told.lines[1:]]) + "\n")
        self.level += 1
        try:
            while text := (self.ask(f"{self.level - 1}] ") or "").strip():
                if not text.isdigit():
                    self.evaluate(text)
                elif int(text) < len(restarts):
                    self.told = None  # it is dealt with
                    conditions.invoke_restart_interactively(restarts[int(text)])
                else:
                    self.write(f"There is no choice {text}; they go from 0 to {len(restarts) - 1}.\n")
        finally:
            self.level -= 1

    def evaluate(self, text):
        """Evaluate ``text`` on the stack of the error, and show the values."""
        try:
            self.write("".join(f"{prin1_to_string(value)}\n" for value in self.session.evaluate_text(text, top=False)))
        except (Exception, Condition) as problem:
            self.write("\n".join(told_of(problem).lines) + "\n")
