"""Streams: the classes of text that is read and written, and strings as streams.

An `OutputStream` knows the column it is in: ``fresh-line`` needs it, and so does the pretty printer. Input streams deliver Python
strings of one character, and ``""`` at the end. Streams made of other streams, the console and the standard variables are in
``streams.py``, files in ``files/file_streams.py``, the functions that Lisp programs call in ``stream_functions.py``. Source: ANSI
chapter 21.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import ClosedStreamError
from cramhy_runtime.lisp_core.condition_types import SimpleTypeError
from cramhy_runtime.lisp_core.conditions import error
from cramhy_runtime.lisp_core.packages import ensure_package, sym
from cramhy_runtime.lisp_core.printing import MAKING

_EXTERNAL = {"SB-SYS": "FD-STREAM", "SB-IMPL": "", "SB-PRETTY": "PPRINT-DISPATCH-TABLE", "SB-FORMAT": "FORMAT-ERROR"}
for _package, _external in _EXTERNAL.items():
    _home = ensure_package(_package)  # SBCL's names of classes, which users see in error messages
    for _name in _external.split():
        _home.export(_home.intern(_name))


class Stream:
    """A source or a sink of characters, or of bytes where `file_streams` says so."""

    lisp_name = "STREAM"
    is_input = False
    is_output = False
    is_pretty = False
    is_interactive = False
    closed = False
    pathname = None
    reserved_attributes = frozenset("source sink label given symbol file target streams read_byte write_byte".split())
    """What the runtime asks some streams for, beside the methods here: no slot of a user's class is kept under one of these names."""

    def close(self, abort=False):
        self.closed = True

    def element_type(self):
        """The type specifier of what is read or written."""
        return sym("CHARACTER")

    def external_format(self):
        """How characters become bytes; ``None`` where they don't."""
        return None

    def position(self):
        """How far reading or writing has come, ``None`` when that means nothing."""
        return None

    def set_position(self, position):
        """Go on from there; whether that was possible. ``position`` is a number or ``None`` for the end."""
        return False


def misused(stream, what):
    """The type-error that ``stream`` is no stream of the kind ``what``, such as ``"character input"``."""
    element, direction = what.split()
    is_other = not (stream.is_input if direction == "input" else stream.is_output)
    predicate = f"{direction.upper()}-STREAM-P" if is_other else f"SB-IMPL::{element.upper()}-{direction.upper()}-STREAM-P"
    return error(SimpleTypeError("~S is not a ~A stream.", stream, what, datum=stream, expected_type=f"(SATISFIES {predicate})"))


class OutputStream(Stream):
    """A sink of text. Subclasses define ``emit(text)``; ``column`` is where the next character goes.

    ``line_length`` is the width of a line in characters, ``None`` when the stream has no opinion. ``filled_to``: the width to which
    warnings are filled; ``None``: they look as SBCL prints them.
    """

    is_output = True
    of_user = False
    """Whether the stream is of a class of a user's, who may want to know what was written how."""
    column = 0
    line_length = filled_to = None

    def write(self, text):
        if not text:
            return
        self.emit(text)
        newline = text.rfind("\n")
        if newline < 0:
            self.column += len(text)
        else:
            self.column = len(text) - newline - 1

    def emit(self, text):
        raise NotImplementedError

    def close(self, abort=False):
        super().close(abort)
        self.emit = lambda text: complain_closed(self)

    def fresh_line(self):
        """Start a new line unless at the beginning of one; ``True`` when a newline was written."""
        if self.column:
            self.write("\n")
            return True
        return False

    def flush(self):
        """Deliver what was written."""

    def force(self):
        """Begin to deliver what was written."""
        self.flush()


def complain_closed(stream):
    """The error that a stream was used after its end. SBCL's text."""
    return error(ClosedStreamError(stream))


class StringStream(Stream):
    """What ``string-stream`` means: text comes from a string or becomes one."""

    lisp_name = "STRING-STREAM"


class StringOutputStream(OutputStream, StringStream):
    """Collects what is written; `take` gives it and starts anew. With ``target``, a string with a fill pointer, it
    goes there.
    """

    lisp_name = "SB-IMPL::STRING-OUTPUT-STREAM"
    behind = ""
    kind = False  # the element type of its strings, if the program gave one

    def __init__(self, target=None):
        self.parts = []
        self.target = target
        self._column = self._counted = 0  # the column behind so many of the parts
        if target is None:
            making = MAKING.value
            self.write = self.parts.append if making is None else making.appender(self.parts)  # nothing else is to be done for most streams
        else:
            text = str(target)
            self.column = len(text) - text.rfind("\n") - 1

    @property
    def column(self):
        """Where the next character goes. It is found out when somebody asks: hardly anybody does."""
        for part in self.parts[self._counted :]:
            newline = part.rfind("\n")
            self._column = self._column + len(part) if newline < 0 else len(part) - newline - 1
        self._counted = len(self.parts)
        return self._column

    @column.setter
    def column(self, column):
        self._column, self._counted = column, len(self.parts)

    def close(self, abort=False):
        super().close(abort)
        self.__dict__.pop("write", None)

    def emit(self, text):
        if self.target is None:
            self.parts.append(text)
            self._counted += 1  # `write` counts the column
            if self.behind:
                self.behind = self.behind[len(text) :]
            return
        target = self.target
        if target.fill_pointer is None:
            target.chars += text
        else:
            end = target.fill_pointer + len(text)
            if end > len(target.chars) and target.chars.__class__ is not list:
                target.chars = list(target.chars)  # it is not displaced any longer
            target.chars[target.fill_pointer : end] = text
            target.fill_pointer = end

    def text(self):
        """What was written since the last `take`."""
        return "".join(self.parts) + self.behind

    def take(self):
        text = self.text()
        self.parts.clear()
        self.behind = ""
        self.column = 0
        return text

    def position(self):
        return sum(map(len, self.parts)) if self.target is None else len(str(self.target))

    def set_position(self, position):
        if self.target is not None:
            return False
        text = self.text()
        position = len(text) if position is None else position
        text = text.ljust(position, "\0")
        self.column, column = 0, self.column
        self.parts[:], self.behind = [text[:position]], text[position:]
        self.column = column
        if not self.closed:
            self.write = super().write  # what was written behind here is overwritten
        return True


class FdStream(Stream):
    """What SBCL's FD-STREAM means: text or bytes of the world outside. It gives its name to several classes."""

    lisp_name = "SB-SYS::FD-STREAM"


class FileOutput(OutputStream, FdStream):
    """Writes to a Python text file (anything with ``write``)."""

    def __init__(self, file, label=None):
        self._file = file
        self.label = label or f"file {getattr(file, 'name', '')}"

    @property
    def file(self):
        return self._file

    def emit(self, text):
        if self.closed:
            complain_closed(self)
        file = self.file
        if file is not None:
            file.write(text)

    def flush(self):
        file = self.file
        if file is not None and hasattr(file, "flush"):
            file.flush()

    def close(self, abort=False):
        super().close()
        self.file.close()

    def external_format(self):
        return sym(":UTF-8")


class InputStream(Stream):
    """A source of characters. Subclasses define ``more()``: the next piece of text, ``""`` at the end."""

    is_input = True
    gives_single_characters = False  # what `more` gives

    def __init__(self, text=""):
        self._text = text
        self._position = 0

    def more(self):
        return ""

    def close(self, abort=False):
        super().close(abort)
        self.clear()

    def _available(self):
        if self._position < len(self._text):
            return True
        if self.closed:
            return complain_closed(self)
        piece = self.more()
        if not piece:
            return False
        self._text, self._position = self._text[-1:] + piece, len(self._text[-1:])
        return True

    def read_char(self):
        """The next character, ``""`` at the end."""
        if not self._available():
            return ""
        character = self._text[self._position]
        self._position += 1
        return character

    def peek_char(self):
        """The next character, which stays; ``""`` at the end."""
        return self._text[self._position] if self._available() else ""

    def unread_char(self, character):
        """Put back the character that was read last."""
        if self._position:
            self._position -= 1
        else:
            self._text = character + self._text

    def read_line(self):
        """(line without its newline, whether the text ended before a newline); ``("", True)`` at the end."""
        parts = []
        while self._available():
            end = self._text.find("\n", self._position)
            if end >= 0:
                parts.append(self._text[self._position : end])
                self._position = end + 1
                return "".join(parts), False
            parts.append(self._text[self._position :])
            self._position = len(self._text)
        return "".join(parts), True

    def put_back(self, text, position):
        """A reader that took what had arrived and asked for `more`, which is ``text`` now, has read up to ``position``."""
        self._text, self._position = text, position

    def listen(self):
        """Whether a character can be read without waiting."""
        return self._position < len(self._text)

    def clear(self):
        """Forget what has arrived and was not read."""
        self._position = len(self._text)


class StringInputStream(InputStream, StringStream):
    """Reads ``text``; `position` is the index of the next character."""

    lisp_name = "SB-IMPL::STRING-INPUT-STREAM"

    def __init__(self, text, start=0):
        super().__init__(text)
        self._position = start

    def position(self):
        return self._position

    def set_position(self, position):
        self._position = len(self._text) if position is None else min(position, len(self._text))
        return True
