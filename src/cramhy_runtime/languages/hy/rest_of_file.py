"""A Lisp text that Hy compiles ahead, and its rest, which is loaded form by form when the module runs.

Hy compiles a whole file before anything in it runs. Common Lisp loads a file form by form, so a form may need what an earlier one
did: ``(asdf:load-system :my-plans)`` makes the package in whose name the next form calls. What follows such a form is therefore loaded
when its turn comes, and so is a form that cannot be read or compiled ahead, with all that follows it, up to ``(in-hy)`` at the beginning
of a line if there is one. If it is wrong, the error comes where ``cramhy run`` gives it: after what the forms before it have printed.
"""

from __future__ import annotations

import re
from contextlib import contextmanager

from hy import models, read

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name

from ..commonlisp.compiler import compilation_unit
from ..commonlisp.reader.reader import incomplete
from ..commonlisp.systems import loader

_LOADING = {"LOAD", "LOAD-SYSTEM", "REQUIRE", "QUICKLOAD", "OPERATE", "OOS", "TEST-SYSTEM"}


def loads(form):
    """Whether the top-level ``form`` loads other files, on which the forms after it may depend."""
    return isinstance(form, Cons) and is_symbol(form.car) and symbol_name(form.car) in _LOADING


class Ahead:
    """How far the text of ``reader``, a Lisp reader, has been compiled ahead, and what the compiler noticed. ``None``: nobody knows.

    before: the `Ahead` of an earlier part of the same file, whose functions this part may call.
    """

    def __init__(self, reader, before=None):
        self.reader = reader
        self.start = None
        self.unit = compilation_unit.CompilationUnit("file") if before is None else before.unit
        self.whole = before is None or before.whole

    @property
    def known(self):
        """Whether it is known where in the text the last form begins."""
        return self.start is not None

    @contextmanager
    def noticing(self):
        """While the block runs, what the compiler notices belongs to this text."""
        with binding(compilation_unit.CURRENT, self.unit):
            yield

    def begin_form(self):
        """The next form begins here."""
        self.reader.skip_blank()
        self.start = self.reader.offset

    def rest(self, after=False):
        """The Hy form that loads the text from the last form on, or what comes after it, when the module runs. Only ``(in-hy)`` is read."""
        start = self.reader.offset if after else self.start
        end = _end_of_lisp(self.reader.text, start)
        text, (line, column) = self.reader.text[start:end], self.reader.place(start)[:2]
        self.start, self.whole, self.reader.offset = None, False, end
        if not text.strip():
            return models.Symbol("None")
        where = models.String(text), models.String(self.reader.filename), models.Integer(line), models.Integer(column)
        return models.Expression([read("hy.I.cramhy_runtime/languages/hy/rest_of_file.load_rest"), *where])

    def finish(self):
        """The text is over: tell what the compiler noticed. Functions that the rest may define are not missed."""
        with self.noticing():
            self.unit.settle(undefined=self.whole)
        self.unit.show()


def _end_of_lisp(text, start):
    """Where Lisp that begins at ``start`` ends: before ``(in-hy)`` at the beginning of a line, and not in a form, string or comment."""
    for found in _WAY_BACK.finditer(text, start):
        if not incomplete(text[start : found.start()]):
            return found.start()
    return len(text)


_WAY_BACK = re.compile(r"^\(in-hy\)", re.M | re.I)


def load_rest(text, filename, line, column):
    """Load the forms of ``text``, which stands in ``filename`` from ``line`` and ``column`` on. Returns ``None``."""
    loader.load_part(text, filename, line, column)


__all__ = ["Ahead", "load_rest", "loads"]
