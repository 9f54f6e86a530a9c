"""The names under which the compiled code of a Hy file has what is ours: functions of `calls`, symbols, constants of Lisp.

The macros of plain Hy write ``(hy.R.cramhy._ours calls block)`` for what is found in the package ``cramhy`` under that path, and
``(hy.R.cramhy._constant "text")`` for an object of Lisp that all images share. In a file both become global variables of the module. They
are assigned before the first form of the file that needs them, as those of compiled Common Lisp are, so a plan finds them as quickly. At a
prompt and in ``hy.eval`` there is no such place: there the code asks the package each time.
"""

from __future__ import annotations

import re
from weakref import WeakKeyDictionary

from hy import models

from .. import kept_hy
from . import calls, operator_bodies, plan_code
from .users_names import variables

_WORD = re.compile(r"[^\W_]+")

_names: WeakKeyDictionary[object, ModuleNames] = WeakKeyDictionary()
"""Hy's compiler of a file → the names of its module."""

CRAMHY = models.Expression([models.Symbol("__import__"), models.String("cramhy")])  # much quicker than hy.I, and Python that runs


class ModuleNames:
    """The names that one file has so far. variables: the mangled names that may be variables in the form that is compiled now.

    bound: those that expansions bind in it. at_work: whether a form of the file is compiled now. With the same compiler a prompt goes on
    after ``hy -i FILE``.
    """

    def __init__(self):
        self.variables = self.bound = frozenset()
        self.at_work = False
        self._known = {}  # what it is: a path or the text of a constant → its name
        self._new = []  # name, value, name, value ... : what the form is the first to need

    def name(self, key, written, value):
        """The symbol for what ``key`` stands for. written: what its name says; value: the form that finds it."""
        found = self._known.get(key)
        if found is None:
            found = "_".join(["_cramhy", *_WORD.findall(written.lower())])
            if found in self._known.values():
                found += f"_{len(self._known)}"
            self._known[key] = found
            self._new += [models.Symbol(found), value]
        return models.Symbol(found)

    def assigned_before(self, made, compiler, form):
        """``made``, what Hy's compiler made of ``form``, behind the assignments of the names that it is the first to need."""
        pairs, self._new = self._new, []
        if not pairs:
            return made
        assignments = compiler.compile(models.Expression([models.Symbol("setv"), *pairs]).replace(form))
        return assignments + assignments.expr_as_stmt() + made


def compiled(compiler, form):
    """What Hy's compiler makes of ``form``, one of the forms of a file, with the names that it needs."""
    names = _names.get(compiler)
    if names is None:
        names = _names[compiler] = ModuleNames()
        kept_hy.seen(compiler.filename)
    names.variables, names.bound, names.at_work = frozenset(variables(form)), frozenset(), True
    try:
        made = compiler.compile(form)
    finally:
        names.at_work = False
    if not _is_lisp(form):
        operator_bodies.settle(made.stmts, vars(compiler.module).keys() | getattr(compiler.scope, "defined", set()))
        plan_code.complete(made.stmts, lambda name: str(_ours(names, "calls", name)))
    return names.assigned_before(made, compiler, form)


def complete_at_prompt(statements, module):
    """Finish the syntax tree of a text that was typed at a prompt of ``module``, as `compiled` does with the forms of a file."""

    def name(path):
        found = f"_cramhy_{path}"
        vars(module)[found] = getattr(calls, path)
        return found

    operator_bodies.settle([statements], vars(module).keys())
    plan_code.complete([statements], name)


def _is_lisp(form):
    """Whether our own compiler makes the code of ``form``."""
    return isinstance(form, models.Expression) and form[:1] == (models.Symbol("lisp-form-read"),)


def _names_of_file(compiler):
    """The `ModuleNames` of the file that ``compiler`` compiles; ``None`` at a prompt."""
    names = _names.get(compiler)
    return names if names is not None and names.at_work else None


def ours(_hy_compiler, *path):
    """The macro that stands for what the package ``cramhy`` has under ``path``, which are symbols of Hy."""
    names = _names_of_file(_hy_compiler)
    if names is None:
        return _attribute(CRAMHY, *path)
    return _ours(names, *path)


def _ours(names, *path):
    path = tuple(map(models.Symbol, path))
    package = names.name((), "", CRAMHY)
    return names.name(path, " ".join(path), _attribute(package, *path))


def constant(_hy_compiler, text):
    """The macro that stands for the object of Lisp that ``text`` means, which all images share."""
    found = models.Expression([ours(_hy_compiler, models.Symbol("calls"), models.Symbol("constant")), text])
    names = _names_of_file(_hy_compiler)
    return found if names is None else names.name(str(text), str(text), found)


def binds(compiler, name):
    """The form that is compiled now binds the mangled ``name`` in an expansion, so that its text does not show it."""
    names = _names_of_file(compiler)
    if names is not None:
        names.bound |= {name}


def is_bound(compiler, name):
    """Whether `binds` was told of ``name`` in the form that is compiled now."""
    names = _names_of_file(compiler)
    return names is not None and name in names.bound


def if_global(compiler, name):
    """A Hy form that tells whether the module has a variable of that mangled name; ``None`` if it may be a variable of a function."""
    names = _names_of_file(compiler)
    if names is None or name in names.variables or name in names.bound:
        return None
    globals_ = names.name("globals", "globals", models.Expression([models.Symbol("globals")]))
    return models.Expression([models.Symbol("in"), models.String(name), globals_])


def _attribute(value, *path):
    return models.Expression([models.Symbol("."), value, *path])


MACROS = {"_ours": ours, "_constant": constant, **operator_bodies.MACROS}

__all__ = ["MACROS", "binds", "compiled", "complete_at_prompt", "if_global", "is_bound"]
