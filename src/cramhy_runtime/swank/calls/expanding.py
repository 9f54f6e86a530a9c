"""Calls that expand macros."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.printer.print_controls import PRINT_PRETTY, PRINT_RIGHT_MARGIN
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import Reader
from cramhy_runtime.languages.commonlisp.syntax import macros

from ..rpcs import rpc, text

QUOTE = sym("QUOTE")
WIDTH = 80


def _expanded(call, source, expand):
    with binding(evaluator.PACKAGE, call.package):
        form = Reader(text(source), filename="<macro>").read()
        with binding(PRINT_PRETTY, True, PRINT_RIGHT_MARGIN, WIDTH):
            return prin1_to_string(expand(form))


@rpc("swank-macroexpand-1 swank-expand-1", evaluates=True)
def expand_1(call, source):
    return _expanded(call, source, lambda form: macros.macroexpand_1(form)[0])


@rpc("swank-macroexpand swank-expand", evaluates=True)
def expand(call, source):
    return _expanded(call, source, lambda form: macros.macroexpand(form)[0])


@rpc("swank-macroexpand-all", evaluates=True)
def expand_all(call, source):
    return _expanded(call, source, everywhere)


@rpc("swank-compiler-macroexpand-1 swank-compiler-macroexpand", evaluates=True)
def compiler_expand(call, source):
    return _expanded(call, source, lambda form: form)


def everywhere(form):
    """``form`` with all macro calls in it expanded, as far as one can tell from the outside: what is quoted stays as it is."""
    form = macros.macroexpand(form)[0]
    if not isinstance(form, Cons) or form.car is QUOTE:
        return form
    items, cell = [], form
    while isinstance(cell, Cons):
        items.append(cell.car)
        cell = cell.cdr
    if cell is not None:
        return form
    head = items[0]
    rest = [everywhere(item) if isinstance(item, Cons) else item for item in items[1:]]
    return list_from([head if isinstance(head, Symbol) else everywhere(head), *rest])


@rpc("swank-format-string-expand", evaluates=True)
def format_string(call, source):
    return text(source)
