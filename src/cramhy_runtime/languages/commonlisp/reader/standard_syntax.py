"""The syntax of the standard readtable, and the question whether a text is complete.

Lists and prefixes are in the engine (``text_reader.py``), what ``#`` begins is in ``dispatch_macros.py``; strings and comments
are here. Source: ANSI 2.4.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import NO_VALUES, FreshString
from . import dispatch_macros
from .reader_errors import QuietEnd, QuietFailure
from .readtables import READTABLE, STANDARD, DispatchTable
from .text_reader import NOTHING, SUPPRESS, Reader, as_reader, read_backquote, read_close, read_comma, read_list, read_quote


def read_comment(stream, character):
    """``;``: a comment up to the end of the line."""
    as_reader(stream).read_line()
    return NO_VALUES


def read_string(stream, character):
    """``"``: a string up to the same character; ``\\`` takes the next character as it is. A program that reads may change it."""
    reader = as_reader(stream)
    quote = character.char
    start = index = reader.offset
    escapes = READTABLE.value.single_escapes
    if escapes != {"\\"}:
        return _read_string_with(reader, quote, escapes)
    pieces = []
    while True:
        text = reader.text
        end = text.find(quote, index)
        escape = text.find("\\", index, end if end >= 0 else len(text))
        if escape >= 0 and escape + 1 < len(text):
            pieces.append(text[index:escape] + text[escape + 1])
            index = escape + 2
        elif end >= 0 and escape < 0:
            reader.offset = end + 1
            pieces.append(text[index:end])
            if SUPPRESS.value is not None:
                return None
            text = "".join(pieces)
            return FreshString(text) if reader.strict else text
        elif not reader.grow():
            reader.offset = len(text)
            reader.describe_frame('"', start - 1)
            return reader.ended()


def _read_string_with(reader, quote, escapes):
    """The string up to ``quote``, where other characters than ``\\`` are single escapes."""
    start, taken = reader.offset, []
    while (char := reader.read_char()) != quote:
        if char in escapes:
            char = reader.read_char()
        if not char:
            reader.describe_frame('"', start - 1)
            return reader.ended()
        taken.append(char)
    return None if SUPPRESS.value is not None else FreshString("".join(taken))


def _install_standard_syntax(table):
    for char, function in (
        ("(", read_list),
        (")", read_close),
        ("'", read_quote),
        ("`", read_backquote),
        (",", read_comma),
        (";", read_comment),
        ('"', read_string),
    ):
        table.set_macro(char, function)
    table.set_macro("#", DispatchTable(dispatch_macros.STANDARD_FUNCTIONS), non_terminating=True)


_install_standard_syntax(STANDARD)
READTABLE.value.assume(STANDARD)


def incomplete(text):
    """Whether ``text`` ends inside a form, string or comment, so that a REPL should ask for another line.

    Nothing is interned, evaluated or signalled; a malformed text counts as complete, for reading it will tell.
    """
    reader = Reader(text)
    reader.quiet = True
    old, SUPPRESS.value = SUPPRESS.value, True
    try:
        while reader.read(False, NOTHING) is not NOTHING:
            pass
    except QuietEnd:
        return True
    except (QuietFailure, RecursionError):
        return False
    except Exception:  # a macro function of the user's own failed; reading in earnest will say how
        return False
    finally:
        SUPPRESS.value = old
    return False
