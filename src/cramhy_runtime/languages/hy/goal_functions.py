"""The functions that ``lisp-fun`` and ``lisp-pred`` call in facts and queries of Hy.

Goals are data of Lisp, in which a function is a symbol. In Hy a function is what its name means where the goal is written: a variable of
the function around it, an import, an attribute such as ``math.sqrt``. So the macros take the names out of a goal (`named`), and at run
time the goal gets symbols that call what the names mean. A global function may be defined after the rule that calls it: such a symbol has
no function when it is called, and then `of_a_module` looks for it. In a template, ``(lisp-fun ~f 4 ?r)``, stands any value (`called`).
"""

from __future__ import annotations

import builtins
import functools
import inspect
import sys
from pathlib import Path

import hy
from hy import models

from cramhy_runtime.lisp_core.conditions import unknown_key
from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.lisp_core.keyword_calls import keyword_name, lisp_takes_keywords, lispify
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.python_names import python_name
from cramhy_runtime.prolog.builtins import function_calls

from . import answer_lists, lisp_data

CALLERS = frozenset(prefix + name for prefix in ("", "prolog:", "cram-prolog:") for name in ("lisp-fun", "lisp-pred"))


def named(model, names):
    """``model``, a goal, with a symbol for each function that it calls. names: a dict, which gets the symbols and what they stand for."""
    if not isinstance(model, (models.Expression, models.List, models.Tuple)):
        return model
    parts = list(model)
    if len(parts) > 1 and isinstance(parts[0], models.Symbol) and str(parts[0]) in CALLERS:
        parts[1] = _function(parts[1], names)
        parts[2:] = [named(part, names) for part in parts[2:]]
    else:
        parts = [named(part, names) for part in parts]
    return type(model)(parts).replace(model, recursive=False)


def _function(model, names):
    if isinstance(model, models.Symbol) and not str(model).startswith("?"):
        names[model] = model
    elif lisp_data.is_dotted(model) and all(isinstance(part, models.Symbol) for part in model):
        symbol = models.Symbol(".".join(map(str, model[1:])), from_parser=True)  # Hy itself reads dots as attributes
        names[symbol] = model
        return symbol
    elif isinstance(model, models.Expression) and len(model) == 2 and model[0] == models.Symbol("unquote"):
        called_form = models.Expression([lisp_data.call_of("called"), *model[1:]])
        return models.Expression([model[0], called_form])
    return model


# --------------------------------------------------------------------------------------------------------------- at run time


def calling(fact, symbol, function):
    """``fact``, whose ``(lisp-fun symbol ...)`` calls what ``function()`` gives when it is called.

    Where there is nothing, or Python's own of that name, it calls what the symbol names in Lisp.
    """
    found = _meant(symbol, function)
    if found is None:
        return fact
    if "<locals>" in getattr(found, "__qualname__", ""):
        return _with_called(fact, symbol, called(found))
    mine = lisp_data.own_symbol(symbol)
    mine.function = Late(symbol, function)
    mine.function_changed()
    answer_lists.published(mine)
    return fact if mine is symbol else _with_called(fact, symbol, mine)


def asking(goal, symbol, function):
    """``goal``, whose ``(lisp-fun symbol ...)`` calls what ``function()`` gives now, as `calling` does."""
    found = _meant(symbol, function)
    return goal if found is None else _with_called(goal, symbol, called(found, symbol.name))


def called(value, name=None):
    """A symbol whose function is ``value``, a function or a class of Hy; any other object stays."""
    if not callable(value) or isinstance(value, (Symbol, models.Object)):
        return value
    symbol = Symbol(name or getattr(value, "__name__", "a function"))
    symbol.function = answer_lists.in_rules(as_lisp_calls(value))
    return symbol


def _meant(symbol, function):
    try:
        found = function()
    except (NameError, AttributeError):
        return None
    pythons_own = getattr(builtins, hy.mangle(symbol.name.lower()), None) is found
    return found if callable(found) and not pythons_own and not isinstance(found, Symbol) else None


class Late:
    """A function that calls what ``function()`` gives then, so that a new definition counts."""

    __slots__ = ("symbol", "function", "last", "made")

    def __init__(self, symbol, function):
        self.symbol, self.function, self.last, self.made = symbol, function, None, None

    def __call__(self, *arguments):
        found = self.function()
        if found is not self.last:
            self.last, self.made = found, answer_lists.for_lisp(as_lisp_calls(found))
        return self.made(*arguments)


def _with_called(form, symbol, called):
    if not isinstance(form, Cons):
        return form
    rest = form.cdr
    if isinstance(form.car, Symbol) and form.car.name in ("LISP-FUN", "LISP-PRED") and isinstance(rest, Cons) and rest.car is symbol:
        return Cons(form.car, Cons(called, _with_called(rest.cdr, symbol, called)))
    return Cons(_with_called(form.car, symbol, called), _with_called(rest, symbol, called))


def of_a_module(symbol):
    """The function that a global variable of a Hy module has under the name of ``symbol``, of the module's package; or ``None``."""
    package = symbol.package
    if package is None or package.built_in:
        return None
    written = symbol.name.lower()
    for name, module in list(sys.modules.items()):
        if package.name in _packages(name, module):
            space = getattr(module, "__dict__", {})
            found = space.get(hy.mangle(written))
            if found is None:  # a name with capitals
                found = next((value for key, value in list(space.items()) if hy.unmangle(key).lower() == written), None)
            if callable(found):
                return answer_lists.in_rules(as_lisp_calls(found))
    return None


def _packages(name, module):
    """The names of the packages that a module may have. Hy compiles a program under the name of its file."""
    file = getattr(module, "__file__", None) if name == "__main__" else None
    return {lisp_data.package_name(each) for each in (name, Path(file).stem if file else name)}


function_calls.FINDERS.append(of_a_module)


def as_lisp_calls(function_):
    """``function_``, anything that Hy calls, with keyword objects among its arguments: from the first that names a parameter on.

    In a pair at the end, a keyword is a name as in a call of Hy. It is data where it names no parameter and one without a name may stand.
    Raises a program-error for a keyword that is neither.
    """
    if lisp_takes_keywords(function_):
        return lispify(function_)
    names = None

    def call(*arguments, **keywords):
        nonlocal names
        for place, argument in enumerate(arguments[:-1]):
            if argument.__class__ is Keyword and (len(arguments) - place) % 2 == 0:
                if names is None:
                    names = _Parameters(function_)
                if names.has(argument, place):
                    return function_(*arguments[:place], **names.of(arguments[place:]), **keywords)
        return function_(*arguments, **keywords)

    return functools.update_wrapper(call, function_, updated=())


class _Parameters:
    """The parameters of a function: ``known`` by keyword object, ``others`` if it takes more names, and how many have places."""

    def __init__(self, function):
        try:
            parameters = inspect.signature(function).parameters
        except (TypeError, ValueError):  # of some that are written in C
            parameters = {"others": inspect.Parameter("others", inspect.Parameter.VAR_KEYWORD)}
        kinds = [parameter.kind for parameter in parameters.values()]
        named = (name for name, kind in zip(parameters, kinds) if kind in (kind.POSITIONAL_OR_KEYWORD, kind.KEYWORD_ONLY))
        self.known = {keyword(keyword_name(name)): name for name in named}
        self.others = inspect.Parameter.VAR_KEYWORD in kinds
        rest = inspect.Parameter.VAR_POSITIONAL in kinds
        self.places = float("inf") if rest else sum(kind.name.startswith("POSITIONAL") for kind in kinds)

    def has(self, key, place):
        """Whether ``key``, the argument number ``place``, is a name and not data."""
        return key in self.known or self.others or place >= self.places

    def of(self, pairs):
        """Python's keyword arguments for keyword objects, each with its value behind it. Raises a program-error for unknown ones."""
        found = {}
        for key, value in zip(pairs[::2], pairs[1::2]):
            if key not in self.known and not (self.others and key.__class__ is Keyword):
                return unknown_key(key, self.known)
            found.setdefault(self.known.get(key) or python_name(key.name), value)
        return found


__all__ = ["as_lisp_calls", "asking", "called", "calling", "named"]
