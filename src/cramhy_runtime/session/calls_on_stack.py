"""The calls on a stack in terms of Lisp: who called whom with which values, where, and what a form means there.

A debugger shows them. Frames of the runtime and of the compiler are left out (law 7). The values are those of the Python frame, so a
variable that the compiler has made away with is not there.
"""

from __future__ import annotations

import linecache
import re
import sys

from cramhy_runtime.lisp_core.data import lisp_list, list_from
from cramhy_runtime.languages.commonlisp.compiler.frame_exits import FrameExit, can_be_left
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import attempt_to_print
from cramhy_runtime.lisp_core.python_names import lisp_spelling, python_name
from cramhy_runtime.lisp_core.source_places import circumstance, frame_position, is_user_file
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.languages.commonlisp.tools.backtrace import name_of

LONGEST = 60  # characters of a value in the text of a frame
_SYMBOL = re.compile(r"""[^\s()'"`,;#|]+""")


class Frame:
    """A call on a stack. name: of the function. position: (file, line, column). text: the call as a list."""

    def __init__(self, frame, lasti):
        self.frame = frame
        self.name = name_of(frame.f_code)
        self.position = frame_position(frame, lasti)

    @property
    def text(self):
        """``(DRIVE 5 2)``: the call with the values that its arguments have now."""
        code = self.frame.f_code
        if self.name == "the form":
            return self.name
        keywords = 0 if code.co_flags & 0x08 else code.co_kwonlyargcount
        count = code.co_argcount + keywords
        values = [value for name, value in self._variables(code.co_varnames[:count])]
        return f"({' '.join([self.name, *(_short(value) for value in values)])})"

    @property
    def variables(self):
        """[(name, value)] of the variables that have a value, in the user's spelling."""
        return self._variables(self.frame.f_locals)

    def _variables(self, names):
        if self.name == "the form":
            return []
        values, spelled = self.frame.f_locals, self._spellings()
        return [
            (spelled.get(name) or lisp_spelling(name), values[name])
            for name in names
            if name in values and not re.match(r"[A-Z]|_hy_|\.", name)
        ]

    def _spellings(self):
        """Names of Python → how the user's text writes them."""
        lines = [line for _, _, line, *_ in [(*entry, None) for entry in self.frame.f_code.co_lines()] if line]
        if not lines:
            return {}
        text = "".join(linecache.getlines(self.position[0])[min(lines) - 1 : max(lines) + 1])
        return {python_name(name): name.upper() for name in reversed(_SYMBOL.findall(text))}

    @property
    def why_it_stays(self):
        """Why the call can neither be ended with a value nor begun anew, a text; ``None`` if it can."""
        if not can_be_left(self.frame):
            return f"{self.name} was not compiled so that its calls can be left."
        running = sys._getframe()
        while running is not None and running is not self.frame:
            running = running.f_back
        return None if running is not None else f"The error has left the call of {self.name} already."

    def leave(self, value):
        """End the call: it returns ``value``."""
        raise FrameExit(self.frame, value)

    def restart(self):
        """Begin the call anew, with its variables as they are now."""
        raise FrameExit(self.frame, again=True)

    @property
    def package(self):
        """The package in which the variables are read: the current one."""
        return evaluator.PACKAGE.value

    def function(self, text):
        """(function, arguments): calling it gives what the forms of ``text`` mean where the frame stands. Setting a variable there has
        no effect on the frame."""
        reader, end, forms = Reader(text, filename="<in frame>"), object(), []
        while (form := reader.read(eof_error=False, eof_value=end)) is not end:
            forms.append(form)
        names = {}
        for name, value in self.variables:
            names[self.package.intern(name)] = value
        symbols = [symbol for symbol in names if not getattr(symbol, "special", False)]
        ignorable = lisp_list(sym("DECLARE"), lisp_list(sym("IGNORABLE"), *symbols))
        function = evaluator.evaluate(lisp_list(sym("FUNCTION"), lisp_list(sym("LAMBDA"), list_from(symbols), ignorable, *forms)))
        return function, [names[symbol] for symbol in symbols]

    def evaluate(self, text):
        """The values of the last form of ``text``, with the variables of the frame."""
        function, arguments = self.function(text)
        return function(*arguments)


def calls_on_stack(frame, condition=None):
    """The `Frame`s of the user's calls that run in ``frame`` and its callers, the innermost first.

    condition: where it has left its stack already, the calls that it passed. Calls outside of the form that was typed into a debugger
    are not among them.
    """
    found = []
    if condition is not None and condition.__traceback__ is not None:
        entry = condition.__traceback__
        while entry is not None:
            found.insert(0, (entry.tb_frame, entry.tb_lasti))
            entry = entry.tb_next
    running = circumstance.running(frame)
    known = {id(each) for each, _ in running}
    found = [entry for entry in found if id(entry[0]) not in known] + running
    return [Frame(each, lasti) for each, lasti in found if is_user_file(each.f_code.co_filename) and each.f_code.co_name != "<module>"]


def _short(value):
    text = attempt_to_print(prin1_to_string, value)
    text = " ".join(text.split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


__all__ = ["Frame", "calls_on_stack"]
