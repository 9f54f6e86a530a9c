"""Checking a text: what the reader and the compiler say of it, while nothing of it runs that compiling does not need.

It is compiled as ``compile-file`` does, so macros, types, packages and what stands in ``(eval-when (:compile-toplevel) ...)`` take effect.
Definitions of functions, methods and classes take effect, too: to define one runs nothing of it, and who looks up names finds it.
Values of variables, and every other form, are compiled only.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name

from ..compiler.compilation_unit import compilation_unit, report_errors_to, report_to
from ..evaluation.evaluator import PACKAGE, Unit
from ..reader.readtables import READTABLE
from .loader import is_hy_requirement, locate
from .program_files import Compilation

DEFINING = frozenset("DEFUN DEFGENERIC DEFMETHOD DEFCLASS DEFINE-CONDITION DEF-CRAM-FUNCTION DEF-TOP-LEVEL-CRAM-FUNCTION".split())
"""Operators whose forms define something and run nothing else."""

MOST_ERRORS = 50


class TextCheck(Compilation):
    """A text that is checked form by form; no code is kept."""

    def __init__(self, text, filename):
        super().__init__(text, filename, False)
        self.unit = Unit(filename, self.reader.positions)
        self.unit.at_once = False  # no form runs into an unknown name, so it is told
        self.package = None  # the one that is current at the end

    def run(self, fail):
        """Check all forms; fail: called with each condition that a form cannot be compiled for, and with what the reader cannot take."""
        end, failed = object(), 0
        while failed < MOST_ERRORS:
            self.package = PACKAGE.value
            try:
                form = self.reader.read(eof_error=False, eof_value=end)
            except (Exception, Condition) as problem:
                fail(from_python(problem))
                return
            if form is end:
                return
            if is_hy_requirement(form):
                continue
            try:
                self.unit.refuse_circle(form)
                for part, now, later in self.parts(form, False):
                    self._check(part, now, later)
            except (Exception, Condition) as problem:
                failed += 1
                condition = from_python(problem)
                locate(condition, self.filename, self.reader.positions.get(id(form)))
                fail(condition)
                if isinstance(form, Cons) and is_symbol(form.car) and symbol_name(form.car) == "IN-PACKAGE":
                    return  # what follows is read in the wrong package

    def parts(self, form, now):
        if isinstance(form, Cons) and is_symbol(form.car) and symbol_name(form.car) in DEFINING:
            yield form, True, False
        else:
            yield from super().parts(form, now)

    def _check(self, part, now, later):
        if now:
            for each in self.unit.toplevel_parts(part):
                self.unit.run(self.unit.compile(each))
        elif later:
            self.unit.compile(part)


def check_text(text, filename, warn, fail, package=None):
    """Check ``text``, which stands in the file ``filename``. Returns the package that is current at its end.

    warn: called with the list of warnings. fail: called with each error. package: the one to begin in; the current one if not given.
    """
    work = TextCheck(text, filename)
    before = report_to(warn), report_errors_to(fail)
    try:
        with binding(PACKAGE, package or PACKAGE.value, READTABLE, READTABLE.value), compilation_unit("file"):
            work.run(fail)
    finally:
        report_to(before[0])
        report_errors_to(before[1])
    return work.package


__all__ = ["check_text"]
