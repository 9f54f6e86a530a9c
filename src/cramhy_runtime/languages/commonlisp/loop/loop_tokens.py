"""The words of a LOOP: a sequence of keywords and forms, and the complaint when one is out of place.

A complaint is a program-error in SBCL's words; it shows the clause that was being read, and its ``hint`` attribute says which
keyword the wrong one resembles.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import SimpleProgramError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime.lisp_core.packages import is_symbol, near_names, symbol_name

NOTHING = object()

ZERO_OF_TYPE = {
    **dict.fromkeys("FIXNUM INTEGER NUMBER REAL RATIONAL BIT BIGNUM UNSIGNED-BYTE SIGNED-BYTE MOD".split(), 0),
    **dict.fromkeys("FLOAT SINGLE-FLOAT SHORT-FLOAT".split(), SingleFloat(0.0)),
    **dict.fromkeys("DOUBLE-FLOAT LONG-FLOAT".split(), 0.0),
}
"""First values of variables that are declared to be numbers and get no value."""
SIMPLE_TYPES = {
    *ZERO_OF_TYPE,
    "T",
    "NIL",
    "ATOM",
    "LIST",
    "CONS",
    "SYMBOL",
    "STRING",
    "CHARACTER",
    "VECTOR",
    "ARRAY",
    "SEQUENCE",
    "FUNCTION",
    "HASH-TABLE",
    "KEYWORD",
    "PACKAGE",
    "NULL",
    "SIMPLE-VECTOR",
    "SIMPLE-STRING",
    "BIT-VECTOR",
    "RATIO",
    "COMPLEX",
    "STREAM",
    "PATHNAME",
    "READTABLE",
} - {"SIGNED-BYTE"}
"""Type names that may stand behind a variable without ``of-type``."""


class Tokens:
    """The items of a loop not read yet; true as long as there are any."""

    def __init__(self, items):
        self.items = items
        self.index = 0
        self.start = 0

    def __bool__(self):
        return self.index < len(self.items)

    def begin_clause(self):
        """From here on a complaint shows what was read."""
        self.start = self.index

    def peek(self):
        return self.items[self.index] if self else NOTHING

    def next_is(self, *names):
        """Whether the next item is a symbol with one of these names."""
        item = self.peek()
        return item is not NOTHING and is_symbol(item) and symbol_name(item) in names

    def take(self):
        """The next item."""
        if not self:
            self.fail("LOOP source code ran out when another token was expected.")
        item = self.items[self.index]
        self.index += 1
        return item

    def form(self):
        """The next item, a form."""
        if not self:
            self.fail("LOOP code ran out where a form was expected.")
        return self.take()

    def keyword(self, wanted):
        """The name of the next item, which must be a symbol."""
        item = self.take()
        if not is_symbol(item):
            self.fail("~S found where a ~A expected", item, wanted)
        return symbol_name(item)

    def compound_forms(self):
        """The compound forms up to the next keyword; at least one."""
        forms = [self.form()]
        if not isinstance(forms[0], Cons):
            hint = (
                "A value is returned with FINALLY (RETURN value)."
                if is_symbol(forms[0]) and symbol_name(forms[0]) == "RETURN"
                else "Forms are lists here: (print x)."
            )
            self.fail("A compound form was expected, but ~S found.", forms[0], hint=hint)
        while self and isinstance(self.peek(), Cons):
            forms.append(self.take())
        return forms

    def type_specifier(self):
        """The type declared behind a variable, ``None`` when there is none."""
        if self.next_is("OF-TYPE"):
            self.take()
            return self.form()
        item = self.peek()
        if isinstance(item, Cons) or (item is not NOTHING and is_symbol(item) and item is not None and symbol_name(item) in SIMPLE_TYPES):
            return self.take()
        return None

    def fail(self, control, *arguments, hint=None):
        """Signal that the loop is malformed."""
        context = self.items[self.start : self.index]
        error(SimpleProgramError(control + "~%current LOOP context:~{ ~S~}.", *arguments, list_from(context)), hint=hint)

    def unknown(self, keyword, known):
        """Signal that ``keyword`` begins no clause."""
        near = near_names(keyword, known, 2)
        if self:
            self.index += 1
        self.fail("unknown LOOP keyword: ~A", keyword, hint=f"Did you mean {' or '.join(near)}?" if near else None)


def zero(type_specifier):
    """The first value of a variable of that type that is given none."""
    if isinstance(type_specifier, Cons):
        type_specifier = type_specifier.car
    if is_symbol(type_specifier):
        return ZERO_OF_TYPE.get(symbol_name(type_specifier))
    return None
