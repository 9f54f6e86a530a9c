"""Functions about forms: compiling and expanding them, and what kind of form they are (ANSI chapter 3)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import StyleWarning, error, type_error, types
from cramhy_runtime.lisp_core.data import Cons, Keyword, MultipleValues, Symbol, UndefinedFunction, one
from cramhy_runtime.lisp_core.packages import is_symbol, redefined, sym
from ..compiler import compilation_unit
from ..packages.package_errors import check_function_name
from ..syntax import macros
from ..collections.lists import items_of
from .definitions import data
from .evaluator import compile_lambda
from .symbols import place_of
from cramhy_runtime.lisp_core.functions import function_of, functionp

LISP_NAMES = "macro-function compiler-macro-function macroexpand macroexpand-1 special-operator-p constantp compile"

SPECIAL_OPERATORS = {
    sym(name)
    for name in """BLOCK CATCH EVAL-WHEN FLET FUNCTION GO IF LABELS LET LET* LOAD-TIME-VALUE LOCALLY
MACROLET MULTIPLE-VALUE-CALL MULTIPLE-VALUE-PROG1 PROGN PROGV QUOTE RETURN-FROM SETQ SYMBOL-MACROLET TAGBODY THE THROW
UNWIND-PROTECT""".split()
}
"""The 25 of ANSI 3.1.2.1.2.1; the compiler treats a few macros itself too, which must not show."""


def macro_function(symbol, environment=None):
    """``macro-function``: the expander of ``symbol``, a function of a form and an environment, or nil."""
    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    macros.ensure_loaded()
    return macros.macro_function(symbol, macros.checked_environment(environment))


def set_macro_function(function, symbol, environment=None):
    """``(setf macro-function)``: ``function`` takes a form and an environment."""
    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    expander = function_of(function)
    redefined(symbol)
    symbol.macro = lambda form, env: one(expander(form, env))
    return function


def macroexpand(form, environment=None):
    """``macroexpand``: two values, the expansion and whether there was one."""
    expansion, expanded = macros.macroexpand(form, macros.checked_environment(environment))
    return MultipleValues((expansion, True if expanded else None))


def macroexpand_1(form, environment=None):
    """``macroexpand-1``: two values, the form expanded once and whether it was a macro call."""
    expansion, expanded = macros.macroexpand_1(form, macros.checked_environment(environment))
    return MultipleValues((expansion, True if expanded else None))


def special_operator_p(symbol):
    """``special-operator-p``: whether ``symbol`` is one of the 25."""
    if not is_symbol(symbol):
        return type_error(symbol, "SYMBOL", "\nwhen binding SYMBOL")
    return True if symbol in SPECIAL_OPERATORS else None


def compiler_macro_function(name, environment=None):
    """The function of a compiler macro, which ``define-compiler-macro`` made; calls of the global function are compiled with it."""
    return _setf_name_data(name).get("compiler-macro")


def set_compiler_macro_function(function, name, environment=None):
    """``(setf compiler-macro-function)``; nil takes the compiler macro away."""
    if function is None:
        _setf_name_data(name).pop("compiler-macro", None)
    else:
        _setf_name_data(name)["compiler-macro"] = function
    return function


def define_compiler_macro(name, function, documentation=None):
    """What ``define-compiler-macro`` does when it is run. Returns the name."""
    check_function_name(name, "setting the compiler-macro-function of ~S")
    set_compiler_macro_function(function, name)
    function.documentation = documentation
    return name


def _setf_name_data(name):
    """The notes about the function of ``name``, a symbol or ``(setf symbol)``."""
    place = place_of(name)
    if place is not None:
        return data(place).setdefault("setf", {})
    return data(name) if isinstance(name, Symbol) else {}


def constantp(form, environment=None):
    """``constantp``: whether ``form`` always has the same value: also a call of a function of numbers or lists on constants, as in SBCL."""
    macros.checked_environment(environment)
    if isinstance(form, Cons):
        return True if _constant_compound(form, environment) else None
    if isinstance(form, Symbol):
        local = environment.variable(form) if environment is not None else None
        expansion, expanded = macros.macroexpand_1(form, environment)
        if expanded:
            return constantp(expansion, environment)
        if local is not None:
            return None
    return True if not isinstance(form, Symbol) or isinstance(form, Keyword) or form.constant else None


CONSTANT_FUNCTIONS = {
    sym(name)
    for name in """+ - * / 1+ 1- = /= < > <= >= ABS MIN MAX MOD REM FLOOR CEILING ROUND TRUNCATE EXPT SQRT EXP LOG SIN COS
TAN ASH LOGAND LOGIOR LOGXOR LOGNOT GCD LCM EVENP ODDP ZEROP PLUSP MINUSP CAR CDR NOT NULL EQ EQL CONSP LISTP ATOM NUMBERP STRINGP
SYMBOLP CHAR-CODE CODE-CHAR CHAR= NUMERATOR DENOMINATOR FLOAT""".split()
}
"""Functions whose call on constants is a constant for `constantp`. The compiler does not ask: Python folds the operators that it writes."""


def _constant_compound(form, environment):
    if not is_symbol(form.car):
        return False
    head, arguments = form.car, items_of(form.cdr)
    if head is sym("QUOTE"):
        return len(arguments) == 1
    if environment is not None and isinstance(head, Symbol) and environment.function(head) is not None:
        return False
    if head is sym("THE"):
        return len(arguments) == 2 and constantp(arguments[1], environment)
    if head in (sym("IF"), sym("PROGN")) or head in CONSTANT_FUNCTIONS:
        return all(constantp(argument, environment) for argument in arguments)
    return False


def compile_(name, definition=None):
    """``compile``: three values, the function or ``name``, whether there were warnings, and whether some were worse than style.

    Everything is compiled anyway, so only a lambda expression gives work.
    """
    warned = failed = None
    function = definition
    if isinstance(definition, Cons):
        function, warnings = compilation_unit.noticing(lambda: compile_lambda(definition))
        warned = True if warnings else None
        failed = True if any(not isinstance(warning, StyleWarning) for warning in warnings) else None
    if name is None:
        return MultipleValues((function, warned, failed))
    place = place_of(name)
    if definition is None:
        defined_function(name)
    elif functionp(function) is None:
        type_error(function, "(OR FUNCTION CONS)")
    elif place is not None:
        redefined(place)
        place.setf_function = function
        place.function_changed()
    else:
        redefined(name)
        name.function = function
        name.function_changed()
    return MultipleValues((name, warned, failed))


def defined_function(name):
    """The function called ``name``; an undefined one is an error."""
    place = place_of(name)
    function = place.setf_function if place is not None else getattr(name, "macro", None) or getattr(name, "function", None)
    if function is None or isinstance(function, UndefinedFunction):
        error(types.UndefinedFunction(name))
    return function


SETTERS = {"MACRO-FUNCTION": set_macro_function, "COMPILER-MACRO-FUNCTION": set_compiler_macro_function}
