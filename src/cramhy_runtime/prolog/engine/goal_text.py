"""Goals and values as the tracer and the explainer show them: on one line, short, variables by the names that the user gave them.

A term may be huge, endless or not computed yet. So only a part of it is read for the text, and lazy lists are not forced. A number
distinguishes two variables of the same name, which come from two uses of a clause: ``?x`` and ``?x-2``.
"""

from __future__ import annotations


from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.lisp_core.conditions import Error, handler_case
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym as lisp_symbol
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.utilities.lazy_lists import LazyTail

from .database import functors
from ..terms.terms import UNSET, TermTail, Var

MOST_ELEMENTS = 12
"""The text shows so many elements of a list."""
MOST_DEPTH = 6
"""The text shows so many levels of lists in lists."""
MOST_CHARACTERS = 240
"""The text of a goal has so many characters at most."""
_MORE, _ANYTHING = Symbol("..."), Symbol("?_")
_BREAK = late_pattern(r"\s*\n\s*")

PRINT_PRETTY, PRINT_GENSYM, PRINT_CASE, PRINT_CIRCLE, PRINT_READABLY = (
    lisp_symbol(f"*PRINT-{control}*") for control in ("PRETTY", "GENSYM", "CASE", "CIRCLE", "READABLY")
)


class Names:
    """The symbols that stand for unset variables in one text."""

    def __init__(self):
        self.symbols, self.counts = {}, {}

    def of(self, variable):
        """The symbol that stands for ``variable``."""
        symbol = self.symbols.get(variable)
        if symbol is None:
            written = variable.written or variable.name
            if written is None:
                return _ANYTHING
            count = self.counts[written.name] = self.counts.get(written.name, 0) + 1
            symbol = self.symbols[variable] = written if count == 1 else Symbol(f"{written.name}-{count}")
        return symbol


def readable(term, names=None, depth=MOST_DEPTH):
    """Lisp data to be printed for ``term``: values in place of variables, and only the part that is shown."""
    names = names or Names()
    while term.__class__ is Var:
        if term.ref is UNSET:
            return names.of(term)
        term = term.ref
    if term.__class__ is LazyTail or term.__class__ is TermTail:
        return list_from([_MORE]) if term.generator is not None else readable(term.value, names, depth)
    if term.__class__ is not Cons:
        return term
    if not depth:
        return _MORE
    items = []
    while True:
        kind = term.__class__
        if kind is Cons:
            if len(items) == MOST_ELEMENTS:
                items.append(_MORE)
                return list_from(items)
            items.append(readable(term.car, names, depth - 1))
            term = term.cdr
        elif kind is Var and term.ref is not UNSET:
            term = term.ref
        elif (kind is LazyTail or kind is TermTail) and term.generator is None:
            term = term.value
        elif kind is LazyTail or kind is TermTail:
            items.append(_MORE)
            return list_from(items)
        else:
            return list_from(items, readable(term, names, depth))


def line(data, case=None):
    """``data`` printed on one line of at most `MOST_CHARACTERS`. ``case`` is ``"DOWNCASE"`` or, for the user's setting, ``None``."""
    case = keyword(case) if case else PRINT_CASE.value
    with binding(PRINT_PRETTY, None, PRINT_GENSYM, None, PRINT_CASE, case, PRINT_CIRCLE, None, PRINT_READABLY, None):
        text = handler_case([(Error, lambda problem: f"#<{type(data).__name__} that cannot be printed>")], lambda: prin1_to_string(data))
    text = _BREAK.sub(" ", text).replace("|...|", "...")
    return text if len(text) <= MOST_CHARACTERS else text[: MOST_CHARACTERS - 4] + " ..."


def show(term, names=None):
    """``term`` as text for a student, in small letters."""
    return line(readable(term, names), "DOWNCASE")


def clause_name(clause, case="DOWNCASE"):
    """``clause 2 of turtle-motions at motions.lisp:14:3``: its number among the clauses of its functor in its group, and its place."""
    place = describe(getattr(clause, "position", None))
    return f"clause {clause_number(clause)} of {line(clause.group, case)}" + (f" at {place}" if place else "")


def clause_number(clause):
    """The number of a clause, from 1, among the clauses of its functor in its group, as text."""
    entry = functors.get(clause.head.car)
    clauses = [other for other in entry.clauses if other.group is clause.group] if entry is not None else []
    return str(clauses.index(clause) + 1) if clause in clauses else "?"
