"""The notation of designators: ``(a motion (type driving) (speed ?speed))`` as a form that builds the description.

A function from forms to a form, called by the macros ``a``, ``an`` and ``all``. ``?name`` is a variable of the surrounding code. A symbol
that is bound when the macro is expanded, as a variable or a constant, stands for its value; so do ``*name*`` and ``+name+``, bound or
not. Everything else is a keyword. Calls are not evaluated; what is computed goes into a ``?variable`` first. Source: designators.md 3.2.

The original puts the value of that moment into the code. Here the code asks for the value when the designator is made, so that a variable
that is bound or set later has its new value. The variables of the prompt, ``*``, ``+``, ``-``, ``/`` and so on, stay words.

Several properties may have one key, and a value may be any list. Two things are worth a style-warning all the same, since nobody
means them: a value that looks like a call, ``(speed (+ 1 2))``, and a property that is there twice, word for word.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import SimpleStyleWarning
from cramhy_runtime.lisp_core.conditions import error, unbound_variable
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Keyword, Symbol, UndefinedFunction, lisp_list, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.equality import equal
from ...compiler.compilation_unit import expansion_place, warn_of
from ...evaluation.definitions import take_as_keyword
from cramhy_runtime.storage.dependency_tracing import current as current_trace
from cramhy_runtime.lisp_core.packages import keyword
from ...printer.print_controls import PRINT_CASE
from ...tools.describing import one_line
from cramhy_runtime.designators.symbols import sym

LIST, QUOTE, WHEN, FUNCTION = sym("LIST"), sym("QUOTE"), sym("WHEN"), sym("FUNCTION")
MAKE, MAKE_ALL, PRESENT = sym("DESIG::MAKE-DESIGNATOR"), sym("DESIG::MAKE-ALL-DESIGNATOR"), sym("DESIG::PRESENT")
GLOBAL_VALUE, VALUE_OF = sym("DESIG::GLOBAL-VALUE"), sym("DESIG::VALUE-OF")
_OF_THE_PROMPT = frozenset(map(sym, "* ** *** + ++ +++ - / // ///".split()))
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
    entries = [entry for entry in (_property(pair) for pair in _proper(pairs)) if entry is not None]
    if not entries:
        return None
    if all(_is_constant(entry) for entry in entries):
        return lisp_list(QUOTE, list_from([_constant(entry) for entry in entries]))
    form = Cons(LIST, list_from(entries))
    return form if all(_is_constant(entry) or _is_list(entry) for entry in entries) else lisp_list(PRESENT, form)


def _property(pair):
    """The form for one entry of a description. A key that is a variable whose value cannot be a key is the key itself."""
    key = pair.car if isinstance(pair, Cons) and isinstance(pair.cdr, Cons) else None
    if isinstance(key, Symbol) and key.name[:1] != "?" and not is_global_name(key.name) and _is_variable(key):
        value = value_of(key)
        if not isinstance(value, Symbol):
            warn_of(
                SimpleStyleWarning,
                "~S is a variable, and the key of a property of a designator here: its value, ~S, cannot be a key, so the key is :~A.",
                key,
                value,
                key.name,
            )
            return _entry(Cons(keyword(key.name), pair.cdr))
    return _entry(pair)


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
    if isinstance(symbol, Keyword) or symbol.name.startswith("?") and symbol.value is UNBOUND:
        return symbol
    if is_global_name(symbol.name):
        return lisp_list(GLOBAL_VALUE, symbol)
    if _is_variable(symbol):
        return lisp_list(VALUE_OF, lisp_list(QUOTE, symbol))
    return keyword(symbol.name.upper())


def _is_variable(symbol):
    """Whether ``symbol`` is bound now. Kept code depends on that, and a definition that comes later is warned of."""
    package = symbol.package
    if symbol in _OF_THE_PROMPT or package is None:
        return False
    bound = symbol.value is not UNBOUND
    if not package.built_in:
        place = expansion_place()
        trace = current_trace()
        if trace is not None:
            trace.ask("bound", (package.name, symbol.name, place or ()))
        if not bound:
            take_as_keyword(symbol, place)
    return bound


def value_of(symbol):
    """What the bound ``symbol`` is in a description: its value. A value that is a symbol is looked up in turn, and becomes a keyword."""
    seen = {symbol}
    value = symbol.value if symbol.value is not UNBOUND else unbound_variable(symbol)
    while value.__class__ is Symbol and value.value is not UNBOUND and value not in seen:
        seen.add(value)
        value = value.value
    return global_value(value)


def is_global_name(name):
    """Whether ``name`` is written as the names of global variables and constants are: ``*name*``, ``+name+``."""
    return len(name) > 2 and name[0] == name[-1] and name[0] in "*+" and name.strip("*+") != ""


def global_value(value):
    """What ``value``, that of a global variable, is in a description: a symbol is a keyword there, as one that is written."""
    return keyword(value.name.upper()) if value.__class__ is Symbol and value.name[:1] != "?" else value


def _is_constant(form):
    if isinstance(form, Cons):
        return form.car is QUOTE
    return not isinstance(form, Symbol) or isinstance(form, Keyword)


def _is_list(form):
    """Whether the value of ``form`` is a property in any case; that of a variable in its place, ``(a location ?where)``, may be nil."""
    return isinstance(form, Cons) and form.car is LIST


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
