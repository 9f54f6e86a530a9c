"""Namestrings: how pathnames are written, ``/a/b.lisp`` and ``ROBOT:PLANS;DRIVE.LISP`` (ANSI 19.1.1, 19.3.1).

Reading follows SBCL: the type is what stands behind the last dot; ``..`` is :up, ``**`` :wild-inferiors, ``~`` at the beginning the
home; ``* ? [..]`` are wild, and a backslash takes its meaning from the character behind it. What is read is written the same.
A *native* namestring is what the operating system calls the file: nothing is wild in it and nothing escaped.

On Windows, as in SBCL for it, a pathname has its drive as the device, ``C:/a/b.lisp``, both slashes stand between folders, and ``^`` is
what ``\\`` is elsewhere. The device of a share is its name, ``//server/share``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Character
from cramhy_runtime.lisp_core.printing import prin1_to_string
import os

from cramhy_runtime.lisp_core.conditions import FileError, ParseError, error
from cramhy_runtime.lisp_core.data import Cons, list_from
from .pathname_objects import (
    ABSOLUTE,
    BACK,
    CHARACTER_SET,
    HOME,
    MULTI_CHAR,
    NEWEST,
    RELATIVE,
    SINGLE_CHAR,
    UNSPECIFIC,
    UP,
    WILD,
    WILD_INFERIORS,
    LogicalPathname,
    Pathname,
    Pattern,
)


class Writing:
    """How the system writes names. drives: whether they begin with a drive. escape: the character that takes the meaning of the next."""

    def __init__(self, drives):
        self.drives, self.escape = drives, "^" if drives else "\\"


WRITING = Writing(drives=os.name == "nt")


def _taken_apart(text):
    """(device, the rest with slashes) of a name."""
    if not WRITING.drives:
        return None, text
    import ntpath

    drive, rest = ntpath.splitdrive(text.replace("\\", "/"))
    return (drive[0].upper() if drive.endswith(":") else drive) or None, rest


def root_text(pathname):
    """The namestring of the root of the drive that ``pathname`` is on."""
    return _drive_text(pathname) + "/"


def _drive_text(pathname):
    device = pathname.device
    return "" if not WRITING.drives or not isinstance(device, str) else f"{device}:" if len(device) == 1 else device


class NamestringParseError(ParseError):
    """Text that is no namestring: ``complaint`` about the character at ``offset``."""

    lisp_name = "SB-KERNEL::NAMESTRING-PARSE-ERROR"

    def __init__(self, complaint, text, offset):
        super().__init__()
        self.complaint, self.text, self.offset = complaint, text, offset

    def report(self):
        return f"parse error in namestring: {self.complaint}\n  {self.text}\n  {' ' * self.offset}^"


class NoNamestringError(FileError):
    """A pathname that cannot be written: the operating system has no such names."""

    lisp_name = "SB-KERNEL::NO-NAMESTRING-ERROR"
    kind = "namestring"

    def __init__(self, pathname=None, why=""):
        super().__init__(pathname)
        self.why = why

    def report(self):
        return f"The pathname\n{prin1_to_string(self.pathname)}\ndoes not have a {self.kind} because\n{self.why}"


class NoNativeNamestringError(NoNamestringError):
    lisp_name = "SB-KERNEL::NO-NATIVE-NAMESTRING-ERROR"
    kind = "native namestring"

    def report(self):
        return f"The pathname {prin1_to_string(self.pathname)}\ndoes not have a native namestring because\n{self.why}"


# -------------------------------------------------------------------------------------------------------------- reading


def component(text, offset=0, whole=None):
    """The component that ``text`` writes: a string, ``:wild`` or a `Pattern`."""
    pieces, plain, index = [], [], 0

    def wild(piece):
        if plain:
            pieces.append("".join(plain))
            plain.clear()
        pieces.append(piece)

    while index < len(text):
        character = text[index]
        if character == WRITING.escape:
            index += 1
            if index == len(text):
                return error(NamestringParseError("backslash with nothing following to quote", whole or text, offset + index - 1))
            plain.append(text[index])
        elif character == "?":
            wild(SINGLE_CHAR)
        elif character == "*":
            wild(MULTI_CHAR)
        elif character == "[":
            end = text.find("]", index)
            if end < 0:
                return error(NamestringParseError("#\\[ with no corresponding #\\]", whole or text, offset + index))
            wild((CHARACTER_SET, text[index + 1 : end]))
            index = end
        else:
            plain.append(character)
        index += 1
    if plain:
        pieces.append("".join(plain))
    if len(pieces) == 1 and pieces[0] is MULTI_CHAR:
        return WILD
    if all(piece.__class__ is str for piece in pieces):
        return "".join(pieces)
    return Pattern(pieces)


def _unescaped_dots(text):
    index = 0
    while index < len(text):
        if text[index] == WRITING.escape:
            index += 1
        elif text[index] == "." and index:
            yield index
        index += 1


def parse_unix(text):
    """The pathname that ``text`` names, without defaults. Errors: `NamestringParseError`."""
    device, text = _taken_apart(text)
    *folders, file = text.split("/")
    absolute = text.startswith("/")
    parts, offset = [], 0
    for index, folder in enumerate(folders):
        if index == 0 and folder.startswith("~") and not absolute:
            absolute = True
            parts.append(HOME if folder == "~" else (HOME, folder[1:]))
        elif folder == "..":
            parts.append(UP)
        elif folder == "**":
            parts.append(WILD_INFERIORS)
        elif folder:
            parts.append(component(folder, offset, text))
        offset += len(folder) + 1
    directory = (ABSOLUTE, *parts) if absolute else (RELATIVE, *parts) if parts else None
    if not file:
        return Pathname(device=device, directory=directory)
    dot = max(_unescaped_dots(file), default=None)
    if "\0" in file:
        return error(NamestringParseError("can't embed #\\Nul or #\\/ in Unix namestrings", text, text.index("\0")))
    name = component(file[:dot], offset, text)
    kind = None if dot is None else component(file[dot + 1 :], offset + dot + 1, text)
    return Pathname(device=device, directory=directory, name=name, type=kind, version=NEWEST)


def parse_native(text):
    """The pathname of a file whose name the operating system gives: nothing in it is wild."""
    device, text = _taken_apart(os.fspath(text))
    *folders, file = text.split("/")
    parts = tuple(UP if folder == ".." else folder for folder in folders if folder)
    directory = (ABSOLUTE, *parts) if folders[:1] == [""] else (RELATIVE, *parts) if parts else None
    dot = file.rfind(".", 1)
    name, kind = (file, None) if dot < 0 else (file[:dot], file[dot + 1 :])
    return Pathname(device=device, directory=directory, name=name or None, type=kind, version=NEWEST if name else None)


def parse_logical(host, text, start=0):
    """The logical pathname on ``host`` that ``text`` names from ``start`` (behind the host's colon) on."""

    def word(piece, at):
        for index, character in enumerate(piece):
            if not (character.isalnum() and character.isascii() or character in "-*"):
                return error(
                    NamestringParseError(
                        "illegal character for logical pathname:\n  " + prin1_to_string(Character(character)), text, at + index
                    )
                )
        return component(piece.upper())

    *folders, file = text[start:].split(";")
    relative = bool(folders) and folders[0] == ""
    parts, offset = [], start + relative
    for folder in folders[relative:]:
        parts.append(WILD_INFERIORS if folder == "**" else UP if folder == ".." else BACK if folder == "<" else word(folder, offset))
        offset += len(folder) + 1
    directory = None if not folders else (RELATIVE if relative else ABSOLUTE, *parts)
    name, *more = file.split(".")
    kind = word(more[0], offset + len(name) + 1) if more else None
    version = _logical_version(more[1], text, len(text) - len(more[1])) if len(more) > 1 else None
    if len(more) > 2:
        return error(NamestringParseError("extra stuff after end of file name", text, len(text) - len(more[-1]) - 1))
    if not folders:
        directory = (ABSOLUTE,)
    return LogicalPathname(host, UNSPECIFIC, directory, word(name, offset) if name else None, kind, version)


def _logical_version(text, whole, offset):
    if text == "*":
        return WILD
    if text.upper() == "NEWEST":
        return NEWEST
    if text.isdecimal():
        return int(text)
    return error(NamestringParseError(f"expected a positive integer, got {prin1_to_string(text.upper())}", whole, offset))


# -------------------------------------------------------------------------------------------------------------- writing


def written(part, escape_dots=False):
    """The text of the component ``part``."""
    if part is WILD:
        return "*"
    if isinstance(part, Pattern):
        return "".join(
            _escaped(piece)
            if piece.__class__ is str
            else f"[{piece[1]}]"
            if isinstance(piece, tuple)
            else "*"
            if piece is MULTI_CHAR
            else "?"
            for piece in part.pieces
        )
    if not isinstance(part, str):
        return str(part)
    text = _escaped(part)
    return text[:1] + text[1:].replace(".", WRITING.escape + ".") if escape_dots else text


def _escaped(text):
    return "".join(WRITING.escape + character if character in WRITING.escape + "*?[" else character for character in text)


def _lose(pathname, why, native):
    why += "." if native else "\nSee also:\n  The ANSI Standard, Section 19.1.2"
    return error((NoNativeNamestringError if native else NoNamestringError)(pathname, why))


def directory_text(pathname, native=False):
    """The folder's part of the namestring, with its slash."""
    if not pathname.directory:
        return _drive_text(pathname)
    start, *parts = pathname.directory
    text, rest = ("/", parts) if start is ABSOLUTE else ("", parts)
    pieces = []
    for index, part in enumerate(rest):
        if part is HOME or isinstance(part, tuple):
            if index or start is not ABSOLUTE:
                return _lose(pathname, ":HOME that is not the first component of an absolute directory", native)
            user = "~" if part is HOME else f"~{part[1]}"
            text = ""
            pieces.append(os.path.expanduser(user).rstrip("/") if native else user)
        elif part is UP:
            pieces.append("..")
        elif part is BACK and not native:
            return error(":BACK cannot be represented in namestrings.")
        elif part is BACK:
            pieces.append("..")
        elif part == "":
            continue
        elif native and not isinstance(part, str):
            return _lose(pathname, f"of the :DIRECTORY component {prin1_to_string(part)}", native)
        else:
            pieces.append("**" if part is WILD_INFERIORS else part if native else written(part))
    return _drive_text(pathname) * (not _begins_at_home(pathname)) + text + "".join(piece + "/" for piece in pieces)


def _begins_at_home(pathname):
    """Whether the directory begins with a user's home, which has a drive of its own."""
    first = pathname.directory[1:2]
    return bool(first) and (first[0] is HOME or isinstance(first[0], tuple))


def _present(part):
    return part is not None and part is not UNSPECIFIC


def file_text(pathname, native=False):
    """Name and type of the namestring."""
    name, kind = pathname.name, pathname.type
    if isinstance(pathname, LogicalPathname):
        return _logical_file(pathname)
    if not _present(name):
        return _lose(pathname, "there is a :TYPE component but no :NAME component", native) if _present(kind) else ""
    if name == "":
        return _lose(
            pathname,
            "the :NAME component is of length 0"
            if not _present(kind)
            else "the :NAME component is of length 0 and there is a :TYPE component",
            native,
        )
    for label, part in (("NAME", name), ("TYPE", kind)):
        if native and part is not None and part is not UNSPECIFIC and not isinstance(part, str):
            return _lose(pathname, f"of the :{label} component {prin1_to_string(part)}", native)
    if native:
        return name if not _present(kind) else f"{name}.{kind}"
    if not _present(kind):
        return written(name, escape_dots=name not in (".",))
    if name == "." and kind == "":
        return ".."
    return f"{written(name)}.{written(kind, escape_dots=True)}"


def namestring(pathname):
    """The text of ``pathname``. Errors: `NoNamestringError`."""
    if isinstance(pathname, LogicalPathname):
        return f"{pathname.host.name}:{logical_directory(pathname)}{_logical_file(pathname)}"
    return directory_text(pathname) + file_text(pathname)


def native_namestring(pathname):
    """What the operating system calls the file. Errors: `NoNativeNamestringError` for what is wild."""
    return directory_text(pathname, True) + file_text(pathname, True)


def logical_directory(pathname):
    """The directory of a logical pathname as it is written: ``PLANS;TURTLE;``."""
    if not pathname.directory:
        return ""
    start, *parts = pathname.directory
    names = {WILD_INFERIORS: "**", UP: "..", BACK: "<"}
    return (";" if start is RELATIVE else "") + "".join((names.get(part) or written(part)) + ";" for part in parts)


def _logical_file(pathname):
    text = written(pathname.name) if _present(pathname.name) else ""
    if _present(pathname.type):
        text += "." + written(pathname.type)
    if _present(pathname.version):
        text += "." + ("*" if pathname.version is WILD else "NEWEST" if pathname.version is NEWEST else str(pathname.version))
    return text


def directory_list(directory):
    """The directory component as Lisp sees it: a list."""
    return None if directory is None else list_from([Cons(HOME, Cons(part[1])) if isinstance(part, tuple) else part for part in directory])
