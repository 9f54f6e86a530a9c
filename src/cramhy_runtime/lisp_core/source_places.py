"""Where in the user's text something happens: from Python frames back to file, line and column.

Compiled code carries the places of its forms, because core forms have them and Python's code objects keep them. So an error knows the
innermost frame of a ``.lisp`` or ``.hy`` file or of a REPL line, and shows that line; frames of the runtime are not shown.
"""

from __future__ import annotations

import os
import sys
from itertools import islice

from cramhy_runtime.kernel.late_patterns import late_pattern
from .data import list_from
from .conditions import guarded

_RUNTIME = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
_LIBRARIES = os.path.join(_RUNTIME, "libraries")


_TYPED = ("<repl", "<stdin>")
_called = {}  # the names of texts that are no files → the files that they were read from


def keep_text(filename, text, file=None):
    """Let errors show the lines of ``text``, which is compiled under the name ``filename``, though there is no file of that name.

    file: the name of the file that it was read from, if there is one. Errors call it so.
    """
    import linecache

    linecache.cache[filename] = (len(text), None, text.splitlines(True), filename)
    if file is not None:
        _called[filename] = file
        _of_users.pop(filename, None)


def file_of_text(filename):
    """The file that the text of that name was read from: what `keep_text` was told, or ``filename`` itself."""
    return _called.get(filename, filename)


def is_user_file(filename):
    """Whether code of this file name was written by the user: Lisp, Hy, or typed at a prompt, or piped into it."""
    known = _of_users.get(filename)
    if known is None:
        file = _called.get(filename, filename)
        known = _of_users[filename] = (
            file.endswith((".lisp", ".hy", ".asd")) and "hy_src" not in file and not file.startswith(_LIBRARIES) or file.startswith(_TYPED)
        )
    return known


_of_users: dict[str, bool] = {}  # names of files → what `is_user_file` found: it is asked for each frame that a failure passes


def is_typed(filename):
    """Whether text of this file name was typed at a prompt, or piped into it."""
    return _called.get(filename, filename).startswith(_TYPED)


def is_lisp_text(filename):
    """Whether code of this file name was written in Lisp or Hy, or typed: by the user, or in a library that comes with cramhy."""
    return is_user_file(filename) or filename.startswith(_LIBRARIES)


def frame_position(frame, lasti=None):
    """(file, line, column) of what ``frame`` is executing; the column may be ``None``."""
    return code_position(frame.f_code, frame.f_lasti if lasti is None else lasti, frame.f_lineno)


def code_position(code, lasti, line=None):
    """(file, line, column) of the instruction ``lasti`` of a code object; ``line`` if the code does not tell."""
    known = _places.get((id(code), lasti))
    if known is not None:
        return known[1]
    found = _code_position(code, lasti, line)
    if len(_places) > 5000:
        _places.clear()
    _places[id(code), lasti] = code, found
    return found


_places: dict = {}
"""(id of a code object, instruction) → the object, which so stays alive, and the place. Python unpacks a table to find it, and plans that
try again fail at the same places."""


def _code_position(code, lasti, line):
    column = None
    position = next(islice(code.co_positions(), lasti // 2, None), None) if lasti >= 0 else None
    if position is not None:
        line, _, column, _ = position
    return code.co_filename, line, column


def user_position(frame=None):
    """The place of the innermost user frame at or above ``frame`` (default: the caller), or ``None``.

    A frame in code that a macro made of nothing the user wrote has column 0; then the one that called it tells more.
    """
    frame = frame or sys._getframe(1)
    made_by_macro = None
    while frame is not None:
        if is_user_file(frame.f_code.co_filename):
            position = frame_position(frame)
            if position[2] != 0:
                return position
            made_by_macro = made_by_macro or position
        frame = frame.f_back
    return made_by_macro


def exception_position(exception):
    """The place of the innermost user frame that ``exception`` passed, or ``None``; of macros' own code as in `user_position`."""
    return _innermost_place(_passed(exception))


def typed_position(exception, frame):
    """The place of the innermost text that was typed in an earlier form than the one that runs, or ``None``.

    exception: an error whose own place is in a file; of any other there is none. frame: where it is handled. The frames that the error
    passed count, and then those that run.
    """
    place = getattr(exception, "position", None) or exception_position(exception)
    if place is None or is_typed(place[0]):
        return None
    frames = [*_passed(exception), *circumstance.running(frame)]
    typed = [each for each in frames if is_typed(each[0].f_code.co_filename)]
    if not typed or typed[0][0].f_code.co_filename == typed[-1][0].f_code.co_filename:
        return None
    return _innermost_place(typed)


def _innermost_place(frames):
    made_by_macro = None
    for frame, lasti in frames:
        if is_user_file(frame.f_code.co_filename):
            position = frame_position(frame, lasti)
            if position[2] != 0:
                return position
            made_by_macro = made_by_macro or position
    return made_by_macro


def locate(condition, exception):
    """Note on ``condition`` the innermost place of the user's text that ``exception`` passed, if no better one is known."""
    frames = _passed(exception)
    if getattr(condition, "position", None) is None:
        position = _innermost_place(frames)
        if position is not None:
            condition.position = position
    circumstance.note_in(condition, frames)


class Circumstances:
    """What the runtime was about when an error arose, where the user's text does not say it: "while the net ... was computed".

    ``@circumstance(tell)`` marks a function of the runtime: errors below it are shown with the line ``tell(its variables)``, if any,
    and with the place that it was called from. That costs nothing until there is an error, since the function is found on the stack.
    A line that cannot be told, since something in it cannot be printed, is left out: the error of the printer must not take the place of
    the one that is reported.

    The variables are read from the frame, because a debugger asks before anything is unwound, and nets are computed at every assignment.
    Measured: a stack of contexts for each task makes an assignment to a fluent with ten nets 1.4 to 2 times as long, and a single stack
    for all tasks, which would be wrong, 1.2 to 1.4 times.
    """

    def __init__(self):
        self._tellers = {}
        self._files = set()  # where the functions that are marked stand: to look for a code object takes longer than for its file
        self._beginnings = set()

    def begins_with(self, function):
        """Mark ``function``, in which the debugger evaluates a form: what its callers were about has nothing to do with errors in it."""
        self._beginnings.add(function.__code__)
        return function

    def running(self, frame):
        """(frame, instruction) of ``frame`` and its callers, up to the form that was typed in the debugger, or all."""
        frames = []
        while frame is not None and frame.f_code not in self._beginnings:
            frames.append((frame, frame.f_lasti))
            frame = frame.f_back
        return frames

    def __call__(self, tell):
        def mark(function):
            self._tellers[function.__code__] = tell
            self._files.add(function.__code__.co_filename)
            return function

        return mark

    def add(self, condition, line):
        """Show ``line`` with ``condition``."""
        lines = getattr(condition, "circumstances", None)
        if lines is None:
            lines = condition.circumstances = []
        if line not in lines:
            lines.append(line)

    def note(self, condition, exception=None):
        """Add the lines for the frames that ``exception`` passed, or for the running ones, to ``condition``, innermost first."""
        self.note_in(condition, _passed(exception) if exception is not None else self.running(sys._getframe(1)))

    def note_in(self, condition, frames):
        """Add the lines for ``frames``, pairs of a frame and an instruction, to ``condition``."""
        for index, (frame, _) in enumerate(frames):
            if frame.f_code.co_filename not in self._files:
                continue
            tell = self._tellers.get(frame.f_code)
            line = tell and guarded(lambda: tell(frame.f_locals), lambda problem: None)
            if line and not _told(condition, line):
                caller = next((frame_position(*outer) for outer in frames[index:] if is_user_file(outer[0].f_code.co_filename)), None)
                if caller is not None and caller != getattr(condition, "position", None):
                    line += f", called at {describe(caller)}"
                self.add(condition, line)


def _told(condition, line):
    """Whether ``line`` is shown with ``condition``, which was noted before, on its way through another task."""
    return any(known == line or known.startswith(line + ", called at ") for known in getattr(condition, "circumstances", None) or ())


def _passed(exception):
    """(frame, instruction) of the frames that ``exception`` passed, innermost first."""
    frames, traceback = [], exception.__traceback__
    while traceback is not None:
        frames.append((traceback.tb_frame, traceback.tb_lasti))
        traceback = traceback.tb_next
    return frames[::-1]


circumstance = Circumstances()


def source_position():
    """``cramhy::source-position``: the place of the innermost user frame as a list (file line column), or ``nil``."""
    return list_from(user_position(sys._getframe(1)) or ())


def error_place(condition):
    """Where ``condition``, which is signalled now, arose: of the user's text, or for an exception of Python the line that raised it."""
    cause = condition.__cause__ if condition.__cause__ is not None else condition
    if cause.__traceback__ is None:
        return user_position(sys._getframe(1))
    place = exception_position(cause)
    if place is None:
        frame, _ = _passed(cause)[0]
        place = None if frame.f_code.co_filename.startswith(_RUNTIME) else (frame.f_code.co_filename, _passed_line(cause))
    return place


def _passed_line(exception):
    traceback = exception.__traceback__
    while traceback.tb_next is not None:
        traceback = traceback.tb_next
    return traceback.tb_lineno


def describe(position):
    """``file:line:column`` in the user's spelling."""
    if position is None:
        return None
    filename, line, *column = position
    shown = _relative(file_of_text(filename))
    return ":".join([shown, str(line), *(str(part) for part in column if part)])


def calling_form(frame, passed_over=()):
    """The outermost form of the user's that led to ``frame``, in one line, or ``None`` if no other text of the user's led there.

    passed_over: the operators of forms that only lead to other texts, such as ``load``. A form of many lines, or a long one, is shown by
    its operator: ``(visit ...)``.
    """
    import linecache

    places = [frame_position(*each) for each in circumstance.running(frame) if is_user_file(each[0].f_code.co_filename)]
    for filename, line, column in reversed(places):
        if filename == places[0][0]:
            return None
        text = linecache.getline(filename, line)[max(0, (column or 0) - 1) :]
        operator = _OPERATOR.match(text)
        if operator is not None and operator[1].lower() not in passed_over:
            form = _balanced(text)
            return form if form is not None and len(form) <= _LONGEST_FORM else f"({operator[1]} ...)"
    return None


_LONGEST_FORM = 60
_OPERATOR = late_pattern(r"\(([^\s()\[\]]+)")
_MARK = late_pattern(r'"(?:[^"\\]|\\.)*"|[()]')


def _balanced(line):
    """The form at the beginning of ``line``, or ``None`` if it does not end in it."""
    depth = 0
    for token in _MARK.finditer(line):
        depth += {"(": 1, ")": -1}.get(token[0], 0)
        if depth == 0:
            return line[: token.end()]
    return None


def _relative(filename):
    if filename.startswith("<"):
        return filename
    relative = os.path.relpath(filename)
    return filename if relative.startswith("..") else relative


def excerpt(position):
    """The line of ``position`` with a caret under the column, two lines; empty when there is no such line."""
    if position is None:
        return ""
    filename, line, *rest = position
    import linecache  # it imports the tokenizer, for who shows a line of a file

    text = linecache.getline(filename, line).rstrip("\n")
    if not text.strip():
        return ""
    column = rest[0] if rest else None
    if column is None or not 0 < column <= len(text) + 1:
        return f"  {text}"
    return f"  {text}\n  {' ' * (column - 1)}^"


def describe_frame(frame):
    """For the kernel's reports: the place in the user's text that ``frame`` stands in."""
    return describe(user_position(frame)) if frame is not None else None
