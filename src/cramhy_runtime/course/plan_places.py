"""What a check says of ``top-level`` in the wrong place: left out of a function whose plan it should be, or written around another one.

The messages of the plan language name the form that was being done. The student has to change another one: the function that was to be
written.
"""

from __future__ import annotations

import linecache
import re

from .trees import Listed, lists, read

_OUTSIDE = re.compile(
    r"^(?P<indent> *)(?:Functions with plan forms are called inside of a plan|Plan forms run inside of a plan): .*$", re.M
)
_NESTED = re.compile(r"^(?P<indent> *)This form runs inside a plan already: .*$", re.M)
_NESTED_PLACE = re.compile(r"^ +at (?!<)(?P<file>\S+?):(?P<line>\d+)(?::\d+)?\n(?: .*\n)*? *\^\n", re.M)
_CALLED = re.compile(r"\((?P<form>(?:top-level\s+\((?:seq\s|progn\s|do\s)?)?\(?(?P<name>[^\s()]+))[^\n]* ended with an error:")


def in_check(told: str, definition) -> str:
    """An error in a check, with what to do about ``top-level``; other texts as they are.

    told: what the check says of the error. definition: gives the form of the student that defines a name, or ``None``.
    """
    found = _CALLED.match(told)
    if found is None:
        return told
    name = found["name"]
    if not found["form"].startswith("top-level"):
        told = _OUTSIDE.sub(rf"\g<indent>Write top-level inside of {name}, around its forms.", told)
        return at_prompt(told, f"in {name}")
    if _NESTED.search(told) and _has_top_level(definition(name)):
        return _NESTED.sub(rf"\g<indent>Leave top-level away in {name}: the plan that calls it has one.", told)
    return at_prompt(told, f"in {name}")


def at_prompt(told: str, where: str = "around it") -> str:
    """An error with the name of the function in a file that has a ``top-level`` of its own, instead of its place; else ``told``.

    where: the student's own ``top-level`` is to be left away there.
    """
    place = _NESTED_PLACE.search(told)
    if place is None or not _NESTED.search(told):
        return told
    name = _defined_at(place["file"], int(place["line"]))
    if name is None:
        return told
    told = told[: place.start()] + told[place.end() :]
    return _NESTED.sub(rf"\g<indent>{name} has a top-level of its own: leave top-level away {where}.", told)


def _has_top_level(form):
    return form is not None and any(each.head == "top-level" for each in lists(read(form)) if isinstance(each, Listed))


def _defined_at(file, line):
    """The name of the function in a text of the course whose ``line`` it is."""
    whole = next((name for name in list(linecache.cache) if name == file or name.endswith(f"/{file}")), file)
    for text in reversed(linecache.getlines(whole)[:line]):
        found = re.match(r"\((?:defun|defn|def-cram-function)\s+([^\s()\[\]]+)", text)
        if found:
            return found[1]
    return None


__all__ = ["at_prompt", "in_check"]
