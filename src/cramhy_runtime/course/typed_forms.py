"""What a student has typed: the forms that were answered, and definitions that were not taken.

A check may ask for the form that was typed last, or for the one that gave a variable its value (`in_session`). A definition that led to an
error is noted, since the one before it still counts, and the student may not have seen that. The session notes what was answered, so it is
known at every door (`answered_texts`).
"""

from __future__ import annotations

import linecache
import re

from cramhy_runtime.lisp_core.source_places import frame_position
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING
from cramhy_runtime.languages import answered_texts

if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import FrameType

    from cramhy_runtime.languages.answered_texts import Answered

_DEFINED = re.compile(r"^\((?:def[\w*-]*|register-[\w-]*)\s+(?:\[[^\]]*\]\s+)?([^\s()\[\]]+)", re.M | re.I)
_DEFINED_INSIDE = re.compile(r"\((?:def[\w*-]*|register-[\w-]*|setv|setf\s+\((?:symbol-function|fdefinition)\s+')\s*([^\s()\[\]]+)", re.I)
"""As `_DEFINED`, anywhere in a form: what was answered counts, too, where it stands inside of ``progn`` or ``top-level``."""
_SETS = re.compile(r"\((?:def(?:var|parameter|constant|global)|p?setf|p?setq|setv|setx)\s", re.I)
_TOKEN = re.compile(r"\"(?:\\.|[^\"\\])*\"|;[^\n]*|#\\.[\w-]*|[()\[\]{}]|['`,~@]+|[^\s()\[\]{}\";]+", re.S)
_CALLED = re.compile(r"\(([^\s()\[\]{}\";'`,]+)")
_GROUP = re.compile(r"\((?:[\w-]+:)?def-fact-group\s", re.I)
_WAITS = re.compile(r"\((?:sleep|wait)", re.I)
_WITHOUT_ANSWER = re.compile(r"\((?:import|require)\s")


class TypedForms:
    """The forms of texts, from the oldest to the newest, in the language of a check."""

    def __init__(self, texts: Iterable[Answered]):
        self.texts = list(texts)

    @classmethod
    def of_session(cls, language: str, caller: FrameType | None = None) -> TypedForms:
        """Those that were answered in this image in ``language``, "lisp" or "hy".

        caller: a frame of a program that asks for a check, if one does. What stands above in its text counts, too.
        """
        texts = [each for each in answered_texts.texts() if each.language == language]
        above = _above(caller) if caller is not None and language == "hy" else None
        return cls([*(each for each in texts if above is None or each.name != above.name), *([above] if above is not None else [])])

    def refused(self) -> str | None:
        """The name of something that was defined again in vain: the last definition led to an error, and an older one still counts."""
        defined: set[str] = set()
        refused: dict[str, None] = {}
        for each in self.texts:
            for name in _names(each.text[: each.upto]):
                defined.add(name)
            for name in _DEFINED_INSIDE.findall(each.text[: each.upto]):
                refused.pop(name.lower(), None)
            for name in _names(each.text[each.upto :]) if each.failed else ():
                refused[name] = None
        return next((name for name in reversed(refused) if name in defined), None)

    def definition(self, name: str) -> str | None:
        """The form that was answered last of those that define ``name``; ``None`` if there is none."""
        found = (form for each in reversed(self.texts) for form in reversed(forms(each.text[: each.upto])))
        return next((form for form in found if (match := _DEFINED.match(form)) is not None and match[1].lower() == name.lower()), None)

    def functions(self) -> set[str]:
        """The names, in lower case, of all functions that were defined."""
        return {name for each in self.texts for name in _names(each.text[: each.upto])}

    def concerned(self, form: str) -> list[str]:
        """The definitions of the functions that ``form`` calls, and of those that these call; then the last group of facts."""
        names, found = _CALLED.findall(form), []
        for name in names:  # which grows
            text = self.definition(name)
            if text is not None:
                found.append(text)
                names += [other for other in _CALLED.findall(text) if other not in names]
        groups = (form for each in reversed(self.texts) for form in reversed(forms(each.text[: each.upto])) if _GROUP.match(form))
        return [*found, *([group] if (group := next(groups, None)) is not None else [])]

    def driving_without_waiting(self, form: str) -> str | None:
        """The name of a function that ``form`` calls, or one of these, that sends a speed and in which nothing waits; else ``None``."""
        names = _CALLED.findall(form)
        for name in names:  # which grows
            text = self.definition(name) or ""
            called = _CALLED.findall(text)
            names += [other for other in called if other not in names]
            if any(other.lower().endswith("send-vel-cmd") for other in called) and not _WAITS.search(text):
                return name
        return None

    def form(self, variable: str | None = None) -> str | None:
        """The form that was answered last, or that which gave ``variable`` its value; ``None`` if there is none."""
        for each in reversed(self.texts):
            for form in reversed(forms(each.text[: each.upto])):
                if variable is None and not _WITHOUT_ANSWER.match(form):
                    return form
                if variable is not None and _SETS.match(form) and (value := _value(form, variable)) is not None:
                    return value
        return None


def _names(text):
    return [name.lower() for form in forms(text, open_one=True) for name in _DEFINED.findall(form)]


def _above(frame):
    """What stands in the text of the code that ``frame`` runs above the place where it is; ``None`` for code without a text."""
    name, line, column = frame_position(frame)
    lines = linecache.getlines(name)
    if not lines or line is None or line > len(lines):
        return None
    above = answered_texts.Answered("".join([*lines[: line - 1], lines[line - 1][: max(0, (column or 1) - 1)]]), "hy", name)
    above.end()
    return above


def forms(text: str, open_one: bool = False) -> list[str]:
    """The forms of ``text``, each as it was typed, without comments between them. open_one: also one that does not end."""
    found, depth, begin = [], 0, None
    for match in _TOKEN.finditer(text):
        token = match[0]
        if token.startswith(";"):
            continue
        begin = match.start() if begin is None else begin
        depth += (token in ("(", "[", "{")) - (token in (")", "]", "}"))
        if depth <= 0 and not token.strip("'`,~@") == "":
            found.append(text[begin : match.end()])
            begin, depth = None, 0
    return found if begin is None or not open_one else [*found, text[begin:]]


def _value(form, variable):
    """The form behind the name ``variable`` in a form that sets variables."""
    inside = forms(form[1:-1])
    places = [place for place, each in enumerate(inside[1:], 1) if each.lower() == variable.lower()]
    return inside[places[0] + 1] if places and places[0] + 1 < len(inside) else None
