"""How names of Python are spelled in Lisp, and back.

Lisp's reader makes capitals of what it reads, and Lisp's names have dashes. So ``lisp_fun`` is ``LISP-FUN``. Keywords and the properties
of designators are shared with rules of Lisp, where case does not count: `lisp_name`. Variables, and the names of predicates and things that
Python makes, are Python's, where it counts: `exact_lisp_name`.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.python_names import hy_name


def lisp_name(name: str) -> str:
    """The Lisp name for a Python name: ``lisp_fun`` becomes ``LISP-FUN``, and ``not_`` becomes ``NOT``."""
    return (name.rstrip("_") or name).replace("_", "-").upper()


def exact_lisp_name(name: str) -> str:
    """The Lisp name of a variable or name of Python: as of `lisp_name`, but names that differ by case only are two.

    Capitals and small letters change places if there is only one sort (``likes`` is ``LIKES``, ``A`` is ``|a|``); ``maxSpeed`` stays.
    """
    name = hy_name(name)
    return other_case((name.rstrip("_") or name).replace("_", "-"))


def python_name(name: str) -> str:
    """The Python name for a Lisp name: ``LISP-FUN`` becomes ``lisp_fun``, and what `exact_lisp_name` has made what it was."""
    return other_case(name).replace("-", "_")


def other_case(name: str) -> str:
    """``name`` with capitals for small letters or small letters for capitals, if it has one sort only and that can be undone."""
    upper, lower = name.upper(), name.lower()
    if name == upper:
        return lower if lower.upper() == name else name
    return upper if name == lower and upper.lower() == name else name
