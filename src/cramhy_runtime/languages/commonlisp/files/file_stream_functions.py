"""Bytes and positions: ``read-byte``, ``write-byte``, ``file-position``, ``file-length`` and their relatives (ANSI 21.2)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import EndOfFile, SimpleTypeError, error, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Character, LispString
from cramhy_runtime.lisp_core.packages import keyword
from ..streams.external_formats import external_format
from .file_streams import FileStream
from ..pathnames.pathnames import ON_NAMED_FILE
from ..streams.streams import BroadcastStream, Stream, StringInputStream, SynonymStream, input_stream, misused, output_stream

LISP_NAMES = "read-byte write-byte file-position file-length file-string-length stream-external-format"

_ON_FILES = "(OR FILE-STREAM SYNONYM-STREAM BROADCAST-STREAM)"


def read_byte(stream, eof_error_p=True, eof_value=None):
    """``read-byte``: the next element of a binary stream."""
    stream = input_stream(stream) if isinstance(stream, Stream) else type_error(stream, "STREAM")
    byte = stream.read_byte() if hasattr(stream, "read_byte") else misused(stream, "binary input")
    if byte is not None:
        return byte
    return eof_value if eof_error_p is None else error(EndOfFile(stream))


def write_byte(integer, stream):
    """``write-byte``: write ``integer`` to a binary stream. Returns it."""
    stream = output_stream(stream) if isinstance(stream, Stream) else type_error(stream, "STREAM")
    if not hasattr(stream, "write_byte"):
        return misused(stream, "binary output")
    if integer.__class__ is not int:
        return type_error(integer, "INTEGER")
    stream.write_byte(integer)
    return integer


def file_position(stream, position=UNSUPPLIED):
    """``file-position``: how many elements precede the next one; with ``position`` (a number, :start, :end) go there, T if that works.

    In files it counts bytes, also of characters, as in SBCL.
    """
    if not isinstance(stream, Stream):
        return type_error(stream, "STREAM")
    if position is UNSUPPLIED:
        return stream.position()
    if position is keyword("START"):
        position = 0
    elif position is keyword("END"):
        position = None
    elif position.__class__ is not int or position < 0:
        return type_error(position, "(OR UNSIGNED-BYTE (MEMBER :START :END))")
    moved = stream.set_position(position)
    if not moved:
        return None
    return stream.position() if isinstance(stream, StringInputStream) else True


def file_length(stream):
    """``file-length``: the number of elements of the file."""
    if isinstance(stream, BroadcastStream):
        return file_length(stream.streams[-1]) if stream.streams else 0
    real = stream
    while isinstance(real, SynonymStream):
        real = real.stream
    if isinstance(real, FileStream):
        return real.length()
    if real is stream and getattr(stream, "lisp_name", "") != "SB-SYS::FD-STREAM":
        return type_error(stream, _ON_FILES)
    return error(SimpleTypeError("~S is not a stream associated with a file.", real, datum=real, expected_type=ON_NAMED_FILE))


def file_string_length(stream, text):
    """``file-string-length``: how much ``file-position`` grows when the string or character ``text`` is written."""
    if isinstance(stream, BroadcastStream):
        return file_string_length(stream.streams[-1], text) if stream.streams else 1
    if isinstance(stream, SynonymStream):
        return file_string_length(stream.stream, text)
    if not isinstance(text, (str, LispString, Character)):
        return type_error(text, "(OR STRING CHARACTER)")
    text = text.char if isinstance(text, Character) else str(text)
    if isinstance(stream, FileStream):
        return stream.format.width(text)
    if getattr(stream, "lisp_name", "") == "SB-SYS::FD-STREAM":
        return external_format(None).width(text)
    return type_error(stream, _ON_FILES)


def stream_external_format(stream):
    """``stream-external-format``: how characters become bytes, :utf-8 if nothing else was said."""
    return stream.external_format() if isinstance(stream, Stream) else type_error(stream, "STREAM")
