"""Pathnames taken apart, put together and written (ANSI chapter 19).

Strings, ``pathlib`` paths and streams on files stand for pathnames. A string that begins with the name of a logical host is a
logical pathname. Results and texts are SBCL's; wild pathnames are in ``wild_pathnames.py``, logical hosts in
``logical_pathnames.py``, the files themselves in ``files/files.py``.
"""

from __future__ import annotations

import pathlib

from cramhy_runtime.kernel.images import per_image
from ..collections.sequence_types import bounds
from cramhy_runtime.lisp_core.conditions import SimpleTypeError, error, type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED, FreshString, LispString, MultipleValues, python_list
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import keyword
from ..streams.streams import Stream
from .namestrings import (
    NamestringParseError,
    directory_list,
    directory_text,
    file_text,
    logical_directory,
    namestring as text_of,
    native_namestring as native_text_of,
    parse_logical,
    parse_native,
    parse_unix,
)
from .pathname_objects import (
    ABSOLUTE,
    BACK,
    HOME,
    NEWEST,
    RELATIVE,
    UNIX,
    UNSPECIFIC,
    UP,
    WILD,
    WILD_INFERIORS,
    LogicalHost,
    LogicalPathname,
    Pathname,
    Pattern,
)

LISP_NAMES = """pathname pathnamep parse-namestring namestring file-namestring directory-namestring host-namestring enough-namestring
pathname-host pathname-device pathname-directory pathname-name pathname-type pathname-version merge-pathnames make-pathname"""
EXTENSION_NAMES = "native-namestring parse-native-namestring"
"""Names of the package SB-EXT."""

DESIGNATOR = "(OR STRING PATHNAME SYNONYM-STREAM FILE-STREAM)"
DEFAULTS = special("*DEFAULT-PATHNAME-DEFAULTS*", Pathname())

logical_hosts: dict = per_image({})
"""The hosts of logical pathnames by name, which is in upper case."""


def pathname(designator):
    """The pathname that a pathname, a string, a ``pathlib`` path or a stream on a file stands for."""
    if isinstance(designator, Pathname):
        return designator
    if isinstance(designator, (str, LispString)):
        return parsed(str(designator))
    if isinstance(designator, pathlib.PurePath):
        return parse_native(str(designator))
    if isinstance(designator, Stream):
        return _pathname_of_stream(designator)
    return type_error(designator, DESIGNATOR)


ON_NAMED_FILE = "(SATISFIES SB-IMPL::STREAM-FILE-STREAM)"
"""The type of streams that have a pathname."""


def _pathname_of_stream(stream):
    found = getattr(stream, "pathname", None)
    if found is not None:
        return found
    if getattr(stream, "lisp_name", "") not in ("SB-SYS::FD-STREAM", "SYNONYM-STREAM"):
        return type_error(stream, DESIGNATOR)
    text = "The stream~%  ~S~%is not associated with a named file."
    return error(SimpleTypeError(text, stream, datum=stream, expected_type=ON_NAMED_FILE))


def parsed(text):
    """The pathname written ``text``: logical if a known logical host stands before a colon, and the rest is fit for one."""
    host = logical_hosts.get(text.partition(":")[0].upper()) if ":" in text else None
    if host is None and isinstance(_defaults().host, LogicalHost):
        host, start = _defaults().host, 0
    else:
        start = text.find(":") + 1
    if host is not None:
        try:
            return parse_logical(host, text, start)
        except NamestringParseError:
            pass  # as in SBCL: then it is an ordinary file with a colon in its name
    return parse_unix(text)


def _defaults():
    value = DEFAULTS.value
    return value if isinstance(value, Pathname) else parse_native(str(value)) if isinstance(value, (str, pathlib.PurePath)) else Pathname()


def logical_host(designator):
    """The `LogicalHost` of that name. An unknown one is a type-error."""
    if isinstance(designator, LogicalHost):
        return designator
    if not isinstance(designator, (str, LispString)):
        return type_error(designator, "(OR STRING SB-KERNEL:LOGICAL-HOST)")
    found = logical_hosts.get(str(designator).upper())
    if found is None:
        expected = "(AND STRING (SATISFIES SB-IMPL::LOGICAL-HOST-NAME-P))"
        return error(SimpleTypeError("logical host not yet defined: ~S", designator, datum=designator, expected_type=expected))
    return found


def parse_namestring(thing, host=None, defaults=None, *, start=0, end=None, junk_allowed=None):
    """``parse-namestring``: the pathname, and where reading it ended."""
    if not isinstance(thing, (str, LispString)):
        path = pathname(thing)
        if host is not None and _host(host) is not path.host:
            return error("The HOST argument doesn't match the pathname host:~%  ~S and ~S.", _host(host), path.host)
        return MultipleValues((path, start or 0))
    text = str(thing)
    start, last = bounds(start or 0, end, len(text))
    text = text[start:last]
    try:
        owner = _host(host) if host is not None else None
        if owner is None:
            path = parsed(text)
        elif owner is UNIX:
            path = parse_unix(text)
        else:
            path = parse_logical(owner, text, text.find(":") + 1)
    except NamestringParseError as problem:
        if junk_allowed is None:
            return error(problem)
        return MultipleValues((None, (start or 0) + problem.offset))
    return MultipleValues((path, last))


def _host(designator):
    """The host that a host, a logical host or a string names; the empty string is the host of the files."""
    return UNIX if designator is UNIX or isinstance(designator, (str, LispString)) and not str(designator) else logical_host(designator)


def pathnamep(obj):
    return True if isinstance(obj, (Pathname, pathlib.PurePath)) else None


# ------------------------------------------------------------------------------------------------------------------ parts


def customary(part):
    """``part`` in the other case, as :case :common asks: ``"foo"`` is ``"FOO"``, and a word of both cases stays."""
    if not isinstance(part, str):
        return part
    return part.upper() if part == part.lower() else part.lower() if part == part.upper() else part


def in_case(part, case, path=None):
    """A component as the argument :case of ``pathname-name`` and its relatives asks; that of a logical pathname stays."""
    if case is UNSUPPLIED or case is None or case is keyword("LOCAL") or isinstance(path, LogicalPathname):
        return part
    if case is not keyword("COMMON"):
        return type_error(case, "(MEMBER :LOCAL :COMMON)")
    return tuple(map(customary, part)) if isinstance(part, tuple) else customary(part)


def pathname_host(designator, *, case=None):
    return pathname(designator).host


def pathname_device(designator, *, case=None):
    return in_case(pathname(designator).device, case)


def pathname_directory(designator, *, case=None):
    """A list of :absolute or :relative and the names of the folders; nil when there are none."""
    path = pathname(designator)
    return directory_list(in_case(path.directory, case, path))


def pathname_name(designator, *, case=None):
    path = pathname(designator)
    return in_case(path.name, case, path)


def pathname_type(designator, *, case=None):
    path = pathname(designator)
    return in_case(path.type, case, path)


def pathname_version(designator):
    return pathname(designator).version


# ------------------------------------------------------------------------------------------------------------- as strings


def namestring(designator):
    """``namestring``: the text that names the file. A pathname without one is a file-error."""
    return FreshString(text_of(pathname(designator)))


def file_namestring(designator):
    return FreshString(file_text(pathname(designator)))


def directory_namestring(designator):
    path = pathname(designator)
    return FreshString(logical_directory(path) if isinstance(path, LogicalPathname) else directory_text(path))


def host_namestring(designator):
    path = pathname(designator)
    return path.host.name if isinstance(path, LogicalPathname) else ""


def enough_namestring(designator, defaults=UNSUPPLIED):
    """``enough-namestring``: the shortest text that, merged with ``defaults``, names the file."""
    path = pathname(designator)
    base = _defaults() if defaults is UNSUPPLIED else pathname(defaults)
    given, prefix = path.directory, base.directory or ()
    device, folder = path.device, given
    if given and given[0] is not RELATIVE and prefix and given[: len(prefix)] == prefix and device in (None, base.device):
        device, folder = None, (RELATIVE, *given[len(prefix) :])
    if isinstance(path, LogicalPathname):
        return FreshString(text_of(path.replace(directory=folder)))
    needs_type = path.type is not None and path.type is not UNSPECIFIC
    needs_name = needs_type or path.name is not None and path.name != base.name
    if needs_name and path.name is None:
        return error("~S cannot be represented relative to ~S.", path, base)
    return FreshString(directory_text(path.replace(device=device, directory=folder)) + (file_text(path) if needs_name else ""))


def native_namestring(designator, *, as_file=None):
    """``sb-ext:native-namestring``: what the operating system calls the file."""
    text = native_text_of(pathname(designator))
    return FreshString(text.rstrip("/") or text if as_file is not None else text)


def parse_native_namestring(thing, host=None, defaults=None, *, start=0, end=None, junk_allowed=None, as_directory=None):
    """``sb-ext:parse-native-namestring``: the pathname of a file that the operating system calls so."""
    text = str(thing)[start:end]
    return MultipleValues((parse_native(text.rstrip("/") + "/" if as_directory is not None else text), start + len(text)))


# ------------------------------------------------------------------------------------------------------ putting together


def folders(directory):
    """The tuple for the :directory argument of ``make-pathname``. Errors: SIMPLE-ERROR with SBCL's text."""
    if directory is None:
        return None
    if directory is WILD:
        return (ABSOLUTE, WILD_INFERIORS)
    if isinstance(directory, (str, LispString)):
        return (ABSOLUTE, str(directory))
    if not hasattr(directory, "car"):
        return type_error(directory, "(OR STRING CONS (MEMBER :WILD NIL))")
    start, *parts = python_list(directory)
    if start is not ABSOLUTE and start is not RELATIVE:
        return error("List of directory components must start with ~S or ~S.", ABSOLUTE, RELATIVE)
    result = [start]
    for part in parts:
        if part is BACK and len(result) > 1 and (isinstance(result[-1], (str, Pattern)) or result[-1] is WILD):
            result.pop()
        elif isinstance(part, (str, LispString)):
            result.append(UP if str(part) == ".." else str(part))
        elif part in (UP, BACK, WILD, WILD_INFERIORS, HOME) or isinstance(part, Pattern):
            result.append(part)
        elif hasattr(part, "car") and part.car is HOME:
            result.append((HOME, str(part.cdr.car)))
        else:
            return error("~S is not allowed as a directory component.", part)
    return tuple(result)


_PART = "(OR STRING SB-IMPL::PATTERN (MEMBER NIL :UNSPECIFIC :WILD))"


def _checked(part):
    if isinstance(part, LispString):
        return str(part)
    if part is None or isinstance(part, (str, Pattern)) or part is WILD or part is UNSPECIFIC:
        return part
    return type_error(part, _PART)


def make_pathname(
    *,
    host=UNSUPPLIED,
    device=UNSUPPLIED,
    directory=UNSUPPLIED,
    name=UNSUPPLIED,
    type=UNSUPPLIED,
    version=UNSUPPLIED,
    defaults=None,
    case=UNSUPPLIED,
):
    """``make-pathname``: the pathname of these parts; those that are not given come from ``defaults``, nil if given as nil."""
    if version is not UNSUPPLIED and version.__class__ is not int and version not in (None, NEWEST, WILD, UNSPECIFIC):
        return type_error(version, "(OR INTEGER (MEMBER NIL :NEWEST :WILD :UNSPECIFIC))")
    base = Pathname() if defaults is None else pathname(defaults)
    owner = (base.host if defaults is not None else _defaults().host) if host is UNSUPPLIED or host is None else _host(host)
    path = Pathname(
        owner,
        base.device if device is UNSUPPLIED else device,
        base.directory if directory is UNSUPPLIED else in_case(folders(directory), case),
        base.name if name is UNSUPPLIED else in_case(_checked(name), case),
        base.type if type is UNSUPPLIED else in_case(_checked(type), case),
        base.version if version is UNSUPPLIED else version,
    )
    return _logical(path) if isinstance(owner, LogicalHost) else path


def _logical(path):
    """``path`` as a logical pathname: its words are in upper case, and of letters, digits and hyphens."""
    text = text_of(LogicalPathname(path.host, UNSPECIFIC, path.directory, path.name, path.type, path.version))
    return parse_logical(path.host, text, text.find(":") + 1)


def merged_directories(given, base):
    """The directory ``given`` as seen from the directory ``base``; :back takes the folder before it away."""
    if given and given[0] is ABSOLUTE or not base:
        return given
    result = list(base)
    for part in given[1:] if given else ():
        if part is BACK and len(result) > 1 and (isinstance(result[-1], (str, Pattern)) or result[-1] in (WILD, WILD_INFERIORS)):
            result.pop()
        else:
            result.append(part)
    return tuple(result)


def merge_pathnames(designator, defaults=UNSUPPLIED, default_version=NEWEST):
    """``merge-pathnames``: the pathname, with what it lacks taken from ``defaults`` (``*default-pathname-defaults*``)."""
    base = _defaults() if defaults is UNSUPPLIED or defaults is None else pathname(defaults)
    if isinstance(base.host, LogicalHost) and isinstance(designator, (str, LispString)) and ":" not in str(designator):
        path = parse_logical(base.host, str(designator))
    else:
        path = pathname(designator)
    owner = path.host
    version = path.version or (base.version if path.name is None else None) or default_version
    merged = Pathname(
        owner,
        path.device or base.device,
        merged_directories(path.directory, base.directory),
        path.name or base.name,
        base.type if path.type is None else path.type,
        version,
    )
    if not isinstance(owner, LogicalHost):
        return merged
    return LogicalPathname(**{**vars(merged), "device": UNSPECIFIC})
