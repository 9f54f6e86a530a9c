"""Loading files of Lisp: read a form, compile it, run it, go on with the next.

``.lisp`` files are read by our reader from the first character on; in ``.hy`` files the line ``(require cramhy *)`` says that
what follows ``(in-package ...)`` is the same language, so they are loaded in the same way (run by ``hy`` itself, the macro
``in-package`` takes the reader over: see ``hy_src/cramhy/language.hy``). A ``.hy`` file that goes into no package, or comes back by
``(in-hy)``, is Hy's alone.

What was compiled is kept beside the source in ``__pycache__`` (or, where that cannot be written, belongs to another user or is cramhy's, in
the user's cache folder). A kept file is used only if nothing has changed that it was made from: its text, the files loaded before it in
its system, cramhy itself and Python; and only if this user or root has written it and its checksum is right (`storage.checksummed_code`).
`why_not_kept` tells why one was not used. So an unchanged system loads without compiling, and without importing Hy.
"""

from __future__ import annotations

import contextlib
import functools
import os
import re
import sys
from pathlib import Path
from types import CodeType

from cramhy_runtime.kernel.typing_names import NamedTuple
from cramhy_runtime.storage import kept_code
from cramhy_runtime.storage.checksummed_code import Unusable
from cramhy_runtime.storage.dependencies import Facts
from cramhy_runtime.storage.dependencies import holds as dependencies_hold
from cramhy_runtime.storage.dependency_tracing import current as current_trace
from cramhy_runtime.storage.dependency_tracing import tracing, untraced
from cramhy_runtime.lisp_core.function_codes import note_code
from cramhy_runtime.lisp_core.conditions import CompileError, Condition, FileError, error
from cramhy_runtime.lisp_core.data import Cons, all_values
from cramhy_runtime.lisp_core.dynamic import binding, special
from ..compiler.compilation_unit import compilation_unit, current as compilation_unit_of_load
from ..evaluation.evaluator import PACKAGE, Unit, new_namespace
from cramhy_runtime.lisp_core.source_places import file_of_text, is_user_file, locate as locate_by_traceback
from ..files.files import lisp_path
from cramhy_runtime.lisp_core.packages import symbol_name
from ..reader.readtables import READTABLE
from ... import answered_texts
from ...compiler_stamp import stamp
from .code_dependencies import Expectations, Notes, Wanted, reading_state

LOAD_PATHNAME, LOAD_TRUENAME = special("*LOAD-PATHNAME*"), special("*LOAD-TRUENAME*")
COMPILE_FILE_PATHNAME, COMPILE_FILE_TRUENAME = special("*COMPILE-FILE-PATHNAME*"), special("*COMPILE-FILE-TRUENAME*")


_not_used = {}


def _sha256(text):
    from cramhy_runtime.storage.digests import sha256  # a prompt that loads nothing does without it

    return sha256(text.encode(errors="surrogatepass"))


def decoded(path, encoding=None):
    """The text of a source file, UTF-8 if nothing else is said. What cannot be read is a file-error."""
    try:
        data = path.read_bytes()
        return data.decode(encoding or "utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except OSError as problem:
        return error(FileError(lisp_path(path), "Cannot load ~A: ~A.", str(path), problem.strerror))
    except UnicodeDecodeError as problem:
        line = data.count(b"\n", 0, problem.start) + 1
        return error(
            FileError(
                lisp_path(path),
                "Cannot load ~A: it is no UTF-8 text (line ~D, byte ~D of the file). Save it as UTF-8.",
                str(path),
                line,
                problem.start,
            )
        )


def load_file(path, chain="", finished=None, show=None, encoding=None, as_source=False):
    """Load a ``.lisp`` or ``.hy`` file; ``*package*`` and ``*readtable*`` are the same afterwards as before.

    path: the file. chain: fingerprint of what was loaded before it and may define macros that it uses. finished: called with
    the package that is current at the end of the file. show: called with the values of each form. encoding: UTF-8 if not given.
    as_source: whether it is ``load`` that loads it, and ``eval-when`` counts as in ``eval``; else it belongs to a compiled system.
    Returns the fingerprint of this file with its chain. A missing file is a file-error, a broken one an error with its place.
    """
    path = Path(path).absolute()
    text = decoded(path, encoding)
    if path.suffix == ".hy" and is_plain_hy(text):
        _run_hy(path)
        return chain
    fingerprint = _fingerprint(path, text, f"source {chain}" if as_source else chain)
    _loads.number += 1
    name, true = lisp_path(path), lisp_path(os.path.realpath(path))
    compiled = (COMPILE_FILE_PATHNAME.value, COMPILE_FILE_TRUENAME.value) if as_source else (name, true)
    with (
        binding(PACKAGE, PACKAGE.value, READTABLE, READTABLE.value, LOAD_PATHNAME, name, LOAD_TRUENAME, true),
        binding(COMPILE_FILE_PATHNAME, compiled[0], COMPILE_FILE_TRUENAME, compiled[1]),
    ):
        _load_or_compile(path, fingerprint, _Text(text, str(path)), show, as_source)
        if finished is not None:
            finished(PACKAGE.value)
    return fingerprint


def _fingerprint(path, text, chain=""):
    return _sha256(f"{stamp()}{chain}{path.name}{reading_state(text)}{text}").hexdigest()


def load_part(text, filename, line, column):
    """Load ``text``, which stands in the file ``filename`` from ``line`` and ``column`` on, in the current package; its code is kept."""
    path = Path(f"{filename}.rest")
    _loads.number += 1
    fingerprint = _sha256(f"{stamp()}{path}{line}:{column}{reading_state(text)}{text}").hexdigest()
    _load_or_compile(path, fingerprint, _Text(text, filename, line, column))


class _Loads:
    """How many files were loaded: code that was made before the last of them may have been made for other definitions."""

    number = 0


_loads = _Loads()


class _Text(NamedTuple):
    """A text to load, and where in ``filename`` it begins."""

    text: str
    filename: str
    line: int = 1
    column: int = 1


class _KeptForm(NamedTuple):
    """A top-level form in a kept file.

    ``place``: its offset in the text, its line and column. ``unit``: forms with the same number share their globals. ``wanted``: what its
    symbols meant to the compiler, ``facts``: what code of the user's asked of the world while it was compiled.
    """

    place: tuple[int, int, int]
    unit: int
    wanted: Wanted
    codes: list[CodeType]
    facts: Facts


def _load_or_compile(path, fingerprint, text, show=None, as_source=False):
    """Run the code that is kept for ``path`` as far as it is what the compiler would make; compile the rest of ``text``, and keep that."""
    noted = answered_texts.note(text.text, name=text.filename) if is_user_file(text.filename) else None
    good = False
    try:
        _load_noted(path, fingerprint, text, show, as_source, noted)
        good = True
    finally:
        if noted is not None:
            noted.end(good)


def _load_noted(path, fingerprint, text, show, as_source, noted):
    _not_used.pop(str(path), None)
    kept = _kept(path, fingerprint, text.filename) if show is None else None
    if kept is None:
        forms, used = [], 0
    else:
        forms = [_KeptForm(*parts) for parts in kept]
        used = _run_kept(forms, text.filename, noted)
        if used == len(forms):
            return
        _not_used[str(path)] = Unusable("outdated", f"something that {text.filename} uses has changed since it was compiled")
    offset, line, column = forms[used].place if used else (0, text.line, text.column)
    with compilation_unit("file"):
        place = {"line": line, "column": column}
        coming = functools.partial(_come_to, noted, offset) if noted is not None else None
        rest = load_text(text.text[offset:], text.filename, stored=True, show=show, as_source=as_source, coming=coming, **place)
    if rest is not None:
        units = forms[used - 1].unit + 1 if used else 0
        rest = [form._replace(place=(offset + form.place[0], *form.place[1:]), unit=units) for form in rest]
        kept_code.keep(path, fingerprint, (text.filename, [tuple(form) for form in [*forms[:used], *rest]]))


def _come_to(noted, begin, offset):
    noted.upto = begin + offset


def _run_kept(forms, filename, noted):
    """Run kept code, form by form, until one was made for other definitions than there are now. How many were run."""
    expectations, unit, namespace = Expectations(lambda: _loads.number), None, None
    trace = current_trace()
    for number, form in enumerate(forms):
        if form.facts:
            know_answers()
        if not (expectations.hold(form.wanted) and dependencies_hold(form.facts)):
            return number
        if form.unit != unit:
            unit, namespace = form.unit, new_namespace(filename)
        if noted is not None:
            noted.upto = form.place[0]
        if trace is not None:  # of a file that is compiled, and loads this one for that
            trace.include(form.facts)
        with untraced():
            for code in form.codes:
                note_code(code)
                exec(code, namespace)
    return len(forms)


def load_text(text, filename, stored=False, show=None, line=1, column=1, as_source=False, coming=None):
    """Load the forms of ``text``; with ``stored`` return them as a list of `_KeptForm`, or ``None`` if they cannot be kept.

    show: called with the values of each form. line, column: where in ``filename`` the text begins. as_source: as of `load_file`. coming:
    called with the offset of each form before it is run.
    """
    from ..reader.reader import Reader

    reader = Reader(text, filename=filename, line=line, column=column)
    unit = Unit(filename, reader.positions, stored=stored, as_source=as_source)
    if not os.path.isfile(filename):
        import linecache  # it imports the tokenizer

        linecache.cache.setdefault(filename, (len(text), None, text.splitlines(True), filename))
    notes = Notes(lambda: _loads.number) if stored else None
    if stored:
        from . import lisp_questions

        lisp_questions.install()
    with tracing() if stored else contextlib.nullcontext() as trace:
        return _load_forms(reader, unit, notes, trace, show, coming)


def _load_forms(reader, unit, notes, trace, show, coming):
    """Load the forms that ``reader`` gives. Result: as of `load_text`, whose parts the arguments are."""
    end, forms, filename, stored = object(), [], unit.filename, unit.stored
    while True:
        start = reader.offset
        if coming is not None:
            coming(start)
        form = reader.read(eof_error=False, eof_value=end)
        if form is end:
            return None if reader.positions.left_out else forms  # so that it is told the next time, too
        if is_hy_requirement(form):
            continue
        if trace is not None:
            trace.settle()  # after #.
        codes, wanted = [], notes.before(form, PACKAGE.value) if forms is not None and stored else {}
        try:
            values = ()
            unit.refuse_circle(form)
            for part in unit.toplevel_parts(form):
                code = _compile(unit, part)
                codes.append(code)
                if trace is not None:
                    trace.include_modules(filename)
                    trace.settle()
                with untraced():
                    values = all_values(unit.run(code))
            if not unit.stored:
                forms = None
            if trace is not None and trace.reason is not None and forms is not None:
                line, column = (reader.positions.get(id(form)) or reader.place(start))[:2]
                kept_code.refuse(filename, (filename, line, column), trace.reason)
                forms = None
            if forms is not None:
                forms.append(_KeptForm((start, *reader.place(start)), 0, wanted, codes, trace.take() if trace is not None else {}))
            if show is not None:
                show(values)
        except BaseException as problem:
            extent, noticed = reader.positions.get(id(form)), compilation_unit_of_load()
            if noticed is not None and extent is not None:
                noticed.failed(filename, extent)
            if isinstance(problem, Condition):
                locate(problem, filename, extent)
                if getattr(problem, "read_in", None) is None:
                    problem.read_in = PACKAGE.value
            raise


def know_answers():
    """Let `storage.dependencies` judge what a compilation asked of Lisp."""
    from . import lisp_answers  # noqa: F401  only where code was kept that asked


def _compile(unit, form):
    from ..compiler.constants import NotStorable

    try:
        return unit.compile(form)
    except NotStorable:
        # an object that code cannot rebuild: run this file from now on without keeping it
        unit.stored = False
        unit.constants = type(unit.constants)("KK")
        return unit.compile(form)


def locate(problem, filename, position):
    """Give a condition the innermost place that it passed, or else that of the top-level form it left."""
    locate_by_traceback(problem, problem)
    if getattr(problem, "position", None) is None and position is not None:
        try:
            problem.position = (filename, *position[:2])
        except AttributeError:
            pass


def is_hy_requirement(form):
    """Whether ``form`` is ``(require cramhy *)`` or another line that only Hy itself needs."""
    return (
        isinstance(form, Cons)
        and symbol_name(form.car) == "REQUIRE"
        and isinstance(form.cdr, Cons)
        and symbol_name(form.cdr.car).startswith("CRAMHY")
        if isinstance(form, Cons) and hasattr(form.car, "name")
        else False
    )


def speaks_lisp(filename):
    """Whether the text of that name, a file or what was typed, is Common Lisp, and not Hy or Python."""
    filename = file_of_text(filename)
    if filename.endswith(".hy"):
        import linecache  # it imports the tokenizer

        return not is_plain_hy("".join(linecache.getlines(filename)))
    return filename.endswith((".lisp", ".asd")) or filename.startswith("<") and not filename.startswith("<stdin>")


def is_plain_hy(text):
    """Whether a ``.hy`` file stays Hy: it never goes into a package of Lisp, or comes back."""
    return bool(re.search(r"^\(in-hy\)", text, re.M | re.I)) or not re.search(r"^\((in-package|defpackage)\b", text, re.M | re.I)


def _run_hy(path):
    """Run a file of Hy as ``hy FILE`` does: with its name in ``sys.argv``, and the modules in its folder can be imported."""
    from ... import kept_hy

    kept_hy.watch()
    words, folder = sys.argv, str(path.parent.resolve())
    sys.argv = [str(path)]
    sys.path.insert(0, folder)
    try:
        kept_hy.run_as_main(str(path))
    finally:
        sys.argv = words
        if folder in sys.path:
            sys.path.remove(folder)


def _kept(path, fingerprint, filename):
    """What is kept for ``path``: a list of `_KeptForm` as tuples, or ``None``. filename: what the code is told that it stands in."""
    try:
        made_in, forms = kept_code.find(path, fingerprint)
        if made_in != filename:
            forms = [
                (place, unit, wanted, [_moved(code, filename) for code in codes], facts) for place, unit, wanted, codes, facts in forms
            ]
            kept_code.keep(path, fingerprint, (filename, forms))
        return forms
    except Unusable as problem:
        _not_used[str(path)] = problem
    return None


def _moved(code, filename):
    """``code``, which was compiled elsewhere, as that of the file ``filename``."""
    constants = tuple(_moved(each, filename) if isinstance(each, CodeType) else each for each in code.co_consts)
    return code.replace(co_filename=filename, co_consts=constants)


def kept_codes(path):
    """The code objects that were kept when the file ``path`` was loaded last by itself, if it has not changed since; else ``None``."""
    path = Path(path).absolute()
    text = decoded(path)
    kept = _kept(path, _fingerprint(path, text, "source "), str(path)) or _kept(path, _fingerprint(path, text), str(path))
    return kept and [code for parts in kept for code in _KeptForm(*parts).codes]


def why_not_kept(path):
    """Why the kept code of the file ``path`` was not used when it was loaded last, an `Unusable`; ``None`` if it was used."""
    return _not_used.get(str(Path(path).absolute()))


def folder_of_load():
    """The folder of the file being loaded, else the working directory."""
    return Path(LOAD_TRUENAME.value).parent if LOAD_TRUENAME.value is not None else Path.cwd()


__all__ = ["CompileError", "load_file", "load_text", "locate"]
