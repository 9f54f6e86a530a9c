"""The notation of designators: ``(a motion (type driving) (speed ?speed))`` as a form that builds the description.

A pure function from forms to a form, called by the macros ``a``, ``an`` and ``all``. What a symbol in the description means is
decided by its text alone: ``?name`` is a variable of the surrounding code, ``*name*`` and ``+name+`` are global ones, everything else is
a keyword. Calls are not evaluated; what is computed goes into a ``?variable`` first. Source: designators.md 3.2. The original takes the
value that any global variable has when the macro is expanded; we don't, because the meaning of a plan then depends on what was loaded
before it, and a variable that is bound or set later keeps its first value.

Several properties may have one key, and a value may be any list. Two things are worth a style-warning all the same, since nobody
means them: a value that looks like a call, ``(speed (+ 1 2))``, and a property that is there twice, word for word.
"""

from __future__ import annotations

from cramhy_runtime.ground.condition_types import SimpleStyleWarning
from cramhy_runtime.ground.conditions import error
from cramhy_runtime.ground.data import Cons, Keyword, Symbol, UndefinedFunction, lisp_list, list_from
from cramhy_runtime.ground.dynamic import binding
from cramhy_runtime.ground.equality import equal
from ...compiler.compilation_unit import warn_of
from cramhy_runtime.ground.packages import keyword
from ...printer.print_controls import PRINT_CASE
from ...tools.describing import one_line
from cramhy_runtime.designators.symbols import sym

LIST, QUOTE, WHEN, FUNCTION = sym("LIST"), sym("QUOTE"), sym("WHEN"), sym("FUNCTION")
MAKE, MAKE_ALL, PRESENT = sym("DESIG::MAKE-DESIGNATOR"), sym("DESIG::MAKE-ALL-DESIGNATOR"), sym("DESIG::PRESENT")
GLOBAL_VALUE = sym("DESIG::GLOBAL-VALUE")
_nested = {name: sym(f"DESIG::{name}") for name in ("A", "AN", "ALL")}


def expand(form):
    """The form that ``(a type pair...)``, ``(an ...)`` or ``(all ...)`` stands for."""
    operator, type_, *pairs = form
    return designator_form(type_, list_from(pairs), operator.name)


def designator_form(type_, pairs, quantifier="A"):
    """The form that ``(a type pair...)`` stands for; ``quantifier`` is "A" or "ALL". ``type_`` is a symbol or string."""
    name = (type_ if isinstance(type_, str) else type_.name).upper()
    look_over(pairs)
    if quantifier == "ALL":
        return lisp_list(MAKE_ALL, keyword(name.rstrip("S")), description_form(pairs))
    return lisp_list(MAKE, keyword(name), description_form(pairs))


def description_form(pairs):
    """The form that builds the description from ``pairs``, a Lisp list of forms. Entries that are nil at the top vanish."""
    entries = [entry for entry in (_entry(pair) for pair in _proper(pairs)) if entry is not None]
    if not entries:
        return None
    if all(_is_constant(entry) for entry in entries):
        return lisp_list(QUOTE, list_from([_constant(entry) for entry in entries]))
    form = Cons(LIST, list_from(entries))
    return form if all(_is_constant(entry) or entry.car is LIST for entry in entries) else lisp_list(PRESENT, form)


def _entry(element):
    """The form for one element of a description, or of a list inside it."""
    if isinstance(element, Symbol):
        return _symbol(element)
    if not isinstance(element, Cons):
        return element
    head = element.car
    if isinstance(head, Symbol):
        if head.name in _nested:
            return Cons(_nested[head.name], element.cdr)
        if head.name in ("SOME", "THE"):
            return element
        if head.name == "WHEN" and len(_proper(element)) == 3:
            condition, pair = element.cdr
            return lisp_list(WHEN, _symbol(condition) if isinstance(condition, Symbol) else condition, _entry(pair))
    parts = [_entry(part) for part in _proper(element)]
    if all(_is_constant(part) for part in parts):
        return lisp_list(QUOTE, list_from([_constant(part) for part in parts]))
    return Cons(LIST, list_from(parts))


def _symbol(symbol):
    if isinstance(symbol, Keyword) or symbol.name.startswith("?"):
        return symbol
    if is_global_name(symbol.name):
        return lisp_list(GLOBAL_VALUE, symbol)
    return keyword(symbol.name.upper())


def is_global_name(name):
    """Whether ``name`` is written as the names of global variables and constants are: ``*name*``, ``+name+``."""
    return len(name) > 2 and name[0] == name[-1] and name[0] in "*+" and name.strip("*+") != ""


def global_value(value):
    """What ``value``, that of a global variable, is in a description: a symbol is a keyword there, as one that is written."""
    return keyword(value.name.upper()) if value.__class__ is Symbol else value


def _is_constant(form):
    if isinstance(form, Cons):
        return form.car is QUOTE
    return not isinstance(form, Symbol) or isinstance(form, Keyword)


def _constant(form):
    return form.cdr.car if isinstance(form, Cons) else form


def _proper(lst):
    """The elements of ``lst``; a dotted list is an error."""
    found, cell = [], lst
    while isinstance(cell, Cons):
        found.append(cell.car)
        cell = cell.cdr
    if cell is not None:
        error(
            "The description of a designator contains a dotted list: ~s. Write lists as (element element ...), and remember "
            "that a dot between two spaces makes a pair.",
            lst,
        )
    return found


def present(entries):
    """``entries`` without nils: what is left of a description when its ``(when ...)`` have been decided."""
    return list_from([entry for entry in entries or () if entry is not None])


# ------------------------------------------------------------------------------------------------------------------- advice


def look_over(pairs):
    """Warn of properties that mean something else than they look like."""
    seen = []
    for pair in pairs or ():
        if not (isinstance(pair, Cons) and isinstance(pair.cdr, Cons) and pair.cdr.cdr is None):
            continue
        key, value = pair.car, pair.cdr.car
        if any(equal(pair, other) for other in seen):
            warn_of(SimpleStyleWarning, "The property ~a is there twice.", _text(pair))
        seen.append(pair)
        if isinstance(value, Cons) and isinstance(value.car, Symbol):
            if value.car is QUOTE:
                warn_of(
                    SimpleStyleWarning,
                    "The value of ~a is the list (quote ~a). The parts of a designator are not evaluated, and need no quote.",
                    _text(key),
                    _text(value.cdr.car if value.cdr else None),
                )
            elif _looks_like_a_call(value):
                variable = f"?{getattr(key, 'name', 'value').lower()}"
                warn_of(
                    SimpleStyleWarning,
                    "The value of ~a is the list ~a: only ?variables in a designator are evaluated. To use what "
                    "the call returns, write~%  (let ((~a ~a)) ... (~a ~a) ...).",
                    _text(key),
                    _text(value),
                    variable,
                    _text(value),
                    _text(key),
                    variable,
                )


def _text(form):
    with binding(PRINT_CASE, keyword("DOWNCASE")):
        return one_line(form)


def _looks_like_a_call(form):
    """Whether ``form`` names a function and gives it an argument that no enumeration of words would have."""
    head = form.car
    if head is FUNCTION:
        return True
    if head.name in _nested or head.function.__class__ is UndefinedFunction:
        return False
    return any(not isinstance(argument, Symbol) or argument.name.startswith("?") for argument in form.cdr or ())
