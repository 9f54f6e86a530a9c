"""How a ``.hy`` file becomes Common Lisp after ``(in-package ...)``.

Hy reads a file form by form, and a macro is expanded before the next form is read. So ``in-package`` can replace the reader's
way of reading a form by our own reader, on the rest of the text. What it reads is handed to the macro ``lisp-form-read``, whose
expansion is the compiler's output: core Hy forms, among them those that make the constants, because Hy keeps the bytecode.
"""

from __future__ import annotations

from hy import models, read
from hy.reader import HyReader

from cramhy_runtime.lisp.evaluation import evaluator
from cramhy_runtime.lisp.compiler.core import hy_model
from cramhy_runtime.lisp.data import Cons, list_from
from cramhy_runtime.lisp.evaluation.macros import from_hy
from cramhy_runtime.lisp.packages import find_package_or_error, intern
from cramhy_runtime.lisp.reader.reader import Reader


class Form(models.Object):
    """A Lisp form on its way through Hy's compiler."""

    def __init__(self, value):
        self.value = value

    def __repr__(self):
        return f"Form({self.value!r})"


_units: dict = {}
_END = object()


def unit_for(filename, positions=None):
    """The compiler's state for a file: its constants have names of their own, counted through the file."""
    unit = _units.get(filename)
    if unit is None:
        unit = _units[filename] = evaluator.Unit(filename, positions, stored=True)
    return unit


def lisp_form(operator, models_):
    """The Lisp form of an operator of COMMON-LISP with Hy models as arguments."""
    user = find_package_or_error("COMMON-LISP-USER")
    return Cons(intern(operator), list_from([from_hy(model, user) for model in models_]))


_COMPILE_TIME = {intern(name) for name in (
    "DEFPACKAGE", "IN-PACKAGE", "DEFMACRO", "DEFTYPE", "DEFCONSTANT", "DEFSETF", "DEFINE-MODIFY-MACRO", "DEFINE-SETF-EXPANDER",
    "DEFINE-SYMBOL-MACRO", "EVAL-WHEN", "DEFSTRUCT", "DEFCLASS", "DEFINE-CONDITION", "DECLAIM")}


def compile_form(form):
    """Hy models that do what the top-level Lisp form ``form`` does when the module runs.

    Forms that later ones need to be read or expanded (packages, macros, types) are evaluated now as well, as ``compile-file``
    does; everything else happens only when the module runs.
    """
    reader = HyReader.current_reader(create=False)
    unit = unit_for(getattr(reader, "_filename", None) or "<hy>")
    statements = []
    if not getattr(unit, "started", False):
        unit.started = True
        statements.append(models.Expression([models.Symbol("import"), read("cramhy_runtime.lisp.compiler.names"), models.Symbol("*")]))
    now = isinstance(form, Cons) and form.car in _COMPILE_TIME
    for part in unit.toplevel_parts(form):
        new = unit.statements(part)
        if now:
            unit.run(unit.code(new))
        statements += map(hy_model, new)
    return models.Expression([models.Symbol("do"), *statements, models.Symbol("Lresult")])


def take_over():
    """From the next form on, let our reader read the text that Hy's reader is reading."""
    reader = HyReader.current_reader(create=False)
    if reader is None or getattr(reader, "lisp_reader", None) is not None:
        return
    rest = "".join(iter(reader._stream.read, ""))
    if reader._peek_chars:
        rest = "".join(reader._peek_chars) + rest
    line, column = reader.pos
    filename = reader._filename or "<hy>"
    lisp_reader = reader.lisp_reader = Reader(rest, filename=filename, line=line, column=column + 1)
    unit_for(filename).positions = lisp_reader.positions
    reader.try_parse_one_form = lambda: _next_form(lisp_reader)
    reader.slurp_space = lambda: None
    reader.peek_and_getc = lambda closer: _at_end(lisp_reader)


def _at_end(lisp_reader):
    lisp_reader.skip_blank()
    return lisp_reader.offset >= len(lisp_reader.text)


def _next_form(lisp_reader):
    form = lisp_reader.read(eof_error=False, eof_value=_END)
    if form is _END:
        return None
    return models.Expression([models.Symbol("lisp-form-read"), Form(form)])


__all__ = ["compile_form", "lisp_form", "take_over"]
