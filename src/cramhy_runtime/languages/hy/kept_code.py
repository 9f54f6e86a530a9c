"""The bytecode of Hy files that Python keeps in ``__pycache__``, for the cramhy that has compiled it.

Python looks at the date of a source only. So code that another cramhy has made, with other macros, would go on being used, and call
functions that are no more. Python asks nobody before it runs a file of bytecode, and cramhy is loaded only when that code asks for it.
So the file of bytecode has little code of its own: a call of `run`, with the code that Hy made and the stamp of the cramhy whose macros are
in it. `run` runs that code, or compiles the source again when the stamp is another one, and keeps that.

`watch` changes the method by which Python's loader of source files writes (``set_data``), as Hy itself changes how it compiles. Code that
no macro of ours has seen is written as it was.
"""

from __future__ import annotations

import contextlib
import importlib.machinery
import importlib.util
import marshal
import sys
from types import CodeType
from typing import Any

import hy

from ..commonlisp.systems.loader import stamp

HEADER = 16  # bytes before the code in a file of bytecode
_CALL = "__import__('cramhy').kept_code.run(globals(), {made_by!r}, {filename!r}, {code!r})"

_filenames: set[str] = set()
"""The files that our macros have seen since Python began."""

_loader = importlib.machinery.SourceFileLoader
_set_data = _loader.set_data


def seen(filename: str) -> None:
    """Our macros are at work in the file of that name."""
    _filenames.add(filename)


def watch() -> None:
    """From now on Python writes the code of files that `seen` has been told of as a call of `run`."""
    _loader.set_data = _set_data_of_ours  # type: ignore[method-assign]


def _set_data_of_ours(self: Any, path: str, data: Any, **mode: int) -> None:
    _set_data(self, path, _guarded(bytes(data)), **mode)


def _guarded(data):
    """``data``, a file of bytecode, with the call of `run` for the code in it, if our macros have seen the source of that."""
    with contextlib.suppress(ValueError, EOFError, TypeError):
        code = marshal.loads(data[HEADER:])
        if isinstance(code, CodeType) and code.co_filename in _filenames:
            call = _CALL.format(made_by=_made_by(), filename=code.co_filename, code=data[HEADER:])
            return data[:HEADER] + marshal.dumps(compile(call, code.co_filename, "exec"))
    return data


def _made_by():
    return f"{stamp()} {hy.__version__}"


def unguarded(code: CodeType) -> CodeType:
    """The code that Hy has made, where ``code``, which Python's loader gives for a file, is the call of `run` with it."""
    guard = compile(_CALL.format(made_by="", filename="", code=b""), "", "exec")
    if code.co_names != guard.co_names:
        return code
    [kept] = [constant for constant in code.co_consts if isinstance(constant, bytes)]
    return marshal.loads(kept)


def run(namespace: dict[str, Any], made_by: str, filename: str, code: bytes) -> None:
    """Run ``code``, which was made from the file ``filename``, in a module's ``namespace``.

    made_by: what made it, a text. If that is not what there is now, the file is compiled again, if it is there still.
    """
    exec(marshal.loads(code) if made_by == _made_by() else _compiled_again(namespace, filename, code), namespace)


def calls_kept_code(frames: list[Any], index: int) -> bool:
    """Whether the frame at ``index`` is that of a file's own code, which calls `run`; Python gives it the name of the source."""
    code = run.__code__
    return any((frame.filename, frame.name) == (code.co_filename, code.co_name) for frame in frames[index + 1 : index + 2])


def _compiled_again(namespace, filename, code):
    loader = _loader(namespace.get("__name__", "__main__"), filename)
    try:
        source = loader.get_data(filename)
    except OSError:
        return marshal.loads(code)
    made = loader.source_to_code(source, filename)
    kept = importlib.util.cache_from_source(filename)
    with contextlib.suppress(OSError):
        if not sys.dont_write_bytecode:
            loader.set_data(kept, loader.get_data(kept)[:HEADER] + marshal.dumps(made))
    return made


__all__ = ["calls_kept_code", "run", "seen", "unguarded", "watch"]
