"""Gray streams: classes of streams whose functions users define as methods (SB-GRAY).

A user's class inherits from one of the classes here, which are streams for the rest of the runtime too: ``write-char``, ``format``,
``read`` and the printer call the stream's Python methods, and these call the generic functions ``stream-write-char``,
``stream-read-char`` and so on. A single character is written by ``stream-write-char``, a longer text by ``stream-write-string``.

``close``, ``stream-element-type``, ``input-stream-p``, ``output-stream-p``, ``open-stream-p`` and ``interactive-stream-p`` of Common Lisp
become generic when a program defines a method on them. Source: SBCL's manual, chapter 10.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNSUPPLIED, Character, MultipleValues, all_values, boolean, lisp_list, one, truth
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction, generic
from cramhy_runtime.lisp_core.dispatch.open_functions import Opening, open_to_methods
from cramhy_runtime.lisp_core.packages import ensure_package, keyword, sym
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..collections.sequence_types import elements, part
from ..packages.face_definition import define_face
from ..streams import stream_functions
from ..streams.streams import InputStream, OutputStream, Stream

if TYPE_CHECKING:
    from collections.abc import Callable

ensure_package("SB-GRAY")
EOF = keyword("EOF")
_openings: dict[str, Opening] = {}


def _asked(name: str, stream: Any, *arguments: Any) -> Any:
    """What the function NAME of Common Lisp says of STREAM when users have methods on it; else UNSUPPLIED."""
    opening = _openings.get(name)
    return one(opening.generic(stream, *arguments)) if opening is not None and opening.added else UNSUPPLIED


class FundamentalStream(Stream):
    """The root of the classes for users' streams."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-STREAM"

    def __init__(self) -> None:
        pass

    def close(self, abort: object = False) -> None:
        """As ``close`` does it, for which users may have methods."""
        if _asked("CLOSE", self, keyword("ABORT"), boolean(truth(abort))) is UNSUPPLIED:
            self.closed = True

    def element_type(self) -> Any:
        """As ``stream-element-type`` says."""
        found = _asked("STREAM-ELEMENT-TYPE", self)
        return self.own_element_type() if found is UNSUPPLIED else found

    def own_element_type(self) -> Any:
        """What ``stream-element-type`` says of a class without a method."""
        return sym("CHARACTER")

    def position(self) -> Any:
        """As ``stream-file-position`` says."""
        return one(STREAM_FILE_POSITION(self))

    def set_position(self, position: Any) -> bool:
        """As ``stream-file-position`` does it; None is the end."""
        return truth(one(STREAM_FILE_POSITION(self, keyword("END") if position is None else position)))


class FundamentalInputStream(FundamentalStream, InputStream):
    """A user's stream to read from."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-INPUT-STREAM"
    _text, _position = "", 0
    gives_single_characters = True

    def more(self) -> str:
        """The next character: a reader of forms gets no more than it needs."""
        return self.read_char()

    def put_back(self, text: str, position: int) -> None:
        """A reader has read TEXT up to POSITION."""
        for character in reversed(text[position:]):
            self.unread_char(character)

    def read_char(self) -> str:
        """``stream-read-char``"""
        return _text_of(STREAM_READ_CHAR(self))

    def read_char_no_hang(self) -> Any:
        """``stream-read-char-no-hang``: a character, "" at the end, None when none has come."""
        found = one(STREAM_READ_CHAR_NO_HANG(self))
        return None if found is None else _text_of(found)

    def peek_char(self) -> str:
        """``stream-peek-char``"""
        return _text_of(STREAM_PEEK_CHAR(self))

    def unread_char(self, character: str) -> None:
        """``stream-unread-char``"""
        STREAM_UNREAD_CHAR(self, Character(character))

    def read_line(self) -> tuple[str, bool]:
        """``stream-read-line``"""
        line, ended = (*all_values(STREAM_READ_LINE(self)), None)[:2]
        return ("", True) if line is EOF else (str(line), truth(ended))

    def listen(self) -> bool:
        """``stream-listen``"""
        return truth(one(STREAM_LISTEN(self)))

    def clear(self) -> None:
        """``stream-clear-input``"""
        STREAM_CLEAR_INPUT(self)

    def read_elements(self, sequence: Any, start: int, end: int) -> Any:
        """``stream-read-sequence``"""
        return one(STREAM_READ_SEQUENCE(self, sequence, start, end))


def _text_of(found: Any) -> str:
    value = one(found)
    return "" if value is EOF else value.char


class FundamentalOutputStream(FundamentalStream, OutputStream):
    """A user's stream to write to."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-OUTPUT-STREAM"
    of_user = True

    @property
    def column(self) -> int:  # type: ignore[override]
        """``stream-line-column``; 0 where the stream does not know."""
        found = one(STREAM_LINE_COLUMN(self))
        return 0 if found is None else found

    @property
    def line_length(self) -> Any:  # type: ignore[override]
        """``stream-line-length``"""
        return one(STREAM_LINE_LENGTH(self))

    def write(self, text: str) -> None:
        """``stream-write-char`` or ``stream-write-string``"""
        if len(text) == 1:
            STREAM_WRITE_CHAR(self, Character(text))
        elif text:
            STREAM_WRITE_STRING(self, text, 0, len(text))

    def write_part(self, text: str, start: int, end: int) -> None:
        """``stream-write-string`` of the characters ``start`` to ``end``"""
        STREAM_WRITE_STRING(self, text, start, end)

    def terpri(self) -> None:
        """``stream-terpri``"""
        STREAM_TERPRI(self)

    def fresh_line(self) -> bool:
        """``stream-fresh-line``"""
        return truth(one(STREAM_FRESH_LINE(self)))

    def flush(self) -> None:
        """``stream-finish-output``"""
        STREAM_FINISH_OUTPUT(self)

    def force(self) -> None:
        """``stream-force-output``"""
        STREAM_FORCE_OUTPUT(self)

    def clear_output(self) -> None:
        """``stream-clear-output``"""
        STREAM_CLEAR_OUTPUT(self)

    def write_elements(self, sequence: Any, start: int, end: Any) -> None:
        """``stream-write-sequence``"""
        STREAM_WRITE_SEQUENCE(self, sequence, start, end)


class FundamentalCharacterStream(FundamentalStream):
    """A user's stream of characters."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-CHARACTER-STREAM"


class FundamentalBinaryStream(FundamentalStream):
    """A user's stream of bytes."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-BINARY-STREAM"

    def own_element_type(self) -> Any:
        """Bytes, if nothing else is said."""
        return lisp_list(sym("UNSIGNED-BYTE"), 8)


class FundamentalCharacterInputStream(FundamentalInputStream, FundamentalCharacterStream):
    """A user's stream of characters to read."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-CHARACTER-INPUT-STREAM"


class FundamentalCharacterOutputStream(FundamentalOutputStream, FundamentalCharacterStream):
    """A user's stream to write characters to."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-CHARACTER-OUTPUT-STREAM"


class FundamentalBinaryInputStream(FundamentalInputStream, FundamentalBinaryStream):
    """A user's stream of bytes to read."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-BINARY-INPUT-STREAM"

    def read_byte(self) -> Any:
        """``stream-read-byte``"""
        found = one(STREAM_READ_BYTE(self))
        return None if found is EOF else found


class FundamentalBinaryOutputStream(FundamentalOutputStream, FundamentalBinaryStream):
    """A user's stream to write bytes to."""

    lisp_name = "SB-GRAY::FUNDAMENTAL-BINARY-OUTPUT-STREAM"

    def write_byte(self, byte: int) -> None:
        """``stream-write-byte``"""
        STREAM_WRITE_BYTE(self, byte)


CLASSES = (
    FundamentalStream,
    FundamentalInputStream,
    FundamentalOutputStream,
    FundamentalCharacterStream,
    FundamentalBinaryStream,
    FundamentalCharacterInputStream,
    FundamentalCharacterOutputStream,
    FundamentalBinaryInputStream,
    FundamentalBinaryOutputStream,
)


# ------------------------------------------------------------------------------------------------------- generic functions


_functions: list[str] = []


def _generic(name: str, parameters: str, *defaults: tuple[type, Callable[..., Any]]) -> GenericFunction:
    """The generic function NAME of SB-GRAY. DEFAULTS: classes of the first argument, and what is done for them."""
    made = generic(f"SB-GRAY::{name.upper()}", f"(stream {parameters})")
    others = len(parameters.partition("&")[0].split())
    for cls, function in defaults:
        made.method(cls, *[None] * others)(function)
    _functions.append(name)
    return made


def _read_line(stream: Any) -> Any:
    parts: list[str] = []
    while True:
        character = _text_of(STREAM_READ_CHAR(stream))
        if character in ("", "\n"):
            return MultipleValues(("".join(parts), boolean(not character)))
        parts.append(character)


def _peek_char(stream: Any) -> Any:
    found = one(STREAM_READ_CHAR(stream))
    if found is not EOF:
        STREAM_UNREAD_CHAR(stream, found)
    return found


def _write_string(stream: Any, string: Any, start: Any = 0, end: Any = None) -> Any:
    for character in str(string)[start or 0 : end]:
        STREAM_WRITE_CHAR(stream, Character(character))
    return string


def _terpri(stream: Any) -> None:
    STREAM_WRITE_CHAR(stream, Character("\n"))


def _fresh_line(stream: Any) -> Any:
    if truth(one(STREAM_START_LINE_P(stream))):
        return None
    STREAM_TERPRI(stream)
    return True


def _advance(stream: Any, column: int) -> Any:
    now = one(STREAM_LINE_COLUMN(stream))
    if now is None:
        return None
    for _ in range(column - now):
        STREAM_WRITE_CHAR(stream, Character(" "))
    return True


def _read_sequence(stream: Any, sequence: Any, start: Any = 0, end: Any = None) -> Any:
    last = len(elements(sequence)) if end is None else end
    return stream_functions.fill_sequence(sequence, stream, start or 0, last)


def _write_sequence(stream: Any, sequence: Any, start: Any = 0, end: Any = None) -> Any:
    if isinstance(sequence, str):
        STREAM_WRITE_STRING(stream, sequence, start or 0, len(sequence) if end is None else end)
        return sequence
    for element in part(sequence, start or 0, end):
        (STREAM_WRITE_CHAR if isinstance(element, Character) else STREAM_WRITE_BYTE)(stream, element)
    return sequence


def _nothing(*arguments: Any) -> None:
    return None


_INPUT, _OUTPUT = FundamentalInputStream, FundamentalOutputStream
STREAM_READ_CHAR = _generic("stream-read-char", "")
STREAM_UNREAD_CHAR = _generic("stream-unread-char", "character")
STREAM_READ_CHAR_NO_HANG = _generic("stream-read-char-no-hang", "", (_INPUT, lambda stream: STREAM_READ_CHAR(stream)))
STREAM_PEEK_CHAR = _generic("stream-peek-char", "", (_INPUT, _peek_char))
STREAM_LISTEN = _generic("stream-listen", "", (_INPUT, lambda stream: boolean(_peek_char(stream) is not EOF)))
STREAM_READ_LINE = _generic("stream-read-line", "", (_INPUT, _read_line))
STREAM_CLEAR_INPUT = _generic("stream-clear-input", "", (_INPUT, _nothing))
STREAM_WRITE_CHAR = _generic("stream-write-char", "character")
STREAM_LINE_COLUMN = _generic("stream-line-column", "", (_OUTPUT, _nothing))
STREAM_LINE_LENGTH = _generic("stream-line-length", "", (_OUTPUT, _nothing))
STREAM_START_LINE_P = _generic("stream-start-line-p", "", (_OUTPUT, lambda stream: boolean(one(STREAM_LINE_COLUMN(stream)) == 0)))
STREAM_WRITE_STRING = _generic("stream-write-string", "string &optional start end", (_OUTPUT, _write_string))
STREAM_TERPRI = _generic("stream-terpri", "", (_OUTPUT, _terpri))
STREAM_FRESH_LINE = _generic("stream-fresh-line", "", (_OUTPUT, _fresh_line))
STREAM_FINISH_OUTPUT = _generic("stream-finish-output", "", (_OUTPUT, _nothing))
STREAM_FORCE_OUTPUT = _generic("stream-force-output", "", (_OUTPUT, _nothing))
STREAM_CLEAR_OUTPUT = _generic("stream-clear-output", "", (_OUTPUT, _nothing))
STREAM_ADVANCE_TO_COLUMN = _generic("stream-advance-to-column", "column", (_OUTPUT, _advance))
STREAM_READ_BYTE = _generic("stream-read-byte", "")
STREAM_WRITE_BYTE = _generic("stream-write-byte", "integer")
STREAM_READ_SEQUENCE = _generic("stream-read-sequence", "sequence &optional start end", (_INPUT, _read_sequence))
STREAM_WRITE_SEQUENCE = _generic("stream-write-sequence", "sequence &optional start end", (_OUTPUT, _write_sequence))
STREAM_FILE_POSITION = _generic("stream-file-position", "&optional position", (FundamentalStream, _nothing))


# ----------------------------------------------------------------------------------------- functions of Common Lisp


def _close(stream: Any, *, abort: object = None) -> bool:
    if isinstance(stream, FundamentalStream):
        stream.closed = True
        return True
    return stream_functions.close(stream, abort=abort)


def _first_method(name: str, own: Callable[[Any], Any], plain: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def answer(stream: Any) -> Any:
        return own(stream) if isinstance(stream, FundamentalStream) else plain(stream)

    answer.__name__ = name
    return answer


_OPENED: dict[str, tuple[Callable[..., Any], Callable[[Any], Any]]] = {
    "STREAM-ELEMENT-TYPE": (stream_functions.stream_element_type, lambda stream: stream.own_element_type()),
    "INPUT-STREAM-P": (stream_functions.input_stream_p, lambda stream: boolean(stream.is_input)),
    "OUTPUT-STREAM-P": (stream_functions.output_stream_p, lambda stream: boolean(stream.is_output)),
    "OPEN-STREAM-P": (stream_functions.open_stream_p, lambda stream: boolean(not stream.closed)),
    "INTERACTIVE-STREAM-P": (stream_functions.interactive_stream_p, lambda stream: None),
}


def define() -> None:
    """Make the package SB-GRAY, and let users define methods on what Common Lisp asks of streams."""
    names = " ".join(cls.lisp_name.partition("::")[2] for cls in CLASSES)
    define_face("SB-GRAY", imports={"COMMON-LISP": "stream-element-type"}, export=names + " " + " ".join(_functions))
    _openings["CLOSE"] = open_to_methods(stream_functions.close, "CLOSE", "(stream &key abort)", None, method=_close)
    for name, (function, own) in _OPENED.items():
        _openings[name] = open_to_methods(function, name, "(stream)", None, method=_first_method(name, own, function))
