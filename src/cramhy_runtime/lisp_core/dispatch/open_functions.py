"""Plain functions that become generic functions when somebody defines a method on them.

Some functions are generic in the original, but hardly anybody adds methods, and dispatching costs more than what they do. So they
are plain Python functions until the first ``defmethod`` or ``defgeneric``; then the generic function takes their place, with the
plain one as its first method.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import part

from ..data import lisp_list
from ..keyword_calls import lispify
from ..packages import sym
from .generic_functions import GenericFunction, all_generic_functions, function_cell, method_watchers


class Opening:
    """What `open_to_methods` notes on a function. ``generic`` is the generic function when there is one, else ``None``."""

    def __init__(self, name, lambda_list, classes, method, when_opened):
        self.name, self.lambda_list, self.classes, self.method, self.when_opened = name, lambda_list, classes, method, when_opened
        self.generic = self.first = None

    def open(self):
        """Make the generic function, whose ``first`` method is the plain one."""
        self.generic = made = GenericFunction(self.name, self.lambda_list)
        made.__doc__ = self.method.__doc__
        made.method(*self.classes)(self.method)
        (self.first,) = made.methods
        if self.when_opened is not None:
            self.when_opened(made)
        return made

    @property
    def added(self):
        """The methods besides the first."""
        return [] if self.generic is None else [method for method in self.generic.methods if method is not self.first]


def lambda_list_of(function):
    """The lambda list of a Python function as text; keyword-only parameters are ``&key``."""
    code, words = function.__code__, []
    names = [name.strip("_").replace("_", "-") for name in code.co_varnames]
    required, positional = code.co_argcount - len(function.__defaults__ or ()), code.co_argcount
    keys = positional + code.co_kwonlyargcount
    words += names[:required]
    words += ["&optional", *names[required:positional]] if required < positional else []
    words += ["&rest", names[keys]] if code.co_flags & 0x04 else []
    words += ["&key", *names[positional:keys]] if positional < keys else []
    return f"({' '.join(words)})"


def open_to_methods(function, name, lambda_list=None, *classes, method=None, when_opened=None):
    """Let users define methods on ``function``, which is the function of ``"PACKAGE::NAME"`` or ``"(setf PACKAGE::NAME)"``.

    lambda_list: text; without it, that of ``function``, for arguments of any class. classes: of its required arguments, ``None`` for any.
    method: what its first method does, if that is not ``function`` itself. when_opened: called with the generic function. Returns the
    `Opening`.
    """
    name = lisp_list(sym("SETF"), sym(name[6:-1])) if name.startswith("(setf ") else sym(name)
    if lambda_list is None:
        lambda_list = lambda_list_of(function)
        classes = (None,) * (function.__code__.co_argcount - len(function.__defaults__ or ()))
    function.opening = opening = Opening(name, lambda_list, classes, method or function, when_opened)
    symbol, setf = function_cell(name)
    function.__lisp_name__ = name
    if setf:
        symbol.setf_function = function
    elif getattr(symbol.function, "python", symbol.function) is function:
        symbol.function.opening = opening
    else:
        symbol.function = lispify(function)
    return opening


@part
class _UsersMethods:
    """The methods that users gave to generic functions, which may be ours."""

    @staticmethod
    def take():
        return {
            function: (
                list(function.methods),
                function.user_methods,
                function.combination,
                function.combination_options,
                function.precedence,
            )
            for function in list(all_generic_functions)
            if function.methods != function.own_methods
        }

    @staticmethod
    def put(state):
        for function in list(all_generic_functions):
            methods, *others = state.get(function) or (
                list(function.own_methods),
                0,
                function.combination,
                function.combination_options,
                function.precedence,
            )
            if function.methods == methods:
                continue
            function.methods[:] = methods  # a hook looks at this very list
            function.user_methods, function.combination, function.combination_options, function.precedence = others
            function.forget()
            for watcher in method_watchers:
                watcher(function)

    @staticmethod
    def copy(state):
        return {function: (list(methods), *others) for function, (methods, *others) in state.items()}

    @staticmethod
    def new(state):
        return {}
