"""A cell: the language that it is written in, and how it is evaluated.

A cell is Common Lisp, unless its first line is ``%%hy``. The form ``(in-hy)`` makes Hy the language of the cells after it, and in a cell
of Hy ``(in-package :tut)`` leads back. ``%%lisp`` and ``%%hy`` say it for one cell. A cell whose first line is ``%%writefile NAME`` is the
text of a file, which it writes.
"""

from __future__ import annotations

import os
import sys
import types

from cramhy_runtime import kernel, storage
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.lisp_core.printing import speak
from cramhy_runtime.session.session import value_text
from cramhy_runtime.lisp_core.source_places import keep_text
from cramhy_runtime.languages import answered_texts
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.reader.reader import incomplete
from cramhy_runtime.languages.hy import module_names

LISP, HY = "lisp", "hy"
MODULE = "notebook"
"""The Python module in which cells of Hy live."""
TOP = "End this cell."


def magic(text):
    """(language, text without that line) of a cell whose first line says its language, else (``None``, text).

    The line is left empty, so that the places of errors are those in the cell.
    """
    first, _, rest = text.lstrip("\n").partition("\n")
    word = first.strip()
    if word in ("%%hy", "%%lisp"):
        return word[2:], "\n" * (text.index(first) > 0) + "\n" + rest
    return None, text


def file_of(text):
    """(name, text) of the file that a cell is, or ``None``."""
    first, _, rest = text.partition("\n")
    words = first.split(maxsplit=1)
    return (words[1].strip(), rest.rstrip("\n") + "\n") if len(words) == 2 and words[0] == "%%writefile" else None


class Aborted(Exception):
    """The user has left a cell by its restart."""


class Notebook:
    """The cells of one notebook. session: its `Session`. ``package``: of the next cell of Lisp. ``language``: of the next cell.
    ``answered_in``: the language whose value the last cell had."""

    def __init__(self, session):
        self.session = session
        self.package = session.package or COMMON_LISP_USER
        self.language = self.answered_in = LISP
        self.module = None

    def language_of(self, text):
        """(language, text) of a cell."""
        said, text = magic(text)
        return said or self.language, text

    def evaluate(self, text):
        """The values of the last form of the cell ``text``, a list. To be called in a task of the session."""
        if (file := file_of(text)) is not None:
            os.makedirs(os.path.dirname(file[0]) or ".", exist_ok=True)
            storage.write_whole(file[0], file[1].encode())
            return []
        language, text = self.language_of(text)
        completed, values = self.session.with_abort(lambda: self._hy(text) if language == HY else self._lisp(text), TOP)
        if not completed:
            raise Aborted
        return values

    def values_of(self, text):
        """The value of each form in ``text``, a list, in the notebook's language and package."""
        if self.language == HY:
            import hy

            return [hy.eval(model, module=self.hy_module()) for model in hy.read_many(text)]
        with binding(evaluator.PACKAGE, self.package):
            return [value for form in self.session.forms(self.session.reader(text)) for value in self.session.evaluate(form)[:1]]

    # ---------------------------------------------------------------------------------------------------------------- Lisp

    def _lisp(self, text):
        with binding(evaluator.PACKAGE, self.package):
            try:
                return self._forms(text)
            finally:
                self.package = evaluator.PACKAGE.value

    def _forms(self, text):
        self.answered_in = LISP
        speak(lisp=True)
        values, reader = [], self.session.reader(text)
        for form in self.session.forms(reader):
            if isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car.name == "IN-HY" and form.cdr is None:
                self.language = HY
                rest = text[reader.offset :]
                return self._hy("\n" * text.count("\n", 0, reader.offset) + rest) if rest.strip() else []
            values = self.session.evaluate(form, reader, top=True)
            self.package = evaluator.PACKAGE.value
        return values

    # ------------------------------------------------------------------------------------------------------------------ Hy

    def hy_module(self):
        """The module of the notebook's Hy, where the plan language is required."""
        if self.module is None:
            import hy

            module = types.ModuleType(MODULE, "The cells of a notebook.")
            module.hy = hy
            sys.modules[MODULE] = module
            hy.eval(hy.read("(require cramhy *)"), module=module)
            self.module = module
        return self.module

    def _hy(self, text):
        import hy
        from hy import models

        self.answered_in, module = HY, self.hy_module()
        speak(lisp=False)
        self.session.texts += 1
        name = f"<notebook {self.session.texts}>"
        keep_text(name, text)
        noted, lines, value = answered_texts.note(text, HY), text.split("\n"), None
        try:
            for model in hy.read_many(text, name):
                if isinstance(model, models.Expression) and model and model[0] == models.Symbol("in-package"):
                    self.language = LISP
                    line, column = model.start_line - 1, model.start_column - 1
                    return self._lisp("\n" * line + "\n".join([" " * column + lines[line][column:], *lines[line + 1 :]]))
                value = self._evaluated_in_hy(model, module, name)
                noted.upto = sum(len(line) + 1 for line in lines[: model.end_line - 1]) + model.end_column
        except BaseException:
            noted.end(good=False)
            raise
        if kernel.current() is kernel.active().main:
            kernel.settle()
        setattr(module, hy.mangle("*1"), value)  # as at a prompt of Hy
        return [] if value is None else [value]

    @staticmethod
    def _evaluated_in_hy(model, module, filename):
        """As ``hy.eval``. Loops have checkpoints and cleanup is shielded, as at the prompt, so the stop button ends them in order."""
        from hy.compiler import hy_compile

        statements, expression = hy_compile(model, module, get_expr=True, filename=filename)
        module_names.complete_at_prompt(statements, module)
        space = vars(module)
        exec(compile(statements, filename, "exec"), space)
        return eval(compile(expression, filename, "eval"), space)

    def shown(self, value):
        """The text of a value of the last cell: as Lisp prints it, and as Hy does where Hy has answered and the value is not ours."""
        if self.answered_in == HY:
            import hy

            from cramhy_runtime.languages.hy.answer_lists import is_ours

            if not is_ours(value):
                return hy.repr(value)
        with binding(PACKAGE, self.package):
            return value_text(value)

    # ---------------------------------------------------------------------------------------------------------- completeness

    def completeness(self, text):
        """``"complete"`` or ``"incomplete"``: whether a form of the cell ``text`` is open."""
        language, text = self.language_of(text)
        if language == LISP:
            return "incomplete" if incomplete(text) else "complete"
        import hy
        from hy.reader.exceptions import LexException, PrematureEndOfInput

        try:
            list(hy.read_many(text))
        except PrematureEndOfInput:
            return "incomplete"
        except LexException:
            return "invalid"
        return "complete"
