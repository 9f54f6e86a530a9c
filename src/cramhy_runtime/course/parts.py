"""What a page of the course is made of, once its text is taken apart."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from cramhy_runtime.kernel.typing_names import Any

LANGUAGES = ("lisp", "hy")
_ONLY_FOR = re.compile(
    r"^<!-- (?P<marked>lisp|hy) -->\n+(?P<text>```.*?^```$\n?|.+?(?:\n\s*\n|\n?\Z))|^(?P<code>```(?P<written>lisp|hy)\n.*?^```$\n?)",
    re.M | re.S,
)
OF_BOTH = re.compile(r"(?P<lisp>`[^`]+`)\s\(in Hy\s(?P<hy>`[^`]+`)\)")
"""Code in a line for Lisp, and what stands for it in Hy, as in ```:left` (in Hy `"left"`)``. Those who learn one language read its own."""


def by_language(markdown: str) -> list[tuple[str | None, str]]:
    """Markdown in pieces, each with the language that it is for, ``None`` for both.

    A paragraph or a block below ``<!-- hy -->`` is for Hy only, and so is a block of code that begins with `````hy``.
    """
    found, end = [], 0
    for match in _ONLY_FOR.finditer(markdown):
        found += [(None, markdown[end : match.start()]), (match["marked"] or match["written"], match["text"] or match["code"])]
        end = match.end()
    found.append((None, markdown[end:]))
    return [(language, stripped) for language, text in found if (stripped := text.strip("\n"))]


def text_in(markdown: str, language: str) -> str:
    """Markdown without what is for the other language."""
    text = "\n\n".join(text for only, text in by_language(markdown) if only in (None, language))
    return OF_BOTH.sub(rf"\g<{language}>", text)


@dataclass(frozen=True)
class Text:
    """Markdown: paragraphs, headings, lists, tables, pictures, and blocks of code that are not typed at the prompt."""

    markdown: str


@dataclass(frozen=True)
class Typed:
    """A form that is typed, and what comes of it. ``prompt``: in front of it. ``answer``: ends with a newline, unless it is empty."""

    prompt: str
    form: str
    answer: str

    @property
    def text(self) -> str:
        """The form without the spaces that put its lines below the first one, behind the prompt."""
        first, *others = self.form.split("\n")
        indent = " " * len(self.prompt)
        return "\n".join([first, *(line.removeprefix(indent) for line in others)])


@dataclass(frozen=True)
class Code:
    """A piece of a session. ``lisp``, ``hy``: what is typed in each language; empty if there is nothing in that one."""

    lisp: tuple[Typed, ...] = ()
    hy: tuple[Typed, ...] = ()


@dataclass(frozen=True)
class File:
    """A file that the student writes. ``lisp``, ``hy``: its name and text in each language, or ``None``."""

    lisp: tuple[str, str] | None = None
    hy: tuple[str, str] | None = None


@dataclass(frozen=True)
class Task:
    """A task. ``markdown``: what to do. ``start``: code to begin with, by language. ``hints``: Markdown, from the first to the last.

    ``checks``: tables as below ``[[check]]`` of an exercise (docs/how-to/grading.md). A key that ends in ``-hy`` counts in Hy only.
    ``helpers``: such tables with the ``name`` of a function of an earlier step, which a solution calls. They are tried when a check has
    failed.
    """

    name: str
    title: str
    markdown: str
    start: dict[str, str] = field(default_factory=dict)
    hints: tuple[str, ...] = ()
    checks: tuple[dict[str, Any], ...] = ()
    helpers: tuple[dict[str, Any], ...] = ()


Part = Text | Code | File | Task


@dataclass(frozen=True)
class Page:
    """A page: its ``name``, its ``title``, and its ``parts`` in their order."""

    name: str
    title: str
    parts: tuple[Part, ...]

    @property
    def tasks(self) -> list[Task]:
        """The tasks among the parts."""
        return [part for part in self.parts if isinstance(part, Task)]
