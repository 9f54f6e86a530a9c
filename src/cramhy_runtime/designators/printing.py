"""How designators are printed: over several lines, one per property, always the same (designators.md section 4).

Errors show designators, so a value that cannot be printed must not become an error in the place of the one that was to be told: it
is shown as ``#<error printing a ...>``.
"""

from __future__ import annotations

from fractions import Fraction

from ..lisp.conditions import Error, handler_case, ignore_errors, type_error
from ..lisp.data import UNBOUND, Character, Cons, DoubleFloat, LispString, all_values
from ..lisp.dynamic import special
from ..lisp.objects.classes import class_name, class_of
from ..lisp.packages import is_symbol, symbol_name
from ..lisp.printer.print_controls import PRINT_ESCAPE
from ..lisp.printer.print_names import in_print_case, token
from ..lisp.printer.printer import define_printer, princ_to_string, print_unreadable, write
from ..lisp.streams.streams import BroadcastStream
from ..lisp.tools.describing import describe_facts, describe_object
from .classes import Designator, type_keyword
from .symbols import sym

PRINT_DESCRIPTION = special(sym("DESIG::*DESIGNATOR-PPRINT-DESCRIPTION*"), True)


def print_designator(designator, stream):
    """``#<A MOTION``, a line ``    (KEY VALUE)`` per property, ``>``. Keys and values that are symbols go without colon."""
    print_unreadable(designator, stream, body=lambda: _print_description(designator, stream))


def _print_description(designator, stream):
    if PRINT_DESCRIPTION.value is None:
        return
    escape = PRINT_ESCAPE.value is not None
    put = stream.write
    put(f"{_bare(designator.quantifier, escape)} {_bare(type_keyword(designator), escape)}")
    description = designator.description
    if description is not None and not isinstance(description, Cons):
        type_error(description, "LIST")
    for entry in description or ():
        if isinstance(entry, Cons):
            put("\n    (")
            _print_part(entry.car, stream, escape)
            put(" ")
            rest = entry.cdr
            _print_part(rest.car if isinstance(rest, Cons) else rest, stream, escape)
            put(")")
        else:  # a description may be anything, such as '(:close-to :fridge)
            put("\n    ")
            _print_part(entry, stream, escape)


def _bare(symbol, escape):
    """The text of a symbol without package, as if it were one of the current package."""
    name = symbol_name(symbol)
    return token(name) if escape else in_print_case(name)


_SAFE = frozenset([int, float, DoubleFloat, Fraction, str, LispString, Character])


def _safe(thing):
    return thing.__class__ in _SAFE or is_symbol(thing) or isinstance(thing, Designator)


def _print_part(thing, stream, escape):
    """Print a key or a value."""
    if is_symbol(thing):
        stream.write(_bare(thing, escape))
    elif _safe(thing) or (isinstance(thing, Cons) and all(map(_safe, thing))):
        write(thing, stream, escape)
    else:  # tried first where nobody sees it, for what a failing printer leaves behind is half a list
        problem = handler_case([(Error, lambda problem: problem)], lambda: write(thing, BroadcastStream(), escape))
        if problem is None:
            write(thing, stream, escape)
        else:
            stream.write(_unprintable(thing, problem))


def _unprintable(thing, problem):
    why, *_ = all_values(ignore_errors(lambda: princ_to_string(problem)))
    return f"#<error printing a {class_name(class_of(thing)).name}{': ' + ' '.join(why.split()) if why else ''}>"


define_printer(Designator, print_designator)


@describe_object.method(Designator, None)
def describe_designator(designator, stream):
    """Its class, what stands in it, and what became of it: data, solution, the designators it was equated with."""
    facts = [("Class", class_name(type(designator))), ("Properties", designator.description), ("Effective", designator.effective),
             ("Data", designator.data), ("Timestamp", designator.timestamp)]
    if designator.solutions is not UNBOUND:
        facts.append(("Current solution", designator.current_solution))
    facts += [(label, other) for label, other in (("Parent", designator.parent), ("Successor", designator.successor)) if other is not None]
    return describe_facts(designator, stream, "designator", facts)
