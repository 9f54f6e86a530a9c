"""How forms of Hy are written, for those who have written them otherwise: mostly as in Common Lisp.

The operators of the plan language say their shape themselves. Here are Hy's own, and the words of Common Lisp that Hy has not.
"""

from __future__ import annotations

import builtins
import re
import sys

import hy

from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import COMMON_LISP, all_packages, find_package

HY = {
    "cond": "(cond test value ...)",
    "defclass": "(defclass Name [Base ...] form...)",
    "defmacro": "(defmacro name [parameter ...] form...)",
    "defn": "(defn name [parameter ...] form...)",
    "dfor": "(dfor name values key value)",
    "except": "(except [name Class] form...)",
    "fn": "(fn [parameter ...] form...)",
    "for": "(for [name values] form...)",
    "if": "(if test then else)",
    "in-hy": "(in-hy)",
    "in-package": "(in-package name)",
    "let": "(let [name value ...] form...)",
    "lfor": "(lfor name values value)",
    "lisp": "(lisp form)",
    "lisp-package": "(lisp-package name)",
    "match": "(match value pattern result ...)",
    "setv": "(setv name value ...)",
    "setx": "(setx name value)",
    "try": "(try form... (except [name Class] form...) (finally form...))",
    "when": "(when test form...)",
    "while": "(while test form...)",
    "with": "(with [name value] form...)",
}
"""Hy's own operators, and those that lead to Lisp and back, by their names."""

LISP = {
    "defconstant": "(setv name value)",
    "defgeneric": "functools.singledispatch, or a method of a class",
    "define-condition": "(defclass Name [SimplePlanFailure])",
    "defmethod": "(defn name [self parameter ...] form...) in a defclass",
    "defparameter": "(setv name value)",
    "defstruct": "(defclass Name [] ...)",
    "defun": "(defn name [parameter ...] form...)",
    "defvar": "(setv name value)",
    "destructuring-bind": "(setv [a b] values)",
    "dolist": "(for [name values] form...)",
    "dotimes": "(for [name (range count)] form...)",
    "flet": "(defn name [parameter ...] form...) where it is used",
    "funcall": "(function argument ...)",
    "handler-case": "(try form... (except [problem Class] form...))",
    "in-package": "(in-package name) at the beginning of a line, after (require cramhy *)",
    "incf": "(+= name 1)",
    "decf": "(-= name 1)",
    "labels": "(defn name [parameter ...] form...) where it is used",
    "lambda": "(fn [parameter ...] form...)",
    "let*": "(let [name value ...] form...)",
    "loop": "(for [name values] form...) or (while test form...)",
    "mapcar": "(lfor name values value)",
    "multiple-value-bind": "(setv [a b] values)",
    "nil": "None",
    "progn": "(do form...)",
    "push": "(.append values value)",
    "setf": "(setv name value)",
    "setq": "(setv name value)",
    "t": "True",
    "unless": "(when (not test) form...)",
    "unwind-protect": "(try form... (finally form...))",
}
"""Words of Common Lisp, and what a Hy program writes instead."""

_WHERE_LISP_IS = "Common Lisp begins after (in-package name)."

_LISP = {hy.mangle(name): name for name in LISP}
_OF_MESSAGES = ("-MSG", "-SRV")
_INSIDE = {
    "retry": "(retry) stands inside (with-failure-handling [clause...] form...), in a clause or among the forms.",
    "leave": "(leave value) stands inside (with-failure-handling [clause...] form...), in a clause.",
}
"""Names that mean something only in a certain place."""


def message(text, name):
    """The text of an error of Hy's compiler about a form of ``name``, or ``None``, without the forms in it as Python prints them."""
    found = re.match(r"parse error for pattern macro .*?: got unexpected (end of macro call|token).*expected: (.*)\Z", text, re.S)
    if not found:
        return text
    there = "it ends too early" if found[1] != "token" else "a part of it has another shape"
    return f"The {name} form is malformed: {there}; expected: {' '.join(found[2].split())}."


def hint(name):
    """How the form ``name`` is written, or ``None``."""
    shape = HY.get(name)
    return f"It is written {shape}." if shape else None


def hint_for_name(name, known, modules=None):
    """What to try where Python says that the name ``name`` is not defined. known: the names that are there. modules: of these, by name."""
    if name in _LISP:
        return f"{_LISP[name]} is Common Lisp. In Hy it is written {LISP[_LISP[name]]}. {_WHERE_LISP_IS}"
    written = hy.unmangle(name)
    if written in _INSIDE:
        return _INSIDE[written]
    if find_package(written.upper()) is not None:
        return f"{written} is a package of Lisp. A colon stands between it and a name of it, as in ({written}:name ...)."
    if hy.mangle(name) in builtins._hy_macros and not any(map(str.isalnum, written)):
        return f"{written} stands at the head of its form, as in ({written} 1 2)."
    for alias, module in (modules or {}).items():
        if hy.mangle(name) in vars(module) or (written.upper() not in COMMON_LISP.external and hasattr(module, hy.mangle(name))):
            return f"{written} is a name of {alias}: {alias}.{written}"
    if len(written) > 1 and hy.mangle(name) in {*builtins._hy_macros, *getattr(sys.modules.get("cramhy"), "_hy_macros", ())}:
        return f"{written} stands at the head of its form, as in ({written} ...)."
    if written.upper() in COMMON_LISP.external:
        return f"{written} is Common Lisp, and Hy has nothing of that name. {_WHERE_LISP_IS}"
    if re.match(r"\?\w", written):
        return f"In a designator {written} is the value of a variable of Hy: (let [{written} value] form...)."
    package = _lisp_package_with(written.upper())
    if package is not None:
        module = package.lower()
        return (
            f"{written} is a function of the Lisp package {package}. In Hy it is called by its module: (import {module}), then "
            f"({module}.{written} ...)."
        )
    import difflib

    names = {hy.unmangle(each) for each in known} - {written}
    names -= {name for name in names if "::" in name and name.replace("::", ":") in names}
    near = difflib.get_close_matches(written, sorted(names), n=2, cutoff=0.7)
    return f"Did you mean {' or '.join(near)}?" if near else None


def _lisp_package_with(name):
    """The name of a package of the user's whose function ``name`` names, or ``None``. Readers of messages' fields are seldom meant."""
    for package in all_packages():
        strange = package.built_in or package.name.endswith(_OF_MESSAGES)
        symbol = None if strange else package.external.get(name) or package.internal.get(name)
        if isinstance(symbol, Symbol) and symbol.package is package and not isinstance(symbol.function, UndefinedFunction):
            return package.name
    return None


def hint_for_text(text):
    """What to try where Hy's reader says ``text``: a ``#`` of Common Lisp is another one in Hy."""
    found = re.match(r"reader macro '(#['\\(:+|-])", text)
    if not found:
        return None
    return f"{found[1]} is Common Lisp" + (", where Hy writes the name alone." if found[1] == "#'" else ".") + f" {_WHERE_LISP_IS}"


__all__ = ["hint", "hint_for_name", "hint_for_text", "message"]
