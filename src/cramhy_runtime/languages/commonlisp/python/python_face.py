"""What Python sees of a Lisp package: its functions with signatures, its classes under Python's kind of names, its variables.

``tut.drive`` is the function DRIVE, ``tut.turtle_pose`` the value of ``*turtle-pose*``, ``tut.TurtleMotion`` the class (or
structure, or condition) TURTLE-MOTION. Functions take keyword arguments for ``&key`` parameters; ``inspect.signature`` and
``help`` show the Lisp lambda list and its documentation. Nothing is copied: a redefinition at the REPL is seen at once.
"""

from __future__ import annotations


from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, Symbol, UNBOUND, UndefinedFunction
from ..evaluation.function_facts import lambda_list_of
from ..syntax.lambda_lists import parse
from cramhy_runtime.lisp_core.python_names import attribute_symbols, hy_name, python_name
from ..objects.classes import symbol_class
from cramhy_runtime.lisp_core.packages import near_names, symbol_name
from ..printer.print_controls import PACKAGE, bound
from ..printer.printer import prin1_to_string
from cramhy_runtime.lisp_core.python_names import lisp_spelling


def find(package, name):
    """What the attribute ``name`` of the module of a Lisp package is; raises AttributeError when there is no such thing."""
    if name[:1].isupper():
        found = _class(package, name)
        if found is not None:
            return found
    for symbol in attribute_symbols(package, name):
        if isinstance(symbol, Symbol):
            if not isinstance(symbol.function, UndefinedFunction):
                return with_signature(symbol.function)
            if symbol.value is not UNBOUND:
                return symbol.value
    near = near_names(name, names(package), 1)
    raise AttributeError(
        f"the Lisp package {package.name} defines no function or variable for the Python name {hy_name(name)!r}"
        + (f". Did you mean {near[0]}?" if near else "")
    )


def _class(package, name):
    """The class of the Lisp name that the Python name in capital letters stands for: ``TurtleMotion`` for TURTLE-MOTION."""
    for spelling in (lisp_spelling(name), name.upper()):
        symbol, status = package.lookup(spelling)
        found = symbol_class(symbol) if status and isinstance(symbol, Symbol) else None
        if found is not None:
            return found
    return None


def names(package):
    """The Python names of the package's own functions, variables and classes."""
    found = set()
    for table in (package.internal, package.external):
        for name, symbol in table.items():
            if not isinstance(symbol, Symbol):
                continue
            if not isinstance(symbol.function, UndefinedFunction) or symbol.value is not UNBOUND:
                found.add(python_name(name))
            if symbol_class(symbol) is not None:
                found.add("".join(part.capitalize() for part in name.split("-")))
    return sorted(found)


def with_signature(function):
    """``function``, which tells ``inspect.signature`` its Lisp lambda list."""
    if getattr(function, "__lisp_name__", None) is not None and not hasattr(function, "__signature__"):
        try:
            function.__signature__ = signature(function)
        except (Condition, ValueError, AttributeError):
            pass  # a lambda list that Python cannot show
    return function


def signature(function):
    """The Python signature of a Lisp function: defaults are shown as the Lisp forms that compute them."""
    import inspect

    parsed, kind = parse(lambda_list_of(function)), inspect.Parameter
    name = function.__lisp_name__
    package = getattr(name.cdr.car if isinstance(name, Cons) else name, "package", None)
    by_position = kind.POSITIONAL_ONLY if parsed.rest is not None else kind.POSITIONAL_OR_KEYWORD
    parameters = [kind(_parameter(symbol), by_position) for symbol in parsed.required]
    parameters += [kind(_parameter(symbol), by_position, default=Default(form, package)) for symbol, form, _ in parsed.optional]
    if parsed.rest is not None and not parsed.has_keys:
        parameters.append(kind(_parameter(parsed.rest), kind.VAR_POSITIONAL))
    parameters += [kind(_parameter(key), kind.KEYWORD_ONLY, default=Default(form, package)) for key, _, form, _ in parsed.keys]
    if parsed.allow_other_keys:
        parameters.append(kind("other_keys", kind.VAR_KEYWORD))
    return inspect.Signature(parameters)


def _parameter(symbol):
    return python_name(symbol_name(symbol.car if hasattr(symbol, "car") else symbol))


class Default:
    """The default of a parameter, shown as the Lisp form that computes it when the function is called, as it reads in ``package``."""

    def __init__(self, form, package):
        self.form, self.package = form, package

    def __repr__(self):
        with bound(PACKAGE, self.package or PACKAGE.value):
            return prin1_to_string(self.form)
