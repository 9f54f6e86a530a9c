"""Takes the text of a page apart: Markdown, as GitHub and the site show it, with comments that say what the course does with it.

===============================================  ==========================================================================
a block of ``lisp`` with a prompt, of ``hy``     a piece of the session (`Code`); below ``<!-- tabs -->`` both languages are one part
with ``=> ``
a block with ``title="NAME"``                    a file (`File`)
``<!-- task: NAME`` TOML ``-->``                 below a heading: the rest, up to the last hint, is a `Task`; the TOML has its checks
a block with ``title="Begin with"``              in a task: the code to begin with
``<details><summary>Hint</summary>`` ...         in a task: a hint
``<!-- installed -->`` ... ``<!-- anywhere -->``  what only concerns those who read the page beside a terminal of their own; the course
                                                 leaves it out
``<!-- in the course`` ... ``-->``               text that the course has in its place
``<!-- lisp -->`` or ``<!-- hy -->``             the paragraph or the piece of a session below is for those who learn in this language
code ``(in Hy `code`)``                          the first code for Lisp, the second one for Hy (`parts.OF_BOTH`)
===============================================  ==========================================================================

All else is text.
"""

from __future__ import annotations

import functools
import re
import tomllib

from . import contents
from .parts import Code, File, Page, Part, Task, Text, Typed

START = "Begin with"
"""The title of the code that a task begins with."""
FENCE = re.compile(r"^```(\w*)(?: title=\"(.*?)\")?\n(.*?)^```$", re.M | re.S)
PROMPT = re.compile(r"^(?:[A-Z][A-Z-]*> |\d+\] |=> )", re.M)
_APART = re.compile(r"^<!-- installed -->$.*?^<!-- anywhere -->$\n?", re.M | re.S)
_INSTEAD = re.compile(r"^<!-- in the course\n(.*?)^-->$\n?", re.M | re.S)
_NUMBERED = re.compile(r"^(## )\d+\. (?=[A-Z])", re.M)
"""The number of a section: the course leaves some of them out, and numbers its steps."""
_TABS = re.compile(r"^<!-- tabs -->\s*\Z", re.M)
_APART_CODE = re.compile(r"^<!-- (?:lisp|hy) -->\s*\Z", re.M)
TASK = re.compile(
    r"^#+ (?:Task: )?(?P<title>[^\n]*)\n+(?P<comment><!-- task: (?P<name>[\w-]+)\n(?P<toml>.*?)^-->$\n)(?P<body>.*?)(?=^#+ |\Z)",
    re.M | re.S,
)
"""A task and what follows it, in the text of a page in which code is blank (`tasks_in`)."""
_HINT = re.compile(r"^<details><summary>[^\n]*</summary>\n(.*?)^</details>$\n?", re.M | re.S)


class PageError(Exception):
    """A page that the course cannot use. Its text says what is wrong, and where."""


@functools.cache
def pages() -> tuple[Page, ...]:
    """All pages, in their order."""
    return tuple(page(name) for name in contents.NAMES)


@functools.cache
def page(name: str) -> Page:
    """The page of that name. Raises `PageError`."""
    if name not in contents.NAMES:
        raise PageError(f"There is no page {name}. There are {', '.join(contents.NAMES)}.")
    return read(name, (contents.folder() / f"{name}.md").read_text(encoding="utf-8"))


def read(name: str, text: str) -> Page:
    """The page of a text. Raises `PageError`."""
    title, text = _title(name, _NUMBERED.sub(r"\1", _INSTEAD.sub(r"\1", _APART.sub("", text))))
    parts: list[Part] = []
    end = 0
    for match, after in tasks_in(text):
        parts += _parts(text[end : match.start()])
        parts.append(_task(name, match["title"], match["name"], text[slice(*match.span("toml"))], text[match.start("body") : after]))
        end = after
    parts += _parts(text[end:])
    return Page(name, title, tuple(parts))


def tasks_in(text: str):
    """The matches of `TASK` in the text of a page, each with the place where the task ends: behind its last hint."""
    blank = FENCE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)  # a # in code is no heading
    for match in TASK.finditer(blank):
        hints = [hint.end() for hint in _HINT.finditer(blank, match.start("body"), match.end())]
        yield match, hints[-1] if hints else match.end()


def _title(name, text):
    match = re.match(r"# (.*)\n", text)
    if match is None:
        raise PageError(f"{name}.md: its first line is not a heading that begins with #.")
    return match[1], text[match.end() :]


def _parts(text):
    """The parts of a piece of text without tasks."""
    found: list[Part] = []
    end, pending = 0, None  # the part that another block may join, and where it ends
    for match in FENCE.finditer(text):
        part = _part(match)
        between = text[end : match.start()]
        joins = pending is not None and not between.strip() and part is not None
        joined = _joined(found[-1], part) if joins else None
        if joined is not None:
            found[-1], end, pending = joined, match.end(), None
            continue
        if part is None:  # code that is part of the text
            pending = None
            continue
        tabs = _TABS.search(between) is not None
        _add_text(found, _APART_CODE.sub("", _TABS.sub("", between)))
        found.append(part)
        end, pending = match.end(), True if tabs else None
    _add_text(found, text[end:])
    return found


def _add_text(found, markdown):
    markdown = re.sub(r"\n{3,}", "\n\n", markdown).strip("\n")
    if markdown.strip():
        found.append(Text(markdown))


def _part(match):
    """The part that a block of code is, or ``None`` if it belongs to the text."""
    language, title, code = match[1], match[2], match[3]
    if title:
        return File(hy=(title, code)) if language == "hy" else File(lisp=(title, code))
    if language == "lisp" and PROMPT.match(code):
        return Code(lisp=tuple(exchanges(code)))
    if language == "hy" and code.startswith("=> "):
        return Code(hy=tuple(exchanges(code)))
    return None


def _joined(one, other):
    """The part for both languages, of one for each; ``None`` if they are no pair."""
    if type(one) is not type(other) or not (one.lisp and other.hy) or one.hy or other.lisp:
        return None
    return type(one)(lisp=one.lisp, hy=other.hy)


def exchanges(session: str):
    """The `Typed` of a session as a page shows it. What is typed ends with the line on which its parentheses are closed."""
    starts = [*(match.start() for match in PROMPT.finditer(session)), len(session)]
    for start, end in zip(starts, starts[1:]):
        text = session[start:end]
        prompt = PROMPT.match(text)[0]
        lines = text[len(prompt) :].splitlines()
        count = next(number for number in range(1, len(lines) + 1) if _closed("\n".join(lines[:number])) or number == len(lines))
        yield Typed(prompt, "\n".join(lines[:count]), "".join(f"{line}\n" for line in lines[count:]))


def _closed(form):
    return form.count("(") <= form.count(")")


def _task(page_name, title, name, toml, body):
    where = f"{page_name}.md, task {name}"
    try:
        table = tomllib.loads(toml)
    except tomllib.TOMLDecodeError as problem:
        raise PageError(f"{where}: the comment is not TOML: {problem}.")
    checks, helpers = table.pop("check", None), table.pop("helper", ())
    if checks is not None and table:
        raise PageError(f"{where}: beside [[check]] stand {', '.join(table)}. Put them below [[check]].")
    hints = [hint.strip("\n") for hint in _HINT.findall(body)]
    if not hints:
        raise PageError(f"{where}: it has no hints. Write one as <details><summary>Hint 1</summary> ... </details>.")
    body = _HINT.sub("", body)
    start = {}
    for match in FENCE.finditer(body):
        if match[2] == START:
            start[match[1]] = match[3]
    body = re.sub(r"^<!-- tabs -->\n+(?=\Z|[^`])", "", FENCE.sub(lambda match: "" if match[2] == START else match[0], body), flags=re.M)
    title = title.strip()
    return Task(
        name,
        title[:1].upper() + title[1:],
        re.sub(r"\n{3,}", "\n\n", body).strip("\n"),
        start,
        tuple(hints),
        tuple(checks or [table]),
        tuple(helpers),
    )
