"""Which names of a Hy program may be the user's own.

A name of ours, such as ``value``, means what the user defined under it, if there is such a thing. Only Python knows that, and asking it
each time costs more than most of our functions. So the source is looked at first: a name that stands only at the heads of calls, in
strings and in comments is nobody's.
"""

from __future__ import annotations

import functools
import re

from hy import mangle, models

_TOKEN = re.compile(r""";[^\n]*|(f?"(?:[^"\\]|\\.)*"|\(?[^\s()\[\]{}"';`~]+)""")
_WORD = re.compile(r"[\w?!*+<>=/-]+")


def may_be_the_users(name, compiler):
    """Whether the user may have a function, or a variable, of that name.

    It is so when the module has one already, or when its source is not there to look at, has the name anywhere but at the head of a call,
    or imports all names of other modules.
    """
    source = compiler.source
    return source is None or mangle(name) in vars(compiler.module) or name in mentioned(source) or _imports_all(source)


@functools.lru_cache(maxsize=4)
def mentioned(source):
    """The names that stand in a text of Hy anywhere but at the heads of calls, as they are written and as Hy unmangles them."""
    found = set()
    for token in _TOKEN.findall(source):
        if token.startswith('f"'):
            found.update(_WORD.findall(token))
        elif token and token[0] not in '(":.':
            found.add(token.lstrip("#@,^").partition(".")[0])
    return found | {name.replace("_", "-") for name in found}


def _imports_all(source):
    return any(not module.startswith("cramhy") for module in re.findall(r"([\w.]+) \*(?=[)\s])", source.replace("(require", "")))


def variables(model):
    """The mangled names of the symbols in ``model`` that can be variables: not the heads of calls, nor the types that handlers are for."""
    if isinstance(model, models.Symbol):
        yield mangle(model)
        return
    if not isinstance(model, models.Sequence):
        return
    parts = list(model)
    if isinstance(model, models.Expression) and parts and isinstance(parts[0], models.Symbol):
        name = str(parts.pop(0))
        if name == ".":  # the others are attributes
            parts = [part for place, part in enumerate(parts) if place == 0 or not isinstance(part, models.Symbol)]
        elif name.endswith("with-failure-handling") and parts and isinstance(parts[0], models.Sequence):
            parts[:1] = [clause[1:] if isinstance(clause, models.Sequence) else clause for clause in parts[0]]
    for part in parts:
        yield from variables(part)


__all__ = ["may_be_the_users", "mentioned", "variables"]
