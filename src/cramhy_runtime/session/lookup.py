"""Lookup: where a name is defined, in Lisp, Hy or Python, and where it is used.

A function knows its file and line, since its code does. Of what leaves no code (a variable, a class, a fact group, a designator's rule) the
definition is looked for in the text of the files that were loaded: a top-level form ``(def... name``. Uses are looked for in these
texts, too, so what a macro makes of them is not known.
"""

from __future__ import annotations

import functools
import linecache
import os
import re
from typing import NamedTuple

from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.dispatch.generic_functions import GenericFunction
from cramhy_runtime.lisp_core.function_codes import files_noted
from cramhy_runtime.lisp_core.packages import find_package, symbol_name
from cramhy_runtime.lisp_core.source_places import file_of_text
from cramhy_runtime.languages.commonlisp.evaluation.function_facts import plain
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.tools.operators_around import TOKEN

from cramhy_runtime.languages import operators
from cramhy_runtime.languages.operators import operator_of

from .arglists import symbol_named

MOST_USES = 200


class Place(NamedTuple):
    """label: what stands there, ``(DEFUN DRIVE)``. file: a path, or the name of a text that was typed. line, column: from 1. offset: how
    many characters stand before it, ``None`` if the text is gone. snippet: how its line begins."""

    label: str
    file: str
    line: int
    column: int
    offset: int | None
    snippet: str


def place(label, filename, line, column=1):
    """The `Place` at a line and a column of a file."""
    lines = text_lines(filename)
    if not 0 < line <= len(lines):
        return Place(label, file_of_text(filename), line, column, None, "")
    offset = sum(map(len, lines[: line - 1])) + max(0, column - 1)
    return Place(label, file_of_text(filename), line, column, offset, lines[line - 1].strip()[:80])


def text_lines(filename):
    """The lines of a file or of a typed text, as it is now."""
    linecache.checkcache(filename)
    return linecache.getlines(filename)


def definitions(name, package):
    """The `Place`s where ``name``, as it stands in a text of Lisp, Hy or Python, is defined. package: the current one of that text."""
    symbol = symbol_named(name.lstrip("#'`,@"), package)
    if symbol is None:
        return _in_python(name)
    return definitions_of(symbol) or _in_python(name)


def definitions_of(symbol):
    """The `Place`s where ``symbol`` is defined: as a function, a macro, methods, a variable, a class and so on."""
    operator = operator_of(symbol)
    found = [] if operator is None else _of_operator(operator)
    if isinstance(symbol, Symbol):
        function = None if isinstance(symbol.function, UndefinedFunction) else symbol.function
        for kind, definition in (("DEFMACRO", symbol.macro), ("DEFUN", function), ("DEFSETF", symbol.setf_function)):
            if isinstance(definition, GenericFunction):
                found += _methods(definition)
            elif definition is not None and not (operator is not None and kind == "DEFMACRO"):  # its macro is made of the row
                found += place_of_function(definition, f"({kind} {symbol.name})")
    # Code of a macro or a method does not know its line as well as the text does.
    in_text = in_texts(symbol_name(symbol), symbol)
    files = {each.file for each in in_text}
    return [each for each in found if each.file not in files] + in_text


def place_of_function(function, label=None):
    """[`Place`] where a function of Lisp, Hy or Python was written; ``[]`` if it was not written in a file that is there."""
    code = getattr(plain(function), "__code__", None)
    if code is None:
        return []
    filename = code.co_filename
    if not (filename.startswith("<repl") or os.path.exists(file_of_text(filename))):
        return []
    line = code.co_firstlineno
    shown = label or f"({getattr(function, '__name__', 'function')})"
    if filename.endswith(".py"):
        shown = f"(PYTHON {function.__module__}.{code.co_qualname})" if label is None else label
    return [place(shown, filename, line, _column(filename, line))]


def _of_operator(operator):
    """[`Place`] of the row that declares an operator of the plan language."""
    folder = os.path.dirname(operators.__file__)
    row = re.compile(rf"""^\s*\(?['"]\((?:[\w-]*::)?{re.escape(operator.name.lower())}[\s)]""")
    for filename in sorted(os.listdir(folder)):
        path = os.path.join(folder, filename)
        if filename.endswith(".py"):
            for number, line in enumerate(text_lines(path), 1):
                if row.match(line):
                    return [place(f"(OPERATOR {operator.name})", path, number, _column(path, number))]
    return []


def _column(filename, line):
    lines = text_lines(filename)
    text = lines[line - 1] if 0 < line <= len(lines) else ""
    return len(text) - len(text.lstrip()) + 1


def _methods(generic):
    found = []
    for method in generic.methods:
        qualifiers = "".join(f" {prin1_to_string(each)}" for each in getattr(method, "qualifiers", None) or ())
        found += place_of_function(method.function, f"(DEFMETHOD {prin1_to_string(getattr(generic, 'name', ''))}{qualifiers})")
    return found


def _in_python(name):
    """The function, class or module of Python that a dotted name means: ``cramhy_runtime.cpl.par`` or ``math.gcd``."""
    import sys

    parts = name.replace("-", "_").split(".")
    for count in range(len(parts), 0, -1):
        thing = sys.modules.get(".".join(parts[:count]))
        if thing is None:
            continue
        for part in parts[count:]:
            thing = getattr(thing, part, None)
        return _of_python(thing) if thing is not None else []
    return []


def _of_python(thing):
    import inspect

    try:
        file = inspect.getsourcefile(thing)
        line = 1 if inspect.ismodule(thing) else inspect.getsourcelines(thing)[1]
    except (TypeError, OSError):
        return place_of_function(thing) if callable(thing) else []
    return [place(f"(PYTHON {getattr(thing, '__qualname__', thing.__name__)})", file, line)] if file else []


# ------------------------------------------------------------------------------------------------------------------ in texts


def known_files():
    """The files of Lisp and Hy whose functions are loaded, and the texts that were typed."""
    return [name for name in files_noted() if name.startswith("<repl") or name.endswith((".lisp", ".hy", ".asd"))]


@functools.lru_cache(maxsize=512)
def _toplevel(filename, stamp):
    """[(line, operator, name, last line, qualifier)] of the top-level forms of a text. stamp: changes when the text does."""
    text = "".join(linecache.getlines(filename))
    found, depth, start, words = [], 0, 0, []
    for token in TOKEN.finditer(text):
        word = token[0]
        if word == "(":
            if depth == 0:
                start, words = token.start(), []
            depth += 1
        elif word == ")":
            depth = max(0, depth - 1)
            if depth == 0 and words:
                line = text.count("\n", 0, start) + 1
                name, *more = [*words[1:], ""]
                qualifier = f" {more[0].upper()}" if more and more[0].startswith(":") and words[0].lower().endswith("method") else ""
                found.append((line, words[0].upper(), name, line + text.count("\n", start, token.end()), qualifier))
        elif not word.startswith((";", "#|")) and len(words) < 3:
            words.append(word)
    return found


def toplevel_forms(filename):
    """[(line, operator, name, last line, qualifier of a method)] of the top-level forms of a file or typed text, as it is now."""
    lines = text_lines(filename)
    return _toplevel(filename, hash(tuple(lines)))


def in_texts(name, symbol=None):
    """The `Place`s of top-level forms ``(def... name`` in the `known_files`. symbol: only those whose name means it there."""
    found = []
    for filename in known_files():
        package = None
        for line, operator, defined, _, qualifier in toplevel_forms(filename):
            if operator.rpartition(":")[2] == "IN-PACKAGE":
                package = find_package(bare_name(defined.strip('"')))
            if not operator.rpartition(":")[2].startswith(("DEF", "DECLARE-GOAL")) or bare_name(defined) != name:
                continue
            if symbol is None or means(defined, package, symbol):
                found.append(place(f"({operator} {name}{qualifier})", filename, line))
    return found


def means(word, package, symbol):
    """Whether a ``word`` of a text means ``symbol``. package: the one that is current there; ``None`` if the text does not say, and then
    any symbol of that name is meant."""
    plain_word = word.lstrip("'#,@`")
    if package is None and ":" not in plain_word.lstrip(":") or plain_word.startswith(":"):
        return True
    return symbol_named(plain_word, package) is symbol


def bare_name(word):
    """The name that a word of a text stands for, without quotes and prefix."""
    return word.lstrip("'#:").rpartition(":")[2].upper()


def uses(name, calls=False, sets=False, symbol=None):
    """The `Place`s at which ``name`` stands in the `known_files`, outside of its own definition, labelled with the form around.

    calls: only where it is called or named as a function. sets: only where it is set. symbol: only where the word means it.
    """
    before = r"(?:\(|#')\s*" if calls else r"\((?:setf|setq|incf|decf|push|pop|pushnew)\s+" if sets else r"[\s()'`,@]"
    wanted = re.compile(rf"{before}([^\s()'`,;\"]*:)?({re.escape(name)})(?=[\s()])", re.I)
    found = []
    for filename in known_files():
        forms, lines = toplevel_forms(filename), text_lines(filename)
        for number, text in enumerate(lines, 1):
            if name.lower() not in text.lower():
                continue
            for match in wanted.finditer(f" {text.partition(';')[0]}"):
                around = next((form for form in forms if form[0] <= number <= form[3]), None)
                if around is not None and around[0] == number and bare_name(around[2]) == name and around[1].startswith("DEF"):
                    continue
                if symbol is not None and not means((match[1] or "") + match[2], _package_of_line(forms, number), symbol):
                    continue
                label = f"({around[1]} {around[2].upper()})" if around else "(the text)"
                found.append(place(label, filename, number, max(1, match.start(2))))
                if len(found) >= MOST_USES:
                    return found
    return found


def _package_of_line(forms, number):
    """The package that is current in a line of a text with these top-level `forms`, or ``None`` if the text does not say."""
    names = [name for line, operator, name, *_ in forms if line < number and operator.rpartition(":")[2] == "IN-PACKAGE"]
    return find_package(bare_name(names[-1].strip('"'))) if names else None
