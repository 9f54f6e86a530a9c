"""Backquote: templates that are read as templates, and expanded when they are compiled.

The reader turns ```(a ,b)`` into ``(SB-INT:QUASIQUOTE (A #<comma B>))``, SBCL's form, so that a quoted template prints as it
was written. ``QUASIQUOTE`` is a macro; `expand` is its expander. A template without commas becomes a quoted constant; a list
becomes calls of ``cons``, ``list``, ``list*``, ``append`` and ``nconc``; a vector is built from a list. In nested templates the
innermost backquote belongs to the innermost comma: a comma of the inner template is data while the outer one is expanded.
Source: ANSI 2.4.6.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons, Keyword, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import ensure_package, find_package, intern, is_symbol, sym

for _name in ("SB-INT", "SB-IMPL", "CRAMHY"):
    ensure_package(_name)
QUASIQUOTE = intern("QUASIQUOTE", "SB-INT")
find_package("SB-INT").export(QUASIQUOTE)
MAKE_COMMA, MAKE_COMMAS, LIST_VECTOR = [intern(name, "CRAMHY") for name in ("MAKE-COMMA", "MAKE-COMMAS", "LIST-VECTOR")]

COMMA, COMMA_KINDS = intern("COMMA", "SB-IMPL"), (",", ",.", ",@")
"""A comma outside of pretty printing is ``#S(SB-IMPL::COMMA :EXPR X :KIND 0)``; the kind is an index of these prefixes."""

QUOTE, LIST, LIST_STAR, APPEND, NCONC = sym("QUOTE"), sym("LIST"), sym("LIST*"), sym("APPEND"), sym("NCONC")
CONS = sym("CONS")


class Comma:
    """``,form``, ``,@form`` or ``,.form`` inside a template; ``kind`` is the prefix as text."""

    __slots__ = equalp_slots = ("kind", "form")

    def __init__(self, kind, form):
        self.kind = kind
        self.form = form

    @property
    def splicing(self):
        return self.kind != ","

    def __repr__(self):
        return f"{self.kind}{self.form!r}"


def make_commas(kind, forms):
    """One comma per form of the list ``forms``: what ``,,@forms`` builds."""
    return list_from([Comma(kind, form) for form in forms or ()])


def list_vector(elements):
    """A vector of the elements of a list: what a template ``#(...)`` builds."""
    return list(elements or ())


MAKE_COMMA.function, MAKE_COMMAS.function, LIST_VECTOR.function = Comma, make_commas, list_vector


def expand(template):
    """The Lisp form that builds what ``template`` describes, at run time."""
    return _expand(template)


def expander(form, environment=None):
    """The expander of the macro ``sb-int:quasiquote``."""
    return expand(form.cdr.car)


QUASIQUOTE.macro = expander


def _expand(template):
    if isinstance(template, Comma):
        return template.form
    if isinstance(template, Cons):
        if _is_nested(template):
            return _expand_nested(template)
        return _expand_list(template)
    if isinstance(template, list) and any(map(_has_comma, template)):
        return lisp_list(LIST_VECTOR, _expand_list(list_from(template)))
    return _constant(template)


def _is_nested(template):
    return template.car is QUASIQUOTE and isinstance(template.cdr, Cons)


def _constant(template):
    if isinstance(template, Cons) or (is_symbol(template) and not _self_evaluating(template)):
        return lisp_list(QUOTE, template)
    return template


def _self_evaluating(symbol):
    return symbol is None or symbol is True or isinstance(symbol, Keyword)


def _expand_list(template):
    """Runs of items become LIST or LIST* calls; splices are appended in between."""
    if not _has_comma(template):
        return lisp_list(QUOTE, template)
    items, cell = [], template
    # A dotted tail may be a template of its own: (a . ,b) ends in a comma, (a . `b) in what looks like list elements.
    while isinstance(cell, Cons) and (cell is template or not _is_nested(cell)):
        items.append(cell)
        cell = cell.cdr
    if cell is None or not _has_comma(cell):
        while not _has_comma(items[-1].car):  # a constant end of the list is one quoted constant
            cell = items.pop()
    items = [item.car for item in items]
    result = None if cell is None else _expand(cell)
    run = []
    for item in reversed(items):
        if isinstance(item, Comma) and item.splicing:
            result = _join(item, _before(run, result))
            run = []
        else:
            run.insert(0, _expand(item))
    return _before(run, result)


def _before(run, rest):
    """The form for a list that begins with the values of the forms ``run`` and ends in that of ``rest``."""
    if not run:
        return rest
    if rest is None:
        return Cons(LIST, list_from(run))
    if len(run) == 1:
        return lisp_list(CONS, run[0], rest)
    return Cons(LIST_STAR, list_from([*run, rest]))


def _join(comma, rest):
    if rest is None:
        return comma.form  # the last spliced list is not copied (ANSI 2.4.6: append of one argument)
    return lisp_list(APPEND if comma.kind == ",@" else NCONC, comma.form, rest)


# ------------------------------------------------------------------------------------------------------------------- nesting


def _expand_nested(template):
    """Form that builds a template: its own commas stay, and those of the template around it are filled in."""
    body = template.cdr.car
    if not _has_outer_comma(body, 1):
        return lisp_list(QUOTE, template)
    return lisp_list(LIST, lisp_list(QUOTE, QUASIQUOTE), _rebuild(body, 1))


def _rebuild(template, depth):
    """Form for ``template``, which lies ``depth`` backquotes further in than what is being expanded."""
    if isinstance(template, Comma):
        if depth == 0:
            return template.form
        return lisp_list(MAKE_COMMA, template.kind, _rebuild(template.form, depth - 1))
    if isinstance(template, list):
        if not _has_outer_comma(template, depth):
            return template
        return lisp_list(LIST_VECTOR, _rebuild(list_from(template), depth))
    if not isinstance(template, Cons) or not _has_outer_comma(template, depth):
        return _constant(template)
    if _is_nested(template):
        return lisp_list(LIST, lisp_list(QUOTE, QUASIQUOTE), _rebuild(template.cdr.car, depth + 1))
    if isinstance(template.car, Comma):
        splice = _splice(template.car, depth)
        if splice is not None:
            rest = _rebuild(template.cdr, depth)
            return splice if rest is None else lisp_list(APPEND, splice, rest)
    return lisp_list(CONS, _rebuild(template.car, depth), _rebuild(template.cdr, depth))


def _splice(comma, depth):
    """Form for the list of items that ``comma`` stands for in a list, when it may be other than one: ,@x and ,,@x, ,@,@x."""
    if depth == 0:
        return comma.form if comma.splicing else None
    if isinstance(comma.form, Comma):
        inner = _splice(comma.form, depth - 1)
        if inner is not None:
            return lisp_list(MAKE_COMMAS, comma.kind, inner)
    return None


def _has_comma(template):
    """Whether anything in ``template`` belongs to the backquote around it."""
    return _has_outer_comma(template, 0)


def _has_outer_comma(template, depth):
    pending, seen = [(template, depth)], set()
    while pending:
        item, level = pending.pop()
        if isinstance(item, (Cons, list)):
            key = id(item)
            if key in seen:  # #1=(a . #1#)
                continue
            seen.add(key)
        if isinstance(item, Comma):
            if level == 0:
                return True
            pending.append((item.form, level - 1))
        elif isinstance(item, Cons):
            if _is_nested(item):
                pending.append((item.cdr.car, level + 1))
            else:
                pending.append((item.car, level))
                pending.append((item.cdr, level))
        elif isinstance(item, list):
            pending.extend((element, level) for element in item)
    return False
