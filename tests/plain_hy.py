"""Text of plain Hy in a session: for tests whose Lisp text runs in Hy too, by way of `lisp_to_hy`."""

from __future__ import annotations

import re
import types

import hy
import pytest
from lisp_to_hy import Writer
from lisp_words import NotConvertible, read

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.classes import find_class_or_error
from cramhy_runtime.cpl import hooks
from cramhy_runtime.lisp_core.conditions import handler_bind
from cramhy_runtime.lisp_core.data import list_from, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string
from cramhy_runtime.languages.hy.malformed import ProgramForm
from cramhy_runtime.repl.session import condition_of


_required = {}
"""What ``(require cramhy *)`` puts into a module. It takes 0.1 s, so one module of the process requires and the others take it over."""


class CommonLisp:
    """Its attributes are the functions of Common Lisp, under the names that Python and Hy give them; ``values`` of them, the first or all."""

    def __init__(self, values):
        self._values = values

    def __getattr__(self, name):
        function = function_of(sym(hy.unmangle(name).upper()))
        return lambda *arguments, **keywords: self._values(function(*arguments, **keywords))


def hy_module(session, beginning):
    """A module of Hy whose names belong to the package of ``session``; ``beginning`` is evaluated in it."""
    module = types.ModuleType("an_example")
    module.cl, module.cl_values = CommonLisp(one), CommonLisp(lambda values: values)
    module.binding, module.hooks, module.checkpoint, module.cleanup = binding, hooks, kernel.checkpoint, kernel.cleanup
    module.class_of_condition, module.handler_bind = find_class_or_error, handler_bind
    module.all_values = all_values
    if not _required:
        first = types.ModuleType("an_example")
        hy_value(first, "(require cramhy *)")
        _required.update({name: value for name, value in vars(first).items() if not name.startswith("__")})
    vars(module).update({name: dict(value) if isinstance(value, dict) else value for name, value in _required.items()})
    hy_value(module, f"(lisp-package :{session.package.name})")
    hy_value(module, beginning)
    return module


def all_values(value, number=None):
    """The values that a function of ours returned; of ``number`` variables, ``None`` for what is missing."""
    values = list(value) if isinstance(value, tuple) else [value]
    return values if number is None else (values + [None] * number)[:number]


def hy_value(module, text):
    """The value of the last form of ``text`` in ``module``; each is compiled as in a file."""
    value = None
    for form in hy.read_many(text, filename="<example>"):
        value = hy.eval(ProgramForm(form), module=module)
        kernel.settle()
    return value


def lisp_value(value):
    """The Lisp object that a value of Python, or of Hy, is; a tuple is several values."""
    if value is False:
        return None
    if isinstance(value, (list, range)):
        return list_from([lisp_value(item) for item in value])
    if isinstance(value, tuple):
        return tuple(lisp_value(item) for item in value)
    if isinstance(value, hy.models.Keyword):
        return sym(":" + value.name.upper())
    return value


class PlainHy:
    """``plain(text)``: the values of the last form of a Lisp text that was written in Hy, printed as Lisp prints them.

    A text that plain Hy has no form for skips the test.
    """

    def __init__(self, session, prelude, functions=(), specials=("*notes*",), of_functions=()):
        self.session = session
        self.writer = Writer("lisp")
        self.writer.functions.update(functions)
        self.writer.of_functions.update(of_functions)
        self.writer.specials.update(specials)
        self.module = hy_module(session, prelude)

    def value(self, text):
        try:
            *first, last = read(text)
            written = [*map(self.writer.form, first), self.writer.many(last)]
        except NotConvertible as problem:
            pytest.skip(f"not in plain Hy: {problem}")
        self.text = "\n".join(written)
        return hy_value(self.module, self.text)

    def __call__(self, text):
        value = lisp_value(self.value(text))
        values = value if isinstance(value, tuple) else (value,)
        return " ; ".join(" ".join(prin1_to_string(each).split()) for each in values)

    def error(self, text):
        """The text of the condition that ``text`` ends with, without addresses."""
        with pytest.raises(BaseException) as problem:
            self.value(text)
        return re.sub(r"\{[0-9A-F]+\}", "{}", " ".join(princ_to_string(condition_of(problem.value)).split()))
