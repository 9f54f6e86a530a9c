"""The calls that Emacs makes: their table, and how a call is checked before anything runs.

A function becomes a call by ``@rpc("name ...")``. Its first argument is the `Call`; the others are what Emacs sends. Parameters that may
only be given by name are keywords of Lisp: ``(swank:autodoc '("car") :print-right-margin 80)``. Keywords that a function does not know
are left out, since each version of SLIME sends some of its own.
"""

from __future__ import annotations

import inspect

from .wire import Name

PREFIXES = ("swank", "swank-repl", "swank-trace-dialog", "swank-macrostep", "slynk", "slynk-mrepl", "slynk-completion", "slynk-apropos")
"""The packages whose calls are in the table under their bare names: SLIME's and SLY's."""

_table = {}
_inner = {}  # calls that may stand in the arguments of another call: what they give need not be sent


class Refused(Exception):
    """A call that ends with this reason: Emacs shows it in the echo area."""


class Entry:
    """A call of the table. evaluates: whether it runs forms of the user's, whose errors open the debugger."""

    def __init__(self, name, function, evaluates):
        self.name, self.function, self.evaluates = name, function, evaluates
        parameters = list(inspect.signature(function).parameters.values())[1:]
        self.keywords = {each.name for each in parameters if each.kind is each.KEYWORD_ONLY}
        positional = [each for each in parameters if each.kind is each.POSITIONAL_OR_KEYWORD]
        self.least = sum(each.default is each.empty for each in positional)
        self.most = None if any(each.kind is each.VAR_POSITIONAL for each in parameters) else len(positional)

    def bind(self, arguments):
        """(positional arguments, keywords) of the values that were sent. `Refused` if there are too few or too many."""
        given, named = list(arguments), {}
        if self.keywords:
            first = next((index for index, value in enumerate(given) if isinstance(value, Name) and value.startswith(":")), len(given))
            given, rest = given[:first], given[first:]
            for name, value in zip(rest[::2], rest[1::2], strict=False):
                key = str(name)[1:].replace("-", "_")
                if key in self.keywords:
                    named[key] = value
        if len(given) < self.least or (self.most is not None and len(given) > self.most):
            wanted = (
                str(self.least) if self.least == self.most else f"{self.least} to {self.most}" if self.most else f"at least {self.least}"
            )
            raise Refused(f"{self.name} takes {wanted} argument{'' if wanted == '1' else 's'}, and {len(given)} came.")
        return given, named


def rpc(names, evaluates=False):
    """A decorator: enter the function under ``names``, with blanks between."""
    return _entering(_table, names, evaluates)


def inner(names):
    """A decorator like `rpc`, for a call that stands in the arguments of another one, such as ``(swank::from-string "tut::drive")``."""
    return _entering(_inner, names, False)


def _entering(table, names, evaluates):
    def enter(function):
        for name in names.split():
            table[name] = Entry(name, function, evaluates)
        return function

    return enter


def find(name):
    """The `Entry` that ``name``, a `Name`, means. `Refused` if there is none."""
    entry = _found(_table, name)
    if entry is None:
        raise Refused(f"cramhy does not know the call {name}.")
    return entry


def _found(table, name):
    package, _, short = name.lower().replace("::", ":").rpartition(":")
    return table.get(short if package in PREFIXES else f"{package}:{short}")


def parse(form):
    """(entry, its arguments, its keywords) of a form that Emacs wants evaluated. `Refused` if it is no call of the table."""
    if not isinstance(form, list) or not isinstance(form[0], Name):
        raise Refused("A call of Emacs is a list that begins with a name.")
    if form[0] in ("cl:mapc", "mapc") and len(form) == 3:
        function, items = (_value(argument) for argument in form[1:])
        if isinstance(function, Name):
            entry = find(function)
            bound = [entry.bind([item]) for item in items or ()]
            each = Entry(
                entry.name, lambda call, *_: [entry.function(call, *given, **named) for given, named in bound][:0], entry.evaluates
            )
            return each, [], {}
    if form[0] in ("cl:progn", "progn"):
        return _one_after_the_other([parse(part) for part in form[1:] if part is not None])
    entry = find(form[0])
    given, named = entry.bind([_value(argument) for argument in form[1:]])
    if any(map(_has_inner, given)):
        outer = entry.function
        entry = Entry(
            entry.name, lambda call, *given, **named: outer(call, *(_now(each, call) for each in given), **named), entry.evaluates
        )
    return entry, given, named


def _one_after_the_other(parsed):
    """(entry, arguments, keywords) of several calls that are carried out one after the other; the last one's value is sent."""
    if not parsed:
        raise Refused("PROGN has no calls in it.")

    def run(call, *_):
        for entry, given, named in parsed:
            value = entry.function(call, *given, **named)
        return value

    last = parsed[-1][0]
    return Entry(last.name, run, any(entry.evaluates for entry, _, _ in parsed)), [], {}


class _Inner:
    """A call in the arguments of a call: it is carried out when its value is needed."""

    def __init__(self, entry, given, named):
        self.entry, self.given, self.named = entry, given, named


def _has_inner(value):
    return any(map(_has_inner, value)) if isinstance(value, list) else isinstance(value, _Inner)


def _now(value, call):
    """The value of an argument when its call is carried out."""
    if isinstance(value, list):
        return [_now(item, call) for item in value]
    return value.entry.function(call, *value.given, **value.named) if isinstance(value, _Inner) else value


def _value(argument):
    """The value of an argument: what is quoted stands for itself, as strings and numbers do."""
    if not isinstance(argument, list):
        return argument
    if len(argument) == 2 and argument[0] in ("quote", "cl:quote"):
        return argument[1]
    if argument[0] in ("list", "cl:list"):
        return [_value(item) for item in argument[1:]] or None
    entry = _found(_inner, argument[0]) if isinstance(argument[0], Name) else None
    if entry is not None:
        return _Inner(entry, *entry.bind([_value(item) for item in argument[1:]]))
    raise Refused(f"cramhy evaluates no calls in the arguments of a call, such as {argument[0]}.")


def known():
    """The names of all calls, sorted."""
    return sorted(_table)


def text(value, what="An argument"):
    """``value``, which must be a string. A symbol is taken as its name."""
    if isinstance(value, str):
        return str(value)
    raise Refused(f"{what} must be a string.")


def number(value, what="An argument"):
    """``value``, which must be an integer."""
    if isinstance(value, int) and not isinstance(value, bool):
        return value
    raise Refused(f"{what} must be a whole number.")
