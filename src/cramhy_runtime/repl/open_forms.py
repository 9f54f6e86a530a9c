"""What is open at the end of the lines that have been typed: lists, a string, a comment. For the prompt of the next line, and for Enter.

The lines come one by one, and no line is looked at twice. So a form of many lines takes time in proportion to its length. (A reader
begins anew at each line, which takes time in proportion to the square.) This knows the standard syntax only, so it is not the judge: where
nothing is open by its account, the reader still decides whether the text is complete (`incomplete`). Where a program has changed the syntax
of Lisp, `of_lisp` says that nothing is known.

Source: ANSI 2.1 to 2.4 for Lisp, ``hy.reader.hy_reader`` for Hy.
"""

from __future__ import annotations

import re

from cramhy_runtime.kernel.late_patterns import late_pattern
from cramhy_runtime.languages.commonlisp.reader.readtables import READTABLE, STANDARD

LONGEST = 20
"""Characters that are shown of a long name of an operator."""
_CLOSE = {"(": ")", "[": "]", "{": "}"}

_LISP = late_pattern(
    r"""(?P<blank>[\s\x7f\xa0\ufeff]+|;[^\n]*)
    | (?P<begins>\#\||["|])                                   # a block comment, a string, a part of a name
    | (?P<bracket>[()])
    | (?P<name>\#\d*\\(?:.(?:\\.|[^\s\x7f\xa0\ufeff()"';`,\\])*)?  # a character
      | (?:\\.?|[^\s\x7f\xa0\ufeff()"';`,|\\\#])(?:\\.?|[^\s\x7f\xa0\ufeff()"';`,|\\])*)
    | (?P<prefix>.)""",
    re.X | re.S,
)
_HY = late_pattern(
    r"""(?P<blank>[\s,]+|;[^\n]*)
    | (?P<begins>[bfrt]*"|\#\[(?P<mark>[^\[\]]*)\[)           # a string, a bracket string
    | (?P<bracket>[()\[\]{}])
    | (?P<name>[^\s()\[\]{}"';`~\#][^\s()\[\]{}"';]*)
    | (?P<prefix>.)""",
    re.X | re.S,
)
_ENDS = {
    '"': late_pattern(r'\\.?|(?P<end>")', re.S),
    "|": late_pattern(r"\\.?|(?P<end>\|)", re.S),
    "#|": late_pattern(r"(?P<begin>\#\|)|(?P<end>\|\#)"),
}


class OpenForms:
    """Reads lines (`read`), of Lisp or, with ``hy``, of Hy.

    ``lists``: the lists that are open, the outermost first, each as [its bracket, its operator or ``None``]. ``within``: how that begins
    which is open and is not a list: ``"``, ``|``, ``#|`` or ``#[[``; else ``None``. ``wrong``: whether a bracket closes what another kind
    has opened. ``within_from``: where the inside of that begins in the text that was read last, if it begins there.
    """

    def __init__(self, hy: bool = False):
        self._syntax = _HY if hy else _LISP
        self.lists: list[list] = []
        self.within: str | None = None
        self.within_from = 0
        self.wrong = False
        self._depth = 0  # of block comments in each other
        self._end = None  # of what is within, a pattern

    @property
    def something(self) -> bool:
        """Whether more lines must come."""
        return bool(self.lists or self.within) and not self.wrong

    def read(self, line: str) -> None:
        """Go on with ``line``, a line without its end, or several."""
        at = 0
        while at < len(line) and not self.wrong:
            at = self._leave(line, at) if self.within else self._go_on(line, at)

    def _go_on(self, line, at):
        match = self._syntax.match(line, at)
        if match.lastgroup == "begins":
            self._begin(match)
        elif match.lastgroup == "bracket":
            self._bracket(match[0], match.start())
        elif match.lastgroup == "name":
            self._operator(match[0])
        return match.end()

    def _begin(self, match):
        text = match["begins"]
        self.within_from = match.end()
        if text[0] == "#" and text[-1] == "[":
            self.within, self._end = "#[[", re.compile(rf"(?P<end>\]{re.escape(match['mark'])}\])")
        else:
            self.within = text if text == "#|" else text[-1]
            self._end, self._depth = _ENDS[self.within], 1
        if text != "#|":
            self._operator("")

    def _leave(self, line, at):
        """Go on inside of what is no list: where it ends, or the end of the line."""
        match = self._end.search(line, at)
        if match is None:
            return len(line)
        if match.lastgroup == "begin":
            self._depth += 1
        elif match.lastgroup == "end":
            self._depth -= 1
            if self._depth < 1 or self.within != "#|":
                self.within = None
        return match.end()

    def _bracket(self, bracket, at):
        if bracket in _CLOSE:
            self._operator("")
            self.lists.append([bracket, None])
        elif self.lists:
            self.wrong = _CLOSE[self.lists.pop()[0]] != bracket

    def _operator(self, name):
        if self.lists and self.lists[-1][1] is None:
            self.lists[-1][1] = name

    def prompt(self) -> str:
        """The prompt of the next line: ``par 2> `` in two lists, the inner one of which is a call of ``par``; ``" 2> `` in a string."""
        bracket, operator = self.lists[-1] if self.lists else ("", "")
        name = self.within or bracket == "(" and operator or bracket
        if not name:  # the reader wants more, such as what a quote is for
            return "... "
        name = name if len(name) <= LONGEST else f"{name[: LONGEST - 2]}.."
        return f"{name} {len(self.lists)}> "


class Pairs(OpenForms):
    """Reads a text, in one piece. ``partner``: where the other bracket of a pair is, by the place of each of the two."""

    def __init__(self, hy: bool = False):
        super().__init__(hy)
        self.partner: dict[int, int] = {}
        self._begun: list[int] = []

    def _bracket(self, bracket, at):
        if bracket in _CLOSE:
            self._begun.append(at)
        elif self._begun:
            other = self._begun.pop()
            self.partner[at], self.partner[other] = other, at
        super()._bracket(bracket, at)


def of_lisp() -> OpenForms | None:
    """`OpenForms` for what is typed in Lisp now; ``None`` if a program has changed what characters mean."""
    return OpenForms() if READTABLE.value.reads_as(STANDARD) else None


__all__ = ["OpenForms", "Pairs", "of_lisp"]
