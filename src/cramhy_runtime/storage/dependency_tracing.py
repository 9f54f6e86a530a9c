"""What a compilation asks of the world: a `Trace` notes it while code of the user's runs that the compiler calls.

Such code is a macro, a reader macro, the form behind ``#.``, the body of ``eval-and-compile``. Whoever calls it for a compiler calls `run`.
Meanwhile the trace hears of

* files and folders, processes and the network: from Python's audit events;
* calls of functions that ask something, from Python's profiler: those in `QUESTIONS`, and functions in C that look at the clock, at chance
  or at the process (`_REASONS`);
* each function of the user's that runs, of which `OBSERVERS` are told: what variables of Lisp it reads, from which file it comes.

What can be compared later becomes a question with its answer (`storage.dependencies`). What cannot makes the trace say why the code may not
be kept: ``reason``. So does a question that has another answer when the compiler is done: compiling changes what it depends on, and kept
code would not.

A module that a macro comes from is a file that was read, whenever that was. Since a session may have read an older text of it than there is
now, a module that has changed after this process began is a reason, too.
"""

from __future__ import annotations

import functools
import os
import sys
import time
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar

from . import dependencies
from .dependencies import Facts, Unanswerable

TYPE_CHECKING = False
if TYPE_CHECKING:  # as type checkers see it; `typing` itself takes 2 ms to import
    from collections.abc import Callable, Iterator
    from types import CodeType, FrameType
    from typing import Any

_BEGAN = time.time_ns()
_TICK = 20_000_000
"""Nanoseconds by which the time of a change may be behind the clock, since the system's clock for that is a coarse one."""


class Trace:
    """What was asked of the world so far. facts: the questions with their answers. reason: why the code cannot be kept, or ``None``.

    audited: whether all that happens is part of the compilation, and not only what `run` calls.
    """

    def __init__(self, audited: bool = False) -> None:
        self.facts: Facts = {}
        self.reason: str | None = None
        self.audited = audited
        self.watches = False
        self.ran = False
        """Whether code of the user's has run that is in a module of Python or of Hy."""
        self.place: tuple[int, int] | None = None
        """Line and column of the form that is compiled."""
        self._answers = False
        self._codes: dict[int, CodeType] = {}
        self._fresh: list[tuple[str, Any]] = []

    def ask(self, kind: str, key: Any) -> None:
        """Note the question and what its answer is now, unless it was asked before."""
        question = kind, key
        if question not in self.facts and not self._answers:
            self._answers = True  # what answers asks nothing
            try:
                self.facts[question] = dependencies.KINDS[kind].now(key)
                self._fresh.append(question)
            except Unanswerable as problem:
                self.refuse(str(problem))
            except Exception as problem:  # of an object of the user's
                self.refuse(f"{dependencies.told(question)} cannot be compared: {problem}")
            finally:
                self._answers = False

    def ask_path(self, kind: str, path: Any) -> None:
        """Note a question about a file or a folder, unless it belongs to Python, to cramhy or to another library."""
        if isinstance(path, bytes):
            path = os.fsdecode(path)
        if isinstance(path, int) or not isinstance(path, (str, os.PathLike)):
            return
        path = os.fspath(path)
        if not os.path.isabs(path):
            self.ask("working folder", "")
            path = os.path.abspath(path)
        if not is_library(path):
            self.ask(kind, path)

    def refuse(self, reason: str) -> None:
        """The code cannot be kept, for that reason. The first one counts."""
        if self.reason is None:
            self.reason = reason

    def include(self, facts: Facts, reason: str | None = None) -> None:
        """What another file that is part of this one depends on, or why that cannot be kept."""
        for question, answer in facts.items():
            self.facts.setdefault(question, answer)
        if reason is not None:
            self.refuse(reason)

    def include_modules(self, path: str) -> None:
        """If code of the user's has run: the modules of Python and of Hy that are there, and what these depend on. path: of the file that
        is compiled, which is no dependency of itself."""
        if not self.ran:
            return
        self.ran = False
        for module in list(sys.modules.values()):
            file = getattr(module, "__file__", None)
            if not isinstance(file, str) or not file.endswith((".py", ".hy")):
                continue
            file = os.path.abspath(file)
            if file == path or is_library(file):
                continue
            known = _loaded.get(file)
            if known is not None:
                self.include(*known[1:])
            if known[0] != _checksum(file) if known is not None else may_have_changed(file):
                self.refuse(f"{file} may have changed after it was loaded")
            self.ask("file", file)
            if "." not in module.__name__ and module.__name__ != "__main__":
                self.ask("module", module.__name__)

    def settle(self) -> None:
        """The compiler is done with a form, which was not run yet: what it has asked for must have the same answers still."""
        fresh, self._fresh = self._fresh, []
        self._answers = True
        try:
            changed = dependencies.broken({question: self.facts[question] for question in fresh if question in self.facts})
        finally:
            self._answers = False
        if changed is not None:
            self.refuse(f"compiling it changes {dependencies.told(changed)}")

    def take(self) -> Facts:
        """The questions since the last call, for the form that was compiled; the next form asks anew."""
        facts, self.facts, self._fresh, self._codes = self.facts, {}, [], {}
        return facts

    def see(self, code: CodeType, names: dict[str, Any], key: int) -> None:
        """The user's function with that code and these globals runs. key: the code's id."""
        if key not in self._codes:
            self._codes[key] = code
            if not is_library(code.co_filename):
                self.ran = self.ran or code.co_filename.endswith((".py", ".hy"))
                for observe in OBSERVERS:
                    observe(self, code, names)

    def hear(self, frame: FrameType, event: str, argument: Any) -> None:
        """What the profiler tells. frame: the one that runs, from which only a question reads its arguments."""
        if event == "call":
            code = frame.f_code
            key = id(code)
            question = QUESTIONS.get(key)
            if question is None:
                self.see(code, frame.f_globals, key)
            else:
                question(self, frame.f_locals)
        elif event == "c_call" and argument.__name__ in _C_NAMES:
            reason = _reason_of(argument, frame.f_code)
            if reason == "working folder":
                self.ask("working folder", "")
            elif reason is not None:
                self.refuse(reason)


_current: ContextVar[Trace | None] = ContextVar("trace of a compilation", default=None)

QUESTIONS: dict[int, Callable[[Trace, Any], None]] = {}
"""The number of a code object → what notes its question, given the trace and the arguments by name. Filled by `questions`."""
OBSERVERS: list[Callable[[Trace, CodeType, dict[str, Any]], None]] = []
"""Called for each function of the user's that runs for the compiler, once for a form: with the trace, its code and its globals."""
CALLS: list[Callable[[Trace, Any, tuple[Any, ...]], None]] = []
"""Called with the trace, the function and the arguments of each call that `run` makes."""
_asking: list[CodeType] = []  # numbers are keys, so they stay


def questions(function: Any, note: Callable[[Trace, Any], None]) -> None:
    """A call of ``function``, one of Python, is a question about the world. note: called with the trace and the arguments by name."""
    code = getattr(function, "__code__", None)
    if code is not None:
        _asking.append(code)
        QUESTIONS[id(code)] = note


_loaded: dict[str, tuple[str, Facts, str | None]] = {}
"""Path of each module that was loaded through the keeper → the checksum of its text, what it depends on, why it cannot be kept."""


def loaded(path: str, text: bytes, facts: Facts, reason: str | None = None) -> None:
    """The module ``path`` is loaded now, whose source is ``text``. facts, reason: of the trace of its compilation."""
    from .digests import sha256

    _loaded[path] = sha256(text).hexdigest(), facts, reason


def _checksum(path: str) -> str | None:
    from .digests import sha256

    try:
        with open(path, "rb") as file:
            return sha256(file.read()).hexdigest()
    except OSError:
        return None


def current() -> Trace | None:
    """The trace of the compilation that is at work now; ``None`` if nobody traces."""
    return _current.get()


def run(function: Callable[..., Any], *arguments: Any) -> Any:
    """The value of ``function(*arguments)``, which is code of the user's that a compiler calls."""
    trace = _current.get()
    if trace is None or trace.watches or trace.reason is not None or _is_ours(function):
        return function(*arguments)
    for note in CALLS:
        note(trace, function, arguments)
    with _watched(trace):
        return function(*arguments)


@contextmanager
def watched() -> Iterator[None]:
    """The block is code of the user's that a compiler runs, as `run` has it."""
    trace = _current.get()
    if trace is None or trace.watches or trace.reason is not None:
        yield
    else:
        with _watched(trace):
            yield


@contextmanager
def _watched(trace: Trace) -> Iterator[None]:
    if sys.getprofile() is not None:
        trace.refuse("a profiler was at work while it was compiled")
        yield
        return
    trace.watches = True
    sys.setprofile(trace.hear)
    try:
        yield
    finally:
        sys.setprofile(None)
        trace.watches = False


@contextmanager
def tracing(audited: bool = False) -> Iterator[Trace]:
    """A new trace, for the file that is compiled in the block. A trace that is there learns all that it finds: its file needs this one."""
    _prepare()
    outer = _current.get()
    trace = Trace(audited)
    with _with(trace):
        yield trace
    if outer is not None:
        outer.include(trace.facts, trace.reason)


def untraced() -> AbstractContextManager[None]:
    """What happens in the block is no part of a compilation."""
    return _NO_TRACE if _current.get() is None else _with(None)


_NO_TRACE: AbstractContextManager[None] = nullcontext()


@contextmanager
def _with(trace: Trace | None) -> Iterator[None]:
    outer = _current.get()
    pauses = outer is not None and outer.watches
    if pauses:
        sys.setprofile(None)
    token = _current.set(trace)
    try:
        yield
    finally:
        _current.reset(token)
        if pauses and outer is not None:
            sys.setprofile(outer.hear)


# ---------------------------------------------------------------------------------------------------------- what is asked


_CLOCK, _CHANCE, _PROCESS = "it looks at the clock", "it depends on chance", "it looks at the process or the machine"
_REASONS: dict[tuple[str | None, str], str] = {
    **{
        ("time", name): _CLOCK
        for clock in ("time", "monotonic", "perf_counter", "process_time", "thread_time")
        for name in (clock, f"{clock}_ns")
    },
    **{("time", name): _CLOCK for name in ("localtime", "gmtime", "ctime", "strftime", "asctime")},
    **{(module, name): _CHANCE for module in ("posix", "nt") for name in ("urandom", "getrandom")},
    **{
        (module, name): _PROCESS
        for module in ("posix", "nt")
        for name in "getpid getppid uname times getloadavg cpu_count getlogin getuid geteuid getgid".split()
    },
    **{(module, name): "working folder" for module in ("posix", "nt") for name in ("getcwd", "getcwdb")},
    **{(module, name): "it looks at a file with os." + name for module in ("posix", "nt") for name in ("stat", "lstat", "access")},
    ("_socket", "gethostname"): _PROCESS,
    ("_uuid", "generate_time_safe"): _CHANCE,
}
_C_NAMES = frozenset(
    "now utcnow today random getrandbits randbytes rand randn randint choice shuffle normal uniform integers standard_normal".split()
) | {name for _, name in _REASONS}
_NUMPY_RANDOM = "numpy.random"


def _reason_of(function: Any, caller: CodeType) -> str | None:
    """Why code that calls the function in C cannot be kept, or "working folder"; ``None`` if it can."""
    name, owner = function.__name__, getattr(function, "__self__", None)
    if name in ("stat", "lstat", "access") and is_library(caller.co_filename):
        return None  # `_python_questions` has those that matter
    reason = _REASONS.get((function.__module__, name))
    if reason is not None:
        return reason
    if name in ("now", "utcnow", "today"):
        return _CLOCK if isinstance(owner, type) and owner.__module__ == "datetime" else None
    kinds = type(owner).__mro__ if owner is not None else ()
    chance = any(kind.__module__.startswith(("random", "_random", _NUMPY_RANDOM)) for kind in kinds)
    return _CHANCE if chance else None


_EVENTS_OF_FILES = {"os.listdir": "folder", "os.scandir": "folder"}
_EVENTS_OF_IMPORTS = frozenset(("open", "os.listdir", "os.scandir"))
_REFUSED_EVENTS = {
    **dict.fromkeys(
        ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.fork", "os.forkpty", "pty.spawn"),
        "it starts another process",
    ),
    **dict.fromkeys(
        ("socket.connect", "socket.bind", "socket.getaddrinfo", "socket.gethostbyname", "socket.sendto", "socket.gethostname"),
        "it uses the network",
    ),
    "urllib.Request": "it uses the network",
    "builtins.input": "it asks somebody at the terminal",
    "sqlite3.connect": "it uses a database",
    **dict.fromkeys(("os.putenv", "os.unsetenv"), "compiling it changes the environment"),
}
_CHANGES = frozenset(
    ("os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.truncate", "os.chmod", "os.chown", "os.utime")
)
_HEARD = _EVENTS_OF_IMPORTS | _REFUSED_EVENTS.keys() | _CHANGES
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC


def _heard(event: str, arguments: tuple[Any, ...]) -> None:
    """What Python's audit events tell."""
    if event not in _HEARD:  # there are many, and this is called for each from the first compilation on
        return
    trace = _current.get()
    if trace is None or trace._answers or not (trace.watches or trace.audited):
        return
    if event in _EVENTS_OF_IMPORTS and sys._getframe(1).f_code.co_filename.startswith("<frozen importlib"):
        return  # of modules, `include_modules` tells
    if event == "open":
        path, mode, flags = arguments
        if isinstance(path, int) or _is_kept_code(path):
            return
        if isinstance(mode, str) and set(mode) & set("wax+") or isinstance(flags, int) and flags & _WRITES:
            if not is_library(_text(path)):
                trace.refuse(f"compiling it writes {_text(path)}")
        else:
            trace.ask_path("file", path)
    elif event in _EVENTS_OF_FILES:
        trace.ask_path("folder", "." if arguments[0] is None else arguments[0])
    elif event in _REFUSED_EVENTS:
        trace.refuse(_REFUSED_EVENTS[event])
    elif event in _CHANGES and not _is_kept_code(arguments[0]):
        trace.refuse(f"compiling it changes {_text(arguments[0])}")


def _text(path: Any) -> str:
    return os.fsdecode(path) if isinstance(path, (str, bytes, os.PathLike)) else str(path)


def _is_kept_code(path: Any) -> bool:
    return "__pycache__" in _text(path)


def _ask_of_path(kind: str, name: str) -> Callable[[Trace, Any], None]:
    return lambda trace, arguments: trace.ask_path(kind, arguments[name])


def _python_questions() -> None:
    """Functions of Python's library that ask something."""
    import genericpath
    import pathlib
    import posixpath

    for module in (genericpath, posixpath):
        for name, kind in (
            ("exists", "existence"),
            ("lexists", "existence"),
            ("isfile", "existence"),
            ("isdir", "existence"),
            ("islink", "existence"),
            ("getsize", "status"),
            ("getmtime", "status"),
            ("getctime", "status"),
            ("getatime", "status"),
        ):
            function = getattr(module, name, None)
            code = getattr(function, "__code__", None)
            if code is not None:
                questions(function, _ask_of_path(kind, code.co_varnames[0]))
    for name in ("stat", "lstat", "exists", "is_file", "is_dir", "is_symlink"):
        function = getattr(pathlib.Path, name, None)
        if function is not None:
            questions(function, _ask_of_path("status" if name.endswith("stat") else "existence", "self"))
    variables = type(os.environ)
    questions(variables.__getitem__, lambda trace, arguments: trace.ask("environment", _text(arguments["key"])))
    for name in ("__iter__", "__len__", "copy"):
        questions(getattr(variables, name), lambda trace, arguments: trace.ask("environment", None))


@functools.cache
def _prepare() -> None:
    """Begin to hear Python's audit events. There is no end to that, so it begins with the first compilation."""
    _python_questions()
    sys.addaudithook(_heard)


# ----------------------------------------------------------------------------------------------------------- whose code it is


@functools.cache
def _library_folders() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """(folders of Python, of cramhy and of what pip has installed; folders in them that are the user's)"""
    import site  # Python's start has imported it; sysconfig would read a table of a thousand values at each start
    from importlib.util import find_spec

    ours = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    installed = [folder for folder in site.getsitepackages() if folder != sys.prefix]  # which Windows names, too
    folders = {ours, os.path.dirname(os.__file__), *installed}
    for name in ("cramhy", "hy"):
        spec = find_spec(name)
        folders.update(spec.submodule_search_locations or () if spec is not None else ())
    folders |= {os.path.realpath(folder) for folder in folders}
    return tuple(f"{folder}{os.sep}" for folder in sorted(folders)), (f"{ours}{os.sep}tutorials{os.sep}",)


@functools.lru_cache(4096)
def is_library(path: str) -> bool:
    """Whether the file ``path`` comes with Python, with cramhy, or with another package: their versions tell what is in it."""
    if path.startswith("<"):
        return path.startswith("<frozen") or ", text " in path  # what cramhy has written itself
    libraries, users = _library_folders()
    return _is_kept_code(path) or path.startswith(libraries) and not path.startswith(users)


def _is_ours(function: Any) -> bool:
    code = getattr(getattr(function, "source", function), "__code__", None)
    return code is not None and is_library(code.co_filename)


def may_have_changed(path: str) -> bool:
    """Whether the file ``path`` may have changed after this process began, so that what was read of it then may be another text."""
    try:
        return os.stat(path).st_mtime_ns >= _BEGAN - _TICK
    except OSError:
        return True


__all__ = [
    "CALLS",
    "OBSERVERS",
    "QUESTIONS",
    "Trace",
    "current",
    "is_library",
    "loaded",
    "may_have_changed",
    "questions",
    "run",
    "tracing",
    "untraced",
    "watched",
]
