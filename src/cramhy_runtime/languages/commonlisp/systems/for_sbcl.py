"""Which files of systems are read with the feature SBCL: those that then name nothing of SBCL that is not here.

A portable library says with ``#+sbcl`` and ``#-sbcl`` what it takes from SBCL and what it does on a Lisp that it does not know; some are
only for Lisps that they know. The packages of SBCL are here to a part. So a system is read as for SBCL if it takes from these packages only
what is there, and as for an unknown Lisp otherwise. The feature holds for the files of that system alone.
"""

from __future__ import annotations

import re
from contextlib import contextmanager

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Character, Cons, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import KEYWORD, named_package
from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from cramhy_runtime.storage.dependencies import file_state, unchanged

from ..reader.dispatch_macros import FEATURES, IMPLIED_FEATURES, with_features
from ..reader.reader_errors import QuietFailure
from ..reader.readtables import READTABLE, Readtable, copy_readtable, set_dispatch_macro_character
from ..reader.text_reader import PACKAGE, SUPPRESS, Reader
from ..syntax.backquote import Comma

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from cramhy_runtime.lisp_core.data import Value

OF_SBCL = tuple(IMPLIED_FEATURES["SBCL"])
_NAMES = late_pattern(r"\bsb-[-a-z0-9]+::?[^\s()'\"`,;|#]+", re.IGNORECASE)
_SPOKEN_OF = late_pattern(r"\bsbcl\b|\bsb-", re.IGNORECASE)
_found: dict[str, tuple[Value, frozenset[str] | None]] = {}
"""File → its state, and the names of SBCL's packages in it when it is read with the feature SBCL; none if it does not speak of SBCL."""


class NamesReader(Reader):
    """Reads forms as `Reader` does, but tokens are strings, and nothing is interned, evaluated or made.

    ``names``: the tokens with a package of SBCL, as ``SB-EXT:GC``, without those that the features leave out.
    """

    def __init__(self, text: str, filename: str) -> None:
        super().__init__(text, filename)
        self.quiet = True
        self.names: set[str] = set()

    def _token(self, word: str, start: int, table: Readtable) -> Value:
        if PACKAGE.value is KEYWORD:  # the feature expression behind #+
            return super()._token(word, start, table)
        if SUPPRESS.value is None and word[:3].lower() == "sb-" and ":" in word:
            self.names.add(word.upper().replace("::", ":"))
        return word

    def _escaped_token(self, start: int, table: Readtable) -> Value:
        self.offset = start
        return self.token_parts()[2]


def _read_over(stream: NamesReader, sub: Value, argument: Value) -> str:
    stream.required()
    return "#"


def readtable_of_names() -> Readtable:
    """The standard one, in which nothing behind ``#`` is evaluated or made."""
    table = copy_readtable(None)
    for char in ".SPCA":
        set_dispatch_macro_character(Character("#"), Character(char), _read_over, table)
    return table


def names_of_sbcl(path: Path) -> frozenset[str] | None:
    """The names of SBCL's packages that the file ``path`` has when it is read with the feature SBCL; ``None`` if it does not speak of SBCL.

    They are written as ``SB-EXT:GC``, and a package that it uses as ``SB-EXT:``. Where its text cannot be read without loading what comes
    before it, all that look so count.
    """
    key = str(path)
    known = _found.get(key)
    if known is None or not unchanged(path, known[0]):
        try:
            known = _found[key] = (file_state(path), _names_in(path, path.read_text(encoding="utf-8", errors="replace")))
        except OSError:
            return None  # that the file is missing, loading it says
    return known[1]


def _names_in(path: Path, text: str) -> frozenset[str] | None:
    if not speaks_of_sbcl(text):
        return None
    reader, end = NamesReader(text, str(path)), object()
    try:
        with binding(READTABLE, readtable_of_names(), FEATURES, with_features(("SBCL",))):
            while (form := reader.read(False, end)) is not end:
                reader.names.update(_taken_by_package(form))
    except (Condition, QuietFailure):
        return frozenset(name.upper().replace("::", ":") for name in _NAMES.findall(text))
    return frozenset(reader.names)


def speaks_of_sbcl(text: str) -> bool:
    """Whether a text may say something else with the feature SBCL than without."""
    return _SPOKEN_OF.search(text) is not None


def _taken_by_package(form: Value) -> Iterator[str]:
    """What the options ``:use`` and ``:import-from`` in a form take from packages of SBCL. A form may be circular."""
    seen: set[int] = set()
    waiting = [form]
    while waiting:
        form = waiting.pop()
        if not isinstance(form, Cons) or id(form) in seen:
            continue
        seen.add(id(form))
        head, rest = form.car, form.cdr
        waiting += (rest, head)
        if isinstance(head, str) and head.lower() in (":use", ":import-from") and isinstance(rest, Cons):
            names = [str(item).lstrip("#:").upper() for item in _elements(rest) if not isinstance(item, (Cons, Comma))]
            if head.lower() == ":use":
                yield from (f"{name}:" for name in names if name.startswith("SB-"))
            elif names and names[0].startswith("SB-"):
                yield from (f"{names[0]}:{name}" for name in names[1:])


def _elements(lst: Value) -> Iterator[Value]:
    """The elements of a list, each cons once: behind the first one that comes again nothing is new."""
    seen: set[int] = set()
    while isinstance(lst, Cons) and id(lst) not in seen:
        seen.add(id(lst))
        yield lst.car
        lst = lst.cdr


def is_here(name: str) -> bool:
    """Whether a name as those of `names_of_sbcl` means something here."""
    package_name, _, symbol_name = name.partition(":")
    package = named_package(package_name)
    return package is not None and (not symbol_name or package.lookup(symbol_name)[1] is not None)


def lacking(paths: Iterable[Path]) -> list[str] | None:
    """What the files name of SBCL when they are read for it, and is not here; sorted. ``None`` if no file speaks of SBCL."""
    names = [found for path in paths if (found := names_of_sbcl(path)) is not None]
    return sorted({name for found in names for name in found if not is_here(name)}) if names else None


@contextmanager
def read_for_sbcl(wanted: bool) -> Iterator[None]:
    """Give ``*features*`` SBCL and what it implies, or take that away. What is pushed on ``*features*`` meanwhile stays there."""
    before = list(FEATURES.value or ())
    inside = list(with_features(("SBCL",))) if wanted else [each for each in before if each.name not in OF_SBCL]
    after = inside
    try:
        with binding(FEATURES, list_from(inside)):
            try:
                yield
            finally:
                after = list(FEATURES.value or ())
    finally:
        gone = [each for each in inside if each not in after]
        FEATURES.value = list_from([*(each for each in after if each not in inside), *(each for each in before if each not in gone)])


__all__ = ["NamesReader", "is_here", "lacking", "names_of_sbcl", "read_for_sbcl", "readtable_of_names", "speaks_of_sbcl"]
