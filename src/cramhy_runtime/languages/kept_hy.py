"""The code of Hy files, in the one keeper of code (`storage.kept_code`): used while the source, what compiles it and what it depends on are
the same.

Python keeps the code of a module in ``__pycache__`` and looks at the date of the source only. Nobody sees that a module of macros has
changed, a module of Python that they call, a file that they read, or cramhy itself. After `watch`, modules in Hy are found by `Finder`, and
their `Loader` asks the keeper: code that it has is used if its record holds. Else the file is compiled by `Compiler`, while a trace notes
what its macros ask of the world.

``hy FILE`` looks into ``__pycache__`` before anybody has loaded cramhy, and compiles a file that is not there. So in Python's file the code
of a text that our macros have seen (`seen`) is a call of `run`, which asks the keeper and compiles again what that does not have. What Hy
compiles then calls `guard` when it begins to run, which brings it there (`loading`).
"""

from __future__ import annotations

import ast
import contextlib
import copy
import importlib.util
import marshal
import os
import re
import sys
from importlib import _bootstrap_external
from importlib.machinery import PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import TYPE_CHECKING, Any

import hy
import hy.compiler
import hy.importer
import hy.macros
from hy.reader import HyReader

from cramhy_runtime.storage import dependencies, dependency_tracing, kept_code
from cramhy_runtime.storage.checksummed_code import Unusable
from cramhy_runtime.storage.dependency_tracing import Trace, is_library, tracing, untraced

from .compiler_stamp import stamp

if TYPE_CHECKING:
    from collections.abc import Iterator

_CALL = "__import__('cramhy').kept_code.run(globals(), {filename!r}, {code!r})"
_BEGINS_WITH_US = re.compile(rb'\A(?:#!.*\n)?(?:\s|;.*\n|"[^"]*"|\(import (?:cramhy|hy)\))*\(require cramhy\b')
"""A text whose first form requires cramhy: nothing of it was compiled before that."""

_HY = os.path.dirname(os.path.abspath(hy.__file__)) + os.sep
_OURS = os.path.join(os.path.abspath(os.path.join(__file__, "..", "..", "..")), "cramhy")

_filenames: set[str] = set()
"""The files that our macros have seen since Python began."""

_loading: dict[str, Trace | None] = {}
"""Path of each file that `loading` has compiled, and that did not run yet → what its macros ask, or ``None``: it is compiled again then."""


def seen(filename: str) -> None:
    """Our macros are at work in the file of that name."""
    _filenames.add(filename)


def watch() -> None:
    """From now on Python asks the keeper for the code of the Hy modules that it imports."""
    if Finder not in sys.meta_path:
        place = sys.meta_path.index(PathFinder) if PathFinder in sys.meta_path else len(sys.meta_path)
        sys.meta_path.insert(place, Finder)


class Finder:
    """Finds what Python's own finder of files finds; modules in Hy get a `Loader`."""

    @staticmethod
    def find_spec(name: str, path: Any = None, target: Any = None) -> Any:
        """The spec of the module ``name``, or ``None``: as ``importlib.abc.MetaPathFinder`` says."""
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader and spec.loader.path.endswith(".hy"):
            spec.loader = Loader(name, spec.loader.path)
        return spec


class Loader(SourceFileLoader):
    """Loads a file of Hy."""

    def get_code(self, fullname: str) -> CodeType | None:
        """The code of the module: what is kept, or what the compiler makes of it."""
        path = os.path.abspath(self.get_filename(fullname))
        if is_library(path):
            with untraced():
                return super().get_code(fullname)
        try:
            source = self.get_data(path)
        except OSError:
            return super().get_code(fullname)
        return _code(self, path, source)

    def source_to_code(self, data: Any, path: Any, *, _optimize: int = -1) -> CodeType:  # type: ignore[override]
        """The code that `Compiler` makes of the text ``data``, in bytes."""
        if os.environ.get("HY_MESSAGE_WHEN_COMPILING"):
            print("Compiling", path, file=sys.stderr)
        return compile(tree_of(self, data, path), path, "exec", dont_inherit=True, optimize=_optimize)

    def keep_for_python(self, path: str, code: CodeType) -> None:
        """Write Python's own file of bytecode. Where our macros have seen the source, the code in it is a call of `run`."""
        with untraced(), contextlib.suppress(OSError, NotImplementedError, AttributeError):
            if not sys.dont_write_bytecode:
                status, target = self.path_stats(path), importlib.util.cache_from_source(path)
                if code.co_filename in _filenames:
                    told = marshal.dumps(code)
                    code = compile(_CALL.format(filename=code.co_filename, code=told), code.co_filename, "exec")
                data = _bootstrap_external._code_to_timestamp_pyc(code, status["mtime"], status["size"])  # type: ignore[attr-defined]
                self._cache_bytecode(path, target, data)  # type: ignore[attr-defined]


def tree_of(loader: Any, data: bytes, path: str) -> Any:
    """Python's syntax tree of the module of ``loader``, whose text is ``data``."""
    source = data.decode("utf-8")
    forms = hy.read_many(source, filename=path, skip_shebang=True, reader=Reader())
    with hy.importer.loader_module_obj(loader) as module:
        return hy.importer.hy_compile(forms, module, compiler=Compiler(module, filename=path, source=source))


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
    loader.keep_for_python(path, code)
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


@contextlib.contextmanager
def loading(compiler: Any, filename: str) -> Iterator[tuple[Any, list[ast.stmt]]]:
    """In the block the rest of the file of that name is compiled: the compiler to take, and Python's statements that come before it.

    compiler: the one at work. If a loader of Python's or Hy's has called it, as ``hy FILE`` does, the statements call `guard`, and where
    nothing stands before ``(require cramhy ...)`` the rest is compiled as by our own loader.
    """
    if isinstance(compiler, Compiler) or getattr(compiler.module, "__file__", None) != filename or sys.dont_write_bytecode:
        yield compiler, []
        return
    path = os.path.abspath(filename)
    guards = ast.parse(f"__import__('cramhy').kept_code.guard({filename!r})").body
    _loading[path] = None
    if dependency_tracing.current() is not None or not _begins_with_us(path):
        yield compiler, guards
        return
    ours = Compiler(compiler.module, filename, compiler.source, compiler.extra_macros)
    ours.anon_var_count, ours.local_state_stack = compiler.anon_var_count, compiler.local_state_stack
    ours.scope.defined = compiler.scope.defined
    with tracing(audited=True) as trace, ours.scope:
        yield ours, guards
    compiler.anon_var_count = ours.anon_var_count
    _loading[path] = trace


def _begins_with_us(path):
    try:
        return not is_library(path) and _BEGINS_WITH_US.match(Path(path).read_bytes()) is not None
    except OSError:
        return False


def guard(filename: str) -> None:
    """The caller is the code of that file. If it was compiled just now: keep it, and let Python's file have a call of `run` instead."""
    path = os.path.abspath(filename)
    if path in _loading:
        trace, code = _loading.pop(path), sys._getframe(1).f_code
        seen(filename)
        Loader("__main__", filename).keep_for_python(path, code)
        if trace is not None:
            with contextlib.suppress(OSError):
                source = Path(path).read_bytes()
                _finish(trace, path)
                if not dependency_tracing.may_have_changed(path):
                    _keep(trace, path, source, code)


def run(namespace: dict[str, Any], *told: Any) -> None:
    """Run the code of a file in a module's ``namespace``: what is kept, or what the compiler makes of the file now.

    told: at its end, the name of the file, and the code that was made of it if it is no longer there. Older versions of cramhy have written
    calls with more before that.
    """
    *_, filename, code = told
    exec(_code_of_file(namespace, filename, code), namespace)


def run_as_main(filename: str) -> None:
    """Run a file of Hy as the module ``__main__``, as ``runpy.run_path`` does."""
    module, before = ModuleType("__main__"), sys.modules.get("__main__")
    loader = module.__loader__ = Loader("__main__", filename)
    module.__file__, module.__cached__, module.__package__ = filename, None, ""  # type: ignore[attr-defined]
    word = sys.argv[0]
    sys.modules["__main__"], sys.argv[0] = module, filename
    try:
        code = loader.get_code("__main__")
        exec(code, vars(module))
    finally:
        sys.argv[0] = word
        if before is not None:
            sys.modules["__main__"] = before


def _code_of_file(namespace, filename, code):
    loader = Loader(namespace.get("__name__", "__main__"), filename)
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


class Compiler(hy.compiler.HyASTCompiler):
    """Hy's compiler, whose trace watches what it calls: macros of the user's, ``eval-and-compile`` and the like."""

    def compile_atom(self, atom: Any) -> Any:
        """As Hy's own; calls of macros of the user's are expanded one by one, before it."""
        trace = dependency_tracing.current()
        if trace is None or trace.watches or not isinstance(atom, hy.models.Expression):
            return super().compile_atom(atom)
        expanded = atom
        while isinstance(expanded, hy.models.Expression) and expanded and self._is_call_of_users_macro(expanded, trace):
            trace.place = trace.place if trace.reason is not None else _place_of(expanded)
            with dependency_tracing.watched():
                expanded = hy.macros.macroexpand(copy.copy(expanded), self.module, self, once=True)
            if isinstance(expanded, (hy.compiler.Result, ast.AST)):
                return hy.compiler.Result() + expanded
        return super().compile_atom(atom) if expanded is atom else self.compile(expanded)

    def eval(self, model: Any) -> Any:
        """The value of ``model``, which stands in ``eval-and-compile`` or the like, or defines a macro."""
        trace = dependency_tracing.current()
        if trace is None or _defines_macro(model):
            return super().eval(model)
        if not trace.watches and trace.reason is None:
            trace.place = _place_of(model)
        with dependency_tracing.watched():
            return super().eval(model)

    def _is_call_of_users_macro(self, form: Any, trace: Trace) -> bool:
        macro = self._macro_of(form[0])
        if macro is None or isinstance(macro, bool):
            return bool(macro)
        file = getattr(getattr(macro, "__code__", None), "co_filename", "")
        if "site-packages" in file and not file.startswith((_HY, _OURS)):  # of a library, which may be another version
            trace.ask("status", file)
        return not is_library(file)

    def _macro_of(self, head: Any) -> Any:
        """The macro that ``head`` names, or ``None``; of ``hy.R.module.macro`` only whether it may be the user's."""
        if isinstance(head, hy.models.Expression):
            return " ".join(map(str, head[:3])) == ". hy R" and str(head[3]) != "cramhy"
        if not isinstance(head, hy.models.Symbol):
            return None
        name = hy.mangle(head)
        tables = [*(state["macros"] for state in reversed(self.local_state_stack)), getattr(self.module, "_hy_macros", {})]
        return next((table[name] for table in tables if dict.__contains__(table, name)), None)


class Reader(HyReader):
    """Hy's reader, whose trace watches the reader macros of the user's."""

    @reader_for("#")  # noqa: F821  Hy's metaclass gives it
    def tag_dispatch(self, key):
        """As Hy's own."""
        name = self.read_ident(just_peeking=True)
        function = self.reader_macros.get(name) if dependency_tracing.current() is not None else None
        if function is None:
            return super().tag_dispatch(key)
        self.getn(len(name))
        model = dependency_tracing.run(function, self, name)
        return None if model is None else hy.models.as_model(model)


def _place_of(tree):
    return getattr(tree, "start_line", 1) or 1, getattr(tree, "start_column", 1) or 1


def _defines_macro(model):
    """Whether ``model`` is what Hy makes of a ``defmacro``: it makes a function and calls nothing of the user's."""
    last = model[-1] if isinstance(model, hy.models.Expression) and len(model) == 2 else None
    head = last[0] if isinstance(last, hy.models.Expression) and len(last) == 2 else None
    return isinstance(head, hy.models.Expression) and len(head) == 2 and [*map(str, head[0])] == [".", "hy", "macros", "macro"]


__all__ = [
    "Compiler",
    "Finder",
    "Loader",
    "Reader",
    "calls_kept_code",
    "guard",
    "loading",
    "run",
    "run_as_main",
    "seen",
    "tree_of",
    "watch",
]
