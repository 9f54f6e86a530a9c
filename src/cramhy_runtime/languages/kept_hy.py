"""The code of Hy files, in the one keeper of code (`storage.kept_code`): used while the source, what compiles it and what it depends on are
the same.

Python keeps the code of a module in ``__pycache__`` and looks at the date of the source only. Nobody sees that a module of macros has
changed, a module of Python that they call, a file that they read, or cramhy itself. `watch` lets Python's loader of source files ask here
for files of Hy: code that the keeper has is used if its record holds. Else the file is compiled, while a trace notes what its macros ask of
the world. Python's own file is written as ever, for those who run Hy without cramhy.

``hy FILE`` looks into ``__pycache__`` before anybody has loaded cramhy. So in Python's file the code of a text that our macros have seen
(`seen`) is a call of `run`, which asks the keeper and compiles again what that does not have.
"""

from __future__ import annotations

import contextlib
import importlib.machinery
import importlib.util
import marshal
import os
import re
import sys
from importlib import _bootstrap_external
from pathlib import Path
from types import CodeType
from typing import Any

import hy
import hy.compiler
import hy.macros

from cramhy_runtime.storage import dependencies, dependency_tracing, kept_code
from cramhy_runtime.storage.checksummed_code import Unusable
from cramhy_runtime.storage.dependency_tracing import Trace, is_library, tracing, untraced

from .compiler_stamp import stamp

HEADER = 16  # bytes before the code in a file of bytecode
_CALL = "__import__('cramhy').kept_code.run(globals(), {filename!r}, {code!r})"
_BEGINS_WITH_US = re.compile(rb'\A(?:#!.*\n)?(?:\s|;.*\n|"[^"]*"|\(import (?:cramhy|hy)\))*\(require cramhy\b')
"""A text whose first form requires cramhy: nothing of it was compiled before that."""

_HY = os.path.dirname(os.path.abspath(hy.__file__)) + os.sep
_OURS = os.path.join(os.path.abspath(os.path.join(__file__, "..", "..", "..")), "cramhy")

_filenames: set[str] = set()
"""The files that our macros have seen since Python began."""

_loader = importlib.machinery.SourceFileLoader
_get_code, _set_data = _loader.get_code, _loader.set_data


class _Begun:
    """The compilation that was at work already when cramhy was loaded: ``hy FILE``."""

    filename = ""
    trace: Trace | None = None
    leave: Any = None


def seen(filename: str) -> None:
    """Our macros are at work in the file of that name."""
    if filename not in _filenames:
        _filenames.add(filename)
        if dependency_tracing.current() is None and not sys.dont_write_bytecode and _begins_with_us(filename):
            _Begun.filename, _Begun.leave = filename, contextlib.ExitStack()
            _Begun.trace = _Begun.leave.enter_context(tracing(audited=True))


def _begins_with_us(filename):
    try:
        return not is_library(filename) and _BEGINS_WITH_US.match(Path(filename).read_bytes()) is not None
    except OSError:
        return False


def watch() -> None:
    """From now on Python asks the keeper for the code of Hy files."""
    if _loader.get_code is not _get_code:
        return
    _loader.get_code = _get_code_of_ours  # type: ignore[method-assign]
    _loader.set_data = _set_data_of_ours  # type: ignore[method-assign]
    hy.macros.MacroExceptions = _Expansion  # type: ignore[attr-defined, misc]
    hy.macros.reader_macro = _reader_macro  # type: ignore[attr-defined]
    hy.compiler.HyASTCompiler.eval = _eval  # type: ignore[attr-defined]


def _get_code_of_ours(self: Any, fullname: str) -> CodeType | None:
    path = os.path.abspath(self.get_filename(fullname))
    if not path.endswith(".hy"):
        return _get_code(self, fullname)
    if is_library(path):
        with untraced():
            return _get_code(self, fullname)
    try:
        source = self.get_data(path)
    except OSError:
        return _get_code(self, fullname)
    return _code(self, path, source)


def _code(loader, path, source):
    """The code of the file ``path``, whose text is ``source``: what is kept, or what the compiler makes of it, which is kept then."""
    place, label = _place(path), _label(path, source)
    outer = dependency_tracing.current()
    with contextlib.suppress(Unusable):
        facts, code = kept_code.find(place, label)
        if _holds(facts):
            if outer is not None:
                outer.include(facts)
            dependency_tracing.loaded(path, source, facts)
            return marshal.loads(code)
    with tracing(audited=True) as trace:
        code = loader.source_to_code(source, path)
        _finish(trace, path)
    _keep(trace, path, source, code)
    with untraced(), contextlib.suppress(OSError, NotImplementedError, AttributeError):
        if not sys.dont_write_bytecode:
            status, target = loader.path_stats(path), importlib.util.cache_from_source(path)
            data = _bootstrap_external._code_to_timestamp_pyc(code, status["mtime"], status["size"])  # type: ignore[attr-defined]
            loader._cache_bytecode(path, target, data)
    return code


def _place(path):
    """The name under which the keeper has the code of a Hy file. A file of Lisp in ``.hy`` may be loaded in another way, too."""
    return Path(f"{path}.module")


def _label(path, source):
    from cramhy_runtime.storage.digests import sha256

    with untraced():
        compilers = stamp()
    return sha256(f"{compilers} {hy.__version__} {sys.flags.optimize} {path} ".encode(errors="surrogatepass") + source).hexdigest()


def _holds(facts):
    if any(kind not in dependencies.KINDS for kind, _ in facts) and "cramhy_runtime.languages.commonlisp.systems.loader" in sys.modules:
        sys.modules["cramhy_runtime.languages.commonlisp.systems.loader"].know_answers()
    return dependencies.holds(facts)


def _finish(trace, path):
    """The file is compiled: add the modules that its macros come from, and what these depend on."""
    trace.include_modules(path)
    performing = sys.modules.get("cramhy_runtime.languages.commonlisp.systems.performing")
    for file in performing.loaded_files() if performing is not None else ():
        trace.ask_path("file", file)
    trace.settle()


def _keep(trace, path, source, code):
    with untraced():
        dependency_tracing.loaded(path, source, trace.facts, trace.reason)
        if trace.reason is None:
            kept_code.keep(_place(path), _label(path, source), (trace.facts, marshal.dumps(code)))
        else:
            kept_code.refuse(path, (path, *(trace.place or (1, 1))), trace.reason)


# ------------------------------------------------------------------------------------------------------------ Python's files


def _set_data_of_ours(self: Any, path: str, data: Any, **mode: int) -> None:
    with untraced():
        _set_data(self, path, _guarded(bytes(data)), **mode)


def _guarded(data):
    """``data``, a file of bytecode, with the call of `run` for the code in it, if our macros have seen the source of that."""
    with contextlib.suppress(ValueError, EOFError, TypeError):
        code = marshal.loads(data[HEADER:])
        if isinstance(code, CodeType) and code.co_filename in _filenames:
            _end_begun(code)
            call = _CALL.format(filename=code.co_filename, code=data[HEADER:])
            return data[:HEADER] + marshal.dumps(compile(call, code.co_filename, "exec"))
    return data


def _end_begun(code):
    """Keep the code that was being compiled when cramhy was loaded."""
    if _Begun.trace is None or _Begun.filename != code.co_filename:
        return
    trace, leave = _Begun.trace, _Begun.leave
    _Begun.trace = _Begun.leave = None
    path = os.path.abspath(code.co_filename)
    with contextlib.suppress(OSError):
        source = Path(path).read_bytes()
        _finish(trace, path)
        if not dependency_tracing.may_have_changed(path):
            _keep(trace, path, source, code)
    leave.close()


def unguarded(code: CodeType) -> CodeType:
    """The code that Hy has made, where ``code``, which Python's loader gives for a file, is the call of `run` with it."""
    guard = compile(_CALL.format(filename="", code=b""), "", "exec")
    if code.co_names != guard.co_names:
        return code
    [kept] = [constant for constant in code.co_consts if isinstance(constant, bytes)]
    return marshal.loads(kept)


def run(namespace: dict[str, Any], *told: Any) -> None:
    """Run the code of a file in a module's ``namespace``: what is kept, or what the compiler makes of the file now.

    told: at its end, the name of the file, and the code that was made of it if it is no longer there. Older versions of cramhy have written
    calls with more before that.
    """
    *_, filename, code = told
    exec(_code_of_file(namespace, filename, code), namespace)


def _code_of_file(namespace, filename, code):
    loader = _loader(namespace.get("__name__", "__main__"), filename)
    try:
        source = loader.get_data(filename)
    except OSError:
        return marshal.loads(code)
    return _code(loader, os.path.abspath(filename), source)


def calls_kept_code(frames: list[Any], index: int) -> bool:
    """Whether the frame at ``index`` is that of a file's own code, which calls `run`; Python gives it the name of the source."""
    code = run.__code__
    return any((frame.filename, frame.name) == (code.co_filename, code.co_name) for frame in frames[index + 1 : index + 2])


# ------------------------------------------------------------------------------------------------- what runs while Hy compiles


class _Expansion(hy.macros.MacroExceptions):
    """What Hy does around the call of a macro, which a trace watches if it is the user's."""

    def __enter__(self):
        self._watched = None
        trace = dependency_tracing.current()
        if trace is not None and not trace.watches and self._is_users():
            trace.place = trace.place if trace.reason is not None else _place_of(self.macro_tree)
            self._watched = dependency_tracing.watched()
            self._watched.__enter__()
        return super().__enter__()

    def __exit__(self, *problem):
        if self._watched is not None:
            self._watched.__exit__(None, None, None)
        return super().__exit__(*problem)

    def _is_users(self):
        name = self.macro_tree[0]
        if not isinstance(name, hy.models.Symbol):  # hy.R.module.macro
            return not str(name).startswith(("hy.R.cramhy", "(. hy R cramhy"))
        name = hy.mangle(name)
        local = self.compiler.local_state_stack if self.compiler is not None else ()
        tables = [*(state["macros"] for state in local), getattr(self.module, "_hy_macros", {})]
        found = next((table[name] for table in tables if dict.__contains__(table, name)), None)
        if found is None:
            return False
        file = getattr(getattr(found, "__code__", None), "co_filename", "")
        trace = dependency_tracing.current()
        if (
            trace is not None and "site-packages" in file and not file.startswith((_HY, _OURS))
        ):  # of a library, which may be another version
            trace.ask("status", file)
        return not is_library(file)


def _place_of(tree):
    return getattr(tree, "start_line", 1) or 1, getattr(tree, "start_column", 1) or 1


_eval_of_hy, _reader_macro_of_hy = hy.compiler.HyASTCompiler.eval, hy.macros.reader_macro


def _eval(self, model):
    """The value of ``model``, which stands in ``eval-and-compile`` or the like, or defines a macro."""
    trace = dependency_tracing.current()
    if trace is None or _defines_macro(model):
        return _eval_of_hy(self, model)
    if not trace.watches and trace.reason is None:
        trace.place = _place_of(model)
    with dependency_tracing.watched():
        return _eval_of_hy(self, model)


def _defines_macro(model):
    """Whether ``model`` is what Hy makes of a ``defmacro``: it makes a function and calls nothing of the user's."""
    last = model[-1] if isinstance(model, hy.models.Expression) and len(model) == 2 else None
    head = last[0] if isinstance(last, hy.models.Expression) and len(last) == 2 else None
    return isinstance(head, hy.models.Expression) and len(head) == 2 and [*map(str, head[0])] == [".", "hy", "macros", "macro"]


def _reader_macro(name, function):
    """Hy's definition of a reader macro, which is called as code of the user's."""
    _reader_macro_of_hy(name, function)
    table = function.__globals__["_hy_reader_macros"]
    named = table[name]
    table[name] = lambda reader, key: dependency_tracing.run(named, reader, key)


__all__ = ["calls_kept_code", "run", "seen", "unguarded", "watch"]
