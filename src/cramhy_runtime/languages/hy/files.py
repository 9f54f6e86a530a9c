"""How a ``.hy`` file becomes Common Lisp after ``(in-package ...)``.

Hy reads a file form by form, and a macro is expanded before the next form is read. So ``in-package`` can replace the reader's
way of reading a form by our own (``reader.py``), on the rest of the text. What it reads is handed to the macro ``lisp-form-read``, whose
expansion is the compiler's output: core Hy forms, among them those that make the constants, because Hy keeps the bytecode.
"""

from __future__ import annotations

from hy import models, read
from hy.reader import HyReader

from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.compiler.core import hy_model
from cramhy_runtime.lisp_core.condition_types import Condition, Warning_
from cramhy_runtime.lisp_core.conditions import handler_bind, muffle_warning
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.languages.commonlisp.syntax.hy_models import from_hy
from cramhy_runtime.lisp_core.packages import find_package_or_error, intern
from . import rest_of_file
from .reader import ProgramReader, take_rest


_units: dict = {}


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


_DEFPACKAGE = intern("DEFPACKAGE")
_COMPILE_TIME = {
    intern(name)
    for name in (
        "DEFPACKAGE",
        "IN-PACKAGE",
        "DEFMACRO",
        "DEFTYPE",
        "DEFCONSTANT",
        "DEFSETF",
        "DEFINE-MODIFY-MACRO",
        "DEFINE-SETF-EXPANDER",
        "DEFINE-SYMBOL-MACRO",
        "EVAL-WHEN",
        "DEFSTRUCT",
        "DEFCLASS",
        "DEFINE-CONDITION",
        "DECLAIM",
    )
}


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
        statements.append(
            models.Expression([models.Symbol("import"), read("cramhy_runtime.languages.hy.compiled_names"), models.Symbol("*")])
        )
    now = isinstance(form, Cons) and form.car in _COMPILE_TIME
    ahead = getattr(reader, "compiled_ahead", None) or rest_of_file.Ahead(None)
    try:
        with ahead.noticing():
            for part in unit.toplevel_parts(form):
                new = unit.statements(part)
                if now:
                    _run_now(unit, new, form)
                statements += map(hy_model, new)
    except (Exception, Condition):
        if not ahead.known:
            raise
        return models.Expression([models.Symbol("do"), *statements[:1], ahead.rest()])
    last = [ahead.rest(after=True)] if ahead.known and rest_of_file.loads(form) else [models.Symbol("Lresult")]
    return models.Expression([models.Symbol("do"), *statements, *last])


def _run_now(unit, statements, form):
    code = unit.code(statements)
    if form.car is not _DEFPACKAGE:
        unit.run(code)
    else:  # it is evaluated again when the module runs, and that time it tells what another definition of the package had
        handler_bind([(Warning_, muffle_warning)], lambda: unit.run(code))


def take_over():
    """From the next form on, let our reader read the text that Hy's reader is reading."""
    reader = HyReader.current_reader(create=False)
    if reader is None or getattr(reader, "lisp", None) is not None:
        return
    evaluator.compiler().allow_exits_from_cleanup()
    if isinstance(reader, ProgramReader):
        reader.begin_lisp(_note_places)
    else:
        take_rest(reader, begin=_note_places)


def _note_places(lisp):
    unit_for(lisp.filename).positions = lisp.positions


__all__ = ["compile_form", "lisp_form", "take_over"]
