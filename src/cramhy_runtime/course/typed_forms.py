"""What a student has typed at the prompt of a page: the forms that were answered, and definitions that were not taken.

A check may ask for the form that was typed last, or for the one that gave a variable its value (`in_session`). A definition that led to an
error is noted, since the one before it still counts, and the student may not have seen that.
"""

from __future__ import annotations

import re

MOST = 300
"""Texts that are kept."""
_DEFINED = re.compile(r"^\((?:def[\w*-]*|register-[\w-]*)\s+(?:\[[^\]]*\]\s+)?([^\s()\[\]]+)", re.M | re.I)
_SETS = re.compile(r"\((?:def(?:var|parameter|constant|global)|p?setf|p?setq|setv|setx)\s", re.I)
_TOKEN = re.compile(r"\"(?:\\.|[^\"\\])*\"|;[^\n]*|#\\.[\w-]*|[()\[\]{}]|['`,~@]+|[^\s()\[\]{}\";]+", re.S)


class TypedForms:
    """The texts of one session of a page."""

    def __init__(self):
        self.texts: list[str] = []
        self._read: str | None = None
        self._refused: dict[str, str] = {}

    def read(self, text: str) -> None:
        """``text``, whole forms, was typed, and is answered now."""
        self._read = text

    def failed(self) -> None:
        """What was typed last has led to an error."""
        for name in _DEFINED.findall(self._read or ""):
            self._refused[name.lower()] = self._read or ""
        self._read = None

    def answered(self) -> None:
        """The prompt is there again, so what was typed last is answered."""
        if self._read is None:
            return
        for name in _DEFINED.findall(self._read):
            self._refused.pop(name.lower(), None)
        self.texts = [*self.texts, self._read][-MOST:]
        self._read = None

    def refused(self) -> str | None:
        """The name of something that was defined again in vain: the last definition led to an error, and an older one still counts."""
        defined = {name.lower() for text in self.texts for name in _DEFINED.findall(text)}
        return next((name for name in reversed(self._refused) if name in defined), None)

    def form(self, variable: str | None = None) -> str | None:
        """The form that was typed last, or that which gave ``variable`` its value; ``None`` if there is none."""
        for text in reversed(self.texts):
            for form in reversed(forms(text)):
                if variable is None:
                    return form
                if _SETS.match(form) and (value := _value(form, variable)) is not None:
                    return value
        return None


def forms(text: str) -> list[str]:
    """The forms of ``text``, each as it was typed, without comments between them."""
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
    return found


def _value(form, variable):
    """The form behind the name ``variable`` in a form that sets variables."""
    inside = forms(form[1:-1])
    places = [place for place, each in enumerate(inside[1:], 1) if each.lower() == variable.lower()]
    return inside[places[0] + 1] if places and places[0] + 1 < len(inside) else None
