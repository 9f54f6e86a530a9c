"""The stream functions of Common Lisp: ``write-string``, ``read-line``, ``make-string-output-stream`` and their
relatives.

Streams themselves are in ``streams.py``. Lisp characters are `Character` objects, streams deal in Python strings; the
border is here. Source: ANSI chapter 21; error texts are SBCL's.
"""

from __future__ import annotations

from ..collections.element_types import upgraded_element_type
from ..collections.sequence_types import INDEX_TYPE, bounds, elements, part
from cramhy_runtime.lisp_core.arrays import BASE_CHAR, CHARACTER, TypedVector
from cramhy_runtime.lisp_core.conditions import EndOfFile, error, type_error
from cramhy_runtime.lisp_core.data import (
    WRITABLE_STRINGS,
    Character,
    Cons,
    FreshString,
    KindString,
    LispString,
    MultipleValues,
    boolean,
    list_from,
)
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from cramhy_runtime.lisp_core.ports import PORTS
from . import streams
from .streams import (
    BroadcastStream,
    ConcatenatedStream,
    EchoStream,
    OutputStream,
    Stream,
    StringInputStream,
    StringOutputStream,
    SynonymStream,
    TwoWayStream,
    input_stream,
    output_stream,
)

# --------------------------------------------------------------------------------------------------------------- output


def _text(string):
    if string.__class__ is str:
        return string
    if isinstance(string, (str, LispString)):
        return str(string)
    text = _characters(string)
    return type_error(string, "STRING") if text is None else text


def _characters(vector):
    try:
        elements = list(vector)
    except TypeError:
        return None
    if all(isinstance(item, Character) for item in elements):
        return "".join(item.char for item in elements)
    return "".join(elements) if all(isinstance(item, str) and len(item) == 1 for item in elements) else None


def write_string(string, stream=None, *, start=0, end=None):
    """``write-string``: the characters ``start`` to ``end`` of ``string``. Returns ``string``."""
    text = string if string.__class__ is str else _text(string)
    if not isinstance(stream, OutputStream):
        stream = output_stream(stream)
    if start or end is not None:
        start, end = bounds(start, end, len(text))
        if stream.of_user:
            stream.write_part(text, start, end)
            return string
        text = text[start:end]
    elif stream.of_user:  # who gets one character, or none, by `stream-write-string`, too
        stream.write_part(text, 0, len(text))
        return string
    stream.write(text)
    return string


def write_line(string, stream=None, *, start=0, end=None):
    """``write-line``: as ``write-string``, and a newline."""
    text = _text(string)
    start, end = bounds(start, end, len(text))
    stream = output_stream(stream)
    if stream.of_user:
        stream.write_part(text, start, end)
        stream.write("\n")
    else:
        stream.write(text[start:end] + "\n")
    return string


def write_char(character, stream=None):
    if character.__class__ is not Character:
        return type_error(character, "CHARACTER")
    (stream if isinstance(stream, OutputStream) else output_stream(stream)).write(character.char)
    return character


def write_sequence(sequence, stream, *, start=0, end=None):
    """``write-sequence``: the elements of ``sequence``, characters or bytes, to ``stream``. Returns ``sequence``."""
    stream = output_stream(stream)
    if hasattr(stream, "write_elements"):  # of a user's class
        stream.write_elements(sequence, start, end)
        return sequence
    _need_index(start)
    if isinstance(sequence, (str, LispString)):
        text = str(sequence)
        start, end = bounds(start, end, len(text))
        stream.write(text[start:end])
        return sequence
    items = part(sequence, start, end)
    if hasattr(stream, "write_bytes") and items.__class__ in (list, TypedVector) and stream.write_bytes(items):
        return sequence
    for element in items:
        if isinstance(element, Character):
            stream.write(element.char)
        elif hasattr(stream, "write_byte"):
            stream.write_byte(element)
        else:
            type_error(element, "CHARACTER")
    return sequence


def terpri(stream=None):
    stream = stream if isinstance(stream, OutputStream) else output_stream(stream)
    if stream.of_user:
        stream.terpri()
    else:
        stream.write("\n")


def fresh_line(stream=None):
    return boolean(output_stream(stream).fresh_line())


def finish_output(stream=None):
    output_stream(stream).flush()


def force_output(stream=None):
    output_stream(stream).force()


def clear_output(stream=None):
    """``clear-output``: there is never anything to throw away, but for streams of users' classes."""
    stream = output_stream(stream)
    if hasattr(stream, "clear_output"):
        stream.clear_output()


# ---------------------------------------------------------------------------------------------------------------- input


def _at_end(stream, eof_error_p, eof_value):
    if eof_error_p is None:
        return eof_value
    return error(EndOfFile(stream))


def read_char(stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    stream = input_stream(stream)
    character = stream.read_char()
    return Character(character) if character else _at_end(stream, eof_error_p, eof_value)


def read_char_no_hang(stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    stream = input_stream(stream)
    if hasattr(stream, "read_char_no_hang"):  # of a user's class
        character = stream.read_char_no_hang()
        return None if character is None else Character(character) if character else _at_end(stream, eof_error_p, eof_value)
    if stream.is_interactive and not stream.listen():
        return None
    return read_char(stream, eof_error_p, eof_value)


def peek_char(peek_type=None, stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    """``peek-char``: the next character, which stays; with T the next that is no white space, else the next like it."""
    stream = input_stream(stream)
    if peek_type is not None and peek_type is not True and not isinstance(peek_type, Character):
        return type_error(peek_type, "(OR CHARACTER BOOLEAN)")
    while True:
        character = stream.peek_char()
        if not character:
            return _at_end(stream, eof_error_p, eof_value)
        if (
            peek_type is None
            or (peek_type is True and character not in sym("*READTABLE*").value.whitespace)
            or (isinstance(peek_type, Character) and peek_type.char == character)
        ):
            return Character(character)
        stream.read_char()


def unread_char(character, stream=None):
    if not isinstance(character, Character):
        return type_error(character, "CHARACTER")
    input_stream(stream).unread_char(character.char)


def read_line(stream=None, eof_error_p=True, eof_value=None, recursive_p=None):
    """``read-line``: the next line without its newline; second value true when the text ended without one."""
    stream = input_stream(stream)
    line, ended = stream.read_line()
    if ended and not line:
        missing = _at_end(stream, eof_error_p, eof_value)
        return MultipleValues((missing, True))
    return MultipleValues((FreshString(line), boolean(ended)))


def _need_index(start):
    if start is None:
        type_error(start, INDEX_TYPE, "\nwhen binding SB-IMPL::START")


def read_sequence(sequence, stream, *, start=0, end=None):
    """``read-sequence``: fill ``sequence`` with characters or bytes; the index of the first element that was not filled."""
    stream = input_stream(stream)
    _need_index(start)
    length = len(elements(sequence))
    start, end = bounds(start, length if end is None else end, length)
    if hasattr(stream, "read_elements"):  # of a user's class
        return stream.read_elements(sequence, start, end)
    return fill_sequence(sequence, stream, start, end)


def fill_sequence(sequence, stream, start, end):
    """Fill ``sequence`` from ``start`` to ``end`` with what is read, element by element; the index of the first that was not filled."""
    by_characters = sequence.__class__ in WRITABLE_STRINGS or stream.element_type() is CHARACTER
    if not by_characters and hasattr(stream, "read_bytes") and sequence.__class__ in (list, TypedVector):
        octets = stream.read_bytes(end - start)
        if octets is not None:
            sequence[start : start + len(octets)] = octets
            return start + len(octets)
    is_string, cell = sequence.__class__ in WRITABLE_STRINGS, sequence
    for _ in range(start if isinstance(sequence, Cons) else 0):
        cell = cell.cdr
    next_element = stream.read_char if by_characters else stream.read_byte
    for index in range(start, end):
        element = next_element()
        if element == "" or element is None:
            return index
        if is_string:
            sequence.writable()[index] = element
            continue
        element = Character(element) if element.__class__ is str else element
        if isinstance(sequence, Cons):
            cell.car, cell = element, cell.cdr
        elif isinstance(sequence, str):
            type_error(sequence, "(AND SEQUENCE (NOT (SATISFIES SB-KERNEL:LITERAL)))")
        else:
            sequence[index] = element
    return end


def listen(stream=None):
    return boolean(input_stream(stream).listen())


def clear_input(stream=None):
    input_stream(stream).clear()


# ------------------------------------------------------------------------------------------------------- making streams


def make_string_output_stream(*, element_type=CHARACTER):
    """``make-string-output-stream``: with the element type BASE-CHAR it gives base strings."""
    stream = StringOutputStream()
    if element_type is not CHARACTER:
        stream.kind = upgraded_element_type(element_type)
    return stream


def get_output_stream_string(stream):
    """``get-output-stream-string``: what was written to ``stream`` since the last time this was asked."""
    if not isinstance(stream, StringOutputStream):
        return type_error(stream, "SB-IMPL::STRING-OUTPUT-STREAM")
    text = stream.take()
    kind = stream.kind
    return KindString(text, kind) if kind is None or kind is BASE_CHAR and text.isascii() else FreshString(text)


def make_string_input_stream(string, start=0, end=None):
    text = _text(string)
    start, end = bounds(start or 0, end, len(text))
    return StringInputStream(text[:end], start)


def _all(streams, predicate, name):
    for stream in streams:
        if not isinstance(stream, Stream):
            type_error(stream, "STREAM")
        if not isinstance(stream, SynonymStream) and not getattr(stream, predicate):
            type_error(stream, f"(SATISFIES {name})")
    return streams


def make_broadcast_stream(*targets):
    return BroadcastStream(*_all(targets, "is_output", "OUTPUT-STREAM-P"))


def _part(cls, attribute, name):
    """The accessor of a part of streams of a class."""

    def read(stream):
        return getattr(stream, attribute) if isinstance(stream, cls) else type_error(stream, name)

    return read


def broadcast_stream_streams(stream):
    return list_from(_part(BroadcastStream, "streams", "BROADCAST-STREAM")(stream))


def make_concatenated_stream(*sources):
    return ConcatenatedStream(*_all(sources, "is_input", "INPUT-STREAM-P"))


def concatenated_stream_streams(stream):
    return list_from(_part(ConcatenatedStream, "streams", "CONCATENATED-STREAM")(stream))


def make_two_way_stream(source, sink):
    _all([source], "is_input", "INPUT-STREAM-P")
    _all([sink], "is_output", "OUTPUT-STREAM-P")
    return TwoWayStream(source, sink)


two_way_stream_input_stream = _part(TwoWayStream, "source", "TWO-WAY-STREAM")
two_way_stream_output_stream = _part(TwoWayStream, "sink", "TWO-WAY-STREAM")


def make_echo_stream(source, sink):
    _all([source], "is_input", "INPUT-STREAM-P")
    _all([sink], "is_output", "OUTPUT-STREAM-P")
    return EchoStream(source, sink)


echo_stream_input_stream = _part(EchoStream, "source", "ECHO-STREAM")
echo_stream_output_stream = _part(EchoStream, "sink", "ECHO-STREAM")


def make_synonym_stream(symbol):
    return SynonymStream(symbol) if is_symbol(symbol) else type_error(symbol, "SYMBOL")


synonym_stream_symbol = _part(SynonymStream, "symbol", "SYNONYM-STREAM")


# --------------------------------------------------------------------------------------------------- asking and closing


def streamp(thing):
    return boolean(isinstance(thing, Stream))


def _stream(thing):
    return thing if isinstance(thing, Stream) else type_error(thing, "STREAM")


def input_stream_p(stream):
    return boolean(_stream(stream).is_input and not stream.closed)


def output_stream_p(stream):
    return boolean(_stream(stream).is_output and not stream.closed)


def interactive_stream_p(stream):
    return boolean(_stream(stream).is_interactive)


def open_stream_p(stream):
    return boolean(not _stream(stream).closed)


def close(stream, *, abort=None):
    """``close``: end the stream; with ``abort`` what was written to a file counts as never written. Returns T."""
    _stream(stream).close(abort=abort is not None)
    return True


def stream_element_type(stream):
    """``stream-element-type``: CHARACTER, or the type of the bytes of a binary stream."""
    return _stream(stream).element_type()


def _ask(control, args, question):
    query = streams.QUERY_IO.value
    query.fresh_line()
    if control is not None:
        PORTS.printer.format_to(query, control, *args)
        query.write(" ")
    query.write(question)
    query.flush()
    return query.read_line()


def _ask_until(control, args, question, yes, no, reminder):
    while True:
        answer, ended = _ask(control, args, question)
        if answer.strip().lower() in yes:
            return True
        if answer.strip().lower() in no:
            return None
        if ended and not answer:
            return _at_end(streams.QUERY_IO.value, True, None)
        streams.QUERY_IO.value.write(reminder)


def y_or_n_p(control=None, *args):
    """``y-or-n-p``: ask on ``*query-io*``. At the end of the input it is an END-OF-FILE, as in SBCL."""
    return _ask_until(control, args, "(y or n) ", ("y",), ("n",), 'Please type "y" for yes or "n" for no.\n')


def yes_or_no_p(control=None, *args):
    """``yes-or-no-p``: ring the bell and ask on ``*query-io*``. At the end of the input it is an END-OF-FILE, as in SBCL."""
    streams.QUERY_IO.value.write("\a")
    return _ask_until(control, args, "(yes or no) ", ("yes",), ("no",), 'Please type "yes" for yes or "no" for no.\n')


LISP_NAMES = """ write-string write-line write-char write-sequence terpri fresh-line finish-output force-output
clear-output read-char read-char-no-hang peek-char unread-char read-line read-sequence listen clear-input
make-string-output-stream get-output-stream-string make-string-input-stream make-broadcast-stream
broadcast-stream-streams make-concatenated-stream concatenated-stream-streams make-two-way-stream
two-way-stream-input-stream two-way-stream-output-stream make-echo-stream echo-stream-input-stream
echo-stream-output-stream make-synonym-stream synonym-stream-symbol streamp input-stream-p output-stream-p
interactive-stream-p open-stream-p close stream-element-type y-or-n-p yes-or-no-p
"""
