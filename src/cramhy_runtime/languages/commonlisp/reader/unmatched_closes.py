"""What a ``)`` that closes nothing means: between the forms of a file or at the prompt it is a warning, and reading goes on.

One slip of the hand gives one message. Several such ``)`` in a row are one slip. If forms stand between the last good form and the ``)``,
and are indented as if they were inside of it, then that form was closed too early: neither it nor they are what was meant, so none of them
is evaluated, and the message tells where the surplus ``)`` must be looked for. What the compiler finds in a form with an unmatched ``)``
behind it may come of the slip, so the places of such forms are noted (`FormPlaces.doubt`).

A program that reads (``strict``) gets an error instead, as in SBCL.
"""

from __future__ import annotations


from cramhy_runtime.kernel.late_patterns import late_pattern
from . import reader_errors
from .readtables import READTABLE, SUPPRESS

MOST = 20
"""So many unmatched ``)`` of a text are warnings; then something else is wrong with it, and the next is an error."""
_LINE = late_pattern(r"\n([ \t]*)([^\s;])")


def unmatched_closes(reader, offset):
    """Warn of the ``)`` at ``offset`` of a top level, and go past it and those that follow it with nothing in between.

    Returns whether that was possible; after too many it is an error.
    """
    end, count = offset, 0
    while reader.text[end : end + 1] == ")":
        count += 1
        end = _next(reader, end + 1)
        if count > MOST:
            break
    reader.stray_closes += count
    if reader.first_stray_close is None:
        reader.first_stray_close = offset
    if reader.stray_closes > MOST:
        return False
    reader.offset = end
    reader_errors.unmatched_close(reader, offset, count)
    return True


def left_out(reader, start):
    """Whether the form from ``start`` to where ``reader`` is was closed too early, so that it and what follows is gone past with a warning.

    A form that has an unmatched ``)`` right behind it is only noted.
    """
    text, end = reader.text, reader.offset
    behind = _next(reader, end)
    if text[behind : behind + 1] == ")":
        reader.positions.doubt(start, behind)
        return False
    begins_line = not text[_line_start(text, behind) : behind].strip(" \t)")
    if behind == len(text) or not begins_line or _line_start(text, behind) <= start or _column(text, behind) <= _column(text, start):
        return False
    close = _close_of_indented_forms(reader, behind, _column(text, start))
    if close is None:
        return False
    reader.positions.doubt(start, close)
    reader.positions.left_out = True
    reader.offset = close
    while text[reader.offset : reader.offset + 1] == ")":
        reader.stray_closes += 1
        reader.offset = _next(reader, reader.offset + 1)
    reader_errors.misplaced_forms(reader, start, end - 1, close)
    return True


def _next(reader, offset):
    """Where the next character is that is neither white space nor in a comment with ``;``."""
    table = READTABLE.value
    return (table.scanner or table.compiled()).match(reader.text, offset).start(1)


def _line_start(text, offset):
    return text.rfind("\n", 0, offset) + 1


def _column(text, offset):
    return offset - _line_start(text, offset)


def _close_of_indented_forms(reader, start, column):
    """The place of the first unmatched ``)`` behind the forms that begin at ``start`` and are indented further than ``column``."""
    text, end = reader.text, len(reader.text)
    for line in _LINE.finditer(text, start):
        if len(line[1]) <= column and line[2] != ")":
            end = line.start()
            break
    part = reader.__class__(text[start:end])
    part.quiet = True
    old, SUPPRESS.value = SUPPRESS.value, True
    try:
        while part.first_stray_close is None and part.read(False, part) is not part:
            pass
    except Exception:
        pass
    finally:
        SUPPRESS.value = old
    return None if part.first_stray_close is None else start + part.first_stray_close
