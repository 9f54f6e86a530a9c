"""How the errors that end a program in a ``.hy`` file are told: the same by ``hy FILE``, by ``cramhy run FILE`` and by a test.

* What a plan signals (a failure, a condition of Lisp), and every error in a text of Common Lisp: what, where, why, what to try.
* A form that cannot be compiled: the same.
* An exception of Python's that passed Hy or Python text: Python's traceback with the lines of Hy, without the frames of the runtime and of
  Hy, and what to try if something is known.

``--backtrace lisp|python``, or the variable CRAMHY_BACKTRACE, shows the calls that led to it; ``python`` leaves out no frame.

`install` lets ``hy FILE`` and every other program that requires ``cramhy`` tell them so, unless it has a ``sys.excepthook`` of its own.
"""

from __future__ import annotations

import atexit
import builtins
import code  # Hy's prompt is made of it
import os
import re
import sys
import traceback
from pathlib import Path
from types import ModuleType

import hy
from hy import errors as hy_errors
from hy.reader.exceptions import LexException

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.python_exceptions import from_python
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.lisp_core.source_places import describe, excerpt, exception_position, file_of_text, frame_position, locate
from cramhy_runtime.kernel import uncaught
from cramhy_runtime.kernel.reports import of_the_library

from ..commonlisp.evaluation.evaluator import PACKAGE
from ..commonlisp.systems.loader import speaks_lisp
from ..commonlisp.tools import backtrace
from ..commonlisp.tools.error_reports import end_line, report_lines, show
from ..kept_hy import calls_kept_code
from . import malformed, shapes
from .malformed import MalformedForm, retold, unreadable

_HY = os.path.dirname(os.path.abspath(hy.__file__)) + os.sep
_GOES_ON = malformed.evaluate.__code__.co_filename, malformed.evaluate.__name__  # the frames before it are those of the program so far
_MANGLED = re.compile(r"\bhyx_\w+")
_AT_A_PROMPT = re.compile(r"-\d+\Z")  # how Hy's prompt ends the name of each text that it reads


def lines(exception):
    """The lines that tell of ``exception``, which nobody caught."""
    problem = _behind(exception)
    with kernel.at_hand(), binding(PACKAGE, COMMON_LISP_USER):  # names are told as those who have not gone into a package see them
        if isinstance(problem, MalformedForm):
            return _of_a_form(problem)
        condition = from_python(problem)
        locate(condition, problem)
        python = _python_exception(condition)
        if python is None and getattr(condition, "position", None) is None:
            condition.position = _typed_position(problem)
        position = getattr(condition, "position", None)
        if python is not None and position is not None and not speaks_lisp(position[0]):
            return _traceback(python, condition)
        if position is None and exception_position(problem) is None and _users_frames(problem):
            return _traceback(python or problem, condition)
        return report_lines(condition)


def tell(exception):
    """Print what `lines` gives on standard error, after what the program has printed."""
    show(lines(exception))


def install():
    """Let the errors that end this program be told so, and its output on a terminal end with its line."""
    atexit.unregister(_end_line)  # each file that requires cramhy comes by here
    atexit.register(_end_line)
    uncaught.told_by(_tell_if_ours, instead_of=(hy_errors.hy_exc_handler,))


def _end_line():
    if not hasattr(sys, "ps1"):  # a prompt has ended its line
        end_line()


def _tell_if_ours(exception):
    if not isinstance(exception, (Exception, Condition)):
        return False
    tell(exception)
    return True


def _behind(exception):
    """What stands behind an error that Hy made of what left a macro: the condition, or what we have made of it."""
    inner = exception.__context__
    if type(exception) in (hy_errors.HyCompileError, hy_errors.HyMacroExpansionError) and isinstance(inner, (Condition, MalformedForm)):
        return inner
    if isinstance(exception, LexException):
        return unreadable(exception) if exception.filename else exception
    if isinstance(exception, hy_errors.HyLanguageError):  # typed at a prompt, or before cramhy was required
        return retold(exception)
    return exception


def _of_a_form(problem):
    """The lines about a form that cannot be compiled."""
    if isinstance(problem.__cause__, Condition):  # what its macro signalled
        if getattr(problem.__cause__, "position", None) is None:
            problem.__cause__.position = problem.position
        return report_lines(problem.__cause__)
    position, hint = problem.position, problem.hint
    if callable(hint):
        hint = hint()
    cause = problem.__cause__
    inside = cause and (exception_position(cause) or _typed_position(cause))  # where a macro of the user's failed
    told = ["cramhy: SYNTAX-ERROR", *(f"  {line}" for line in problem.msg.rstrip().splitlines())]
    if position is not None:
        told += [f"  at {describe(position)}", *(f"  {line}" for line in excerpt(position).splitlines())]
    if inside and _is_users(inside[0]):
        told += [f"  in the macro at {describe(inside)}", *(f"  {line}" for line in excerpt(inside).splitlines())]
    return told + ([f"  {line}" for line in hint.splitlines()] if hint else []) + backtrace.lines(cause or problem)


def _typed_position(exception):
    """The innermost place that ``exception`` passed in a text which is no file: of ``hy -c``, of standard input, of a prompt of Hy's."""
    found, entry = None, exception.__traceback__
    while entry is not None:
        filename = entry.tb_frame.f_code.co_filename
        if _is_users(filename) and (filename.startswith("<") or _AT_A_PROMPT.search(filename)):
            found = frame_position(entry.tb_frame, entry.tb_lasti)
        entry = entry.tb_next
    return found


def _python_exception(condition):
    """The exception of Python's that ``condition`` stands for, or ``None``."""
    cause = condition.__cause__
    if isinstance(cause, Exception) and not isinstance(cause, Condition) and getattr(cause, "__lisp_condition__", None) is condition:
        return cause
    return None


def _is_users(filename):
    return not (
        of_the_library(filename)
        or filename.startswith((_HY, "<frozen "))
        or os.path.join("hy_src", "cramhy") in filename
        or filename in (getattr(hy, "executable", None), code.__file__)
    )


def _users_frames(exception):
    return any(_is_users(frame.filename) for frame in traceback.extract_tb(exception.__traceback__))


def _traceback(exception, condition):
    """Python's traceback of ``exception``, without what is not the user's, and the hint for it."""
    told = traceback.TracebackException.from_exception(exception)
    if backtrace.kind() != "python":
        _leave_out(told, set())
    text = [_as_written(line, exception) for line in "".join(told.format()).rstrip("\n").split("\n")]
    hint = _hint(exception, condition)
    return text + ([f"  {line}" for line in hint.splitlines()] if hint else [])


def _leave_out(told, seen):
    """Take the frames that are not the user's out of a `traceback.TracebackException` and those that it is chained to."""
    if told is None or id(told) in seen:
        return
    seen.add(id(told))
    inside = [index for index, frame in enumerate(told.stack) if (frame.filename, frame.name) == _GOES_ON]
    frames = told.stack[inside[-1] if inside else 0 :]
    told.stack[:] = [frame for index, frame in enumerate(frames) if _is_users(frame.filename) and not calls_kept_code(frames, index)]
    for frame in told.stack:
        frame.filename = file_of_text(frame.filename)
    for other in (told.__cause__, told.__context__, *(getattr(told, "exceptions", None) or ())):
        _leave_out(other, seen)


def _as_written(line, exception):
    """A line of the traceback of ``exception``, with the name that is missing, and all that Hy has mangled, as they are written in Hy."""
    if line.startswith(" "):
        return line
    line = _MANGLED.sub(lambda found: hy.unmangle(found[0]), line)
    name = getattr(exception, "name", None)
    if not isinstance(exception, (NameError, AttributeError)) or not name:
        return line
    return line.replace(f"'{name}'", f"'{_spelling(name, exception)}'")


def _spelling(name, exception):
    """How ``name``, a name of Python's, is written where ``exception`` arose: ``pose_cb`` may be ``pose-cb`` in Hy."""
    written = hy.unmangle(name)
    if name.startswith("hyx_"):
        return written
    lines = [frame.line or "" for frame in traceback.extract_tb(exception.__traceback__) if _is_users(frame.filename)]
    return written if lines and written in lines[-1] else name


def _not_required(exception):
    """What to try if the program uses an operator of cramhy without ``(require cramhy *)``, or ``None``."""
    frames = [frame.filename for frame in traceback.extract_tb(exception.__traceback__) if _is_users(frame.filename)]
    file = getattr(exception, "filename", None) or (frames[-1] if frames else None)
    try:
        text = Path(file_of_text(file)).read_text(encoding="utf-8")
    except (OSError, TypeError, ValueError):
        return None
    if re.search(r"\(require[^()]*\bcramhy\s*(\*|:macros\s+\*)", text):
        return None
    named = isinstance(exception, NameError)
    used = [exception.name] if named else [hy.mangle(head) for head in re.findall(r"\(([a-z][\w*+-]*[\w*+])(?=[\s)])", text)]
    from .plan_macros import macros

    ours = macros()
    operator = next((name for name in used if name in ours), None)
    if operator is None:
        return None
    return f"{hy.unmangle(operator)} is an operator of cramhy. Begin the file with (require cramhy *)."


def _hint(exception, condition):
    if isinstance(exception, (NameError, SyntaxError)) and (hint := _not_required(exception)):
        return hint
    if isinstance(exception, NameError) and exception.name:
        if (part := _part_of_argument(exception)) is not None:
            return part
        return shapes.hint_for_name(exception.name, _names_known(exception), _modules_known(exception))
    hint = condition.hint
    return hint() if callable(hint) else hint


def _part_of_argument(exception):
    """What to say if the name that is missing is a part of an argument of the function that looked for it; else ``None``."""
    frames = [frame for frame, _ in traceback.walk_tb(exception.__traceback__) if _is_users(frame.f_code.co_filename)]
    code = frames[-1].f_code if frames else None
    for argument in code.co_varnames[: code.co_argcount] if code is not None else ():
        value, part = frames[-1].f_locals.get(argument), exception.name
        if part in getattr(type(value), "__slots__", ()) or part in getattr(value, "__dict__", ()):
            function = "fn" if code.co_name == "<lambda>" else hy.unmangle(code.co_name)
            return f"{hy.unmangle(part)} is a part of what {function} gets: {hy.unmangle(argument)}.{hy.unmangle(part)}"
    return None


def _modules_known(exception):
    """The modules that were imported where ``exception`` arose, by the names that they have there."""
    frames = [frame for frame, _ in traceback.walk_tb(exception.__traceback__) if _is_users(frame.f_code.co_filename)]
    found = frames[-1].f_globals if frames else {}
    return {hy.unmangle(name): each for name, each in found.items() if isinstance(each, ModuleType) and not name.startswith(("_", "hy"))}


def _names_known(exception):
    """The names that could have been meant where ``exception`` arose: macros, and what the user and Python have defined."""
    known = {*vars(builtins), *builtins._hy_macros, *getattr(sys.modules.get("cramhy"), "_hy_macros", ())}
    users = set()
    for frame, _ in traceback.walk_tb(exception.__traceback__):
        if _is_users(frame.f_code.co_filename):
            users = {*frame.f_globals, *frame.f_locals}  # the innermost ones count
    return {name for name in known | users if not name.startswith("_")}


__all__ = ["install", "lines", "tell"]
