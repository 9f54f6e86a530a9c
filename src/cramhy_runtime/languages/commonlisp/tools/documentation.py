"""``documentation`` and its setter: the text that belongs to a name or an object, for every kind of thing that has one.

A function keeps its text as Python's ``__doc__``, a class too, so that Python's ``help`` shows what Lisp's ``describe`` shows;
the texts of variables, places and of names without an object lie with the symbol. Both functions are generic, as in the
standard. Source: ANSI 25.2 (DOCUMENTATION); the texts of the warning and of ``(setf documentation)`` are SBCL's.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import warn
from cramhy_runtime.lisp_core.data import Cons, LispString, Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.printing import attempt_to_print, prin1_to_string, suppressed
from ..evaluation.definitions import data
from ..evaluation.forms import compiler_macro_function
from ..objects import classes
from ..objects.class_objects import DirectSlot, Slot
from cramhy_runtime.lisp_core.dispatch.generic_functions import generic
from cramhy_runtime.lisp_core.dispatch.method_combination import Combination, known_combination
from cramhy_runtime.lisp_core.dispatch.methods import Method
from cramhy_runtime.lisp_core.dispatch.generic_functions import protocol_function
from cramhy_runtime.lisp_core.packages import Package, is_symbol, symbol_name
from ..types import types

LISP_NAMES = "documentation"


def _function_of_name(name):
    """What carries the text of the function or macro ``name``; ``None`` when there is nothing."""
    if isinstance(name, Cons):
        return getattr(name.cdr.car, "setf_function", None) if isinstance(name.cdr, Cons) else None
    if not isinstance(name, Symbol):
        return None
    return name.macro if name.macro is not None else _defined(name.function)


def _defined(function):
    return None if isinstance(function, UndefinedFunction) else getattr(function, "traced", function)


def _type_of_name(name):
    """What carries the text of the type ``name``: a class or the function of a ``deftype``."""
    return types.type_expander(name) or classes.symbol_class(name)


_CARRIERS = {
    "FUNCTION": _function_of_name,
    "COMPILER-MACRO": compiler_macro_function,
    "TYPE": _type_of_name,
    "STRUCTURE": _type_of_name,
    "METHOD-COMBINATION": known_combination,
}
KINDS = {*_CARRIERS, "VARIABLE", "SETF"}


def _carrier(obj, kind):
    """The object whose text is meant, or ``None`` if the text lies with the symbol."""
    if is_symbol(obj) or isinstance(obj, Cons):
        find = _CARRIERS.get(kind)
        return find(obj) if find is not None else None
    return obj


def _attribute(carrier):
    return "documentation" if hasattr(carrier, "documentation") else "__doc__"


def _unsupported(obj, kind):
    warn("~@<unsupported DOCUMENTATION: doc-type ~S for object of type ~S~:@>", kind, types.type_of(obj))


def _supported(obj, kind):
    if is_symbol(obj):
        return symbol_name(kind) in KINDS
    if isinstance(obj, Cons):
        return symbol_name(kind) in ("FUNCTION", "COMPILER-MACRO")
    return callable(obj) or isinstance(obj, (Package, Method, DirectSlot, Slot, Combination))


def _symbol_of(name):
    return name.cdr.car if isinstance(name, Cons) else name


def _key(name, kind):
    return f"setf-{kind.lower()}-documentation" if isinstance(name, Cons) else f"{kind.lower()}-documentation"


def _documentation(obj, doc_type):
    """The text of ``obj`` as a ``doc_type`` (a symbol), or nil."""
    if not is_symbol(doc_type) or not _supported(obj, doc_type):
        return _unsupported(obj, doc_type)
    kind = symbol_name(doc_type)
    carrier = _carrier(obj, kind)
    if carrier is not None:
        text = getattr(carrier, _attribute(carrier), None)
        if text is not None:
            return text
    if is_symbol(obj) or isinstance(obj, Cons):
        symbol = _symbol_of(obj)
        return (symbol.compiler_data or {}).get(_key(obj, kind)) if isinstance(symbol, Symbol) else None
    return None


def _set_documentation(text, obj, doc_type):
    if not is_symbol(doc_type) or not _supported(obj, doc_type):
        _unsupported(obj, doc_type)
        return text
    kind = symbol_name(doc_type)
    carrier = _carrier(obj, kind)
    if carrier is not None:
        try:
            setattr(carrier, _attribute(carrier), text)
            return text
        except (AttributeError, TypeError):  # a function or class that is not written in Python
            if not is_symbol(obj):
                return text
    if isinstance(_symbol_of(obj), Symbol):
        data(_symbol_of(obj))[_key(obj, kind)] = text
    return text


documentation = protocol_function("DOCUMENTATION", "(object doc-type)", _documentation)
set_documentation = generic("(setf DOCUMENTATION)", "(new-value object doc-type)")
set_documentation.method(None, None, None)(_set_documentation)


def shown_documentation(obj, kind):
    """The text of ``obj`` as a ``kind`` for somebody who looks it up, or nil. A method that fails, or gives no text, is told as such."""

    def failed(problem):
        return f"#<error finding the documentation: {' '.join(str(problem).split())}>"

    text = suppressed(lambda: documentation(obj, kind), failed)
    return text if text is None or isinstance(text, (str, LispString)) else attempt_to_print(prin1_to_string, text)
