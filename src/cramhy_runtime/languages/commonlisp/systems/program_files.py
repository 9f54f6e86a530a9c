"""Files of programs: ``load``, ``compile-file`` and what they write (ANSI 24.2, 3.2.3).

``compile-file`` writes a file of code, of type ``fasl`` as in SBCL, which ``load`` runs without looking at the source again.
Macros, types, constants and packages of the file take effect while it is compiled; its functions and variables when it is loaded.
One needs it seldom: ``load`` keeps what it compiled in ``__pycache__`` anyway (see ``systems/loader.py``).
"""

from __future__ import annotations

import marshal
import os
from pathlib import Path

from cramhy_runtime import storage
from cramhy_runtime.storage import kept_code
from cramhy_runtime.storage.checksummed_code import Unusable, sealed, unsealed
from ... import answered_texts
from ..compiler.constants import NotStorable
from cramhy_runtime.lisp_core.function_codes import note_code
from cramhy_runtime.lisp_core.conditions import Error, SimpleFileError, StyleWarning, Warning_, error, handler_bind, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, Cons, LispString, MultipleValues, Symbol, boolean, lisp_list
from cramhy_runtime.lisp_core.dynamic import binding, special
from ..compiler.compilation_unit import REPORTING, compilation_unit
from ..evaluation.evaluator import EVAL_WHEN, LOCALLY, MACROLET, PACKAGE, PROGN, SYMBOL_MACROLET, Unit, compiler, evaluate, new_namespace
from cramhy_runtime.lisp_core.packages import keyword, sym
from ..printer.printer import prin1_to_string
from ..reader.reader import Reader
from ..reader.readtables import READTABLE
from ..streams.external_formats import external_format as format_named
from ..files.file_streams import FileStream
from ..streams.streams import ERROR_OUTPUT, Stream, output_stream
from .loader import (
    COMPILE_FILE_PATHNAME,
    COMPILE_FILE_TRUENAME,
    LOAD_PATHNAME,
    LOAD_TRUENAME,
    decoded,
    folder_of_load,
    load_file,
    load_text,
    locate,
    stamp,
    why_not_kept,
)
from ..files.files import lisp_path, path_of, say, truename
from ..pathnames.namestrings import native_namestring, parse_native
from ..pathnames.pathname_objects import NEWEST, Pathname
from ..pathnames.pathnames import merge_pathnames, pathname

LISP_NAMES = "load compile-file compile-file-pathname"

LOAD_PRINT, LOAD_VERBOSE = special("*LOAD-PRINT*"), special("*LOAD-VERBOSE*")
COMPILE_PRINT, COMPILE_VERBOSE = special("*COMPILE-PRINT*"), special("*COMPILE-VERBOSE*", True)

FIRST_WORDS = b"# cramhy compiled file"
FIRST_LINE = FIRST_WORDS + b" 2\n"
TYPES = ("lisp", "hy", "fasl")
"""What `load` appends to a name without a type, in this order."""


def _flag(value, variable):
    return variable.value if value is UNSUPPLIED else value


# --------------------------------------------------------------------------------------------------------------- loading


stand_ins: dict = {}
"""Names of files, ``swank-loader.lisp``, which a room above has parts of its own for: a function of the path is called, and no file is
loaded or needs to be there."""


def load(designator, *, verbose=UNSUPPLIED, print=UNSUPPLIED, if_does_not_exist=True, external_format=None):
    """``load``: run the forms of a file, source or compiled, or of a stream. Returns T.

    The type ``.lisp`` may be left out. A relative name is one of ``*default-pathname-defaults*``, or else of the folder of the
    file being loaded. verbose: say so, and why kept code was refused; print: show the values of each form. A missing file is
    a file-error, or nil with ``:if-does-not-exist nil``.
    """
    show = _show_values if _flag(print, LOAD_PRINT) is not None else None
    if isinstance(designator, Stream):
        if _flag(verbose, LOAD_VERBOSE) is not None:
            say(f";; loading stuff from {prin1_to_string(designator)}")
        return _load_stream(designator, show)
    if not isinstance(designator, (str, LispString, os.PathLike)):
        return type_error(designator, "(OR STRING PATHNAME STREAM)")
    stand_in = stand_ins.get(os.path.basename(path_of(designator)))
    if stand_in is not None:
        stand_in(path_of(designator))
        return True
    found = _file_to_load(designator)
    if found is None:
        if if_does_not_exist is None:
            return None
        return error(SimpleFileError(pathname(designator), "Couldn't load ~S: file does not exist.", designator))
    if os.path.isdir(found):
        return error(SimpleFileError(pathname(designator), "Can't LOAD a directory: ~S.", pathname(designator)))
    if _flag(verbose, LOAD_VERBOSE) is not None:
        say(f";; loading {prin1_to_string(lisp_path(found))}")
    if _is_compiled(found):
        _load_compiled(found)
    else:
        codec = None if external_format is None else format_named(external_format).codec
        load_file(found, show=show, encoding=codec, as_source=True)
        if _flag(verbose, LOAD_VERBOSE) is not None:
            unusable, refused = why_not_kept(found), kept_code.not_kept(found)
            if unusable is not None and unusable.kind in ("distrusted", "damaged"):
                say(f";; compiled again: {unusable}")
            if refused is not None:
                say(f";; {refused}")
    return True


def _file_to_load(designator):
    wanted = Path(native_namestring(pathname(designator)) if not isinstance(designator, os.PathLike) else os.fspath(designator))
    for base in (Path(path_of(designator)), folder_of_load() / wanted):
        for candidate in (base, *(base.with_name(f"{base.name}.{kind}") for kind in TYPES if base.name)):
            if candidate.is_file():
                return candidate
    return Path(path_of(designator)) if os.path.isdir(path_of(designator)) else None


def _show_values(values):
    say(";; " + ", ".join(prin1_to_string(value) for value in values))


def _load_stream(stream, show):
    of_file = isinstance(stream, FileStream)
    path, true = (stream.pathname, truename(stream)) if of_file else (None, None)
    name = native_namestring(path) if of_file else "<stream>"
    parts = []
    while piece := stream.read_line()[0:2]:
        line, ended = piece
        parts.append(line if ended else line + "\n")
        if ended:
            break
    with binding(PACKAGE, PACKAGE.value, READTABLE, READTABLE.value, LOAD_PATHNAME, path, LOAD_TRUENAME, true):
        load_text("".join(parts), name, show=show)
    return True


def _is_compiled(path):
    try:
        with open(path, "rb") as file:
            start = file.read(len(FIRST_WORDS))
    except OSError:
        return False  # reading it will say why
    if start.startswith(b"# FASL"):
        return error(
            SimpleFileError(
                lisp_path(path), "~A was compiled by SBCL. Load its source, or compile it here with COMPILE-FILE.", lisp_path(path)
            )
        )
    return start == FIRST_WORDS


_OTHER_VERSION = "~A was compiled by another version of cramhy or Python. Compile its source again."
_REFUSALS = {
    "damaged": "~A is damaged: it is not a complete compiled file. Compile its source again.",
    "foreign": _OTHER_VERSION,
    "outdated": _OTHER_VERSION,
}


def _load_compiled(path):
    try:
        source, codes = marshal.loads(unsealed(path, FIRST_LINE, stamp(), in_folder=False))
    except Unusable as problem:
        told = _REFUSALS.get(problem.kind)
        return error(
            SimpleFileError(lisp_path(path), told, lisp_path(path))
            if told
            else SimpleFileError(lisp_path(path), "~A, so it is not loaded. Compile its source again.", str(problem))
        )
    namespace = new_namespace(source)
    with binding(
        PACKAGE, PACKAGE.value, READTABLE, READTABLE.value, LOAD_PATHNAME, lisp_path(path), LOAD_TRUENAME, lisp_path(os.path.realpath(path))
    ):
        noted = answered_texts.note(decoded(Path(source)), name=source) if os.path.isfile(source) else None
        good = False
        try:
            for code in codes:
                note_code(code)
                exec(code, namespace)
            good = True
        finally:
            if noted is not None:
                noted.end(good)


# ------------------------------------------------------------------------------------------------------------- compiling


def compile_file_pathname(input_file, *, output_file=None, **options):
    """``compile-file-pathname``: the file that ``compile-file`` would write."""
    source = merge_pathnames(input_file)
    usual = Pathname(source.host, source.device, source.directory, source.name, "fasl", NEWEST)
    return usual if output_file is None or output_file is True else merge_pathnames(output_file, usual)


def compile_file(input_file, *, output_file=None, verbose=UNSUPPLIED, print=UNSUPPLIED, external_format=None):
    """``compile-file``: three values, the truename of the file of code (nil if the source cannot be read), whether there were
    warnings, and whether there were others than style warnings.
    """
    path = _source(input_file)
    text = decoded(path, None if external_format is None else format_named(external_format).codec)
    target = path_of(compile_file_pathname(pathname(input_file), output_file=output_file))
    talks = _flag(verbose, COMPILE_VERBOSE) is not None
    if talks:
        say(f"; compiling file {prin1_to_string(str(path))}:")
    work = Compilation(text, str(path), _flag(print, COMPILE_PRINT) is not None)
    name = lisp_path(path)
    with (
        binding(
            PACKAGE,
            PACKAGE.value,
            READTABLE,
            READTABLE.value,
            COMPILE_FILE_PATHNAME,
            merge_pathnames(name),
            COMPILE_FILE_TRUENAME,
            lisp_path(os.path.realpath(path)),
        ),
        compilation_unit("file"),
    ):
        codes = handler_bind([(Warning_, work.note)], work.codes)
    if codes is None:
        return MultipleValues((None, True, True))
    _write(target, (str(path), codes))
    if talks:
        say(f"; wrote {target}")
    return MultipleValues((lisp_path(os.path.realpath(target)), boolean(work.warned), boolean(work.failed)))


def _source(designator):
    path = Path(path_of(designator))
    for candidate in (path, *(path.with_name(f"{path.name}.{kind}") for kind in TYPES[:2] if path.name)):
        if candidate.is_file():
            return candidate
    return Path(native_namestring(truename(designator)))  # which says that there is none


def _write(target, contents):
    try:
        storage.write_whole(target, sealed(FIRST_LINE, stamp(), marshal.dumps(contents)))
    except OSError as problem:
        return error(SimpleFileError(parse_native(target), "Cannot write the compiled file ~A: ~A", target, storage.why(problem)))


EVALUATED = {
    sym(name)
    for name in """DEFMACRO DEFPACKAGE IN-PACKAGE DEFTYPE DEFINE-COMPILER-MACRO DEFSETF DEFINE-SETF-EXPANDER
DEFINE-MODIFY-MACRO DEFSTRUCT DECLAIM DEFCONSTANT DEFINE-SYMBOL-MACRO""".split()
}
"""What takes effect while a file is compiled, and again when it is loaded (ANSI 3.2.3.1.1)."""
DECLARED = {sym("DEFVAR"), sym("DEFPARAMETER")}
COMPILING = {keyword("COMPILE-TOPLEVEL"), sym("COMPILE")}
LOADING = {keyword("LOAD-TOPLEVEL"), sym("LOAD")}
EXECUTING = {keyword("EXECUTE"), sym("EVAL")}


class Compilation:
    """A file being compiled, form by form."""

    def __init__(self, text, filename, shows):
        self.reader = Reader(text, filename=filename)
        self.filename, self.shows = filename, shows
        self.unit = Unit(filename, self.reader.positions, stored=True)
        self.warned = self.failed = False

    def note(self, warning):
        """Remember for the values of ``compile-file`` that there was a warning."""
        self.warned = True
        self.failed = self.failed or not isinstance(warning, StyleWarning)

    def codes(self):
        """The code of all forms; ``None`` if the text cannot be read to its end."""
        codes, end = [], object()
        while True:
            try:
                form = self.reader.read(eof_error=False, eof_value=end)
            except Error as problem:
                self._complain("READ error during COMPILE-FILE", problem)
                return None
            if form is end:
                return codes
            if self.shows:
                say(f"; processing {prin1_to_string(form)}")
            try:
                codes += [code for part, now, later in self.parts(form, False) for code in self._dealt_with(part, now, later)]
            except Error as problem:
                locate(problem, self.filename, self.reader.positions.get(id(form)))
                self._complain("caught ERROR", problem)
                text = f"Execution of a form compiled with errors. Compile-time error: {problem.report()}"
                codes.append(self.unit.compile(lisp_list(sym("ERROR"), "~A", text)))

    def _complain(self, what, problem):
        self.warned = self.failed = True
        REPORTING.failed(problem)
        output = output_stream(ERROR_OUTPUT.value)
        output.fresh_line()
        place = getattr(problem, "position", None)
        where = f" ({place[0]}:{place[1]}:{place[2]})" if place else ""
        output.write(f"; {what}:{where}\n; " + problem.report().replace("\n", "\n; ") + "\n")

    def _dealt_with(self, part, now, later):
        if now:
            evaluate(part, self.filename, self.reader.positions)
        if later:
            try:
                yield self.unit.compile(part)
            except NotStorable as problem:
                error(
                    "~A cannot be written to a compiled file: ~A. LOAD the source instead.", self.filename, prin1_to_string(problem.args[0])
                )

    def parts(self, form, now):
        """(form, whether it is evaluated now, whether it is run when the file is loaded) for the forms that ``form`` consists of.

        now: whether it stands in an ``eval-when`` for compile time.
        """
        if isinstance(form, Cons) and isinstance(form.car, Symbol):
            head = form.car
            if head is PROGN:
                for part in form.cdr or ():
                    yield from self.parts(part, now)
                return
            if head is EVAL_WHEN and isinstance(form.cdr, Cons) and isinstance(form.cdr.car, Cons):
                yield from self._eval_when(set(form.cdr.car), Cons(PROGN, form.cdr.cdr), now)
                return
            if head in (MACROLET, SYMBOL_MACROLET, LOCALLY) and isinstance(form.cdr, Cons):
                for part in self.unit._scoped_parts(form):
                    inner = list(part)[-1]
                    yield part, now or isinstance(inner, Cons) and inner.car in EVALUATED, True
                return
            if head in EVALUATED:
                yield form, True, True
                return
            if head in DECLARED and isinstance(form.cdr, Cons):
                yield lisp_list(sym("DECLAIM"), lisp_list(sym("SPECIAL"), form.cdr.car)), True, False
            elif not compiler().is_special(head):
                expansion, expanded = self.unit.expand(form)
                if expanded:
                    yield from self.parts(expansion, now)
                    return
        yield form, now, True

    def _eval_when(self, situations, body, now):
        compiling = bool(situations & COMPILING) or now and bool(situations & EXECUTING)
        if situations & LOADING:
            yield from self.parts(body, compiling)
        elif compiling:
            yield body, True, False
