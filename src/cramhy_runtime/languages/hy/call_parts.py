"""The parts of an operator's call in Hy: which of them are code, and the Lisp form of the call.

The parts that are code stay the Hy models that they are; the others, names and lists of them, become Lisp data. A `Call` remembers how
names and lists were written, since what they stand for in the expansion is again what the user wrote.
"""

from __future__ import annotations

import contextlib

import hy
from hy import models

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.packages import intern, sym
from ..operators.grammar import Many, Maybe, Text, Word, WrongShape, match
from .lisp_data import call_of, is_dotted, is_quoted, lisp_data, symbol_of

CODE = frozenset(
    "form body-form watcher step before after fluent task text status test seconds timeout priority message publication client "
    "filter designator callback hook begin-hook end-hook source episode clock instance lock table string predicate place condition "
    "argument arguments policy path".split()
)
"""The words of the grammars that are code, which is evaluated where the expansion puts it."""


class Code:
    """A part of the call that is Hy code."""

    __slots__ = ("model",)

    def __init__(self, model):
        self.model = model

    def __repr__(self):
        return hy.repr(self.model).removeprefix("'")


class Call:
    """One call of an operator. package: the Lisp package of the names in it."""

    def __init__(self, package):
        self.package = package
        self.names = {}  # Lisp symbol → the Hy symbol that the user wrote
        self.written = {}  # identity of a list of the call → (it, its Hy model)
        self.functions = set()  # symbols that the call names as functions: a function of Hy may be meant
        self.types = set()  # symbols that the call names as types of conditions: a class of Python may be meant

    def form(self, symbol, pattern, arguments):
        """The Lisp form of the call of ``symbol`` with Hy models as arguments."""
        return Cons(symbol, list_from(self.parts(pattern, list(arguments))))

    def parts(self, pattern, arguments):
        """``arguments`` as the pattern of a grammar says which of them are code."""
        made, options = [], _options(pattern)
        for place, item in enumerate(pattern):
            while options and arguments and isinstance(arguments[0], models.Keyword):
                key = arguments.pop(0)
                made += [self.data(key), *([self.part(options.get(key.name), arguments.pop(0))] if arguments else [])]
            if isinstance(item, Many):
                return made + self.many(item.item, arguments)
            if isinstance(item, Maybe):
                behind = pattern[place + 1 :]
                if not (behind and isinstance(behind[0], Text) and arguments and isinstance(arguments[0], models.String)):
                    made += self.maybe(item, arguments)
                continue
            if not arguments:
                break
            made.append(self.part(item, arguments.pop(0)))
        return made + [self.data(argument) for argument in arguments]

    def many(self, item, arguments):
        if not isinstance(item, Maybe):
            return [self.part(item, argument) for argument in arguments]
        made = []
        while arguments:  # groups of parts
            made += [self.part(each, arguments.pop(0)) for each in item.items if arguments]
        return made

    def maybe(self, item, arguments):
        first = item.items[0]
        if _is_option(item) or not arguments or isinstance(first, Text) and not (isinstance(arguments[0], models.String)):
            return []
        if isinstance(arguments[0], models.Keyword):
            return []
        inner = [self.part(first, arguments.pop(0))]
        for more in item.items[1:]:
            inner += self.maybe(more, arguments) if isinstance(more, Maybe) else []
        return inner

    def part(self, item, argument):
        if isinstance(item, list):
            if not isinstance(argument, (models.Expression, models.List, models.Tuple)):
                return self.data(argument)
            made = list_from(self.parts(item, list(argument)))
            self.note(made, argument)
            return made
        if item == "seconds" and isinstance(argument, models.List):
            return list_from([self.code_part(each) for each in argument])
        if item == "list":
            return Code(models.Expression([call_of("items"), argument]))
        if isinstance(item, Word) and item in CODE and (item in ("form", "body-form") or not _is_object(argument)):
            return self.code_part(argument)
        if item == "failure-type" and is_dotted(argument):  # module.Class
            return Code(argument)
        if item == "failure-type" and isinstance(argument, models.Tuple):
            made = Cons(sym("OR"), list_from([Code(each) if is_dotted(each) else self.data(each) for each in argument]))
        else:
            made = self.data(argument)
        if item in ("function", "failure-type"):
            (self.functions if item == "function" else self.types).update(_symbols_in(made))
        return made

    @staticmethod
    def code_part(argument):
        if isinstance(argument, models.String):
            return str(argument)
        return Code(argument)

    def data(self, model):
        """A part that is data, or names, or both: lists remember what was written."""
        if is_quoted(model):
            return list_from([sym("QUOTE"), lisp_data(model[1], self.package)])
        if isinstance(model, (models.Expression, models.List, models.Tuple)) and not is_dotted(model):
            made = list_from([self.data(item) for item in model])
            self.note(made, model)
            return made
        if isinstance(model, models.Symbol) and str(model) != "True":
            if str(model) in ("None", "False", "nil", "t"):  # nil and t are names like others where they are code
                return Code(model)
            try:
                symbol = symbol_of(str(model), self.package)
            except Condition:
                return Code(model)
            if isinstance(symbol, Symbol):
                self.names[symbol] = model
            return symbol
        try:
            return lisp_data(model, self.package)
        except (ValueError, Condition):
            return Code(model)

    def note(self, made, model):
        if made is not None:
            self.written[id(made)] = (made, model)

    def written_as(self, form):
        """The Hy model of a list of the call, ``None`` for any other form."""
        found = self.written.get(id(form))
        return found[1] if found is not None and found[0] is form else None


def lisp_call(operator, arguments, package):
    """The call of ``operator`` with Hy models as ``arguments``, in the first of its grammars that they fit, as ``(call, form)``.

    form: the Lisp form. Raises `WrongShape`.
    """
    symbol = intern(operator.name, operator.package)
    *others, last = operator.patterns
    for pattern in others:
        with contextlib.suppress(WrongShape):
            return _fitting(symbol, pattern, arguments, package)
    return _fitting(symbol, last, arguments, package)


def _fitting(symbol, pattern, arguments, package):
    call = Call(package)
    form = call.form(symbol, pattern, arguments)
    match(pattern, form.cdr)
    return call, form


def _is_object(model):
    """Whether an argument is an object of Lisp as it stands: a quoted name, or a keyword."""
    return is_quoted(model) or isinstance(model, models.Keyword)


def _is_option(item):
    return isinstance(item, Maybe) and isinstance(item.items[0], Word) and item.items[0].startswith(":")


def _options(pattern):
    """Name of a keyword option of the pattern → the item for its value."""
    return {item.items[0][1:]: item.items[1] for item in pattern if _is_option(item)}


def _symbols_in(data):
    while isinstance(data, Cons):
        yield from _symbols_in(data.car)
        data = data.cdr
    if isinstance(data, Symbol):
        yield data


def shown_data(model, package):
    """A Hy model as data that shows a person what was written; code that no Lisp data can say becomes its text."""
    return without_code(Call(package).data(model), package)


def without_code(data, package):
    """``data`` with what its code says as data; code that no Lisp data can say becomes its text."""
    if isinstance(data, Cons):
        return Cons(without_code(data.car, package), without_code(data.cdr, package))
    if isinstance(data, Code):
        try:
            return lisp_data(data.model, package)
        except (ValueError, Condition):
            return hy.repr(data.model).removeprefix("'")
    return data
