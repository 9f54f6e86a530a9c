"""Wild pathnames: which files ``/a/**/*.lisp`` means, and what becomes of one that moves to ``/b/**/*.fasl`` (ANSI 19.2.2.2, 19.4)."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Symbol, list_from
from cramhy_runtime.lisp_core.packages import keyword
from .pathname_objects import WILD, WILD_INFERIORS, LogicalPathname, Pathname, Pattern
from .pathnames import customary, pathname

LISP_NAMES = "wild-pathname-p pathname-match-p translate-pathname"

_FIELDS = "HOST DEVICE DIRECTORY NAME TYPE VERSION"
_KEYS = {keyword(name): name.lower() for name in _FIELDS.split()}


def is_wild(part):
    """Whether a component, or one in a directory, is wild."""
    if isinstance(part, tuple):
        return any(map(is_wild, part))
    return part is WILD or part is WILD_INFERIORS or isinstance(part, Pattern)


def wild_pathname_p(designator, field=None):
    """``wild-pathname-p``: whether the pathname, or its component ``field``, has wild cards."""
    path = pathname(designator)
    if field is None:
        parts = [getattr(path, name) for name in _KEYS.values()]
    elif isinstance(field, Symbol) and field in _KEYS:
        parts = [getattr(path, _KEYS[field])]
    else:
        return type_error(field, "(MEMBER NIL :HOST :DEVICE :DIRECTORY :NAME :TYPE :VERSION)")
    return True if any(map(is_wild, parts)) else None


def component_matches(part, wild):
    """Whether the component ``part`` is one of those that ``wild`` means."""
    if wild is WILD or part is wild or part.__class__ is wild.__class__ and part == wild:
        return True
    return isinstance(wild, Pattern) and isinstance(part, str) and wild.match(part) is not None


def directory_matches(parts, wild):
    """The same for the tuples of two directories, without :absolute or :relative."""
    if not wild:
        return not parts
    if wild[0] is WILD_INFERIORS:
        return any(directory_matches(parts[index:], wild[1:]) for index in range(len(parts) + 1))
    return bool(parts) and component_matches(parts[0], wild[0]) and directory_matches(parts[1:], wild[1:])


def pathname_match_p(designator, wildcard):
    """``pathname-match-p``: whether ``wildcard`` means the pathname. What it leaves out is no matter."""
    path, wild = pathname(designator), pathname(wildcard)
    if path.host is not wild.host:
        return None
    mine, theirs = path.directory, wild.directory
    if theirs is not None and not (mine and mine[0] is theirs[0] and directory_matches(mine[1:], theirs[1:])):
        return None
    parts = ("device", "name", "type") + (("version",) if isinstance(wild, LogicalPathname) else ())
    pairs = [(getattr(path, part), getattr(wild, part)) for part in parts]
    return True if all(theirs is None or component_matches(mine, theirs) for mine, theirs in pairs) else None


# ------------------------------------------------------------------------------------------------------------ translation


def _mismatch(source, from_):
    shown = [list_from(part) if isinstance(part, tuple) else part for part in (source, from_)]
    return error("Pathname components from SOURCE and FROM args to TRANSLATE-PATHNAME~%did not match:~%  ~S ~S", *shown)


def _substituted(pattern, values):
    """``pattern`` with ``values``, a list that is used up, for its wild pieces."""
    pieces = []
    for piece in pattern.pieces:
        if piece.__class__ is not str:
            if not values:
                return error("not enough wildcards in FROM pattern to match TO pattern:~%  ~S", pattern)
            piece = values.pop(0)
            if piece.__class__ is not str:
                return error("can't substitute this into the middle of a word:~%  ~S", list_from(piece))
        pieces.append(piece)
    return "".join(pieces)


def _component(source, from_, to, changed):
    if to is None or to is WILD:
        return changed(source)
    if isinstance(to, Pattern):
        found = (
            from_.match(source)
            if isinstance(from_, Pattern) and isinstance(source, str)
            else [source]
            if from_ is WILD
            else []
            if source == from_
            else None
        )
        return _mismatch(source, from_) if found is None else _substituted(to, [changed(each) for each in found])
    return to if component_matches(source, from_) or from_ is None else _mismatch(source, from_)


def _directory_values(source, from_):
    """What the wild parts of ``from_`` stand for in ``source``: a list, with a list for each ``**``."""
    values, rest, wilds = [], list(source), list(from_)
    while rest:
        if not wilds:
            return _mismatch(source, from_)
        wild = wilds.pop(0)
        if wild is WILD_INFERIORS:
            here = []
            while not directory_matches(tuple(rest), tuple(wilds)):
                if not rest:
                    return _mismatch(source, from_)
                here.append(rest.pop(0))
            values.append(here)
            continue
        part = rest.pop(0)
        if wild is WILD:
            values.append(part)
        elif isinstance(wild, Pattern) and isinstance(part, str) and wild.match(part) is not None:
            values += wild.match(part)
        elif part != wild:
            return _mismatch(source, from_)
    if any(wild is not WILD_INFERIORS for wild in wilds):
        return _mismatch(source, from_)
    return values + [[] for _ in wilds]


def _directory(source, from_, to, changed):
    if not (source and from_ and to):
        return to or (source and tuple(map(changed, source)))
    values, result = _directory_values(source[1:], from_[1:]), [to[0]]
    for part in to[1:]:
        if part is WILD or part is WILD_INFERIORS:
            value = values.pop(0) if values else None
            if value is None or isinstance(value, list) is (part is WILD):
                return error(":WILD-INFERIORS is not paired in from and to patterns:~%  ~S ~S", list_from(from_), list_from(to))
            result += map(changed, value if isinstance(value, list) else [value])
        elif isinstance(part, Pattern):
            result.append(_substituted(part, values))
        else:
            result.append(part)
    return tuple(result)


def translate_pathname(source, from_wildname, to_wildname):
    """``translate-pathname``: what ``source``, which ``from_wildname`` means, is called by ``to_wildname``."""
    path, from_, to = map(pathname, (source, from_wildname, to_wildname))
    # from the upper case of logical pathnames to the customary lower case of files
    changed = customary if isinstance(path, LogicalPathname) is not isinstance(to, LogicalPathname) else lambda part: part
    parts = {name: _component(getattr(path, name), getattr(from_, name), getattr(to, name), changed) for name in ("device", "name", "type")}
    logical = isinstance(to, LogicalPathname)
    device = parts.pop("device") if logical else to.device
    version = path.version if to.version in (None, WILD) else to.version
    return (LogicalPathname if logical else Pathname)(
        to.host,
        device,
        _directory(path.directory, from_.directory, to.directory, changed),
        version=version,
        **{name: parts[name] for name in ("name", "type")},
    )
