"""How designators are printed: over several lines, one per property, always the same (designators.md section 4).

Errors show designators, so a value that cannot be printed must not become an error in the place of the one that was to be told: it
is shown as ``#<error printing a ...>``.
"""

from __future__ import annotations

from fractions import Fraction

from cramhy_runtime.lisp_core.conditions import Error, handler_case, type_error
from cramhy_runtime.lisp_core.data import FLOATS, UNBOUND, WRITABLE_STRINGS, Character, Cons
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.classes import class_name
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from ...printer.pprint_dispatch import PRINT_PPRINT_DISPATCH
from ...printer.print_controls import PRINT_BASE, PRINT_CASE, PRINT_CIRCLE, PRINT_ESCAPE
from ...printer.print_names import in_print_case, token
from ...printer.printer import atom_text, print_unreadable, write
from cramhy_runtime.lisp_core.printing import define_printer, unprintable
from ...streams.streams import BroadcastStream
from ...reader.readtables import READTABLE
from ...tools.describing import describe_facts, describe_object
from cramhy_runtime.designators.classes import IN_ERROR_TEXT, Designator, type_keyword
from cramhy_runtime.designators.symbols import sym

PRINT_DESCRIPTION = special(sym("DESIG::*DESIGNATOR-PPRINT-DESCRIPTION*"), True)


def print_designator(designator, stream):
    """``#<A MOTION``, a line ``    (KEY VALUE)`` per property, ``>``. Keys and values that are symbols go without colon."""
    print_unreadable(designator, stream, body=lambda: _print_description(designator, stream))


def _print_description(designator, stream):
    if PRINT_DESCRIPTION.value is None:
        return
    escape = PRINT_ESCAPE.value is not None
    bare = _Bare.table(escape)
    plain = PRINT_CIRCLE.value is None and not PRINT_PPRINT_DISPATCH.value.entries
    written = [bare[designator.quantifier], " ", bare[type_keyword(designator)]]  # text that the stream has not got yet

    def put(thing):
        if is_symbol(thing):
            written.append(bare[thing])
            return
        text = plain and atom_text(thing.__class__)
        if text:
            written.append(text(thing, escape))
        else:
            stream.write("".join(written))
            written.clear()
            _print_part(thing, stream, escape)

    description = designator.description
    if description is not None and not isinstance(description, Cons):
        if IN_ERROR_TEXT.value is None:
            type_error(description, "LIST")
        description = [description]
    for entry in description or ():
        if isinstance(entry, Cons):
            written.append("\n    (")
            put(entry.car)
            written.append(" ")
            rest = entry.cdr
            put(rest.car if isinstance(rest, Cons) else rest)
            written.append(")")
        else:  # a description may be anything, such as '(:close-to :fridge)
            written.append("\n    ")
            put(entry)
    stream.write("".join(written))


class _Bare(dict):
    """Symbol -> its text without package, as if it were one of the current package, under some state of the printer's variables."""

    tables = {}

    def __init__(self, escape):
        super().__init__()
        self.escape = escape

    @classmethod
    def table(cls, escape):
        """The table for the printer's variables as they are."""
        controls = escape, PRINT_CASE.value, READTABLE.value.case, PRINT_BASE.value
        found = cls.tables.get(controls)
        if found is None or len(found) > 10_000:
            found = cls.tables[controls] = cls(escape)
        return found

    def __missing__(self, symbol):
        name = symbol_name(symbol)
        text = self[symbol] = token(name) if self.escape else in_print_case(name)
        return text


_SAFE = frozenset([int, *FLOATS, Fraction, str, *WRITABLE_STRINGS, Character])


def _safe(thing):
    return thing.__class__ in _SAFE or is_symbol(thing) or isinstance(thing, Designator)


def _print_part(thing, stream, escape):
    """Print a key or a value that is no symbol."""
    if _safe(thing) or (isinstance(thing, Cons) and all(map(_safe, thing))):
        write(thing, stream, escape)
    else:  # tried first where nobody sees it, for what a failing printer leaves behind is half a list
        problem = handler_case([(Error, lambda problem: problem)], lambda: write(thing, BroadcastStream(), escape))
        if problem is None:
            write(thing, stream, escape)
        else:
            stream.write(unprintable(thing, problem))


def describe_designator(designator, stream):
    """Its class, what stands in it, and what became of it: data, solution, the designators it was equated with."""
    facts = [
        ("Class", class_name(type(designator))),
        ("Properties", designator.description),
        ("Effective", designator.effective),
        ("Data", designator.data),
        ("Timestamp", designator.timestamp),
    ]
    if designator.solutions is not UNBOUND:
        facts.append(("Current solution", designator.current_solution))
    facts += [(label, other) for label, other in (("Parent", designator.parent), ("Successor", designator.successor)) if other is not None]
    return describe_facts(designator, stream, "designator", facts)


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(Designator, print_designator)
    describe_object.method(Designator, None)(describe_designator)
