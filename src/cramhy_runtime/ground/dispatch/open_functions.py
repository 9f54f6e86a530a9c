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


def open_to_methods(function, name, lambda_list, *classes, method=None, when_opened=None):
    """Let users define methods on ``function``, which is the function of ``"PACKAGE::NAME"`` or ``"(setf PACKAGE::NAME)"``.

    lambda_list: text. classes: of its required arguments, ``None`` for any. method: what its first method does, if that is not
    ``function`` itself. when_opened: called with the generic function. Returns the `Opening`.
    """
    name = lisp_list(sym("SETF"), sym(name[6:-1])) if name.startswith("(setf ") else sym(name)
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
