"""Python functions with keyword-only parameters, as Lisp calls them: keyword objects among the arguments become Python keywords."""

from __future__ import annotations

import functools

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
    known = {keyword(_keyword_name(name)): name for name in names}
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


def _keyword_name(name):
    if name.startswith("hyx_"):  # a parameter of Hy, such as ?x
        return hy_name(name).upper()
    return name.rstrip("_").replace("_", "-").upper()
