"""Forms of Hy that cannot be compiled: the error says which form, where, why, and how it is written.

Hy makes a `HyLanguageError` of what is wrong in a text, and ``hy FILE`` prints those itself, with internal frames around them and before
anybody else is asked. So the file that requires ``cramhy`` gets a reader that puts each of its forms into one of ours (`check`). Its
macro, `form`, compiles the form that is in it. When that fails, its expansion is a `Refused`: a model that raises a `MalformedForm` as
soon as Hy's compiler touches it. That one is a SyntaxError, as a tool for Python expects it, and nothing that ``hy FILE`` prints.
"""

from __future__ import annotations

import linecache
import re

import hy
from hy.errors import HyCompileError, HyError, HyLanguageError, HyMacroExpansionError
from hy.models import Expression, Object
from hy.reader import HyReader

from cramhy_runtime.ground.condition_types import Condition

from .. import answered_texts
from . import brackets, module_names, program_texts, shapes

BRACKET_TOO_MANY = re.compile(r"Ran into a '(.)' where it wasn't expected")
"""How Hy's reader says so."""

_FORM = hy.read("hy.R.cramhy._form")  # the name under which a file finds our macro, whatever it has required


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


class Refused(Object):
    """A model in place of the expansion of a macro that failed. Hy's compiler copies each model first; then it raises ``problem``."""

    def __init__(self, problem):
        self.problem = problem

    def __copy__(self):
        raise self.problem.with_traceback(None)


def form(_hy_compiler, form):
    """The macro around each form of a file: what Hy's compiler makes of ``form``, or a `Refused`."""
    try:
        return module_names.compiled(_hy_compiler, form)
    except (Exception, Condition) as problem:
        position = _hy_compiler.filename, getattr(form, "start_line", 1), getattr(form, "start_column", 1)
        return Refused(retold(problem, position))


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
    if reader is None or type(reader) is not HyReader or "try_parse_one_form" in vars(reader):
        return
    filename, inside = getattr(reader, "_filename", None), []
    if not filename or not program_texts.is_program(filename):
        return
    if reader._source is not None:  # and not one of `evaluate`, whose text is kept already
        program_texts.keep(filename, reader._source)
        if program_texts.before_the_prompt(filename) is not None:
            answered_texts.note(reader._source, "hy", filename).end()

    def try_parse_one_form():
        if reader._filename != filename:  # the reader of a prompt, which came after the program
            del reader.try_parse_one_form
            return reader.try_parse_one_form()
        inside.append(True)
        try:
            model = type(reader).try_parse_one_form(reader)
        except HyLanguageError as problem:
            if len(inside) > 1:  # a form in a form: the reader around it wants to know
                raise
            raise unreadable(problem) from None
        finally:
            inside.pop()
        return model if inside or model is None else Expression([_FORM, model]).replace(model, recursive=False)

    reader.try_parse_one_form = try_parse_one_form


def evaluate(text, filename, module):
    """Evaluate ``text``, which goes on with the program of that name in Hy. Its places are those in the whole program."""
    reader = HyReader()
    reader._filename = filename
    check(reader)
    hy.eval(hy.read_many(text, filename, reader), module=module)


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


__all__ = ["BRACKET_TOO_MANY", "MalformedForm", "check", "evaluate", "form", "retold", "unreadable"]
