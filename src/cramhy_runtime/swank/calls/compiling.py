"""Calls that compile: a file, or a form of a buffer. What the compiler says comes back as notes with their places."""

from __future__ import annotations

import functools
import os
import tempfile
import time
from contextlib import contextmanager

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import CompileError, StyleWarning
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.compiler import compilation_unit
from cramhy_runtime.languages.commonlisp.compiler.frame_exits import DEBUGGED
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.systems import program_files
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for, report_text

from .. import indentation, places
from ..rpcs import Refused, rpc, text
from ..wire import Name
from .evaluating import aborting


UNREADABLE = (conditions.types.ReaderError, conditions.types.EndOfFile)


class Notes(list):
    """What the compiler has said, as Emacs wants it. where: a function from a position to a location."""

    def __init__(self, where):
        super().__init__()
        self.where = where
        self.failed = False

    def warn(self, told):
        for condition in told:
            self.add(condition, ":style-warning" if isinstance(condition, StyleWarning) else ":warning")

    def fail(self, condition):
        self.failed = True
        self.add(condition, ":read-error" if isinstance(condition, UNREADABLE) else ":error")

    def add(self, condition, severity):
        message = report_text(condition)
        hint = hint_for(condition)
        position = getattr(condition, "position", None)
        self.append(
            [
                Name(":message"), f"{message}\n{hint}" if hint else message,
                Name(":severity"), Name(severity),
                Name(":location"), self.where(position) if position else places.error("The place of this is not known."),
                Name(":references"), None,
            ]
        )  # fmt: skip

    def result(self, began, loads=None, file=None):
        return [Name(":compilation-result"), list(self), not self.failed, round(time_now() - began, 6), loads, file]


def time_now():
    """Seconds of the wall's clock, to tell how long the compiler took."""
    return time.perf_counter()


def debugged(policy):
    """Whether ``policy``, such as ``((cl:debug . 3))``, wants functions whose calls the debugger can leave."""
    for entry in policy if isinstance(policy, list) else ():
        if isinstance(entry, list) and len(entry) > 1 and str(entry[0]).rpartition(":")[2].lower() == "debug":
            return isinstance(entry[-1], int) and entry[-1] >= 2
    return False


@contextmanager
def noted(notes):
    """While the block runs, what the compiler says goes to ``notes``."""
    reporter = compilation_unit.report_to(notes.warn)
    errors = compilation_unit.report_errors_to(notes.fail)
    try:
        yield
    finally:
        compilation_unit.report_to(reporter)
        compilation_unit.report_errors_to(errors)


@rpc("compile-file-for-emacs", evaluates=True)
def compile_file_for_emacs(call, path, loads=None, *, policy=None):
    path = os.path.abspath(os.path.expanduser(text(path)))
    if not os.path.isfile(path):
        raise Refused(f"There is no file {path}.")
    notes, began, file = Notes(places.location_of), time_now(), None
    with noted(notes), binding(evaluator.PACKAGE, call.package, DEBUGGED, debugged(policy)):
        if path.endswith(".hy"):
            _caught(notes, lambda: aborting(call, lambda: call.session.load(path)))
        else:
            folder = tempfile.mkdtemp(prefix="cramhy-swank-")
            target = os.path.join(folder, os.path.splitext(os.path.basename(path))[0] + ".fasl")
            compile_ = functools.partial(program_files.compile_file, path, output_file=target)
            aborting(call, lambda: conditions.handler_bind([(conditions.types.Error, _raise)], compile_))
            file = target if os.path.exists(target) else None
            call.connection.keep_until_end(folder)
    return notes.result(began, bool(loads) and file is not None, file)


@rpc("compile-string-for-emacs", evaluates=True)
def compile_string_for_emacs(call, source, buffer, position, filename=None, policy=None):
    """Compile and run the forms of a piece of ``buffer``. Errors of the compiler are notes, errors of the forms open the debugger."""
    source, buffer = text(source), text(buffer)
    at = {str(entry[0]): entry[1:] for entry in position or () if isinstance(entry, list) and entry}
    start, (line, column) = (at.get(":position") or [1])[0], (*(at.get(":line") or [1]), 1)[:2]
    path = os.path.abspath(filename) if isinstance(filename, str) else None
    padding = "\n" * (line - 1) + " " * max(0, column - 1)
    name = path or f"<repl {buffer}>"
    whole = padding + source

    def where(place):
        if place[0] != name:
            return places.location_of(place)
        lines = whole.splitlines(True)
        offset = sum(map(len, lines[: (place[1] or 1) - 1])) + max(0, (place[2] or 1) - 1) - len(padding)
        return [Name(":location"), [Name(":buffer"), buffer], [Name(":offset"), start, max(0, offset)], None]

    notes, began = Notes(where), time_now()
    reader = call.session.reader(whole, name) if path is None else call.session.reader_in_file(whole, path, 1, 1)

    def run():
        for form in call.session.forms(reader):
            _caught(notes, lambda form=form: call.session.evaluate(form, reader, top=call.debugger is None))

    with noted(notes), binding(evaluator.PACKAGE, call.package, DEBUGGED, debugged(policy)):
        _caught(notes, lambda: aborting(call, run))
    indentation.tell(call.connection)
    return notes.result(began)


def _raise(condition):
    """Let an error go up to ``compile-file``, which notes it and goes on with the next form, past the debugger."""
    raise condition


def _caught(notes, thunk):
    """Call ``thunk``. What the compiler or the reader cannot take becomes a note, and the rest of it is left out."""
    kinds = (CompileError, *UNREADABLE)
    conditions.handler_case([(kind, notes.fail) for kind in kinds], thunk)


@rpc("compile-multiple-strings-for-emacs", evaluates=True)
def compile_multiple_strings(call, sources, policy=None):
    results = []
    for source in sources or ():
        string, buffer, package, position, filename = (*source, None, None, None, None)[:5]
        call.package_name = package or call.package_name
        results.append(compile_string_for_emacs(call, string, buffer, [[Name(":position"), position or 1]], filename, policy))
    return results


@rpc("compile-file-if-needed", evaluates=True)
def compile_file_if_needed(call, path, loads=None):
    return compile_file_for_emacs(call, path, loads)


@rpc("swank-compiler-notes-for-emacs compiler-notes-for-emacs")
def no_notes(call):
    return None
