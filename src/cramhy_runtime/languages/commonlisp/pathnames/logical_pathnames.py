"""Logical pathnames: ``ROBOT:PLANS;DRIVE.LISP``, whose place is decided by a table of translations (ANSI 19.3).

(setf (logical-pathname-translations "ROBOT") '(("PLANS;*.*.*" "/plans/*.*")))
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Character
from cramhy_runtime.lisp_core.printing import prin1_to_string
from cramhy_runtime.lisp_core.conditions import SimpleFileError, SimpleTypeError, error, type_error
from cramhy_runtime.lisp_core.data import Cons, LispString, lisp_list, list_from, python_list
from cramhy_runtime.lisp_core.packages import sym
from .namestrings import NamestringParseError, parse_logical
from .pathname_objects import LogicalHost, LogicalPathname
from .pathnames import logical_host, logical_hosts, pathname
from .wild_pathnames import pathname_match_p, translate_pathname

LISP_NAMES = "logical-pathname logical-pathname-translations translate-logical-pathname load-logical-pathname-translations"

_WORD = "logical namestring character which is not alphanumeric or hyphen:\n  "


def _not_logical(designator, why):
    return error(
        SimpleTypeError(
            "~S is not a valid logical namestring:~%  ~A", designator, why, datum=designator, expected_type=sym("LOGICAL-PATHNAME")
        )
    )


def logical_pathname(designator):
    """``logical-pathname``: the logical pathname that a string names. One without a known host is a type-error."""
    if not isinstance(designator, (str, LispString)):
        path = pathname(designator)
        expected = "(OR STRING LOGICAL-PATHNAME SYNONYM-STREAM FILE-STREAM)" if path is designator else "LOGICAL-PATHNAME"
        return path if isinstance(path, LogicalPathname) else type_error(path, expected)
    text = str(designator)
    name, colon, _ = text.partition(":")
    if colon and name.upper() not in logical_hosts:
        return _not_logical(text, f"logical host not yet defined: {prin1_to_string(name.upper())}")
    host = logical_hosts.get(name.upper()) if colon else None
    try:
        path = parse_logical(host, text, len(name) + 1 if colon else 0)
    except NamestringParseError as problem:
        return _not_logical(text, problem.report())
    return path if host else _not_logical(text, "no host specified")


def logical_pathname_translations(host):
    """``logical-pathname-translations``: the rules of the host, a list of (from, to)."""
    return list_from([lisp_list(from_, to) for from_, to, _, _ in logical_host(host).rules])


def set_logical_pathname_translations(rules, host):
    """``(setf (logical-pathname-translations host) rules)`` makes the host if it is not there. Returns ``rules``."""
    if not isinstance(host, (LogicalHost, str, LispString)):
        return type_error(host, "(OR STRING SB-KERNEL:LOGICAL-HOST)")
    if rules is not None and not isinstance(rules, Cons):
        return type_error(rules, "LIST")
    if not isinstance(host, LogicalHost):
        name = str(host).upper()
        for index, character in enumerate(name):
            if not (character.isascii() and (character.isalnum() or character == "-")):
                return error(NamestringParseError(_WORD + prin1_to_string(Character(character)), name, index))
        host = logical_hosts.get(name) or LogicalHost(name)
    logical_hosts[host.name] = host
    host.rules = [_rule(host, rule) for rule in python_list(rules)]
    return rules


def _rule(host, rule):
    if not isinstance(rule, Cons) or len(python_list(rule)) != 2:
        return error(
            "~S is not a translation of a logical host: it has to be a list (FROM TO) of two namestrings, such as ~S.",
            rule,
            lisp_list("PLANS;*.*.*", "/plans/*.*"),
        )
    from_, to = python_list(rule)
    if isinstance(from_, (str, LispString)):
        text = str(from_)
        pattern = parse_logical(host, text, len(host.name) + 1 if text.upper().startswith(host.name + ":") else 0)
    else:
        pattern = pathname(from_)
    return from_, to, pattern, pathname(to)


def translate_logical_pathname(designator, *, allow_other_keys=None):
    """``translate-logical-pathname``: the pathname of the file; others than logical pathnames are what they are."""
    path = pathname(designator)
    for _ in range(100):  # one host may translate to another
        if not isinstance(path, LogicalPathname):
            return path
        rule = next((rule for rule in path.host.rules if pathname_match_p(path, rule[2]) is not None), None)
        if rule is None:
            return error(SimpleFileError(path, "no translation for ~S", path))
        path = translate_pathname(path, rule[2], rule[3])
    return error(SimpleFileError(path, "The translations of ~S lead in a circle.", path))


def load_logical_pathname_translations(host):
    """``load-logical-pathname-translations``: nil for a known host. We have no site file in which to look for another."""
    if not isinstance(host, (str, LispString)):
        return type_error(host, "STRING")
    if str(host).upper() in logical_hosts:
        return None
    return error(
        SimpleFileError(
            str(host),
            "There are no translations of the logical host ~S to load: define them with (SETF "
            "(LOGICAL-PATHNAME-TRANSLATIONS ~S) '((~S ~S))).",
            str(host),
            str(host),
            "**;*.*.*",
            "/folder/**/*.*",
        )
    )


SETTERS = {"LOGICAL-PATHNAME-TRANSLATIONS": set_logical_pathname_translations}
