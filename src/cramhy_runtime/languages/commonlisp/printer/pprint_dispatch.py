"""Which function pretty-prints which object: the tables of ``*print-pprint-dispatch*``.

An entry says: objects of this type are printed by that function, with this priority. The standard entries have the
lowest priority and are kept apart in a form that is quick to look up: a dict from operator to layout, and rules for
other lists and for arrays. Entries that a user adds with ``set-pprint-dispatch`` are tried by type, the highest
priority first. Source: ANSI 22.2.1.4; SBCL ``src/code/pprint.lisp``.
"""

from __future__ import annotations

from .components import COMPONENTS
from cramhy_runtime.lisp_core.ports import PORTS
from fractions import Fraction

from cramhy_runtime.lisp_core.arrays import LispArray, is_bit_vector
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Cons, MultipleValues, Symbol, UndefinedFunction, python_list
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.equality import equal
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, sym
from . import pprint_code as code
from .pretty import pprint_fill
from .print_arrays import pprint_array

_LAYOUTS = {
    code.pprint_lambda: "lambda",
    code.pprint_declare: "declare declaim",
    code.pprint_block: (
        "block catch return-from throw eval-when multiple-value-call multiple-value-prog1 unwind-protect "
        "defconstant defparameter defstruct defvar multiple-value-setq prog1 pprint-logical-block "
        "print-unreadable-object unless when with-compilation-unit with-simple-restart "
        "with-hash-table-iterator with-package-iterator with-input-from-string with-output-to-string "
        "with-open-file with-open-stream"
    ),
    code.pprint_flet: "flet labels macrolet",
    code.pprint_quote: "function quote",
    code.pprint_if: "if",
    code.pprint_let: "let let* symbol-macrolet",
    code.pprint_progn: "locally progn step time with-standard-io-syntax",
    code.pprint_prog2: "progv multiple-value-bind prog2",
    code.pprint_setq: "setq psetq setf psetf",
    code.pprint_tagbody: "tagbody",
    code.pprint_case: "case ccase ecase",
    code.pprint_typecase: "ctypecase etypecase typecase",
    code.pprint_defun: "define-modify-macro define-setf-expander defmacro defsetf deftype defun",
    code.pprint_defmethod: "defmethod",
    code.pprint_defpackage: "defpackage",
    code.pprint_destructuring_bind: "destructuring-bind",
    code.pprint_do: "do do*",
    code.pprint_dolist: "do-all-symbols do-external-symbols do-symbols dolist dotimes",
    code.pprint_loop: "loop",
    code.pprint_prog: "prog prog*",
}
_STANDARD = {sym(name.upper()): layout for layout, names in _LAYOUTS.items() for name in names.split()}
LOWEST = -3.4028235e38


class Entry:
    """One line of a table. ``priority`` is a real."""

    __slots__ = ("type", "priority", "function")

    def __init__(self, type_, priority, function):
        self.type, self.priority, self.function = type_, priority, function


class DispatchTable:
    """A pprint dispatch table: ``operators`` by the head of a list, ``entries`` by type, the most important first."""

    lisp_name = "SB-PRETTY:PPRINT-DISPATCH-TABLE"

    def __init__(self, operators=None, entries=()):
        self.operators = dict(operators or {})
        self.entries = list(entries)

    def copy(self):
        return DispatchTable(self.operators, self.entries)

    def find(self, obj):
        """The function ``(stream, object)`` that prints ``obj`` prettily; ``None`` when nothing is said about it."""
        found = self.find_designator(obj)
        return found.function if isinstance(found, Symbol) else found

    def find_designator(self, obj):
        """The same as it was given to ``set-pprint-dispatch``: a function or a symbol."""
        chosen = None
        if obj.__class__ is Cons:
            head = obj.car
            if isinstance(head, Symbol):
                chosen = self.operators.get(head)
        if self.entries:
            for entry in self.entries:
                if chosen is not None and entry.priority < chosen.priority:
                    break
                if _is_of_type(obj, entry.type):
                    return entry.function
        return chosen.function if chosen is not None else standard(obj)


def standard(obj):
    """The layout of an object that no table mentions."""
    if obj.__class__ is Cons:
        head = obj.car
        if isinstance(head, Symbol):
            if head.name == "QUASIQUOTE":
                return code.pprint_quote
            if _is_operator(head):
                return code.pprint_call_form
        return pprint_fill
    return pprint_array if isinstance(obj, (list, LispArray)) and not is_bit_vector(obj) else None


def _is_operator(symbol):
    """Whether ``symbol`` names a function, macro or special operator, so that a list that starts with it looks like a call."""
    if not isinstance(symbol.function, UndefinedFunction) or symbol.macro is not None:
        return True
    return symbol.package is COMMON_LISP and symbol.name in code.OPERATORS


def _is_of_type(obj, specifier):
    return PORTS.types.predicate(specifier)(obj)


INITIAL = DispatchTable({head: Entry(None, LOWEST, layout) for head, layout in _STANDARD.items()})
PRINT_PPRINT_DISPATCH = special("*PRINT-PPRINT-DISPATCH*", INITIAL.copy())


def _table(designator):
    if designator is None:
        return INITIAL
    return designator if isinstance(designator, DispatchTable) else type_error(designator, f"(OR {DispatchTable.lisp_name} NULL)")


def copy_pprint_dispatch(table=PRINT_PPRINT_DISPATCH):
    """``copy-pprint-dispatch``: a copy of ``table``; of the initial one for nil."""
    return _table(table.value if table is PRINT_PPRINT_DISPATCH else table).copy()


def pprint_dispatch(obj, table=PRINT_PPRINT_DISPATCH):
    """``pprint-dispatch``: the function for ``obj``, and whether the table has one."""
    found = _table(table.value if table is PRINT_PPRINT_DISPATCH else table).find_designator(obj)
    if found is None:
        return MultipleValues((lambda stream, thing, *_: COMPONENTS.output_ugly(thing, stream), None))
    return MultipleValues((found, True))


def set_pprint_dispatch(type_, function, priority=0, table=None):
    """``set-pprint-dispatch``: print objects of ``type_`` with ``function`` (of stream and object); nil removes the
    entry.
    """
    table = _table(table or PRINT_PPRINT_DISPATCH.value)
    if not isinstance(priority, (int, float, Fraction)):
        type_error(priority, "REAL")
    if not (is_symbol(type_) or isinstance(type_, type) or isinstance(type_, Cons) and is_symbol(type_.car)):
        error("~S is not a valid type-specifier", type_)
    heads = _heads(type_)
    if heads is not None:
        for head in heads:
            if function is None:
                table.operators.pop(head, None)
            else:
                table.operators[head] = Entry(type_, priority, function)
        return None
    table.entries = [entry for entry in table.entries if not equal(entry.type, type_)]
    if function is not None:
        table.entries.append(Entry(type_, priority, function))
        table.entries.sort(key=lambda entry: -entry.priority)
    return None


def _heads(type_):
    """The symbols for a type ``(cons (member ...))`` or ``(cons (eql x))``; ``None`` for other types."""
    parts = python_list(type_) if isinstance(type_, Cons) else []
    if len(parts) == 2 and parts[0] is sym("CONS") and isinstance(parts[1], Cons) and parts[1].car in (sym("MEMBER"), sym("EQL")):
        return [head for head in parts[1].cdr if isinstance(head, Symbol)]
    return None


LISP_NAMES = "copy-pprint-dispatch pprint-dispatch set-pprint-dispatch"
