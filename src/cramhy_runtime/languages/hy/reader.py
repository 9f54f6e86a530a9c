"""Readers of Hy that read programs, and Common Lisp in them.

Hy reads a text form by form, and compiles each form before it reads the next. So a macro can change how the rest of the text is read. It
does so with the reader that is at work: `take_rest` gives that a reader macro for the character that comes next. The macro reads all that
is left, and makes one model of it, a `Rest`. When Hy compiles that, it is read by a `ProgramReader`, form by form again.

A `ProgramReader` reads Hy, and Lisp after `begin_lisp`: then our reader finds the forms, and each of them becomes a call of the macro
``lisp-form-read``. The form ``(in-hy)`` leads back.
"""

from __future__ import annotations

import re

from hy import models, read_many
from hy.errors import HyLanguageError
from hy.reader import HyReader
from hy.reader.exceptions import PrematureEndOfInput

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.data import Cons, Symbol
from cramhy_runtime.languages.commonlisp.reader.reader import NOTHING, incomplete
from cramhy_runtime.languages.commonlisp.reader.reader import Reader as LispReader

from ..kept_hy import Reader
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


class ProgramForm(models.Object):
    """A form of a program, which `malformed` compiles."""

    def __init__(self, form):
        self.form = form

    def __repr__(self):
        return repr(self.form)


class Rest(models.Object):
    """What is left of a text, as one model. before: the text up to it. reader: the reader that was at work.

    program: whether the text is a program, whose errors are told in our words. begin: if it is Lisp, a function that is called with the
    Lisp reader when it begins.
    """

    def __init__(self, text, before, reader, program, begin):
        self.text, self.before, self.outer, self.program, self.begin = text, before, reader, program, begin

    def __repr__(self):
        return self.text

    @property
    def filename(self):
        return self.outer._filename

    def forms(self):
        """The models of the text, read by a `ProgramReader` as they are asked for. Their places are those in the whole text."""
        reader = ProgramReader(self.program, self.begin)
        reader.reader_macros, reader.bracketed_templates = self.outer.reader_macros, self.outer.bracketed_templates
        return read_many(re.sub(r"[^\n]", " ", self.before) + self.text, self.filename, reader)


class _Take:
    """The reader macro that reads the rest of a text. place: where; own: what reads that character else."""

    def __init__(self, place, own):
        self.place, self.own = place, own
        self.program, self.begin = False, None

    def __call__(self, reader, key):
        if self.own is None:
            del reader.reader_table[key]
        else:
            reader.reader_table[key] = self.own
        if (reader._filename, reader.pos[0], reader.pos[1] - 1) != self.place:  # another text: an error came before the rest of that one
            return reader.read_default(key) if self.own is None else self.own(reader, key)
        text = key + "".join(reader.chars(eof_ok=True))
        return Rest(text, reader._source[: len(reader._source) - len(text)], reader, self.program, self.begin)


def take_rest(reader, program=False, begin=None):
    """Let a `ProgramReader` read what ``reader``, a `hy.HyReader` at work, has not read yet. program, begin: as for `Rest`."""
    reader.slurp_space()
    key = reader.peekc()
    if not key:
        return
    take = reader.reader_table.get(key)
    if not isinstance(take, _Take):
        take = reader.reader_table[key] = _Take((reader._filename, *reader.pos), take)
    take.program, take.begin = take.program or program, take.begin or begin


class ProgramReader(Reader):
    """Reads the forms of a text, in Hy, or in Lisp from `begin_lisp` on. program, begin: as for `Rest`.

    ``lisp`` reads the text while it is Lisp. The characters of each form are taken from the stream of Hy, too, so both have the same place,
    and the text can go on in Hy behind any form. told: makes an error that is told in our words of one of Hy's reader.
    """

    told = None

    def __init__(self, program=False, begin=None):
        super().__init__()
        self.program, self.begin = program, begin
        self.lisp = self.lisp_before = self.compiled_ahead = None
        self.taken = 0  # how many characters of Lisp's text have been taken from Hy's stream
        self.inside = False

    def begin_lisp(self, begin):
        """Read Lisp from here on. begin: called with the Lisp reader."""
        line, column = self.pos
        self.lisp = LispReader("".join(self.peeking(eof_ok=True)), filename=self._filename or "<hy>", line=line, column=column + 1)
        self.compiled_ahead = Ahead(self.lisp, self.lisp_before)
        self.taken = 0
        begin(self.lisp)

    def keep_up(self):
        """Take from Hy's stream what has been read of Lisp's text."""
        taken, self.taken = self.taken, self.lisp.offset
        return self.getn(self.taken - taken)

    def slurp_space(self):
        if self.lisp is None:
            skipped = super().slurp_space()
            if self.begin is not None:
                begin, self.begin = self.begin, None
                self.begin_lisp(begin)
            return skipped
        self.lisp.skip_blank()
        return self.keep_up()

    def peek_and_getc(self, target):
        over = super().peek_and_getc(target)
        if over and not target and self.lisp is not None:
            self.compiled_ahead.finish()
        return over

    def try_parse_one_form(self):
        if self.lisp is not None:
            model = self._lisp_form()
        elif self.inside or not self.program:  # of a form in a form the reader around it wants to know
            return super().try_parse_one_form()
        else:
            self.inside = True
            try:
                model = super().try_parse_one_form()
            except HyLanguageError as problem:
                raise ProgramReader.told(problem) from None
            finally:
                self.inside = False
        return ProgramForm(model).replace(model, recursive=False) if self.program and model is not None else model

    def _lisp_form(self):
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
            self.lisp_before, self.compiled_ahead, self.lisp = self.compiled_ahead, None, None
            return models.Expression([models.Symbol("in-hy")])
        return models.Expression([models.Symbol("lisp-form-read"), Form(form)])


class TypedReader(HyReader):
    """Gives each text that is typed at a prompt as one model: a call of ``answer``, a Hy model of a function, with the text.

    The text is not taken apart, because a form may change how the next one is read (``(in-package ...)``, ``(setf *readtable* ...)``), and
    at a prompt each form runs before the next one is read. One that ends inside a form, a string or a comment raises
    `hy.PrematureEndOfInput`, so Hy's REPL asks for another line.
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


__all__ = [
    "Form",
    "ProgramForm",
    "ProgramReader",
    "Rest",
    "TypedReader",
    "is_way_back",
    "more_wanted",
    "rest_of_text",
    "source_of",
    "take_rest",
]
