"""Definitions at run time: what ``defun``, ``defvar``, ``defmacro``, ``defsetf`` and ``defconstant`` do when they are run.

The macros in ``hy_src/cramhy/cl.hy`` compute the functions; here they are entered under their symbols. A function knows its
Lisp name (``__lisp_name__``) and the file it came from, for printing, ``describe`` and the warning about redefinition.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.lisp_core.conditions import CompileError, error, program_error, restart_case, style_warn, type_error, warn
from cramhy_runtime.lisp_core.conditions import types as condition_types
from cramhy_runtime.lisp_core.data import Cons, Symbol, UNBOUND, UNSUPPLIED, UndefinedFunction, lisp_list, one
from cramhy_runtime.lisp_core.equality import eql
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.packages import printed, sym, symbol_name
from ..packages.package_errors import check_symbol, locked
from .evaluator import macro_lambda


def _check_name(symbol, what):
    if not isinstance(symbol, Symbol):
        return error(CompileError("~S cannot be defined as a ~A: its name must be a symbol.", symbol, what))
    return symbol


def source_of(function):
    """The file that the compiled function came from, or ``None``."""
    code = getattr(getattr(function, "traced", function), "__code__", None)
    return code.co_filename if code is not None else None


def define_function(name, function, documentation=None, lambda_list=UNSUPPLIED):
    """``defun``: make ``function`` the global function of ``name``, a symbol or ``(setf symbol)``. Returns the name.

    lambda_list: as it was written, for ``describe``. A function that is traced stays traced.
    """
    function.__doc__ = documentation
    if lambda_list is not UNSUPPLIED:
        function.__lisp_lambda_list__ = lambda_list
    if isinstance(name, Cons):
        symbol = name.cdr.car
        check_symbol(symbol, "setting fdefinition of ~S", name)
        function.__lisp_name__ = name
        symbol.setf_function = traced_like(symbol.setf_function, function)
        symbol.function_changed()
        return name
    _check_name(name, "function")
    new = isinstance(name.function, UndefinedFunction)
    check_symbol(name, "proclaiming ~S as a function" if new else "setting fdefinition of ~S", name)
    function.__lisp_name__ = name
    function.__name__ = function.__qualname__ = python_name(symbol_name(name))
    old = name.function
    if name.macro is not None:
        name.macro = None
    elif not isinstance(old, UndefinedFunction) and (source_of(old) != source_of(function) or source_of(function).startswith("<")):
        warn(RedefinitionWarning(f"redefining {printed(name)} in DEFUN"))
    name.function = traced_like(old, function)
    name.function_changed()
    return name


def traced_like(old, new):
    """The function ``new`` as it takes the place of ``old``: traced if that was."""
    retrace = getattr(old, "retrace", None)
    return new if retrace is None else retrace(new)


class Redefinition(condition_types.SimpleWarning):
    """Something is defined again, from another place."""

    lisp_name = "SB-KERNEL::REDEFINITION-WARNING"


class RedefinitionWarning(Redefinition):
    """A function is defined again, from another place."""

    lisp_name = "SB-KERNEL::REDEFINITION-WITH-DEFUN"


def define_macro(name, expander, documentation=None, lambda_list=None):
    """``defmacro``: ``expander`` is a function of the form and the environment. Returns the name.

    A function of that name is no more, and a style-warning says so; names that cramhy gives may be both.
    """
    _check_name(name, "macro")
    check_symbol(name, "defining ~S as a macro", name)
    if not isinstance(name.function, UndefinedFunction) and not (name.package is not None and name.package.built_in):
        style_warn("~S is being redefined as a macro when it was previously defined to be a function.", name)
        name.function = UndefinedFunction(name)
        name.function_changed()
    expander.__doc__ = documentation
    expander.__lisp_name__ = name
    name.macro = lambda form, environment: one(expander(form, environment))
    name.macro.__lisp_name__ = lisp_list(sym("MACRO-FUNCTION"), name)
    name.macro.documentation, name.macro.__lisp_lambda_list__, name.macro.source = documentation, lambda_list, expander
    return name


_taken: dict = per_image({})
"""Symbol → the places where it was taken as a keyword. They are no notes of the compiler's, which kept code depends on."""


def take_as_keyword(symbol: Symbol, place: tuple | None) -> None:
    """Note that a macro took the unbound ``symbol``, which stands at ``place``, as a keyword, where a variable would be its value.

    place: (file, line, column), or ``None``. A definition that makes it a variable later warns of that.
    """
    _taken.setdefault(symbol, {})[place] = None


def _becomes_variable(symbol):
    """Warn if ``symbol``, which has a value from now on, was taken as a keyword before: those forms keep the keyword."""
    places = _taken.pop(symbol, None)
    if places is None:
        return
    warning = condition_types.SimpleStyleWarning(
        "~S becomes a variable, but in a designator that was expanded before it is the keyword :~A.", symbol, symbol.name
    )
    told = [text for text in map(describe, places) if text]
    warning.where = f"at {', '.join(told[:3])}{' and others' if len(told) > 3 else ''}" if told else None
    warning.hint = "Define a variable before the forms that use it, and evaluate those forms again."
    warn(warning)


def define_variable(symbol, thunk=None, documentation=None, always=False):
    """``defvar`` and, with ``always``, ``defparameter``: proclaim ``symbol`` special and give it its value.

    thunk: computes the value; called for ``defvar`` only while the variable is unbound; ``None``: no value is given.
    """
    proclaim_special(symbol)
    is_new = symbol.value is UNBOUND
    if thunk is not None and (always or is_new):
        symbol.value = one(thunk())
        if is_new:
            _becomes_variable(symbol)
    if documentation is not None:
        data(symbol)["variable-documentation"] = documentation
    return symbol


class ConstantChanged(condition_types.Error):
    """A ``defconstant`` gives another value than the one before it."""

    lisp_name = "SB-EXT::DEFCONSTANT-UNEQL"

    def __init__(self, name, old, new, **slots):
        super().__init__(**slots)
        self.name, self.old, self.new = name, old, new

    def report(self):
        return (
            f"The constant {prin1_to_string(self.name)} is being redefined (from {prin1_to_string(self.old)} to "
            f"{prin1_to_string(self.new)})\nSee also:\n  The ANSI Standard, Macro DEFCONSTANT\n"
            '  The SBCL Manual, Node "Idiosyncrasies"'
        )


def define_constant(symbol, value, documentation=None):
    """``defconstant``: a value that is not ``eql`` to the one before is an error with the restarts CONTINUE and ABORT."""
    if not isinstance(symbol, Symbol):
        return error("The NAME argument to DEFCONSTANT, ~S, is not a symbol.", symbol)
    check_symbol(symbol, "defining ~S as a constant", symbol)
    if symbol.constant and not eql(symbol.value, value):
        unequal = ConstantChanged(symbol, symbol.value, value)
        keep = restart_case(
            [(sym("CONTINUE"), lambda: False, "Go ahead and change the value."), (sym("ABORT"), lambda: True, "Keep the old value.")],
            lambda: error(unequal),
        )
        if one(keep):
            return symbol
    is_new = symbol.value is UNBOUND
    symbol.value = value
    symbol.special = symbol.constant = True
    if is_new:
        _becomes_variable(symbol)
    if documentation is not None:
        data(symbol)["variable-documentation"] = documentation
    return symbol


def note_special(symbol):
    """What the compiler does when it meets a ``defvar``. Whether the variable may be defined is asked when it is."""
    if isinstance(symbol, Symbol) and not locked(symbol.package):
        proclaim_special(symbol)


def proclaim_special(symbol):
    """Make ``symbol`` a special variable. A constant or a symbol of a locked package is an error."""
    if not isinstance(symbol, Symbol):
        return type_error(symbol, "SYMBOL")
    check_symbol(symbol, "globally declaring ~S SPECIAL", symbol)
    if symbol.constant:
        return error("The constant ~S cannot be a variable.", symbol)
    symbol.special = True
    return symbol


def define_symbol_macro(symbol, expansion):
    """What ``define-symbol-macro`` does when it is run. Returns the symbol; a special variable is a program-error."""
    check_symbol(symbol, "defining ~S as a symbol-macro", symbol)
    if not isinstance(symbol, Symbol) or symbol.special:
        return program_error("Symbol macro name already declared SPECIAL: ~S.", symbol)
    data(symbol)["symbol-macro"] = expansion
    return symbol


def data(symbol):
    """The compiler's notes about ``symbol``, a dict."""
    if symbol.compiler_data is None:
        symbol.compiler_data = {}
    return symbol.compiler_data


def macro_function_form(name, lambda_list, body, definer="DEFMACRO"):
    """(lambda expression, documentation) of a macro: see `evaluator.macro_lambda`."""
    return macro_lambda(name, lambda_list, body, definer)


def type_function_form(name, lambda_list, body):
    """(lambda expression, documentation) of a ``deftype``: optional parameters are ``*`` where nothing else is said (ANSI 3.4.8)."""
    return macro_lambda(name, lambda_list, body, "DEFTYPE", lisp_list(sym("QUOTE"), sym("*")))
