"""What the guide says of a function of the student's own that was defined behind another prompt, and so stands in another package.

A page of Lisp begins behind ``CL-USER>`` and goes on behind ``TUT>``. A form that was typed too early, or after a way back, defines a
function that the next form does not find.
"""

from __future__ import annotations

import re

from cramhy_runtime.languages.commonlisp.printer.print_controls import PACKAGE
from cramhy_runtime.languages.commonlisp.tools.advice import is_operator, users_package_with
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.packages import find_package

_DOTTED = re.compile(r"(?<![\w.:-])([a-z][\w-]*)\.([a-z][\w-]*)(?![\w.])")
_BEGIN = "COMMON-LISP-USER"


def of_name(name: str) -> str | None:
    """What to say of ``name``, which is not a function where the prompt is, if another package of the user's has one; else ``None``."""
    here = PACKAGE.value
    other, known = users_package_with(name.upper()), here.lookup(name.upper())[0]
    if other is None or other is here or (isinstance(known, Symbol) and is_operator(known)):
        return None
    there, shown = _short(other), name.lower()
    if here.name == _BEGIN:
        return f"; {shown} is a function of another package: after (in-package :{there.lower()}) the prompt is {there}> and knows it."
    return (
        f"; {shown} was defined behind {there}>, in another package. The prompt is {_short(here)}> now: type the definition again here. "
        "(Press the arrow key up until it is there.)"
    )


def of_dot(text: str, missing: str | None) -> str | None:
    """What to say of a form of Hy with a point between a package of CRAM and a name of it, ``cut.force-ll``; else ``None``.

    missing: the name without a meaning with which the form has failed. ``None``: all packages count, in data, where nothing is evaluated.
    """
    for before, name in _DOTTED.findall(text):
        package = find_package(before.upper()) if missing in (None, before) else None
        if package is not None and package.lookup(name.upper())[1] is not None:
            return f"; A colon stands between a package of CRAM and its name: {before}:{name}"
    return None


def _short(package):
    return min(package.names, key=len)


__all__ = ["of_dot", "of_name"]
