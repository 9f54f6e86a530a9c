"""Which words of a text mean the same: those of a local variable or function, by the form that binds it."""

from __future__ import annotations

from .texts import Form

_LET = frozenset(("let", "let*", "symbol-macrolet", "prog", "prog*", "do", "do*"))
_FUNCTIONS = frozenset(("flet", "labels", "macrolet"))
_LISTS = frozenset(("multiple-value-bind", "destructuring-bind", "lambda", "with-fields", "with-slots", "fn", "with-accessors"))
_ONE = frozenset(("dolist", "dotimes", "with-open-file", "do-symbols", "with-output-to-string", "with-task-suspended"))
_DEFINING = ("defun", "defmacro", "defmethod", "defn", "def-cram-function", "def-top-level-cram-function", "deftype")


def _words(item):
    """The words in a lambda list or a list of variables; of ``(name default)`` the first one only."""
    for each in item.items:
        if isinstance(each, Form):
            if each.items:
                yield from (_words(each.items[0]) if isinstance(each.items[0], Form) else [each.items[0]])
        elif each.kind == "word" and not each.text.startswith("&"):
            yield each


def binders(form):
    """The tokens of the names that ``form`` binds in its body."""
    name = form.word(0).lower().rpartition(":")[2]
    items = form.items
    first = items[1] if len(items) > 1 and isinstance(items[1], Form) else None
    if name in _DEFINING:
        parameters = next((item for item in items[2:] if isinstance(item, Form)), None)
        return list(_words(parameters)) if parameters is not None else []
    if name in _LET or name in _LISTS or name in _FUNCTIONS:
        return list(_words(first)) if first is not None else []
    if name in _ONE:
        return [item for item in first.items[:1] if not isinstance(item, Form)] if first is not None else []
    if name == "loop":
        return [
            items[number + 1]
            for number, item in enumerate(items[:-1])
            if not isinstance(item, Form) and item.text.lower() in ("for", "with", "as") and not isinstance(items[number + 1], Form)
        ]
    return []


def _same(one, other):
    return one.upper() == other.upper()


def _outside(form):
    """The parts of ``form`` that stand outside of what it binds: the values of ``let``."""
    name = form.word(0).lower()
    if name != "let" or len(form.items) < 2 or not isinstance(form.items[1], Form):
        return []
    return [part for binding in form.items[1].items if isinstance(binding, Form) for part in binding.items[1:]]


def local(text, token):
    """The tokens that mean the same local name as ``token``, or ``None`` if no form around binds it."""
    for form in text.around(token.start + 1):
        bound = [each for each in binders(form) if each.kind == "word" and _same(each.text, token.text)]
        if not bound or any(part.start <= token.start < part.end for part in _outside(form)):
            continue
        found = list(_uses(form, token.text, _outside(form)))
        return found if any(each.start == token.start for each in found) else None
    return None


def _uses(form, name, left_out=()):
    for item in form.items:
        if item in left_out:
            continue
        if not isinstance(item, Form):
            if item.kind == "word" and _same(item.text, name):
                yield item
        elif any(each.kind == "word" and _same(each.text, name) for each in binders(item)):
            for part in _outside(item):
                yield from _uses(_Alone(part), name)
        else:
            yield from _uses(item, name, left_out)


class _Alone:
    def __init__(self, part):
        self.items = [part]


def free(text, name):
    """The tokens of ``name``, with or without a prefix, that no form around binds."""
    for token in text.tokens:
        if token.kind == "word" and _same(token.text.rpartition(":")[2], name) and not token.text.startswith((":", "#:")):
            if token.text.count(":") or local(text, token) is None:
                yield token
