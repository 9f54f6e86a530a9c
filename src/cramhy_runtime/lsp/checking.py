"""Diagnostics: what our readers and compilers say of a text, with its places."""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import PACKAGE
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.text_checking import check_text
from cramhy_runtime.session import typed_texts

from . import system_files
from .findings import ERROR, WARNING, Finding, of_condition
from .surroundings import session_in
from .texts import LONGEST


def too_long(text):
    """The only `Finding` of a text that is too long to be looked at, or ``None``."""
    if len(text.text) <= LONGEST:
        return None
    return Finding(0, 1, WARNING, f"This text has {len(text.text)} characters. cramhy looks at texts of at most {LONGEST}.")


def parsed(text):
    """The `Finding`s of the brackets alone; they need no image. A text in which they are right has none."""
    found, opened = [], []
    for token in text.tokens:
        if token.kind == "open":
            opened.append(token)
        elif token.kind == "close":
            if not opened:
                found.append(Finding(token.start, token.end, ERROR, f"This {token.text} closes nothing.", (_remove(token),)))
            else:
                before = opened.pop()
                if _CLOSES[before.text] != token.text:
                    line = text.place(before.start)[0] + 1
                    fix = f"Write {_CLOSES[before.text]}", token.start, token.end, _CLOSES[before.text]
                    found.append(
                        Finding(
                            token.start, token.end, ERROR, f"This {token.text} does not close the {before.text} of line {line}.", (fix,)
                        )
                    )
        elif token.kind == "string" and (len(token.text) < 2 or not token.text.endswith('"')):
            found.append(Finding(token.start, token.start + 1, ERROR, "This string is never closed."))
        elif token.kind == "comment" and token.text.startswith("#|") and not token.text.endswith("|#"):
            found.append(Finding(token.start, token.start + 2, ERROR, "This comment is never closed."))
    if opened:
        found.append(_never_closed(text, opened))
    return found


def _remove(token):
    return f"Remove the {token.text}", token.start, token.end, ""


_CLOSES = {"(": ")", "[": "]", "{": "}"}


def _never_closed(text, opened):
    """The `Finding` of the outermost bracket that is open at the end, with where its closing ones may be missing.

    A top-level form begins at the left margin, so a form that is open where another one begins there lacks its brackets before that one.
    """
    begins = [token for token in opened if token.start in text.starts_set]
    first = begins[0] if begins else opened[0]
    inside = opened[opened.index(first) :]
    following = next((token for token in inside[1:] if token.start in text.starts_set), None)
    if following is not None:
        inside = inside[: inside.index(following)]
    before = text.text[: following.start if following else len(text.text)].rstrip()
    before = text.end_of_code(len(before))
    close = "".join(_CLOSES[token.text] for token in reversed(inside))
    count = len(close)
    what = "a closing bracket" if count == 1 else f"{count} closing brackets"
    message = f"The {first.text} here is never closed: {what} {close} {'is' if count == 1 else 'are'} missing."
    return Finding(first.start, first.end, ERROR, message, ((f"Close it with {close}", before, before, close),))


def compiled(text, path, filename, image, further=None):
    """(the `Finding`s of the compiler, the package that is current at the end).

    image: a new one, which then holds the definitions. further: called in it with the findings; gives more of them.
    """
    conditions = []
    with session_in(image), binding(PACKAGE, systems.asdf_user() if filename.endswith(".asd") else COMMON_LISP_USER):
        package = None
        if filename.endswith(".asd"):
            package = system_files.check(text.text, filename, conditions.append)
        else:
            typed_texts.keep(filename, text.text) if path is None else None
            package = check_text(text.text, filename, conditions.extend, conditions.append)
        found = []
        with binding(PACKAGE, package or COMMON_LISP_USER):
            for condition in conditions:
                try:
                    finding = of_condition(condition, text, filename)
                except (Exception, Condition) as problem:
                    finding = Finding(0, 1, ERROR, f"{type(problem).__name__}: {problem}")
                if finding is not None and finding not in found:
                    found.append(finding)
        if further:
            found += further(found)
    return found, package


__all__ = ["compiled", "parsed", "too_long"]
