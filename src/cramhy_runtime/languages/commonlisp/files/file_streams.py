"""Files as streams: ``open``, ``with-open-file``, and positions in files (ANSI 21.1.3).

A file is read and written as bytes; characters are made of them here, so that ``file-position`` counts bytes as in SBCL, and a
byte that means no character is an error at its place, not at the beginning of the file. A file that replaces another (``:supersede``,
``:rename``, ``:rename-and-delete``) is written beside it and takes its name when the stream is closed (`storage`); until then, and if
writing is aborted or fails, the old one stays. A file of a new name has it at once, and goes if writing it is aborted or if closing it
fails.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.printing import prin1_to_string
import contextlib
import os

from cramhy_runtime import kernel

from cramhy_runtime import storage
from cramhy_runtime.lisp_core.conditions import FileError, SimpleFileError, StreamError, error, restart_case, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, Symbol, lisp_list
from .files import FileDoesNotExist, FileExists, absolute, is_regular, physical, reason
from ..pathnames.namestrings import native_namestring
from ..pathnames.pathname_objects import LogicalPathname
from ..pathnames.pathnames import merge_pathnames, pathname
from cramhy_runtime.lisp_core.packages import is_symbol, sym
from ..types.type_relations import subtypep
from ..types.types import expand_type
from ..streams.basic_streams import FdStream, InputStream, OutputStream, complain_closed, misused
from ..streams.external_formats import ATTEMPT_RESYNC, FORCE_END_OF_FILE, INPUT_REPLACEMENT, StreamDecodingError, external_format

CHARACTER = sym("CHARACTER")
CHUNK = 8192
"""About how many bytes of text are fetched at a time."""


class FileStreamClass(OutputStream, InputStream):
    """What ``file-stream`` means: text or bytes of a file."""

    lisp_name = "FILE-STREAM"


class SimpleStreamError(StreamError, FileError):
    """The system could not read or write: ``problem`` is Python's exception. A file-error, too; its pathname is what `open` was given."""

    lisp_name = "SB-INT::SIMPLE-STREAM-ERROR"

    def __init__(self, stream=None, doing="read from", problem=None):
        super().__init__(stream)
        self.doing, self.problem = doing, problem
        self.pathname = getattr(stream, "given", None)

    def report(self):
        why = reason(self.problem) if self.doing == "read from" or not isinstance(self.problem, OSError) else storage.why(self.problem)
        return f"couldn't {self.doing} {prin1_to_string(self.stream)}:\n  {why}"


class FileStream(FdStream, FileStreamClass):
    """A file that was opened. ``size`` is the number of bytes of an element, 1 for characters."""

    def __init__(self, file, pathname, label, reads, writes, kind=CHARACTER, size=1, signed=False, format_=None):
        InputStream.__init__(self)
        self.file, self.pathname, self.label = file, pathname, label
        self.is_input, self.is_output = reads, writes
        self.kind, self.size, self.signed = kind, size, signed
        self.characters, self.bytes = kind is CHARACTER or kind is None, kind is not CHARACTER
        self.format = format_ or external_format(None)
        self.waits = False
        self.given = pathname
        self.part = self.backup = None
        self.replaces = False

    # ------------------------------------------------------------------------------------------------------- characters

    def _system(self, function, doing="read from"):
        try:
            return kernel.run_blocking(function) if self.waits else function()
        except (OSError, ValueError) as problem:
            return self._failed(doing, problem)

    def _failed(self, doing, problem):
        return complain_closed(self) if self.closed else error(SimpleStreamError(self, doing, problem))

    def more(self):
        if self.closed:
            return complain_closed(self)
        if not (self.is_input and self.characters):
            return misused(self, "character input")
        # of a file several lines at a time, of what may keep us waiting no more than there is
        octets = self._system(self.file.readline if self.waits else lambda: b"".join(self.file.readlines(CHUNK)))
        if self.format.codec.startswith(("utf-16", "utf-32")):
            octets += self._system(self.file.read)  # the byte of a newline may be half of another character
        try:
            return octets.decode(self.format.codec)
        except UnicodeDecodeError as problem:
            return self._undecodable(octets, problem.start, problem.end, 0 if self.waits else self.file.tell() - len(octets))

    def _undecodable(self, octets, bad, after, start):
        if bad:  # first what stands before it
            self.file.seek(start + bad)
            return octets[:bad].decode(self.format.codec)
        if self.format.replacement is not None:
            self.file.seek(start + after)
            return self.format.replacement
        length = 1
        if self.format.codec == "utf-8":  # as long as the first byte says
            length = next((size for size, low in ((4, 0xF0), (3, 0xE0), (2, 0xC0)) if octets[0] >= low), 1)

        def resynchronize():
            self.file.seek(start + after)
            return self.more()

        def replace(text="\N{REPLACEMENT CHARACTER}"):
            self.file.seek(start + after)
            return str(getattr(text, "char", text))

        self.file.seek(start)
        return restart_case(
            [
                (ATTEMPT_RESYNC, resynchronize, "Attempt to resync the stream at a character boundary and continue."),
                (FORCE_END_OF_FILE, lambda: "", "Force an end of file."),
                (INPUT_REPLACEMENT, replace, "Use string as replacement input, attempt to resync at a character boundary and continue."),
            ],
            lambda: error(StreamDecodingError(self, octets[:length])),
        )

    def listen(self):
        return self._position < len(self._text) or not self.waits and self._available()

    def emit(self, text):
        if not (self.is_output and self.characters):
            return complain_closed(self) if self.closed else misused(self, "character output")
        if self._text:
            self._forget_fetched()
        octets = self.format.encode(text, self)
        return self._put(octets)

    def flush(self):
        if self.is_output and not self.closed:
            self._system(self.file.flush, "write to")

    # ------------------------------------------------------------------------------------------------------------ bytes

    def read_byte(self):
        """The next element of a binary file, ``None`` at the end."""
        if self.closed:
            return complain_closed(self)
        if not (self.is_input and self.bytes):
            return misused(self, "binary input")
        if self._text:
            self._forget_fetched()
        try:
            octets = kernel.run_blocking(lambda: self.file.read(self.size)) if self.waits else self.file.read(self.size)
        except (OSError, ValueError) as problem:
            return self._failed("read from", problem)
        return int.from_bytes(octets, "little", signed=self.signed) if len(octets) == self.size else None

    def write_byte(self, number):
        if self.closed:
            return complain_closed(self)
        if not (self.is_output and self.bytes):
            return misused(self, "binary output")
        if number.__class__ is not int:  # T, which is a number for Python
            return type_error(number, self.element_type())
        try:
            octets = number.to_bytes(self.size, "little", signed=self.signed)
        except OverflowError:
            return type_error(number, self.element_type())
        return self._put(octets)

    def write_bytes(self, numbers):
        """Write ``numbers``, a list, at once. Returns whether that was possible: each must be an element of the file, of one byte."""
        if self.closed or not (self.is_output and self.bytes and self.size == 1) or self.signed or bool in map(type, numbers):
            return False
        try:
            octets = bytes(numbers)
        except (TypeError, ValueError):
            return False
        self._put(octets)
        return True

    def read_bytes(self, count):
        """The next elements of a binary file, at most ``count``, as a list; ``None`` where they must be read one by one."""
        if self.closed or not (self.is_input and self.bytes and self.size == 1) or self.signed or self.waits:
            return None
        if self._text:
            self._forget_fetched()
        return list(self._system(lambda: self.file.read(count)))

    def _put(self, octets):
        if self.waits:
            return self._system(lambda: self.file.write(octets), "write to")
        try:
            return self.file.write(octets)
        except (OSError, ValueError) as problem:
            return self._failed("write to", problem)

    # --------------------------------------------------------------------------------------------------------- position

    def _forget_fetched(self):
        # text that was fetched and not read: the file goes on behind what was read
        if self._position < len(self._text):
            self.file.seek(self._bytes_read())
        self._text, self._position = "", 0

    def _bytes_read(self):
        return self.file.tell() - self.format.width(self._text[self._position :])

    def position(self):
        if self.closed:
            return complain_closed(self)
        if self._position < len(self._text):
            return self._bytes_read() // self.size
        return self._system(self.file.tell) // self.size if self.file.seekable() else None

    def set_position(self, position):
        if self.closed:
            return complain_closed(self)
        self._text, self._position = "", 0
        if not self.file.seekable():
            return False
        self._system(lambda: self.file.seek(*((0, os.SEEK_END) if position is None else (position * self.size,))))
        return True

    def length(self):
        """The number of elements of the file."""
        if self.closed:
            return complain_closed(self)
        self.flush()
        return os.fstat(self.file.fileno()).st_size // self.size

    def element_type(self):
        if self.characters:
            return CHARACTER
        return self.kind

    def external_format(self):
        return self.format.designator()

    # ---------------------------------------------------------------------------------------------------------- closing

    def close(self, abort=False):
        """Close the file. With ``abort`` a file that was made is gone again, and one that was to be replaced stays as it is."""
        if self.closed:
            return
        try:
            if self.part is not None:
                self.part.discard() if abort else self._system(lambda: self.part.finish(self.replaces, self.backup), "close")
            elif self.file is not None and not abort:
                self._system(self.file.close, "close")
        finally:
            self.closed = True
            self._text, self._position = "", 0
            with contextlib.suppress(OSError):  # what could not be written is known, or not wanted any more
                if self.file is not None:
                    self.file.close()


# -------------------------------------------------------------------------------------------------------------- opening


_DIRECTIONS = "INPUT OUTPUT IO PROBE"
_IF_EXISTS = "ERROR NEW-VERSION RENAME RENAME-AND-DELETE OVERWRITE APPEND SUPERSEDE NIL"
_IF_MISSING = "ERROR CREATE NIL"


def _choice(value, default, choices):
    if value is UNSUPPLIED:
        return default
    if value is None and "NIL" in choices.split():
        return None
    if not isinstance(value, Symbol) or value.name not in choices.split():
        words = " ".join(word if word == "NIL" else ":" + word for word in choices.split())
        return type_error(value, f"(MEMBER {words})")
    return value.name


def element_of(specifier):
    """(element type, its size in bytes, whether it is signed); the type is ``None`` for both characters and bytes."""
    if specifier is UNSUPPLIED or is_symbol(specifier) and subtypep(specifier, CHARACTER)[0] and specifier is not None:
        return CHARACTER, 1, False
    if specifier is sym(":DEFAULT"):
        return None, 1, False
    expanded = expand_type(specifier)
    name = expanded.car if isinstance(expanded, Cons) else expanded
    argument = expanded.cdr.car if isinstance(expanded, Cons) and isinstance(expanded.cdr, Cons) else sym("*")
    if name is sym("BIT"):
        name, argument = sym("UNSIGNED-BYTE"), 1
    if name is sym("UNSIGNED-BYTE") or name is sym("SIGNED-BYTE"):
        bits = argument if argument.__class__ is int else 8
        if bits <= 0:
            return error("could not find any input routine for ~S", specifier)
        size = next((size for size in (1, 2, 4, 8) if bits <= size * 8), (bits + 7) // 8)
        return lisp_list(name, size * 8), size, name is sym("SIGNED-BYTE")
    for sign in ("UNSIGNED-BYTE", "SIGNED-BYTE"):  # (integer 0 255), (mod 256)
        for size in (1, 2, 4, 8):
            bytes_ = lisp_list(sym(sign), size * 8)
            if isinstance(expanded, (Cons, Symbol)) and subtypep(expanded, bytes_)[0]:
                return bytes_, size, sign == "SIGNED-BYTE"
    return error("could not find any input routine for ~S", specifier)


def _python_mode(reads, writes, exists, if_exists):
    if not writes:
        return "rb"
    if exists and if_exists == "OVERWRITE":
        return "r+b"
    if exists and if_exists == "APPEND":
        return "r+b" if reads else "ab"
    return "w+b" if reads else "wb"  # a terminal, a pipe or a device


def open_(
    filespec, *, direction=UNSUPPLIED, element_type=UNSUPPLIED, if_exists=UNSUPPLIED, if_does_not_exist=UNSUPPLIED, external_format=None
):
    """``open``: a stream on a file; nil where the arguments say so.

    direction: :input (default), :output, :io or :probe. if_exists: :error (default), :supersede, :append, :overwrite, :rename,
    :rename-and-delete, :new-version, nil. if_does_not_exist: :error, :create, nil. element_type: CHARACTER (default), a type of
    bytes, or :default for both. Errors: `FileDoesNotExist`, `FileExists`, `SimpleFileError`.
    """
    direction = _choice(direction, "INPUT", _DIRECTIONS)
    reads, writes = direction in ("INPUT", "IO"), direction in ("OUTPUT", "IO")
    if_exists = _choice(if_exists, "ERROR", _IF_EXISTS)
    usual = None if direction == "PROBE" else "CREATE" if writes and if_exists not in ("APPEND", "OVERWRITE") else "ERROR"
    missing = _choice(if_does_not_exist, usual, _IF_MISSING)
    kind, size, signed = element_of(element_type)
    format_ = _format(external_format) if kind is CHARACTER or kind is None else _format(sym(":LATIN-1"))
    return _open(filespec, direction, reads, writes, if_exists, missing, kind, size, signed, format_)


def open_whole(filespec, if_exists=UNSUPPLIED):
    """A stream of characters to a file that gets its name when the stream is closed, also if no file has it yet; else as `open_`."""
    if_exists = _choice(if_exists, "ERROR", _IF_EXISTS)
    missing = "ERROR" if if_exists in ("APPEND", "OVERWRITE") else "CREATE"
    return _open(filespec, "OUTPUT", False, True, if_exists, missing, CHARACTER, 1, False, _format(None), beside=True)


def _open(filespec, direction, reads, writes, if_exists, missing, kind, size, signed, format_, beside=False):
    name = native_namestring(absolute(physical(filespec)))
    logical = merge_pathnames(filespec)
    path = logical if isinstance(logical, LogicalPathname) else absolute(logical)
    exists = os.path.lexists(name)
    if not exists:
        if missing is None:
            return None
        if missing == "ERROR":
            return error(FileDoesNotExist(path, "The file ~S does not exist: No such file or directory", path))
    elif writes and if_exists in (None, "ERROR"):
        return None if if_exists is None else error(FileExists(path, "The file ~S already exists: File exists", path))
    elif writes and if_exists == "NEW-VERSION":
        return error(SimpleFileError(path, "OPEN :IF-EXISTS :NEW-VERSION is not supported when a new version must be created."))
    if direction == "PROBE":
        if not exists:
            _part(path, name).finish(durable=False)
        stream = FileStream(None, path, name, False, False, kind, size, signed, format_)
        stream.close()
        return stream
    if not exists and not writes:
        _part(path, name).finish(durable=False)
    part = None
    if writes and (not exists or if_exists in ("SUPERSEDE", "RENAME", "RENAME-AND-DELETE") and is_regular(name)):
        part = _part(path, name, beside)
    file = part.file if part is not None else _opened(path, name, _python_mode(reads, writes, exists, if_exists))
    stream = FileStream(file, path, f"file {name}", reads, writes, kind, size, signed, format_)
    stream.given, stream.part, stream.replaces = pathname(filespec), part, exists or beside
    stream.waits = not is_regular(name)
    if exists and if_exists == "RENAME":
        stream.backup = os.path.realpath(name) + ".bak"
    if writes and reads and if_exists == "APPEND":
        file.seek(0, os.SEEK_END)
    return stream


_format = external_format


def _part(path, name, beside=False):
    """A `storage.Part` for the file: at its place if there is none, unless ``beside``; else beside the one that there is."""

    def opened():
        storage.tidy_once(os.path.dirname(os.path.realpath(name)))
        return storage.Part(name, claim=not beside)

    return _checked(path, opened, storage.why)


def _opened(path, name, mode):
    return _checked(path, lambda: kernel.run_blocking(lambda: open(name, mode)) if not is_regular(name) else open(name, mode))


def _checked(path, opened, told=reason):
    """The value of ``opened()``; what goes wrong in it is a file-error. told: makes a text of an `OSError`."""
    try:
        return opened()
    except FileNotFoundError:
        return error(SimpleFileError(path, "The path ~S does not exist.", path))
    except OSError as problem:
        return error(SimpleFileError(path, "Error opening ~S: ~A", path, told(problem)))
    except ValueError as problem:
        return error(SimpleFileError(path, "Error opening ~S: ~A", path, str(problem)))


def with_open_file(
    function,
    filespec,
    *,
    direction=UNSUPPLIED,
    element_type=UNSUPPLIED,
    if_exists=UNSUPPLIED,
    if_does_not_exist=UNSUPPLIED,
    external_format=None,
):
    """What ``with-open-file`` becomes: the values of ``function(stream)``; the file is always closed, and a new one is gone again
    if the function was left by an error or another jump. Arguments: those of `open_`.
    """
    return with_open_stream(
        function,
        open_(
            filespec,
            direction=direction,
            element_type=element_type,
            if_exists=if_exists,
            if_does_not_exist=if_does_not_exist,
            external_format=external_format,
        ),
    )


def with_open_stream(function, stream):
    """What ``with-open-stream`` becomes: the values of ``function(stream)``; the stream is closed, and aborted if a jump left it."""
    done = False
    try:
        result = function(stream)
        done = True
        return result
    finally:
        if stream is not None:
            stream.close(abort=not done)


LISP_NAMES = "open"
