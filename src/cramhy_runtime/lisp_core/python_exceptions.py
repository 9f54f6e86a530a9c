"""Python's exceptions as conditions: each class of exceptions has a class of conditions, arranged as in Python.

``(handler-case (py:call "int" "x") (py:ValueError (e) ...))`` works because ``py:ValueError`` (or ``py:value-error``) names the
condition class of ``ValueError``; all are errors. Where Common Lisp has a class of its own for the same thing, that is it: a
``ZeroDivisionError`` is a ``division-by-zero``. The text of such a condition is that of the exception, which
``py:exception`` gives.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from . import condition_types as types
from .function_codes import codes_named
from .packages import all_packages
from .ports import PORTS
from .python_names import lisp_spelling

PYTHON = "PYTHON"
EQUIVALENT = {
    Exception: types.Error,
    ArithmeticError: types.ArithmeticError_,
    ZeroDivisionError: types.DivisionByZero,
    OverflowError: types.FloatingPointOverflow,
    RecursionError: types.StorageCondition,
    MemoryError: types.StorageCondition,
}
"""Classes of exceptions that are classes of conditions already."""
ALSO = {EOFError: types.EndOfFile}
"""Classes of exceptions that mean what a class of conditions means: a handler for either gets them."""

_classes: dict = {}


def condition_class(cls):
    """The class of conditions for the class ``cls`` of exceptions."""
    found = EQUIVALENT.get(cls) or _classes.get(cls)
    if found is None:
        bases = tuple(
            dict.fromkeys(condition_class(base) for base in cls.__bases__ if issubclass(base, Exception) and base not in EQUIVALENT)
        ) or (types.PythonError,)
        if cls in ALSO:
            bases += (ALSO[cls],)
        found = _classes[cls] = type(
            cls.__name__, bases, {"lisp_name": f"{PYTHON}::{lisp_spelling(cls.__name__)}", "__module__": __name__, "__doc__": cls.__doc__}
        )
    return found


def python_condition(exception):
    """The condition for an exception that has no meaning of its own in Lisp."""
    condition = condition_class(type(exception))(exception)
    if isinstance(exception, ModuleNotFoundError) and exception.name:
        asked = f"Is there a module {exception.name} in this Python, or is it to be installed with pip?"
        condition.hint = getattr(exception, "hint", asked)
    if isinstance(exception, SyntaxError):  # it knows its place itself, and perhaps what to try
        condition.hint = getattr(exception, "hint", None)
        if exception.filename and exception.lineno:
            condition.position = exception.filename, exception.lineno, exception.offset
    return condition


def exception(condition):
    """``py:exception``: the Python exception that ``condition`` stands for."""
    if isinstance(condition, types.PythonError):
        return condition.exception
    return condition if isinstance(condition, types.Condition) else PORTS.signals.type_error(condition, "CONDITION")


_ARITY = (  # a text: Python compiles it when the first such error is made, not when a plan starts
    r"^(?P<name>.*)\(\) (?:takes (?:from )?(?P<least>\d+)(?: to (?P<most>\d+))? positional arguments? but (?P<given>\d+) (?:was|were) given"
    r"|missing \d+ required positional arguments?: (?P<missing>'.*))$"
)
_VARARGS = 0x04  # the flag of code with a parameter ``*rest``


def _wrong_argument_count(exception):
    """The program-error for Python's complaint about the number of arguments of a call, or ``None`` if it is another one.

    Of too few arguments Python says which are missing, not how many were given, so the code of the function is looked up by its name.
    """
    import re

    match = re.match(_ARITY, str(exception))
    if not match:
        return None
    missing = re.findall(r"'([^']*)'", match["missing"] or "")
    name, code = _called(match["name"], missing, exception)
    if match["given"]:
        condition = types.SimpleProgramError("invalid number of arguments: ~S", int(match["given"]))
        least, most = int(match["least"]), int(match["most"] or match["least"])
    elif code is None:
        return types.SimpleProgramError("invalid number of arguments")
    else:  # the arguments that were given are those before the first missing one; the last missing one is the last that is required
        condition = types.SimpleProgramError("invalid number of arguments: ~S", code.co_varnames.index(missing[0]))
        least, most = code.co_varnames.index(missing[-1]) + 1, code.co_argcount
    count = f"{least} to {most}" if least != most else str(most)
    if code is not None and code.co_flags & _VARARGS:
        count = f"at least {least}"
    condition.hint = f"{name} takes {count} argument{'' if count.split()[-1] == '1' else 's'}."
    return condition


def _called(name, missing, exception):
    """(how the user calls it, its code or ``None``) for Python's qualified name of a function that misses the parameters ``missing``."""
    if "<locals>" not in name:
        for package in all_packages():
            for table in (package.external, package.internal):
                for symbol in table.values():
                    function = getattr(symbol, "function", None)
                    if getattr(function, "__qualname__", None) == name:
                        code = getattr(getattr(function, "python", function), "__code__", None)
                        if _takes(code, missing):
                            return types.shown(symbol), code
    code = next((code for code in codes_named(name, exception.__traceback__) if _takes(code, missing)), None)
    short = name.rpartition(".")[2]
    if short.startswith(("<lambda>", "Lfunction")):
        return "The function", code
    return f"The function {short.replace('_', '-').upper()}", code


def _takes(code, missing):
    """Whether a function of that code can be the one that misses these parameters (none: it was given too many)."""
    parameters = () if code is None else code.co_varnames[: code.co_argcount]
    return code is not None and all(name in parameters for name in missing)


def condition_for(exception):
    """The condition that says in Lisp what the Python ``exception`` says."""
    if isinstance(exception, ZeroDivisionError):
        return types.DivisionByZero()
    if isinstance(exception, OverflowError):
        return types.FloatingPointOverflow()
    if isinstance(exception, RecursionError):
        return types.StorageCondition("Control stack exhausted: a function calls itself too deeply, perhaps without end.")
    if isinstance(exception, MemoryError):
        return types.StorageCondition("Heap exhausted: there is no memory for this object.")
    if isinstance(exception, kernel.Deadlock):
        return types.Deadlock(exception)
    if isinstance(exception, kernel.TimeLimit):
        return types.TimeLimit(exception)
    if isinstance(exception, TypeError):
        wrong = _wrong_argument_count(exception)
        if wrong is not None:
            return wrong
    if isinstance(exception, AttributeError) and hasattr(type(exception.obj), "lisp_condition"):
        return exception.obj.lisp_condition(exception.name) or python_condition(exception)
    return python_condition(exception)


def from_python(exception):
    """The condition that handlers see for a Python exception: itself if it is one, else a wrapper with its cause.

    Hy makes an error of its own of everything that leaves a macro. If that was no error, but a request to end or an exit from a form,
    it is raised again.
    """
    if isinstance(exception, types.Condition):
        return exception
    inner = exception.__context__
    if inner is not None and not isinstance(inner, (Exception, types.Condition)) and type(exception).__name__ == "HyMacroExpansionError":
        raise inner
    known = getattr(exception, "__lisp_condition__", None)
    if known is None:
        known = condition_for(exception)
        known.__cause__ = exception
        try:
            exception.__lisp_condition__ = known
        except AttributeError:
            pass
    return known
