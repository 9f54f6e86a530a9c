"""Forms of Hy that cannot be compiled: the error says which form, where, why, and how it is written.

Hy makes a `HyLanguageError` of what is wrong in a text, and ``hy FILE`` prints those itself, with internal frames around them and before
anybody else is asked. So the file that requires ``cramhy`` gets a reader that makes a `ProgramForm` of each of its forms (`check`). Here
Hy's compiler gets the functions that compile this model, and `Rest`. When a form cannot be compiled, they raise a `MalformedForm`: that one
is a SyntaxError, as a tool for Python expects it, and nothing that ``hy FILE`` prints.
"""

from __future__ import annotations

import linecache
import re
from contextlib import nullcontext

import hy
from hy.compiler import Result, builds_model
from hy.errors import HyCompileError, HyError, HyLanguageError, HyMacroExpansionError
from hy.reader import HyReader

from cramhy_runtime.lisp_core.condition_types import Condition

from .. import answered_texts, kept_hy
from . import brackets, module_names, program_texts, shapes
from .reader import ProgramForm, ProgramReader, Rest, take_rest

BRACKET_TOO_MANY = re.compile(r"Ran into a '(.)' where it wasn't expected")
"""How Hy's reader says so."""


class MalformedForm(HyCompileError, SyntaxError):
    """A form that cannot be compiled. ``hint``: what to try, a text or a function that gives it, or ``None``."""

    def __init__(self, message, filename, line, column, hint=None):
        super().__init__(message, (filename, line, column, None))
        self.hint = hint

    def __str__(self):
        return self.msg

    @property
    def position(self):
        return (self.filename, self.lineno, self.offset) if self.filename and self.lineno else None


@builds_model(ProgramForm)
def _compile_form(compiler, wrapped):
    """What Hy's compiler makes of a form of a program; a `MalformedForm` is raised if it cannot be compiled."""
    form = wrapped.form
    try:
        return module_names.compiled(compiler, form)
    except (Exception, Condition) as problem:
        position = compiler.filename, getattr(form, "start_line", 1), getattr(form, "start_column", 1)
        told = retold(problem, position)
    raise told.with_traceback(None)


@builds_model(Rest)
def _compile_rest(compiler, rest):
    """What Hy's compiler makes of the rest of a text, and where it is a file that is loaded, what keeps the code of that."""
    forms, keeps = rest.forms(), rest.program
    with (
        forms.reader.as_current_reader(),
        kept_hy.loading(compiler, rest.filename) if keeps else nullcontext((compiler, [])) as (ours, first),
    ):
        return Result(stmts=first) + ours.compile(forms)


def retold(problem, position=(None, None, None)):
    """The `MalformedForm` for ``problem``, for which a form could not be compiled.

    position: (file, line, column) of the form; ``problem`` may know a better one.
    """
    root = problem
    while isinstance(root, HyError) and root.__context__ is not None and not isinstance(root, MalformedForm):
        root = root.__context__
    if isinstance(root, MalformedForm) or not isinstance(root, (Exception, Condition)):  # such as an interrupt, which is no error
        return root
    if isinstance(problem, HyLanguageError) and problem.text and problem.filename:
        position = (problem.filename, problem.lineno, problem.offset)
    name = re.match(r"expanding macro (\S+)|parse error for pattern macro '(\S+?)'", getattr(problem, "msg", ""))
    name = hy.unmangle(name[1] or name[2]) if name else None
    if isinstance(root, Condition):
        made = MalformedForm(str(root), *position, hint=getattr(root, "hint", None))
    elif isinstance(problem, HyLanguageError) and not isinstance(problem, HyMacroExpansionError):
        made = MalformedForm(shapes.message(problem.msg, name), *position, hint=shapes.hint(name))
    else:
        what = f"The {name} form" if name else "This form"
        made = MalformedForm(f"{what} cannot be compiled: {type(root).__name__}: {root}", *position, hint=shapes.hint(name))
    made.__cause__ = root
    return made


# ------------------------------------------------------------------------------------------------------------------- reading


def check(reader):
    """Let the errors of the program that ``reader`` reads for Hy be `MalformedForm`. A prompt and other languages are left alone."""
    if type(reader) not in (HyReader, kept_hy.Reader):
        return
    filename = getattr(reader, "_filename", None)
    if not filename or not program_texts.is_program(filename):
        return
    program_texts.keep(filename, reader._source)
    if program_texts.before_the_prompt(filename) is not None:
        answered_texts.note(reader._source, "hy", filename).end()
    take_rest(reader, program=True)


def evaluate(text, filename, module):
    """Evaluate ``text``, which goes on with the program of that name in Hy. Its places are those in the whole program."""
    hy.eval(hy.read_many(text, filename, ProgramReader(program=True)), module=module)


def unreadable(problem):
    """The `MalformedForm` for an error of Hy's reader."""
    line, column = problem.lineno, problem.offset
    message, hint = problem.msg, shapes.hint_for_text(problem.msg)
    if re.match("Premature end of input", message):
        linecache.checkcache(problem.filename)
        text = "".join(linecache.getlines(problem.filename))
        message, hint = "The text ends inside of a form.", brackets.explanation(text)
        still_open = brackets.open_brackets(text)
        if still_open:
            _, line, column = still_open[0]
    elif found := BRACKET_TOO_MANY.match(message):
        message = f"There is a {found[1]} too many, or one that does not fit the bracket that is open."
    return MalformedForm(message, problem.filename, line, column, hint=hint)


ProgramReader.told = staticmethod(unreadable)

__all__ = ["BRACKET_TOO_MANY", "MalformedForm", "check", "evaluate", "retold", "unreadable"]
