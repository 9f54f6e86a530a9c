"""What is wrong with a text, where, and what to try.

The report of a reader error is SBCL's sentence and nothing more, because courses and tests quote it. What helps a beginner
stands beside it, in attributes that the REPL and the loader print: ``position`` (file, line, column, counted from 1),
``excerpt`` (the source line with a caret below the place) and ``hint`` (what to try). Law 7.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import EndOfFile, ReaderError, ReaderPackageError, SimpleStyleWarning, SimpleWarning, shown
from cramhy_runtime.lisp_core.conditions import ask_value, restart_case
from cramhy_runtime.lisp_core.data import Symbol
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import named_package, find_package_or_error, near_names, package_names, sym
from cramhy_runtime.lisp_core.source_places import describe
from cramhy_runtime.ros.definition_files import why_no_lisp_package
from cramhy_runtime.ros.former_types import successor_of_symbol
from ..packages.package_errors import PackageLockedError, locked, violated


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


class MisplacedForms(SimpleWarning):
    """Forms that an unmatched ``)`` shows to be outside of the form in which they were meant to be; none of them is evaluated."""

    lisp_name = "CRAMHY::MISPLACED-FORMS"
    position = hint = excerpt = None


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


def fail(reader, offset, text, *arguments, hint=None, kind=SimpleReaderError, **slots):
    """Signal a reader error at ``offset``; slots: of the condition."""
    if reader.quiet:
        raise QuietFailure(text)
    return conditions.error(place(kind(text, *arguments, stream=reader.stream, **slots), reader, offset, hint))


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


def unmatched_close(reader, offset, count=1):
    """Warn that the ``)`` at ``offset``, the first of ``count`` in a row, closes nothing."""
    if reader.quiet:
        return
    warning = UnmatchedClose("unmatched close parenthesis at ~A, ignored", describe((reader.filename, *reader.place(offset))))
    too_many = "one ) too many here, or a ( is" if count == 1 else f"{count} ) too many here, or {count} ( are"
    conditions.warn(place(warning, reader, offset, f"There {'is' if count == 1 else 'are'} {too_many} missing before it."))


def misplaced_forms(reader, start, end, close):
    """Warn that the form from ``start`` to ``end`` is closed before what should be in it, which goes up to the ``)`` at ``close``."""
    first, _ = reader.place(start)
    line, column = reader.place(end)
    last, last_column = reader.place(close)
    where = describe((reader.filename, last, last_column))
    warning = MisplacedForms("unmatched close parenthesis at ~A, lines ~D to ~D left out", where, first, last)
    hint = (
        f"The form of line {first} ends at line {line}, column {column}, but the lines behind it are indented as if they were inside. "
        f"There is one ) too many up to line {line}, column {column}, or a ( is missing."
    )
    conditions.warn(place(warning, reader, close, hint))


# ------------------------------------------------------------------------------------------- symbols with a package prefix


def no_package(reader, offset, package_name, name):
    """Signal that there is no package ``package_name``; the restarts decide which symbol is read."""
    near = near_names(package_name, [name for name in package_names() if name != package_name])
    hint = f"There is no package {package_name}."
    hint += (
        f" Did you mean {_either(near)}?" if near else f" {why_no_lisp_package(package_name) or 'Is the system that defines it loaded?'}"
    )
    current = sym("*PACKAGE*").value

    def again():
        package = named_package(package_name)
        return package.intern(name) if package else no_package(reader, offset, package_name, name)

    return restart_case(
        [
            (sym("CONTINUE"), lambda: current.intern(name), f"Use the current package, {current.name}."),
            (sym("RETRY"), again, "Retry finding the package."),
            (sym("USE-VALUE"), lambda other: find_package_or_error(other).intern(name), "Specify a different package", ask_value),
            (sym("UNINTERN"), lambda: Symbol(name), "Read the symbol as uninterned."),
            (sym("SYMBOL"), lambda symbol: symbol, "Specify a symbol to return", ask_value),
        ],
        lambda: fail(reader, offset, "Package ~A does not exist.", package_name, hint=hint, kind=ReaderPackageError, package=package_name),
    )


def no_external(reader, offset, package, name, found):
    """Signal that ``name`` is not exported from ``package``; ``found``: whether it is an internal symbol there."""
    if found:
        text = "The symbol ~S is not external in the ~A package."
        hint = f"It is internal to {package.name}: with two colons, {_prefix(package)}::{name.lower()}, it can be used all the same."
    else:
        text = "Symbol ~S not found in the ~A package."
        near = near_names(name, package.external)
        former = successor_of_symbol(package.name, name)
        hint = f"{package.name} exports no symbol {name}." + (f" {former}" if former else "")
        if near and not former:
            hint += f" Did you mean {_either([f'{_prefix(package)}:{other.lower()}' for other in near])}?"
    return restart_case(
        [(sym("CONTINUE"), lambda: package.intern(name), "Use symbol anyway.")],
        lambda: fail(reader, offset, text, name, package.name, hint=hint, kind=ReaderPackageError, package=package),
    )


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


def comma_hint(text, at):
    """What to try for the comma at ``at``, outside of a backquote: it may be that of a number, or separate the elements of a list."""
    before, after = re.search(r"[-+]?\d+\Z", text[:at]), re.match(r"\d+", text[at + 1 :])
    return f"Numbers have a point: {before[0]}.{after[0]}" if before and after else "Lists are written without commas: (1 2 3)."
