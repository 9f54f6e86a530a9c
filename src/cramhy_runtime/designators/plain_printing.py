"""How a designator looks when no language is loaded: ``#<A MOTION`` and a line ``    (KEY VALUE)`` per property."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.lisp_core.printing import define_printer, prin1_to_string
from .classes import Designator, type_keyword


def _text(thing):
    return symbol_name(thing) if is_symbol(thing) else prin1_to_string(thing)


def print_designator(designator, stream):
    """Print the quantifier, the class and the properties. Keys and values that are symbols are printed without colon."""
    stream.write(f"#<{_text(designator.quantifier)} {_text(type_keyword(designator))}")
    for entry in designator.description or ():
        if isinstance(entry, Cons):
            value = entry.cdr.car if isinstance(entry.cdr, Cons) else entry.cdr
            stream.write(f"\n    ({_text(entry.car)} {_text(value)})")
        else:
            stream.write(f"\n    {_text(entry)}")
    stream.write(">")


define_printer(Designator, print_designator)
