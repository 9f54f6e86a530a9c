"""The reading functions that Lisp programs call, on strings and streams. Source: ANSI 23.2.

After an object at top level one white-space character is consumed as well, unless white space is to be preserved.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import Character, LispString, MultipleValues, list_from, truth
from .dispatch_macros import FEATURES, READ_EVAL
from .readtables import READTABLE
from .text_reader import NOTHING, PACKAGE, SUPPRESS, Reader, StreamReader, as_reader
from .tokens import FLOAT_FORMAT, READ_BASE, bounds


class StringReader(Reader):
    """The reader of ``read-from-string``."""

    lisp_name = "SB-IMPL::STRING-INPUT-STREAM"


def read_from_string(string, eof_error_p=True, eof_value=None, *, start=0, end=None, preserve_whitespace=None):
    """``cl:read-from-string``: the object at ``start`` and the index behind it (two values)."""
    if not isinstance(string, (str, LispString)):
        return type_error(string, "STRING")
    text = str(string)
    start, end = bounds(text, start, end)
    reader = StringReader(text[:end], "a string", strict=True)
    reader.offset = start
    found = _read(reader, eof_error_p, eof_value, None, truth(preserve_whitespace))
    return MultipleValues((found, reader.offset))


def read(stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    """``cl:read``: the next object of ``stream``, by default ``*standard-input*``; t stands for ``*terminal-io*``."""
    return _read(as_reader(stream), eof_error_p, eof_value, recursive_p, False)


def read_preserving_whitespace(stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    """As `read`, but the character behind the object is left in the stream."""
    return _read(as_reader(stream), eof_error_p, eof_value, recursive_p, True)


def _read(reader, eof_error_p, eof_value, recursive, preserve):
    nested = reader.is_reading
    try:
        found = reader.read(truth(eof_error_p), NOTHING)
        if found is NOTHING:
            return eof_value
        if not preserve and not nested:
            if isinstance(reader, StreamReader) and reader.source.gives_single_characters and reader.offset == len(reader.text):
                reader.grow()
            if reader.offset < len(reader.text) and reader.text[reader.offset] in READTABLE.value.whitespace:
                reader.offset += 1
        return found
    finally:
        if isinstance(reader, StreamReader) and not nested:
            reader.release()


def read_from_stream(stream=None, eof_error=True, eof_value=None):
    """`read` for the runtime's own use."""
    return read(stream, eof_error, eof_value)


def read_delimited_list(char, stream=None, recursive_p=None):
    """``cl:read-delimited-list``: the objects up to the character ``char``, as a list."""
    if not isinstance(char, Character):
        return type_error(char, "CHARACTER")
    reader = as_reader(stream)
    try:
        found = reader.objects_until(char.char)
        return list_from(found) if SUPPRESS.value is None else None
    finally:
        if isinstance(reader, StreamReader) and not reader.is_reading:
            reader.release()


LISP_NAMES = "read read-preserving-whitespace read-delimited-list read-from-string"
VARIABLES = {
    "*read-base*": READ_BASE.value,
    "*read-default-float-format*": FLOAT_FORMAT.value,
    "*read-eval*": READ_EVAL.value,
    "*read-suppress*": SUPPRESS.value,
    "*readtable*": READTABLE.value,
    "*features*": FEATURES.value,
    "*package*": PACKAGE.value,
}
