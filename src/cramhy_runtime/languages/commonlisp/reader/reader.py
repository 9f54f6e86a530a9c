"""The reader: Common Lisp text in, Lisp data out.

    >>> Reader("(drive-to (pose 1 2))", filename="plan.lisp").read()

This module is the entrance. Behind it are

* ``text_reader``        the engine: the class `Reader`, places, lists and prefixes
* ``standard_syntax``    strings, comments, the standard readtable, `incomplete`
* ``dispatch_macros``    what ``#`` begins
* ``shared_structure``   labels: ``#1=`` and ``#1#``
* ``tokens``             numbers and names
* ``readtables``         what each character does
* ``reader_functions``   `read` and its relatives on strings and streams
* ``form_places``        where lines, forms and symbols stand
* ``reader_errors``      what is wrong, where, and what to try

Templates are in ``syntax/backquote.py``.

Source: ANSI chapters 2 and 23.
"""

from __future__ import annotations

from .reader_functions import read, read_delimited_list, read_from_stream, read_from_string, read_preserving_whitespace
from .readtables import (
    Readtable,
    copy_readtable,
    get_dispatch_macro_character,
    get_macro_character,
    make_dispatch_macro_character,
    readtable_case,
    readtablep,
    set_dispatch_macro_character,
    set_macro_character,
    set_syntax_from_char,
)
from .standard_syntax import incomplete
from .text_reader import NOTHING, Reader, StreamReader, as_reader
from .tokens import parse_integer

__all__ = [
    "NOTHING",
    "Reader",
    "Readtable",
    "StreamReader",
    "as_reader",
    "copy_readtable",
    "get_dispatch_macro_character",
    "get_macro_character",
    "incomplete",
    "make_dispatch_macro_character",
    "parse_integer",
    "read",
    "read_delimited_list",
    "read_from_stream",
    "read_from_string",
    "read_preserving_whitespace",
    "readtable_case",
    "readtablep",
    "set_dispatch_macro_character",
    "set_macro_character",
    "set_syntax_from_char",
]
