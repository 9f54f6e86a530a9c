"""Pathnames as objects: names of files taken apart into host, device, directory, name, type and version (ANSI 19.2).

A component is a string, ``None``, a keyword such as ``:wild``, or a `Pattern` (``"b*"``); a directory is a tuple that begins with
``:absolute`` or ``:relative``. Unlike a ``pathlib`` path, ``a/`` and ``a`` differ here, as in Lisp; ``pathlib`` paths that Python
code hands in are accepted wherever a pathname is. A `Pathname` is itself accepted by Python's ``open`` and ``pathlib.Path``.
This is the ground: how names are written is in ``namestrings.py``, what is done with them in ``pathnames.py``.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.packages import keyword

ABSOLUTE, RELATIVE, UP, BACK, HOME = map(keyword, "ABSOLUTE RELATIVE UP BACK HOME".split())
WILD, WILD_INFERIORS, NEWEST, UNSPECIFIC = map(keyword, "WILD WILD-INFERIORS NEWEST UNSPECIFIC".split())


class UnixHost:
    """The one host of ordinary files."""

    lisp_name = "SB-IMPL::UNIX-HOST"


class LogicalHost:
    """A host of logical pathnames: ``rules`` is a list of (pattern, target), both pathnames."""

    lisp_name = "SB-KERNEL::LOGICAL-HOST"

    def __init__(self, name):
        self.name = name
        self.rules = []


UNIX = UnixHost()


class Pattern:
    """A component with wild cards in it: pieces are strings, ``"*"`` as :multi-char-wild, ``"?"`` as :single-char-wild, or a
    pair (:character-set, characters).
    """

    lisp_name = "SB-IMPL::PATTERN"

    def __init__(self, pieces):
        self.pieces = tuple(pieces)

    def match(self, text):
        """What the wild pieces stand for if ``text`` fits, a list, the first ones as long as they can be; else ``None``.

        It takes no longer for several ``*``: at which places the last pieces fit is known before the ones in front of them are tried.
        """
        fits = [{len(text)}]
        for piece in reversed(self.pieces):
            fits.append(_places(piece, text, fits[-1]))
        if 0 not in fits.pop():
            return None
        at, found = 0, []
        for piece, after in zip(self.pieces, reversed(fits), strict=True):
            end = at + len(piece) if piece.__class__ is str else max(after) if piece is MULTI_CHAR else at + 1
            if piece.__class__ is not str:
                found.append(text[at:end])
            at = end
        return found

    def __eq__(self, other):
        return isinstance(other, Pattern) and self.pieces == other.pieces

    def __hash__(self):
        return hash(self.pieces)


MULTI_CHAR, SINGLE_CHAR, CHARACTER_SET = map(keyword, "MULTI-CHAR-WILD SINGLE-CHAR-WILD CHARACTER-SET".split())


def _places(piece, text, after):
    """Where in ``text`` a piece fits, so that what follows it begins at one of the places ``after``."""
    if piece is MULTI_CHAR:
        return set(range(max(after) + 1)) if after else set()
    if piece.__class__ is str:
        return {end - len(piece) for end in after if end >= len(piece) and text.startswith(piece, end - len(piece))}
    wild = re.compile("[" + re.sub(r"([\\\]\[^])", r"\\\1", piece[1]) + "]") if isinstance(piece, tuple) else re.compile(".", re.DOTALL)
    return {end - 1 for end in after if end and wild.match(text, end - 1)}


class Pathname:
    """The name of a file. Never changed after it was made; ``equal`` pathnames are ``==``."""

    lisp_name = "PATHNAME"

    def __init__(self, host=UNIX, device=None, directory=None, name=None, type=None, version=None):
        self.host, self.device, self.directory = host, device, directory
        self.name, self.type, self.version = name, type, version

    def replace(self, **parts):
        """This pathname with other ``parts``."""
        return type(self)(**{**vars(self), **parts})

    @property
    def key(self):
        return (self.host, self.device, self.directory, self.name, self.type)

    def __eq__(self, other):
        return isinstance(other, Pathname) and self.key == other.key

    def __hash__(self):
        return hash(self.key)

    def __fspath__(self):
        from .namestrings import native_namestring

        return native_namestring(self)

    def __str__(self):
        from .namestrings import namestring

        return namestring(self)

    def __repr__(self):
        return f"Pathname({str(self)!r})"


class LogicalPathname(Pathname):
    """A pathname of a `LogicalHost`; what it stands for is decided by the host's translations."""

    lisp_name = "LOGICAL-PATHNAME"

    @property
    def key(self):
        return (*super().key, self.version)


def parts_of_pathname(path):
    """What `pathname_of_parts` makes ``path`` of again: texts, keywords and lists, as compiled code can hold them."""

    def plain(part):
        return ["pattern", *map(plain, part.pieces)] if isinstance(part, Pattern) else list(part) if isinstance(part, tuple) else part

    directory = None if path.directory is None else [plain(part) for part in path.directory]
    host = path.host.name if isinstance(path.host, LogicalHost) else None
    return [host, path.device, directory, plain(path.name), plain(path.type), path.version]


def pathname_of_parts(host_named, host, device, directory, name, type, version):
    """The pathname of these parts; ``host_named`` gives the logical host of a name."""

    def part(plain):
        if not isinstance(plain, list):
            return plain
        return Pattern(map(part, plain[1:])) if plain[:1] == ["pattern"] else tuple(plain)

    cls, owner = (Pathname, UNIX) if host is None else (LogicalPathname, host_named(host))
    return cls(owner, device, directory if directory is None else tuple(map(part, directory)), part(name), part(type), version)
