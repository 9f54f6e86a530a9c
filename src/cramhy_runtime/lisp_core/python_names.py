"""Names between Lisp and Python: ``read-csv`` is ``read_csv``, ``data-frame`` or ``DataFrame`` is ``DataFrame``.

Lisp's reader makes upper case of what it reads and Lisp's names have dashes, while Python's names have case and underscores. So
a Lisp name means the Python name that is spelled the same apart from that, if there is only one; the one in small letters comes
first. A name in bars is taken as it stands, and ``+name+`` is the name all in capitals: ``logging:debug`` is the function,
``logging:+debug+`` the constant. A name that could mean several is an error that lists them.
"""

from __future__ import annotations

import keyword as python_keywords

from .ports import PORTS
from .data import Character, LispString, list_from
from .packages import find_package, is_symbol, symbol_name

_CAMEL = r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])"


def lisp_spelling(name):
    """The Lisp name for a Python name: ``ValueError`` → ``VALUE-ERROR``, ``read_csv`` → ``READ-CSV``."""
    import re

    return re.sub(_CAMEL, "-", name).replace("_", "-").upper()


def keyword_spelling(name):
    """The Python keyword argument for the name of a Lisp keyword: ``:sort-keys`` → ``sort_keys``; one in bars as it stands."""
    if name != name.upper():
        return name
    name = name.lower().replace("-", "_")
    return name + "_" if python_keywords.iskeyword(name) else name


def attribute_name(obj, designator):
    """The name of the attribute of ``obj`` that a string (as it stands) or a symbol means; ``None`` if there is none."""
    if not is_symbol(designator):
        return _text(designator)
    return python_spelling(symbol_name(designator), lambda name: _has(obj, name), lambda: dir(obj))


def _text(designator):
    if isinstance(designator, Character):
        return designator.char
    return str(designator) if isinstance(designator, LispString) else designator


def _has(obj, name):
    try:
        return hasattr(obj, name)
    except Exception:  # a property that fails is there all the same
        return True


def python_spelling(name, exists, known):
    """The Python name that the Lisp name ``name`` means.

    exists: whether a Python name is there; known: gives all names that are there, asked for only when the plain spelling is not.
    """
    if name != name.upper():
        return name if exists(name) else None
    constant = len(name) > 2 and name[0] == name[-1] == "+"
    if constant:
        name = name[1:-1]
        plain = name.replace("-", "_")
    else:
        plain = name.lower().replace("-", "_")
    for candidate in (plain, plain + "_"):
        if exists(candidate):
            return candidate
    if constant:
        return None
    names = list(known())
    for fold in (lambda text: text.lower(), lambda text: text.lower().replace("_", "")):
        found = [candidate for candidate in names if fold(candidate) == fold(plain) and candidate[0] != "_"]
        if len(found) == 1:
            return found[0]
        if found:
            return PORTS.signals.error(
                "~A may mean ~{~A~^ or ~} in Python. Write the one that is meant in bars, as in |~A|.",
                name.lower(),
                list_from(found),
                found[0],
            )
    return None


_WORDS = (
    ("->", "_to_"),
    ("/=", "_ne"),
    ("<=", "_le"),
    (">=", "_ge"),
    ("=", "_eq"),
    ("<", "_lt"),
    (">", "_gt"),
    ("+", "_plus"),
    ("*", "_star"),
    ("/", "_slash"),
    ("?", "_p"),
    ("!", "_bang"),
    ("%", "_"),
    (".", "_"),
    ("&", "_and_"),
    ("-", "_"),
)


def python_name(name):
    """The Python identifier for a Lisp name: ``make-fluent`` → ``make_fluent``, ``string=`` → ``string_eq``."""
    name = name.lower()
    if len(name) > 2 and name[0] == name[-1] == "*":
        name = name[1:-1]  # *package* is the variable `package` for Python
    plain = name.replace("-", "_")
    if "->" in name or not plain.isidentifier():
        for character, word in _WORDS:
            name = name.replace(character, word)
        plain = "".join(character if f"_{character}".isidentifier() else "_" for character in name)
    if python_keywords.iskeyword(plain):
        plain += "_"
    return plain if plain.isidentifier() else f"_{plain}"


def hy_name(attribute):
    """How Hy writes a name of Python: ``hyx_Xquestion_markXx`` is ``?x``; other names as they stand."""
    if not attribute.startswith("hyx_"):
        return attribute
    from hy import unmangle

    return unmangle(attribute)


def attribute_symbols(package, attribute):
    """The symbols visible in ``package`` that Python code may mean by ``attribute``, its own before inherited ones.

    ``drive`` is DRIVE; ``turtle_pose`` is TURTLE-POSE or the special *TURTLE-POSE*. Hy may write the Lisp name itself, ``*turtle-pose*``.
    """
    package = find_package(package)
    if attribute.startswith("hyx_"):
        symbol, status = package.lookup(hy_name(attribute).upper())
        return (symbol,) if status else ()
    tables = [package.internal, package.external, *(other.external for other in package.use)]
    size = sum(map(len, tables))
    index = package.__dict__.get("_attributes")
    if index is None or index[0] != size:
        names = {}
        for table in tables:
            for name, symbol in table.items():
                names.setdefault(python_name(name), []).append(symbol)
        index = package._attributes = (size, names)
    return index[1].get(attribute, ())
