"""Functions about functions, forms and the environment (ANSI chapters 3, 5, 9, 25)."""

from __future__ import annotations

from . import conditions
from .conditions import type_error
from .data import UNBOUND, Cons, Keyword, MultipleValues, Symbol, list_from, one
from .definitions import data
from .evaluator import compile_lambda, evaluate
from .functions import functionp
from .macros import macroexpand as expand_macros
from .macros import macroexpand_1 as expand_macro
from .packages import is_symbol, sym

LISP_NAMES = """eval compiled-function-p fdefinition macro-function compiler-macro-function
macroexpand macroexpand-1 special-operator-p constantp compile get-setf-expansion
error signal warn cerror break invoke-debugger compute-restarts find-restart invoke-restart invoke-restart-interactively restart-name
abort continue muffle-warning use-value store-value make-condition simple-condition-format-control
simple-condition-format-arguments type-error-datum type-error-expected-type cell-error-name unbound-slot-instance
arithmetic-error-operation arithmetic-error-operands print-not-readable-object stream-error-stream file-error-pathname"""


compiled_function_p = functionp
eval_ = evaluate


def fdefinition(name):
    from .compiler.support import fdefinition as definition
    from .compiler.support import setf_function

    return setf_function(name.cdr.car) if isinstance(name, Cons) else definition(name)


def macro_function(symbol, environment=None):
    from .macros import ensure_loaded
    from .macros import macro_function as expander

    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")

    ensure_loaded()
    return expander(symbol, environment)


def set_macro_function(function, symbol, environment=None):
    symbol.macro = lambda form, env: one(function(form, env))
    return function


def macroexpand(form, environment=None):
    expansion, expanded = expand_macros(form, environment)
    return MultipleValues((expansion, True if expanded else None))


def macroexpand_1(form, environment=None):
    expansion, expanded = expand_macro(form, environment)
    return MultipleValues((expansion, True if expanded else None))


SPECIAL_OPERATORS = {sym(name) for name in """BLOCK CATCH EVAL-WHEN FLET FUNCTION GO IF LABELS LET LET* LOAD-TIME-VALUE LOCALLY
MACROLET MULTIPLE-VALUE-CALL MULTIPLE-VALUE-PROG1 PROGN PROGV QUOTE RETURN-FROM SETQ SYMBOL-MACROLET TAGBODY THE THROW
UNWIND-PROTECT""".split()}
"""The 25 of ANSI 3.1.2.1.2.1; the compiler treats a few macros itself too, which must not show."""


def compiler_macro_function(name, environment=None):
    """The function of a compiler macro, which ``define-compiler-macro`` made; calls are compiled without it."""
    return _setf_name_data(name).get("compiler-macro")


def set_compiler_macro_function(function, name, environment=None):
    _setf_name_data(name)["compiler-macro"] = function
    return function


def define_compiler_macro(name, function):
    """What ``define-compiler-macro`` does when it is run. Returns the name."""
    set_compiler_macro_function(function, name)
    return name


def _setf_name_data(name):
    """The notes about the function of ``name``, a symbol or ``(setf symbol)``."""
    if isinstance(name, Cons):
        return data(name.cdr.car).setdefault("setf", {})
    return data(name) if isinstance(name, Symbol) else type_error(name, "SYMBOL")


def special_operator_p(symbol):
    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    return True if symbol in SPECIAL_OPERATORS else None


def constantp(form, environment=None):
    if isinstance(form, Cons):
        return True if form.car is sym("QUOTE") else None
    return True if not isinstance(form, Symbol) or isinstance(form, Keyword) or form.constant else None


def compile_(name, definition=None):
    """Three values; everything is compiled, so only a lambda expression gives work."""
    if definition is None:
        function = name if not isinstance(name, Symbol) else name.function
    else:
        function = compile_lambda(definition) if isinstance(definition, Cons) else definition
        if isinstance(name, Symbol):
            name.function = function
            function = name
    return MultipleValues((function if name is None or isinstance(name, Symbol) is False else name, None, None))


def get_setf_expansion(place, environment=None):
    from .places import get_setf_expansion as expansion

    return expansion(place, environment)


error, signal, warn, cerror, break_ = conditions.error, conditions.signal, conditions.warn, conditions.cerror, conditions.break_
invoke_debugger = conditions.invoke_debugger


def compute_restarts(condition=None):
    return list_from(conditions.compute_restarts(condition))


find_restart, invoke_restart = conditions.find_restart, conditions.invoke_restart
invoke_restart_interactively = conditions.invoke_restart_interactively
abort, continue_, muffle_warning = conditions.abort, conditions.continue_, conditions.muffle_warning
use_value, store_value = conditions.use_value, conditions.store_value


def restart_name(restart):
    return restart.name


def make_condition(kind, *arguments):
    return conditions.make_condition(kind, arguments)


def _reader(attribute, kind="Condition"):
    def reader(condition):
        if not isinstance(condition, conditions.Condition):
            return type_error(condition, "CONDITION")
        value = getattr(condition, attribute, UNBOUND)
        return type_error(condition, getattr(conditions, kind).lisp_name) if value is UNBOUND else value

    return reader


simple_condition_format_control = _reader("format_control", "SimpleCondition")
type_error_datum = _reader("datum", "TypeError_")


def type_error_expected_type(condition):
    """The type specifier. The runtime names types by their printed form, which is read here."""
    expected = condition.expected_type
    if not isinstance(expected, str):
        return expected
    from .dynamic import binding
    from .evaluator import PACKAGE
    from .packages import COMMON_LISP
    from .reader import read_from_string

    with binding(PACKAGE, COMMON_LISP):
        return one(read_from_string(expected))


print_not_readable_object = _reader("object", "PrintNotReadable")
cell_error_name, unbound_slot_instance = _reader("name"), _reader("instance")
arithmetic_error_operation, arithmetic_error_operands = _reader("operation"), _reader("operands")
stream_error_stream, file_error_pathname = _reader("stream"), _reader("pathname")


def simple_condition_format_arguments(condition):
    arguments = condition.format_arguments
    return list_from(arguments) if isinstance(arguments, tuple) else arguments


SETTERS = {"MACRO-FUNCTION": set_macro_function, "COMPILER-MACRO-FUNCTION": set_compiler_macro_function}

