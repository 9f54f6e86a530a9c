"""How pathnames and streams are printed: ``#P"/a/b.lisp"``, ``#<SB-SYS:FD-STREAM for "file /a/b.lisp" {1001}>``."""

from __future__ import annotations

from pathlib import PurePath

from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.conditions import Error, handler_case
from ..pathnames.namestrings import directory_list, namestring
from ..pathnames.pathname_objects import LogicalHost, Pathname, Pattern, UnixHost
from ..files.file_streams import FileStream
from ..streams.streams import ConcatenatedStream, ConsoleInput, FileOutput, Stream, TwoWayStream
from .print_controls import PRINT_ESCAPE, bound
from .print_names import string_text
from .printer import define_printer, escaping, output_object, print_unreadable


def _print_pathname(path, stream):
    text = handler_case([(Error, lambda condition: None)], lambda: namestring(path))  # no handler of the program hears of it
    if text is None:
        _print_parts(path, stream)
    else:
        stream.write("#P" + string_text(text) if escaping() else text)


def _print_parts(path, stream):
    def contents():
        stream.write("(with no namestring)")
        for name in "host device directory name type version".split():
            value = directory_list(path.directory) if name == "directory" else getattr(path, name)
            stream.write(f" :{name.upper()} ")
            output_object(value, stream)

    with bound(PRINT_ESCAPE, True):
        print_unreadable(path, stream, type_=True, body=contents)


def _print_python_path(path, stream):
    stream.write("#P" + string_text(str(path)) if escaping() else str(path))


def _print_pattern(pattern, stream):
    pieces = list_from([Cons(piece[0], piece[1]) if isinstance(piece, tuple) else piece for piece in pattern.pieces])
    print_unreadable(pattern, stream, type_=True, body=lambda: output_object(pieces, stream))


def _print_two_way(both, stream):
    def contents():
        stream.write(":INPUT-STREAM ")
        output_object(both.source, stream)
        stream.write(" :OUTPUT-STREAM ")
        output_object(both.sink, stream)

    print_unreadable(both, stream, type_=True, identity=True, body=contents)


def _print_concatenated(joined, stream):
    def contents():
        stream.write(":STREAMS ")
        output_object(list_from(joined.streams), stream)

    print_unreadable(joined, stream, type_=True, identity=True, body=contents)


def _print_labelled(obj, stream):
    print_unreadable(obj, stream, f"for {string_text(obj.label)}", True, True)


for _class, _printer in (
    (PurePath, _print_python_path),
    (Pathname, _print_pathname),
    (Pattern, _print_pattern),
    (UnixHost, lambda host, stream: print_unreadable(host, stream, type_=True, identity=True)),
    (LogicalHost, lambda host, stream: print_unreadable(host, stream, string_text(host.name), type_=True)),
    (Stream, lambda obj, stream: print_unreadable(obj, stream, type_=True, identity=True)),
    (ConcatenatedStream, _print_concatenated),
    (TwoWayStream, _print_two_way),
    (FileOutput, _print_labelled),
    (FileStream, _print_labelled),
    (ConsoleInput, _print_labelled),
):
    define_printer(_class, _printer)
