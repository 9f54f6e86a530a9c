"""What is wrong with a text, where, and what to try.

The report of a reader error is SBCL's sentence and nothing more, because courses and tests quote it. What helps a beginner
stands beside it, in attributes that the REPL and the loader print: ``position`` (file, line, column, counted from 1),
``excerpt`` (the source line with a caret below the place) and ``hint`` (what to try). Law 7.
"""

from __future__ import annotations

import bisect

from .. import conditions
from ..condition_types import EndOfFile, ReaderError, ReaderPackageError, SimpleStyleWarning, shown
from ..conditions import ask_value, restart_case
from ..data import Symbol
from ..dynamic import binding
from ..packages import find_package, find_package_or_error, near_names, package_names, sym
from ..symbols.package_errors import PackageLockedError, locked, violated


class SimpleReaderError(ReaderError):
    """A text that breaks the syntax of Common Lisp."""

    lisp_name = "SB-INT::SIMPLE-READER-ERROR"

    def report(self):
        with binding(sym("*PRINT-CIRCLE*"), True):  # what is shown may have been labelled, and contain itself
            return super().report()


class ImpossibleNumber(ReaderError):
    """A numeric token that no number can represent, such as ``1/0``."""

    lisp_name = "SB-KERNEL::READER-IMPOSSIBLE-NUMBER-ERROR"


class ReaderEndOfFile(EndOfFile):
    """The text ends where another character must follow; ``context`` says after what."""

    lisp_name = "SB-KERNEL::READER-EOF-ERROR"

    def report(self):
        return f"unexpected end of file on {shown(self.stream)} {self.context}"


class UnmatchedClose(SimpleStyleWarning):
    """A ``)`` that closes nothing, between the forms of a file or at the prompt; it is ignored."""

    lisp_name = "CRAMHY::UNMATCHED-CLOSE-PARENTHESIS"
    position = hint = excerpt = None


class LineIndex:
    """Lines and columns of the offsets of a text that starts at ``line`` and ``column``."""

    def __init__(self, text, line=1, column=1):
        self.text, self.line, self.column = text, line, column
        self.starts = [0]
        position = text.find("\n")
        while position >= 0:
            self.starts.append(position + 1)
            position = text.find("\n", position + 1)

    def place(self, offset):
        """(line, column) of ``offset``, counted from 1."""
        index = bisect.bisect_right(self.starts, offset) - 1
        column = offset - self.starts[index] + (self.column if index == 0 else 1)
        return self.line + index, column

    def excerpt(self, offset):
        """The line around ``offset`` and below it a caret; a long line is cut."""
        index = bisect.bisect_right(self.starts, offset) - 1
        start = self.starts[index]
        end = self.text.find("\n", start)
        line = self.text[start:len(self.text) if end < 0 else end].rstrip("\r").replace("\t", " ")
        column = offset - start
        if len(line) > 100:
            cut = max(0, column - 50)
            line, column = line[cut:cut + 100], column - cut
        return f"{line}\n{' ' * column}^"


class QuietFailure(Exception):
    """Raised instead of a condition by a reader that only asks whether a text is complete."""


class QuietEnd(QuietFailure):
    """The text is not complete."""


def place(condition, reader, offset, hint=None):
    """Give ``condition`` its position, excerpt and hint; returns it."""
    condition.position = (reader.filename, *reader.place(offset))
    condition.excerpt = reader.lines.excerpt(offset)
    condition.hint = hint
    return condition


def fail(reader, offset, text, *arguments, hint=None, kind=SimpleReaderError):
    """Signal a reader error at ``offset``."""
    if reader.quiet:
        raise QuietFailure(text)
    return conditions.error(place(kind(text, *arguments, stream=reader.stream), reader, offset, hint))


def end_of_file(reader, opened, context=None):
    """Signal that the text ends inside a form.

    opened: offsets and openers of what is not closed, outermost first. context: SBCL's words, when it has some.
    """
    if reader.quiet:
        raise QuietEnd
    offset, opener = opened[0] if opened else (len(reader.text), None)
    if opener is None:
        hint = "The text ends before a form begins."
    else:
        line, column = reader.place(offset)
        hint = f"The {opener} at line {line}, column {column} is not complete."
        if opener.endswith("("):
            hint = f"The {opener} at line {line}, column {column} is never closed."
            suspect = _next_form_at_margin(reader.text, offset)
            if suspect is not None:
                hint += f" Perhaps its ) is missing before line {reader.place(suspect)[0]}, where a new form begins."
            elif len(opened) > 1:
                inner_line, inner_column = reader.place(opened[-1][0])
                hint += f" {len(opened)} are open at the end; the innermost begins at line {inner_line}, column {inner_column}."
        elif opener in ('"', "|"):
            hint = f"The {opener} at line {line}, column {column} has no second {opener}."
        elif opener == "#|":
            hint = f"The comment #| at line {line}, column {column} has no |#."
    if context is None:
        condition = EndOfFile(stream=reader.stream)
    else:
        condition = ReaderEndOfFile(stream=reader.stream)
        condition.context = context
    return conditions.error(place(condition, reader, min(offset, len(reader.text)), hint))


def _next_form_at_margin(text, offset):
    # People begin top-level forms at the left margin: the first "(" there after an unclosed one is where they believe to be out.
    position = text.find("\n(", offset)
    return position + 1 if position >= 0 else None


def unmatched_close(reader, offset):
    """Warn that the ``)`` at ``offset`` closes nothing."""
    if reader.quiet:
        return
    line, column = reader.place(offset)
    warning = UnmatchedClose("unmatched close parenthesis at ~A:~D:~D, ignored", reader.filename, line, column)
    conditions.warn(place(warning, reader, offset, "There is one ) too many here, or a ( is missing before it."))


# ------------------------------------------------------------------------------------------- symbols with a package prefix


def no_package(reader, offset, package_name, name):
    """Signal that there is no package ``package_name``; the restarts decide which symbol is read."""
    near = near_names(package_name, package_names())
    hint = f"There is no package {package_name}."
    hint += f" Did you mean {_either(near)}?" if near else " Is the system that defines it loaded?"
    current = sym("*PACKAGE*").value

    def again():
        package = find_package(package_name)
        return package.intern(name) if package else no_package(reader, offset, package_name, name)

    return restart_case([(sym("CONTINUE"), lambda: current.intern(name), f"Use the current package, {current.name}."),
                         (sym("RETRY"), again, "Retry finding the package."),
                         (sym("USE-VALUE"), lambda other: find_package_or_error(other).intern(name),
                          "Specify a different package", ask_value),
                         (sym("UNINTERN"), lambda: Symbol(name), "Read the symbol as uninterned."),
                         (sym("SYMBOL"), lambda symbol: symbol, "Specify a symbol to return", ask_value)],
                        lambda: fail(reader, offset, "Package ~A does not exist.", package_name, hint=hint, kind=ReaderPackageError))


def no_external(reader, offset, package, name, found):
    """Signal that ``name`` is not exported from ``package``; ``found``: whether it is an internal symbol there."""
    if found:
        text = "The symbol ~S is not external in the ~A package."
        hint = f"It is internal to {package.name}: with two colons, {_prefix(package)}::{name.lower()}, it can be used all the same."
    else:
        text = "Symbol ~S not found in the ~A package."
        near = near_names(name, package.external)
        hint = f"{package.name} exports no symbol {name}."
        if near:
            hint += f" Did you mean {_either([f'{_prefix(package)}:{other.lower()}' for other in near])}?"
    return restart_case([(sym("CONTINUE"), lambda: package.intern(name), "Use symbol anyway.")],
                        lambda: fail(reader, offset, text, name, package.name, hint=hint, kind=ReaderPackageError))


def new_in_locked_package(reader, offset, package, name):
    """Signal that reading ``package::name`` would put a new symbol into a locked package; returns when it may."""
    if locked(package):
        if reader.quiet:
            raise QuietFailure(name)
        near = near_names(name, package.external)
        hint = f"{package.name} has no symbol {name}." + (f" Did you mean {_either(near)}?" if near else "")
        violated(place(PackageLockedError(package, "interning ~A", name), reader, offset, hint))


def _prefix(package):
    return min(package.names, key=len).lower()


def _either(names):
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " or " + names[-1]
