"""Plain Hy: what Hy's reader and compiler say of a text, and names that nothing defines.

Compiling expands macros. So the modules that a text requires are imported, and only `TRUSTED` ones are: a text that requires others is
read, and not compiled. What it imports is not imported.
"""

from __future__ import annotations

import ast
import builtins
import functools
import importlib.util
import re
import sys
import types

import hy
from hy.compiler import hy_compile
from hy.errors import HyLanguageError
from hy.reader import HyReader

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.languages.hy.malformed import MalformedForm, retold, unreadable
from cramhy_runtime.languages.hy.plan_macros import macros

from .findings import ERROR, WARNING, Finding, fixes, meant


@functools.cache
def plan_macros():
    """The mangled names of the macros of ``(require cramhy *)``."""
    return frozenset(macros())


TRUSTED = frozenset(("cramhy", "hyrule", "hy"))
_REQUIRED = re.compile(r"^[ \t]*\((?:require|eval-when-compile|eval-and-compile|do-mac)\b([^()]*)", re.M)
_RUNS = re.compile(r"\((?:eval-when-compile|eval-and-compile|do-mac|defreader|defmacro)\b")


def check(text, filename):
    """The `Finding`s of a text of Hy."""
    try:
        models = list(_read(text.text, filename))
    except (HyLanguageError, MalformedForm) as problem:
        made = problem if isinstance(problem, MalformedForm) else unreadable(problem)
        return [_of_malformed(made, text)]
    unknown = list(_unknown_modules(text))
    if unknown or not _may_be_compiled(text.text):
        return unknown
    module = types.ModuleType("checked_by_cramhy")
    module.__file__ = filename
    tree = ast.Module([], [])
    found = []
    for model in models:
        try:
            tree.body += hy_compile(hy.models.Expression([hy.models.Symbol("do"), model]), module, filename=filename, source=text.text).body
        except (Exception, Condition) as problem:
            position = filename, getattr(model, "start_line", 1), getattr(model, "start_column", 1)
            found.append(_of_malformed(retold(problem, position), text))
    return found + ([] if found else _unknown_names(tree, text, module))


def _read(text, filename):
    reader = HyReader()
    yield from hy.read_many(text, filename, reader)


def _may_be_compiled(text):
    if _RUNS.search(text):
        return False
    return all(set(_heads(match[1])) <= TRUSTED for match in _REQUIRED.finditer(text))


def _unknown_modules(text):
    """A `Finding` for each module that is not there and whose name is almost that of one that a plan imports."""
    for form in text.forms:
        if form.word(0) not in ("require", "import"):
            continue
        for item in form.items[1:]:
            name = getattr(item, "text", "").split(".")[0]
            if not re.match(r"[A-Za-z]", name) or getattr(item, "kind", "") != "word" or name in ("as",):
                continue
            known = [*TRUSTED, "cramhy_runtime", *sys.stdlib_module_names]
            near = near_names(hy.mangle(name), known) if hy.mangle(name) not in known and not _found(hy.mangle(name)) else ()
            if near:
                hint = meant(near)
                message = f"There is no module {name}."
                fixing = tuple(fixes(message, hint, text, item.start, item.start + len(name)))
                yield Finding(item.start, item.start + len(name), WARNING, f"{message}\n{hint}", fixing)


def _found(name):
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _heads(words):
    words = re.sub(r"\[[^\]]*\]", " ", words)
    return [word.split(".")[0] for word in words.split() if re.match(r"[\w.]", word) and word not in ("as",)]


def _of_malformed(made, text):
    hint = made.hint() if callable(made.hint) else made.hint
    start = text.offset_of_reader(made.lineno or 1, made.offset or 1)
    end = min(text.end_of_datum(start), _line_end(text.text, start))
    message = str(made.msg).strip()
    return Finding(start, max(end, start), ERROR, f"{message}\n{hint}" if hint else message, tuple(fixes(message, hint, text, start, end)))


def _line_end(text, start):
    end = text.find("\n", start)
    return len(text) if end < 0 else end


class _Names(ast.NodeVisitor):
    """Names that a module defines anywhere, and those that it uses."""

    def __init__(self):
        self.defined, self.used, self.open = set(), [], False

    def visit_Name(self, node):
        if isinstance(node.ctx, ast.Load):
            self.used.append(node)
        else:
            self.defined.add(node.id)

    def _definition(self, node):
        self.defined.add(node.name)
        self.generic_visit(node)

    visit_FunctionDef = visit_AsyncFunctionDef = visit_ClassDef = _definition

    def visit_arg(self, node):
        self.defined.add(node.arg)
        self.generic_visit(node)

    def visit_ExceptHandler(self, node):
        self.defined.add(node.name)
        self.generic_visit(node)

    def _import(self, node):
        for alias in node.names:
            self.open |= alias.name == "*"
            self.defined.add((alias.asname or alias.name).split(".")[0])

    visit_Import = visit_ImportFrom = _import

    def _match(self, node):
        self.defined.add(getattr(node, "name", None) or getattr(node, "rest", None))
        self.generic_visit(node)

    visit_MatchAs = visit_MatchStar = visit_MatchMapping = _match


@functools.cache
def _operators():
    """The mangled names that may stand behind a parenthesis and are no values."""
    return frozenset(name for name in {*plan_macros(), *builtins._hy_macros} if not name.startswith("_") and "hyx_" not in name) | {
        hy.mangle(name) for name in ("try", "except", "finally", "while", "for", "if", "let", "fn", "setv", "defn", "do", "when", "cond")
    }


def _unknown_names(tree, text, module):
    names = _Names()
    names.visit(tree)
    if names.open:
        return []
    known = {*names.defined, *vars(builtins), *vars(module), "hy", "__file__", "__name__"} - {None}
    found, told = [], set()
    for node in names.used:
        if node.id in known or node.id.startswith(("_", "hyx_")):
            continue
        written = hy.unmangle(node.id)
        near_it = text.offset_of_reader(node.lineno, max(1, node.col_offset))  # releases of Hy count columns from 0 or from 1
        start = text.text.find(written, near_it)
        if start < 0:
            continue
        end = start + len(written)
        if (start, written) in told:
            continue
        told.add((start, written))
        called = text.text[:start].rstrip().endswith("(")
        near = [hy.unmangle(name) for name in near_names(node.id, {*known, *(_operators() if called else ())})]
        hint = meant(near)
        message = f"Nothing in this file defines {written}."
        whole = f"{message}\n{hint}" if hint else message
        found.append(Finding(start, end, WARNING, whole, tuple(fixes(message, hint, text, start, end))))
    return found
