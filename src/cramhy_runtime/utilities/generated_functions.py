"""Functions that the program writes itself: a name, parameters and lines of text become a Python function.

Some functions depend on what is known only at run time: the fields of a message type, the clauses of a predicate. A general function
would look at the fields or clauses at each call; a function that is written for them does not. `dataclasses` makes ``__init__`` so.

This module is the only one that runs text that the library has written; ``tests/test_house.py`` checks it. It keeps two laws:

* A traceback shows the generated lines. `linecache` has them under a file name of their own, such as ``<call of a relation, text 7>``.
* The lines go when the functions go. The globals of the functions hold them, so they last as long as a function or a frame of it.
"""

from __future__ import annotations

import linecache
import weakref
from itertools import count
from keyword import iskeyword

TYPE_CHECKING = False  # as type checkers read it; `typing` takes long to import
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

_numbers = count(1)


class _Lines:
    """Stands in the globals of generated functions; `linecache` forgets the functions' lines when it goes."""

    __slots__ = ("__weakref__",)


def generated_function(title: str, name: str, parameters: Iterable[str], body: Iterable[str], scope: dict) -> Callable:
    """Return the function ``name`` that the given lines make.

    title: what the function is, for tracebacks. name: the function's name. parameters: each as it stands in Python text, ``x``,
    ``x=0``, ``*rest``. body: the lines below ``def``, without its indentation; none make a function that returns ``None``.
    scope: the function's globals, a fresh dict; the function itself is not put into it, so that no circle keeps the function.
    Errors: ValueError when a name is not a Python name; SyntaxError, with the line, when Python cannot read the text.
    """
    made: dict = {}
    exec(_code(title, [(name, parameters, body)], scope), scope, made)
    return made[name]


def define_functions(title: str, functions: Iterable[tuple[str, Iterable[str], Iterable[str]]], scope: dict) -> None:
    """Put several functions that call each other into ``scope``, which is the globals of all of them.

    functions: the name, parameters and body of each. The rest is as for `generated_function`.
    """
    exec(_code(title, functions, scope), scope)


def _code(title, functions, scope):
    """The code object that defines ``functions``; `linecache` has its lines until ``scope`` is gone."""
    text = "\n".join([_text(*function) for function in functions]) + "\n"
    filename = f"<{title}, text {next(_numbers)}>"
    code = compile(text, filename, "exec")
    linecache.cache[filename] = (len(text), None, text.splitlines(True), filename)
    holder = scope[filename] = _Lines()
    weakref.finalize(holder, linecache.cache.pop, filename, None).atexit = False
    return code


def _text(name, parameters, body):
    parameters = list(parameters)
    if not _is_name(name):
        raise ValueError(f"A generated function cannot be called {name!r}: this is not a Python name.")
    for parameter in parameters:
        if not _is_name(parameter.partition("=")[0].lstrip("*").strip()):
            raise ValueError(
                f"The generated function {name} cannot have the parameter {parameter!r}: it does not begin with a Python name."
            )
    return f"def {name}({', '.join(parameters)}):\n    " + ("\n    ".join(body) or "pass")


def _is_name(text):
    return text.isidentifier() and not iskeyword(text)
