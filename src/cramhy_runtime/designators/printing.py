"""How designators are printed: over several lines, one per property, always the same (designators.md section 4)."""

from __future__ import annotations

from ..lisp.conditions import type_error
from ..lisp.data import UNBOUND, Cons, Symbol
from ..lisp.dynamic import special
from ..lisp.objects.classes import class_name
from ..lisp.packages import symbol_name
from ..lisp.printer.print_controls import PACKAGE, PRINT_ESCAPE
from ..lisp.printer.printer import define_printer, print_unreadable, write
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
    _bare(designator.quantifier, stream, escape)
    stream.write(" ")
    _bare(type_keyword(designator), stream, escape)
    description = designator.description
    if description is not None and not isinstance(description, Cons):
        type_error(description, "LIST")
    for entry in description or ():
        if not isinstance(entry, Cons):  # a description may be anything, such as '(:close-to :fridge)
            stream.write("\n    ")
            _bare(entry, stream, escape)
            continue
        stream.write("\n    (")
        _bare(entry.car, stream, escape)
        stream.write(" ")
        _bare(entry.cdr.car if entry.cdr is not None else None, stream, escape)
        stream.write(")")


def _bare(thing, stream, escape):
    """Print ``thing``; a symbol as the symbol of its name in the current package, which needs no prefix."""
    if isinstance(thing, Symbol):
        thing = PACKAGE.value.intern(symbol_name(thing))
    write(thing, stream, escape)


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
