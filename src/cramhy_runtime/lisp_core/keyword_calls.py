"""Calls with keywords, between Lisp, where keyword objects stand among the arguments, and Python.

`lispify` makes of a Python function with keyword-only parameters one that Lisp calls. A compiled Lisp function with ``&key`` takes
keywords both ways (`takes_keywords`). So compiled code that names the keywords of a call gives them as Python's; `KeywordCalls` knows
for each symbol whether its function takes them so, and stands in between if it does not.
"""

from __future__ import annotations

import functools
from types import FunctionType

from .conditions import program_error, unknown_key
from .data import Keyword, Symbol
from .packages import keyword
from .python_names import hy_name, python_name


def lispify(function):
    """``function`` as Lisp calls it: keyword objects among the arguments become Python keywords.

    A function without keyword-only parameters is returned as it is. Unknown and odd keywords are program-errors, unless the
    call says ``:allow-other-keys t`` or the function takes ``**others``. The result's attribute ``python`` is ``function``, and
    ``python_keywords`` are the names of its parameters by keyword object.
    """
    code = getattr(function, "__code__", None)
    if code is None or not code.co_kwonlyargcount:
        return function
    positional = code.co_argcount
    names = code.co_varnames[positional : positional + code.co_kwonlyargcount]
    known = {keyword(keyword_name(name)): name for name in names}
    takes_others = bool(code.co_flags & 0x08)
    takes_rest = bool(code.co_flags & 0x04)
    allow = keyword("ALLOW-OTHER-KEYS")

    @functools.wraps(function)
    def lisp_function(*arguments, **keywords):
        if len(arguments) <= positional:
            return function(*arguments, **keywords)
        rest = arguments[positional:]
        if len(rest) % 2:
            return program_error("odd number of &KEY arguments")
        unknown = []
        for index in range(0, len(rest), 2):
            key = rest[index]
            name = known.get(key) if isinstance(key, Symbol) else None
            if name is not None:
                keywords.setdefault(name, rest[index + 1])  # the first of equal keywords counts
            elif takes_others:
                if isinstance(key, Keyword):
                    keywords.setdefault(python_name(key.name), rest[index + 1])
            elif key is not allow:
                unknown.append(key)
        if unknown and not (allow in rest[::2] and rest[rest.index(allow) + 1] is not None):
            return unknown_key(unknown[0], known)
        return function(*(arguments if takes_rest else arguments[:positional]), **keywords)

    lisp_function.python, lisp_function.python_keywords = function, known
    return lisp_function


GIVEN = "Lgiven"
"""How the rest parameter of a compiled function begins whose keyword-only parameters are those of its ``&key``."""


def name_of_key(key):
    """The Python name of the keyword ``key``; ``None`` if the way back does not lead to it, as from other symbols."""
    if key.__class__ is not Keyword:
        return None
    name = python_name(key.name)
    return name if name.isidentifier() and not name.startswith("_") and keyword(name.upper().replace("_", "-")) is key else None


def takes_keywords(function, count, names):
    """Whether the compiled ``function`` takes the keywords ``names`` as Python's, behind ``count`` other arguments.

    One that is not compiled may have ``python_keys``, the set of the names that the function which ``written()`` returns takes.
    """
    if function.__class__ is not FunctionType or "traced" in function.__dict__:
        return False
    if "python_keys" in function.__dict__:
        return not count and function.python_keys.issuperset(names)
    if not lisp_takes_keywords(function):
        return False
    code = function.__code__
    positional, keys = code.co_argcount, code.co_kwonlyargcount
    least = positional - len(function.__defaults__ or ())
    return least <= count <= positional and set(names) <= set(code.co_varnames[positional : positional + keys])


def lisp_takes_keywords(function):
    """Whether ``function`` was compiled from Lisp with ``&key``, and so takes keyword objects, and Python's keywords, too."""
    if function.__class__ is not FunctionType or function.__code__.co_flags & 0x0C != 0x0C:
        return False
    code = function.__code__
    return code.co_varnames[code.co_argcount + code.co_kwonlyargcount].startswith(GIVEN)


class KeywordCalls:
    """Calls of the function of ``symbol`` with ``count`` arguments and then the keywords ``keys``: ``call`` takes these as Python's."""

    __slots__ = ("symbol", "count", "keys", "call")

    def __init__(self, symbol, count, keys):
        self.symbol, self.count, self.keys = symbol, count, keys
        self.refresh()

    def refresh(self):
        """Find out anew what the function takes."""
        function = self.symbol.function
        if takes_keywords(function, self.count, map(name_of_key, self.keys)):
            self.call = self._write if "python_keys" in function.__dict__ else function
        else:
            self.call = self._as_lisp_calls

    def _write(self, **keywords):
        self.call = self.symbol.function.written()
        return self.call(**keywords)

    def _as_lisp_calls(self, *arguments, **keywords):
        for key, value in zip(self.keys, keywords.values(), strict=True):
            arguments += key, value
        return self.symbol.function(*arguments)


def keyword_calls(symbol, count, *keys):
    """The `KeywordCalls` of ``symbol`` with so many arguments and then these keywords, one for all calls."""
    return symbol.calls.kept((count, keys), lambda: KeywordCalls(symbol, count, keys))


def keyword_name(name):
    """The name of the keyword for a parameter of Python: ``the_other`` is named by ``:the-other``."""
    if name.startswith("hyx_"):  # a parameter of Hy, such as ?x
        return hy_name(name).upper()
    return name.rstrip("_").replace("_", "-").upper()
