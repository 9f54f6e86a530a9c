"""Readers of Hy that read Common Lisp.

Hy reads a text form by form, and compiles each form before it reads the next. So a macro can change how the rest of the text is read. It
does this with the reader that is at work, which keeps its place in the stream.

* `LispReader` reads a file. `change_over` makes one of the reader at work: from the next form on, our reader finds the forms, and each of
  them becomes a call of the macro ``lisp-form-read``. The form ``(in-hy)`` makes a `hy.HyReader` of it again.
* `TypedReader` reads what is typed at a prompt. It does not take the text apart, because a form may change how the next one is read
  (``(in-package ...)``, ``(setf *readtable* ...)``), and at a prompt each form runs before the next one is read. It only finds out whether
  the text is complete.
"""

from __future__ import annotations

from hy import models
from hy.reader import HyReader
from hy.reader.exceptions import PrematureEndOfInput

from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.data import Cons, Symbol
from cramhy_runtime.languages.commonlisp.reader.reader import NOTHING, Reader, incomplete

from .rest_of_file import Ahead

WAY_BACK = "IN-HY"


class Form(models.Object):
    """A Lisp form on its way through Hy's compiler."""

    def __init__(self, value):
        self.value = value

    def __repr__(self):
        return f"Form({self.value!r})"


def is_way_back(form):
    """Whether ``form`` is ``(in-hy)``, in whatever package it was read."""
    return isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car.name == WAY_BACK and form.cdr is None


class LispReader(HyReader):
    """A `hy.HyReader` whose text is Common Lisp from some place on. `change_over` makes one.

    ``lisp`` reads the text from that place on. The characters of each form are taken from the stream of Hy, too, so both have the same
    place, and the text can go on in Hy behind any form.
    """

    def begin(self):
        """Read Lisp from here on."""
        line, column = self.pos
        self.lisp = Reader("".join(self.peeking(eof_ok=True)), filename=self._filename or "<hy>", line=line, column=column + 1)
        self.compiled_ahead = Ahead(self.lisp, getattr(self, "lisp_before", None))
        self.taken = 0  # how many characters of Lisp's text have been taken from Hy's stream

    def parse(self, stream, filename=None, skip_shebang=False):
        """Another text begins in Hy."""
        self.__class__ = HyReader
        return self.parse(stream, filename, skip_shebang)

    def keep_up(self):
        """Take from Hy's stream what has been read of Lisp's text."""
        taken, self.taken = self.taken, self.lisp.offset
        return self.getn(self.taken - taken)

    def slurp_space(self):
        self.lisp.skip_blank()
        return self.keep_up()

    def peek_and_getc(self, target):
        over = super().peek_and_getc(target)
        if over and not target:
            self.compiled_ahead.finish()
        return over

    def try_parse_one_form(self):
        self.compiled_ahead.begin_form()
        try:
            form = self.lisp.read(eof_error=False, eof_value=NOTHING)
        except (Exception, Condition):
            model = self.compiled_ahead.rest()
            self.keep_up()
            return model
        self.keep_up()
        if form is NOTHING:
            return None
        if is_way_back(form):
            self.compiled_ahead.finish()
            self.lisp_before, self.compiled_ahead = self.compiled_ahead, None
            self.__class__ = HyReader
            return models.Expression([models.Symbol("in-hy")])
        return models.Expression([models.Symbol("lisp-form-read"), Form(form)])


def change_over(reader):
    """Let ``reader``, a `hy.HyReader` that is at work, read Lisp from the next form on. Returns the Lisp reader."""
    reader.__class__ = LispReader
    reader.begin()
    return reader.lisp


class TypedReader(HyReader):
    """Gives each text as one model: a call of ``answer``, a Hy model of a function, with the text.

    A text that ends inside a form, a string or a comment raises `hy.PrematureEndOfInput`, so Hy's REPL asks for another line.
    """

    def __init__(self, answer):
        super().__init__()
        self.answer = answer

    def parse(self, stream, filename=None, skip_shebang=False):
        text = stream.read()
        if not text.strip():
            return
        if incomplete(text):
            raise more_wanted(text, filename)
        yield models.Expression([self.answer, models.String(text)])


def more_wanted(text, filename):
    """The exception that tells Hy's REPL that ``text`` ends inside a form."""
    return PrematureEndOfInput("The text ends inside a Lisp form.", None, filename, text, 1, 1)


def rest_of_text(reader):
    """What ``reader``, which is at work, has not read yet. Nothing is left for it."""
    return "".join(reader.chars(eof_ok=True))


def source_of(model, source):
    """The text of ``model``, which Hy has read from the text ``source``."""
    lines = source.split("\n")[model.start_line - 1 : model.end_line]
    lines[-1] = lines[-1][: model.end_column]
    lines[0] = lines[0][model.start_column - 1 :]
    return "\n".join(lines)


__all__ = ["Form", "LispReader", "TypedReader", "change_over", "is_way_back", "more_wanted", "rest_of_text", "source_of"]
