"""The code of functions by their qualified names: what an error needs that names a function, and not how many arguments it takes.

Python says ``toplevel.<locals>.<lambda>() missing 1 required positional argument: 'y'``. A session that runs compiled code notes it here
(`note_code`), which costs nothing when the code is called. Code is held weakly: it goes with the last function that runs it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from types import CodeType, TracebackType
from weakref import ref


class _NotedCodes:
    """Weak references to codes, in the order in which they were noted. Dead ones are dropped when the list has doubled."""

    __slots__ = ("references", "full")
    MARGIN = 1024

    def __init__(self):
        self.references: list[ref[CodeType]] = []
        self.full = self.MARGIN

    def drop_dead(self) -> None:
        self.references = [reference for reference in self.references if reference() is not None]
        self.full = 2 * len(self.references) + self.MARGIN


_noted = _NotedCodes()


def note_code(code: CodeType) -> None:
    """Note the functions that the compiled form ``code`` contains. It runs for each form of a file, so it sorts nothing."""
    if len(_noted.references) > _noted.full:
        _noted.drop_dead()
    _note(code, _noted.references.append)


def _note(code: CodeType, append: Callable[[ref[CodeType]], None]) -> None:
    for inner in code.co_consts:
        if inner.__class__ is CodeType:
            append(ref(inner))
            _note(inner, append)


def codes_named(name: str, traceback: TracebackType | None) -> Iterator[CodeType]:
    """The codes of functions called ``name``: noted ones, the newest first; those that an exception passed; those of Python's modules."""
    for reference in reversed(_noted.references):
        code = reference()
        if code is not None and code.co_qualname == name:
            yield code
    while traceback is not None:
        yield from _inside(traceback.tb_frame.f_code, name)
        traceback = traceback.tb_next
    first, *rest = name.partition(".<locals>")[0].split(".")
    for module in list(sys.modules.values()):
        thing = getattr(module, "__dict__", {}).get(first)
        for part in rest:
            thing = vars(thing).get(part) if isinstance(thing, type) else None
        code = getattr(getattr(thing, "__func__", thing), "__code__", None)
        if isinstance(code, CodeType):
            yield from _inside(code, name)


def _inside(code: CodeType, name: str) -> Iterator[CodeType]:
    """``code`` and the codes in it that have the qualified name ``name``."""
    waiting = [code]
    while waiting:
        code = waiting.pop()
        if code.co_qualname == name:
            yield code
        waiting += [constant for constant in code.co_consts if isinstance(constant, CodeType)]


def files_noted() -> list[str]:
    """The names of the files that living functions were compiled from, each once, in the order in which they were noted last.

    Not first: a function that was defined again may live on, unseen, until the collector comes.
    """
    found: dict[str, None] = {}
    for reference in _noted.references:
        if (code := reference()) is not None:
            found.pop(code.co_filename, None)
            found[code.co_filename] = None
    return list(found)
